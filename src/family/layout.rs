//! What a family draws: objects, a start, an aim; and the text of a scenario that they become.

use std::fmt::Write;

use super::outline::turn;
use crate::geometry::{Harmonic, Point2, Pose, Vector2};

/// A scene without its speed, its start not yet varied.
#[derive(Debug, Clone)]
pub(super) struct Layout {
    /// What this scene is like, in a few words and figures.
    pub(super) about: String,
    /// The objects as YAML.
    pub(super) objects: Vec<String>,
    /// The start that those of runs are near. The rig stands clear at all of them.
    pub(super) start: Pose,
    /// When a run is completed.
    pub(super) aim: Aim,
    /// About how long the way is (m).
    pub(super) way: f64,
    /// [`REFERENCE`] or [`FEELERS`].
    pub(super) rig: Rig,
}

/// What differs between the rigs of families.
#[derive(Debug, Clone, Copy)]
pub(super) struct Rig {
    /// Whiskers as YAML, with a comma behind; nothing for those of the reference rig.
    whiskers: &'static str,
    physics: &'static str,
}

/// When a run is completed.
#[derive(Debug, Clone, Copy)]
pub(super) enum Aim {
    /// When an object has been traced all the way round.
    Loop,
    /// When the platform has gone through a tunnel to its end, which is at this place.
    Through(Point2),
}

/// How near the end of a tunnel (m) the platform's centre of mass is when it has gone through.
const AT_END: f64 = 0.05;
/// How far behind the mouth of a tunnel (m) the first tick is at most: at the greatest speed it goes 3.3 mm a tick.
const AT_MOUTH: f64 = 0.01;
/// How far the platform may go until it has found the object (m).
const APPROACH: f64 = 1.0;
/// How often it may go all that, at its speed.
const WAYS: f64 = 6.0;
/// Time for what does not depend on the speed (s).
const REST: f64 = 60.0;
/// The reference rig, with small steps and short contacts, as the thesis's scenes with corners have them: a whisker that springs round
/// a corner, or comes to an object on the swing, sinks in for a moment, and deeper the longer the steps are.
pub(super) const REFERENCE: Rig =
    Rig { whiskers: "", physics: "physics: {step: 0.5556 ms, contact_time: 1.25 ms, penetration_limit: 3 mm}" };
/// The reference rig with two whiskers more a side, which look ahead: one near the corner of the nose that leans out, since what turns
/// towards the platform by more than some 60°, or stands beside its way, would else meet the nose first; and one that points nearly
/// straight on, for corners that come between these. They are pressed on nearly along their shafts, under which contacts that are as
/// long as those of the reference rig give way by millimetres.
pub(super) const FEELERS: Rig = Rig {
    whiskers: "whiskers: {r0: {}, l0: {}, \
     feeler_r: {base: [100 mm, -14 mm], direction: -30 deg, length: 75 mm, radius: 0.11 mm}, \
     feeler_l: {base: [100 mm, 14 mm], direction: 30 deg, length: 75 mm, radius: 0.11 mm}, \
     nose_r: {base: [107 mm, -8 mm], direction: -6 deg, length: 75 mm, radius: 0.11 mm}, \
     nose_l: {base: [107 mm, 8 mm], direction: 6 deg, length: 75 mm, radius: 0.11 mm}}, ",
    physics: "physics: {step: 0.2778 ms, contact_time: 0.6 ms, penetration_limit: 3 mm}",
};

impl Layout {
    /// The scenario at a speed (m/s), as YAML.
    pub(super) fn text(&self, name: &str, seed: u64, speed: f64) -> String {
        let time = (REST + WAYS * (APPROACH + self.way) / speed).ceil();
        let aim = match self.aim {
            Aim::Loop => "loop_closed: {within: 5 mm, after: 5 s}".to_owned(),
            Aim::Through(end) => {
                format!("reached: {{place: {}, within: {}, after: 5 s}}", point(end), metres(AT_END))
            }
        };
        let expect = match self.aim {
            Aim::Loop => "object_coverage: 95 %".to_owned(),
            Aim::Through(_) => {
                // From the first tick behind the mouth to the place where the run ends.
                let passage = 1.0 - (AT_MOUTH + AT_END) / self.way;
                format!("passage: {:.2} %, wall_coverage: 85 %", 100.0 * passage)
            }
        };
        let mut text = format!(
            "name: {name}\ndescription: {}\nseed: {seed}\nrig: {{{}{}}}\nobjects:\n",
            self.about, self.rig.whiskers, self.rig.physics
        );
        for object in &self.objects {
            // Writing to a string cannot fail.
            let _ = writeln!(text, "  - {object}");
        }
        text + &format!(
            "start: {}\nstop: {{time: {time} s, {aim}}}\nexpect: {{collisions: 0, {expect}}}\n",
            pose(&self.start)
        )
    }
}

