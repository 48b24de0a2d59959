//! What a family draws: objects, a start, an aim; and the text of a scenario that they become.

use std::f64::consts::FRAC_PI_2;
use std::fmt::Write;

use crate::geometry::{Point2, Pose};

/// A scene without its speed, its start not yet varied.
#[derive(Debug, Clone)]
pub(super) struct Layout {
    /// What this scene is like, in a few words and figures.
    pub(super) about: String,
    /// The objects as YAML.
    pub(super) objects: Vec<String>,
    /// How whiskers meet them in the simulation.
    pub(super) physics: Contact,
    /// The start that others are near.
    pub(super) start: Pose,
    /// When a run is completed.
    pub(super) aim: Aim,
    /// About how long the way is (m).
    pub(super) way: f64,
}

/// What a scene is to the simulation, as in the scenes of the thesis.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Contact {
    /// A whisker springs round a sharp corner.
    Sharp,
    /// It springs round an edge against a wall that faces it, and sinks in for a moment.
    Facing,
}

/// When a run is completed.
#[derive(Debug, Clone, Copy)]
pub(super) enum Aim {
    /// When an object has been traced all the way round.
    Loop,
    /// When the platform is at a place.
    Place(Point2),
}

/// How far the start beside an object is turned towards it (rad).
const INCLINATION: f64 = 0.35;

/// Time that a run has to find the object (s).
const APPROACH_TIME: f64 = 60.0;
/// How often the way may be gone in the rest of the time.
const WAYS: f64 = 6.0;

impl Layout {
    /// The scenario at a speed (m/s), as YAML.
    pub(super) fn text(&self, name: &str, seed: u64, speed: f64) -> String {
        let physics = match self.physics {
            Contact::Sharp => "{step: 1.1111 ms, contact_time: 2.5 ms, penetration_limit: 3 mm}",
            Contact::Facing => "{step: 1.1111 ms, penetration_limit: 3 mm}",
        };
        let time = (APPROACH_TIME + WAYS * self.way / speed).ceil();
        let aim = match self.aim {
            Aim::Loop => "loop_closed: {within: 5 mm, after: 5 s}".to_owned(),
            Aim::Place(place) => format!("reached: {{place: {}, within: 50 mm, after: 5 s}}", point(place)),
        };
        let mut text =
            format!("name: {name}\ndescription: {}\nseed: {seed}\nrig: {{physics: {physics}}}\nobjects:\n", self.about);
        for object in &self.objects {
            // Writing to a string cannot fail.
            let _ = writeln!(text, "  - {object}");
        }
        text + &format!("start: {}\nstop: {{time: {time} s, {aim}}}\n", pose(&self.start))
    }
}

/// The start beside an object that stands 0.2 m to the right or left (`hand` +1 or −1) of the line that goes up through it,
/// turned a little towards it.
pub(super) fn beside(hand: f64) -> Pose {
    Pose { position: Point2::new(0.0, 0.072), heading: FRAC_PI_2 - hand * INCLINATION }
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

/// A convex polygon, counter-clockwise, with its corners but for the first rounded by these radii (m), 0 for a sharp one, as an
/// object. A path adds up, so that its numbers keep all their digits.
pub(super) fn rounded_polygon(corners: &[Point2], radii: &[f64]) -> String {
    let count = corners.len();
    let side = |k: usize| corners[(k + 1) % count] - corners[k];
    let turn = |k: usize| {
        let (into, out) = (side((k + count - 1) % count), side(k));
        into.perp(&out).atan2(into.dot(&out))
    };
    // What the rounding of a corner takes of the sides that meet there.
    let taken = |k: usize| radii[k % count] * (0.5 * turn(k % count)).tan();
    let mut moves = Vec::new();
    for k in 0..count - 1 {
        let (next, length) = (k + 1, side(k).norm() - taken(k) - taken(k + 1));
        moves.push(format!("{{straight: {length} m}}"));
        moves.push(if radii[next] > 0.0 {
            format!("{{arc: {{radius: {} m, angle: {} rad}}}}", radii[next], turn(next))
        } else {
            format!("{{turn: {} rad}}", turn(next))
        });
    }
    let heading = side(0).y.atan2(side(0).x);
    let start = format!("{{position: [{} m, {} m], heading: {heading} rad}}", corners[0].x, corners[0].y);
    format!("path: {{start: {start}, moves: [{}], closed: true}}", moves.join(", "))
}

/// A tunnel as an object: straight runs, each with its length (m) and heading (rad), from a place on; clear between the walls.
pub(super) fn tunnel(from: &Pose, runs: &[(f64, f64)], width: f64, thickness: f64) -> String {
    let runs: Vec<_> = runs
        .iter()
        .map(|&(length, heading)| format!("{{length: {}, heading: {}}}", metres(length), degrees(heading)))
        .collect();
    format!(
        "tunnel: {{frame: {}, centre_line: {{polyline: [{}]}}, width: {}, thickness: {}}}",
        pose(from),
        runs.join(", "),
        metres(width),
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
