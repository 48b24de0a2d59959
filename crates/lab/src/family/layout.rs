//! The layout of a random scene: objects, a start, an end. Also the text of its scenario.

use std::fmt::Write;

use super::outline::{turn, turning_angle};
use vibrissa_runtime::math;
use vibrissa_world::geometry::{Contour, Harmonic, Piece, Point2, Pose, Vector2};

/// A scene without its speed and without the deviation of its start.
#[derive(Debug, Clone)]
pub(super) struct Layout {
    /// Description of the scene in a few words and figures.
    pub(super) about: String,
    /// The objects as YAML.
    pub(super) objects: Vec<String>,
    /// The mean start of runs. The rig is collision-free at all starts.
    pub(super) start: Pose,
    /// The end of a run.
    pub(super) aim: Aim,
    /// Approximate length of the path (m).
    pub(super) path_length: f64,
    /// [`REFERENCE`] or [`FORWARD_FACING`].
    pub(super) rig: Rig,
}

/// The differences between the rigs of families.
#[derive(Debug, Clone, Copy)]
pub(super) struct Rig {
    /// Whiskers as YAML with a comma at the end. Empty for those of the reference rig.
    whiskers: &'static str,
    physics: &'static str,
}

/// The end of a run.
#[derive(Debug, Clone, Copy)]
pub(super) enum Aim {
    /// The closed loop around an object.
    Loop,
    /// The passage through a tunnel.
    Through,
    /// All that whiskers reach is traced.
    Everything,
}

impl Aim {
    /// The conditions that end a run, and the expectations of tracing, as YAML. `passage` is the share of a tunnel's axis.
    fn text(self, passage: &str) -> (String, String) {
        match self {
            Self::Loop => ("loop_closed: {within: 5 mm, after: 5 s}".to_owned(), "object_coverage: 95 %".to_owned()),
            Self::Through => (format!("passed: {passage}"), format!("passage: {passage}, wall_coverage: 85 %")),
            Self::Everything => ("succeeded: true".to_owned(), "coverage_in_reach: 95 %".to_owned()),
        }
    }
}

/// The largest error of a recorded tip (m) in a run that passes. It exceeds the errors of every contact estimator in its
/// range: a tip farther off is not on the object.
const WRONG_TIP: f64 = 2e-3;
/// Distance between the end of a tunnel (m) and the platform's centre of mass at which a passage is complete.
const AT_END: f64 = 0.05;
/// Largest distance of the first tick inside a tunnel (m) from its end. At the highest speed the platform moves 3.3 mm
/// in a tick.
const AT_MOUTH: f64 = 0.01;
/// Largest distance that the platform may move before it finds the object (m).
const APPROACH: f64 = 1.0;
/// Time limit as a multiple of the time for the whole path.
const PATH_FACTOR: f64 = 6.0;
/// Time for actions that do not depend on the speed (s).
const FIXED_TIME: f64 = 60.0;
/// The reference rig with short steps and hard contacts, as in the baseline's scenes with corners. A whisker that slips
/// off a corner, or touches an object while it vibrates, penetrates briefly. Longer steps cause deeper penetration.
pub(super) const REFERENCE: Rig =
    Rig { whiskers: "", physics: "physics: {step: 0.5556 ms, contact_time: 1.25 ms, penetration_limit: 3 mm}" };
/// The reference rig with two additional forward-facing whiskers on each side. One is near the corner of the nose and
/// points outwards. Without it, surfaces that turn towards the platform by more than some 60°, or stand beside its
/// path, would first meet the nose. The other points almost straight ahead, for corners between these. Forces on
/// forward-facing whiskers are almost axial. With the soft contacts of the reference rig they would penetrate by
/// millimetres.
pub(super) const FORWARD_FACING: Rig = Rig {
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
        let time = (FIXED_TIME + PATH_FACTOR * (APPROACH + self.path_length) / speed).ceil();
        let passage = format!("{:.2} %", 100.0 * (1.0 - (AT_MOUTH + AT_END) / self.path_length));
        let (aim, expect) = self.aim.text(&passage);
        let mut text = format!(
            "name: {name}\ndescription: {}\nseed: {seed}\nrig: {{{}{}}}\nobjects:\n",
            self.about, self.rig.whiskers, self.rig.physics
        );
        for object in &self.objects {
            // Writing to a string cannot fail.
            let _ = writeln!(text, "  - {object}");
        }
        text + &format!(
            "start: {}\nstop: {{time: {time} s, {aim}}}\nexpect: {{collisions: 0, error_max: {}, {expect}}}\n",
            pose(&self.start),
            metres(WRONG_TIP)
        )
    }
}

