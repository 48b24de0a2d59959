//! Features of random shapes: what is added to an outline or removed from it.

use std::f64::consts::{FRAC_PI_2, PI};

use vibrissa_runtime::math;
use vibrissa_world::geometry::{Contour, Path, Point2, Pose, circle, perpendicular, polygon};

/// The tangent of the largest lean of a feature, 30°.
const STEEPEST: f64 = 0.577_350_269_189_625_8;
/// How far features reach beyond the outline that they meet (share of the length of the base).
const BEYOND: f64 = 0.06;

/// A feature at a position on the outline of the base. Sizes are shares of the length of the base.
pub(super) struct Feature {
    /// `None` if there is none.
    pub(super) tool: Option<Tool>,
    /// Position along the outline of the base, 0 to 1.
    pub(super) place: f64,
    /// Rotation against the outward normal (rad).
    pub(super) lean: f64,
    /// Width, from the smallest (0) to the largest (1) of its kind.
    pub(super) width: f64,
    /// Height or depth, from the smallest (0) to the largest (1) of its kind.
    pub(super) depth: f64,
}

/// The kind of a feature.
#[derive(Debug, Clone, Copy)]
pub(super) enum Tool {
    Boss,
    RoundBoss,
    Notch,
    Bite,
    Slot,
    /// A row of so many teeth.
    Teeth(u32),
}

impl Tool {
    /// The kind with this number. `None` for 0.
    pub(super) fn numbered(number: u32, teeth: u32) -> Option<Self> {
        match number {
            1 => Some(Self::Boss),
            2 => Some(Self::RoundBoss),
            3 => Some(Self::Notch),
            4 => Some(Self::Bite),
            5 => Some(Self::Slot),
            6 => Some(Self::Teeth(teeth)),
            _ => None,
        }
    }

    /// True if the feature is added to the outline, false if it is removed.
    pub(super) fn adds(self) -> bool {
        matches!(self, Self::Boss | Self::RoundBoss | Self::Teeth(_))
    }

    pub(super) fn name(self) -> &'static str {
        match self {
            Self::Boss => "boss",
            Self::RoundBoss => "round boss",
            Self::Notch => "notch",
            Self::Bite => "bite",
            Self::Slot => "slot",
            Self::Teeth(_) => "teeth",
        }
    }

    /// The smallest and the largest width, and the smallest and the largest height or depth.
    fn sizes(self) -> [(f64, f64); 2] {
        match self {
            Self::Boss => [(0.12, 0.4), (0.08, 0.35)],
            // The height is that of the centre over the outline, as a share of the radius.
            Self::RoundBoss => [(0.12, 0.4), (-0.4, 0.6)],
            Self::Notch => [(0.1, 0.4), (0.08, 0.4)],
            // The depth is that of the centre below the outline, as a share of the radius.
            Self::Bite => [(0.16, 0.5), (-0.5, 0.3)],
            Self::Slot => [(0.05, 0.14), (0.15, 0.55)],
            Self::Teeth(_) => [(0.3, 0.7), (0.05, 0.15)],
        }
    }
}

impl Feature {
    /// The outline of this feature on a base, larger by a factor.
    pub(super) fn outline(&self, base: &Contour, factor: f64) -> Option<Contour> {
        let tool = self.tool?;
        let [width, depth] = tool.sizes();
        let between = |(least, most): (f64, f64), share: f64| least + share * (most - least);
        let (width, depth) = (factor * between(width, self.width), between(depth, self.depth));
        let s = self.place * base.length();
        let outwards = -perpendicular(base.tangent_at(s));
        // x is along the outline, y outwards.
        let heading = math::atan2(outwards.y, outwards.x) - FRAC_PI_2 + self.lean;
        Some(local(tool, width, depth, factor)?.transformed(&Pose { position: base.point_at(s), heading }))
    }
}

/// The outline of a feature whose foot is at the origin. It points along y.
fn local(tool: Tool, width: f64, depth: f64, factor: f64) -> Option<Contour> {
    // A feature that leans has its foot entirely inside, or its mouth entirely outside.
    let (half, beyond) = (0.5 * width, 0.5 * width * STEEPEST + BEYOND);
    let rectangle =
        |from: f64, to: f64| polygon(&[(-half, from), (half, from), (half, to), (-half, to)].map(point)).ok();
    match tool {
        Tool::Boss => rectangle(-beyond, factor * depth),
        Tool::RoundBoss => circle(Point2::new(0.0, depth * half), half).ok(),
        Tool::Notch => rectangle(-factor * depth, beyond),
        Tool::Bite => circle(Point2::new(0.0, -depth * half), half).ok(),
        Tool::Slot => {
            let straight = factor * depth + beyond;
            let start = Pose { position: Point2::new(half, half - factor * depth), heading: FRAC_PI_2 };
            Path::from(start).straight(straight).arc(half, PI).straight(straight).arc(half, PI).close().ok()
        }
        Tool::Teeth(count) => {
            let pitch = width / f64::from(count);
            let tooth = |k: u32| {
                let left = half - pitch * f64::from(k);
                [(left - 0.5 * pitch, factor * depth), (left - pitch, 0.0)]
            };
            let foot = [(-half, -beyond), (half, -beyond), (half, 0.0)];
            let corners: Vec<Point2> = foot.into_iter().chain((0..count).flat_map(tooth)).map(point).collect();
            polygon(&corners).ok()
        }
    }
}

fn point((x, y): (f64, f64)) -> Point2 {
    Point2::new(x, y)
}