/// A polygon as an object.
pub(super) fn polygon(corners: &[Point2]) -> String {
    let corners: Vec<_> = corners.iter().map(|&corner| point(corner)).collect();
    format!("polygon: {{vertices: [{}]}}", corners.join(", "))
}

/// A circle as an object.
pub(super) fn circle(centre: Point2, radius: f64) -> String {
    format!("circle: {{centre: {}, radius: {}}}", point(centre), metres(radius))
}

/// A smooth curve as an object.
pub(super) fn polar(centre: Point2, radius: f64, harmonics: &[Harmonic]) -> String {
    let harmonic = |&Harmonic { order, amplitude, phase }: &Harmonic| {
        format!("{{order: {order}, amplitude: {}, phase: {}}}", metres(amplitude), degrees(phase))
    };
    let harmonics: Vec<_> = harmonics.iter().map(harmonic).collect();
    format!("polar: {{centre: {}, radius: {}, harmonics: [{}]}}", point(centre), metres(radius), harmonics.join(", "))
}

/// A convex polygon, counter-clockwise, with its corners but for the first rounded by these radii (m), 0 for a sharp one, as an
/// object. A path adds up, so that its numbers keep all their digits.
pub(super) fn rounded_polygon(corners: &[Vector2], radii: &[f64], centre: Point2) -> String {
    // What the rounding of a corner takes of the sides that meet there.
    let taken = |k: usize| radii[k % radii.len()] * (0.5 * turn(corners, k).2).tan();
    let mut moves = Vec::new();
    for k in 0..corners.len() - 1 {
        let ((into, _, angle), radius) = (turn(corners, k + 1), radii[k + 1]);
        moves.push(format!("{{straight: {} m}}", into.norm() - taken(k) - taken(k + 1)));
        moves.push(if radius > 0.0 {
            format!("{{arc: {{radius: {radius} m, angle: {angle} rad}}}}")
        } else {
            format!("{{turn: {angle} rad}}")
        });
    }
    let (first, out) = (centre + corners[0], turn(corners, 0).1);
    let start = format!("{{position: [{} m, {} m], heading: {} rad}}", first.x, first.y, out.y.atan2(out.x));
    format!("path: {{start: {start}, moves: [{}], closed: true}}", moves.join(", "))
}

/// A tunnel as an object: straight runs, each with its length (m) and heading (rad), from a place on; how much is clear between
/// the walls (m) square to each run, and how thick they are (m).
pub(super) fn tunnel(from: &Pose, runs: &[(f64, f64)], clear: f64, thickness: f64) -> String {
    let runs: Vec<_> = runs
        .iter()
        .map(|&(length, heading)| format!("{{length: {}, heading: {}}}", metres(length), degrees(heading)))
        .collect();
    format!(
        "tunnel: {{frame: {}, centre_line: {{mitred: [{}]}}, width: {}, thickness: {}}}",
        pose(from),
        runs.join(", "),
        metres(clear + thickness),
        metres(thickness)
    )
}

/// A length to the micrometre.
pub(super) fn metres(length: f64) -> String {
    format!("{length:.6} m")
}

/// An angle to some millionths of a radian.
pub(super) fn degrees(angle: f64) -> String {
    format!("{:.4} deg", angle.to_degrees())
}

pub(super) fn point(point: Point2) -> String {
    format!("[{}, {}]", metres(point.x), metres(point.y))
}

fn pose(pose: &Pose) -> String {
    format!("{{position: {}, heading: {}}}", point(pose.position), degrees(pose.heading))
}