/// A polygon as an object.
pub(super) fn polygon(corners: &[Point2]) -> String {
    let corners: Vec<_> = corners.iter().map(|&corner| point(corner)).collect();
    format!("polygon: {{vertices: [{}]}}", corners.join(", "))
}

/// A convex corner at this position (m) as an object. It points along `heading` (rad).
pub(super) fn convex_corner(corner: Point2, heading: f64, angle: f64, side: f64, back: f64) -> String {
    format!(
        "convex_corner: {{corner: {}, heading: {}, angle: {}, side: {}, back: {}}}",
        point(corner),
        degrees(heading),
        degrees(angle),
        metres(side),
        metres(back)
    )
}

/// A concave corner at this position (m) as an object. Its first side has this `heading` (rad). `sizes` are the lengths
/// of both sides and the thickness (m).
pub(super) fn concave_corner(corner: Point2, heading: f64, angle: f64, sizes: [f64; 3]) -> String {
    let [first, second, thickness] = sizes.map(metres);
    format!(
        "concave_corner: {{corner: {}, heading: {}, angle: {}, first: {first}, second: {second}, thickness: {thickness}}}",
        point(corner),
        degrees(heading),
        degrees(angle)
    )
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

/// A convex polygon as an object, counter-clockwise. All corners except the first are rounded by these radii (m), 0 for
/// a sharp corner. Errors of a path accumulate, so its numbers keep all digits.
pub(super) fn rounded_polygon(corners: &[Vector2], radii: &[f64], centre: Point2) -> String {
    // The length of the adjacent sides that the rounding of a corner replaces.
    let taken = |k: usize| radii[k % radii.len()] * math::tan(0.5 * turn(corners, k).2);
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
    let start = format!("{{position: [{} m, {} m], heading: {} rad}}", first.x, first.y, math::atan2(out.y, out.x));
    format!("path: {{start: {start}, moves: [{}], closed: true}}", moves.join(", "))
}

/// A closed outline of segments and arcs as an object. Errors of a path accumulate, so its numbers keep all digits.
pub(super) fn outline(outline: &Contour) -> String {
    let pieces = outline.pieces();
    let mut moves = Vec::new();
    let mut heading: Option<Vector2> = None;
    for (index, piece) in pieces.iter().enumerate() {
        if let Some(before) = heading {
            moves.push(format!("{{turn: {} rad}}", turning_angle(before, piece.tangent_at(0.0))));
        }
        match piece {
            // A closed path has its last side without a move.
            Piece::Segment(_) if index + 1 == pieces.len() => {}
            Piece::Segment(side) => moves.push(format!("{{straight: {} m}}", side.length())),
            Piece::Arc(arc) => moves.push(format!("{{arc: {{radius: {} m, angle: {} rad}}}}", arc.radius, arc.sweep)),
        }
        heading = Some(piece.tangent_at(piece.length()));
    }
    let (first, along) = (outline.point_at(0.0), outline.tangent_at(0.0));
    let start = format!("{{position: [{} m, {} m], heading: {} rad}}", first.x, first.y, math::atan2(along.y, along.x));
    format!("path: {{start: {start}, moves: [{}], closed: true}}", moves.join(", "))
}

/// A tunnel as an object. It begins at `from` and has straight sections, each with its length (m) and heading (rad).
/// `clear` is the distance between the walls (m), perpendicular to each section, and `thickness` that of the walls (m).
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
