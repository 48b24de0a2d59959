//! The strokes of a run: shafts, trails of the tips and of the platform, and the estimated contour.

use vibrissa_lab::report::WHISKERS;
use vibrissa_lab::run::Trace;
use vibrissa_mujoco::visual::{Drawing, Stroke, top};
use vibrissa_runtime::rig::Rig;
use vibrissa_world::geometry::{BoundingBox, Point2, Pose, unit};
use vibrissa_world::scene::Scene;
use vibrissa_world::world::{Posture, raised};

use super::trail::Trail;

/// Widths of strokes (px).
const TRAIL_WIDTH: f64 = 1.5;
const CONTOUR_WIDTH: f64 = 4.0;
const SHAFT_WIDTH: f64 = 3.0;
/// The colour of the platform's trail, and of whiskers that the policy does not use.
const GREY: [f32; 4] = [0.45, 0.5, 0.55, 1.0];
/// The share of white in the colour of a tip's trail.
const PALE: f32 = 0.5;
/// The margin (m) around the area of a run.
const MARGIN: f64 = 0.02;

/// The strokes of a run up to a tick.
#[derive(Debug)]
pub(super) struct Sketch {
    /// The whiskers of the rig.
    names: Vec<String>,
    /// The whiskers of the trace.
    traced: Vec<String>,
    /// The height (m) of trails, above all objects.
    top: f64,
    platform: Trail,
    /// For each whisker of the trace: its true tip, and its recorded contour.
    tips: Vec<Trail>,
    contours: Vec<Trail>,
}

impl Sketch {
    /// The sketch of a run before its first tick.
    pub(super) fn new(scene: &Scene) -> Self {
        Self {
            names: scene.rig.whiskers.iter().map(|whisker| whisker.name.clone()).collect(),
            traced: Vec::new(),
            top: top(&scene.physics),
            platform: Trail::default(),
            tips: Vec::new(),
            contours: Vec::new(),
        }
    }

    /// Adds the tick with this index, with the true pose of the platform (world frame).
    pub(super) fn add(&mut self, trace: &Trace, tick: usize, body: &Pose) {
        let Some(tick) = trace.ticks.get(tick) else { return };
        if self.traced.is_empty() {
            self.traced.clone_from(&trace.whiskers);
            self.tips = vec![Trail::default(); self.traced.len()];
            self.contours = self.tips.clone();
        }
        self.platform.add(raised(body.position, self.top));
        let whiskers = self.tips.iter_mut().zip(&mut self.contours).zip(&tick.whiskers);
        for ((tip, contour), whisker) in whiskers {
            if let Some(end) = whisker.tip_end {
                tip.add(raised(end, self.top));
            }
            if let Some(recorded) = whisker.tip {
                contour.add(raised(recorded, self.top));
            }
        }
    }

    /// The drawing of a posture with all ticks until now. Later strokes cover earlier ones.
    pub(super) fn drawing(&self, posture: &Posture) -> Drawing {
        let mut strokes = Vec::new();
        for (points, name) in posture.shafts.iter().zip(&self.names) {
            let index = self.traced.iter().position(|traced| traced == name);
            let colour = index.map_or(GREY, |index| colour(index, 0.0));
            strokes.push(Stroke { points: points.clone(), colour, width: SHAFT_WIDTH });
        }
        let mut add = |trail: &Trail, colour, width| {
            strokes.extend(trail.pieces().into_iter().map(|points| Stroke { points, colour, width }));
        };
        for (whisker, contour) in self.contours.iter().enumerate() {
            add(contour, colour(whisker, 0.0), CONTOUR_WIDTH);
        }
        for (whisker, tip) in self.tips.iter().enumerate() {
            add(tip, colour(whisker, PALE), TRAIL_WIDTH);
        }
        add(&self.platform, GREY, TRAIL_WIDTH);
        Drawing { body: posture.body, strokes }
    }
}

/// The colour of a whisker of the trace in the pictures of reports, with this share of white.
fn colour(whisker: usize, white: f32) -> [f32; 4] {
    let hex = WHISKERS[whisker % WHISKERS.len()];
    let part = |from: usize| {
        let byte = hex.get(from..from + 2).and_then(|digits| u8::from_str_radix(digits, 16).ok());
        f32::from(byte.unwrap_or_default()) / 255.0
    };
    let [red, green, blue] = [1, 3, 5].map(|from| part(from) * (1.0 - white) + white);
    [red, green, blue, 1.0]
}

/// The area that shows the reference contours and the rig at all these poses (world frame).
pub(super) fn area<'p>(scene: &Scene, bodies: impl IntoIterator<Item = &'p Pose>) -> BoundingBox {
    let corners = bodies.into_iter().flat_map(|body| corners(&scene.rig, body));
    let corners = corners.filter(|corner| corner.x.is_finite() && corner.y.is_finite());
    let area = corners
        .fold(scene.truth.reference.bounding_box(), |area, corner| area.union(&BoundingBox::around(corner, corner)));
    let margin = nalgebra::Vector2::repeat(MARGIN);
    BoundingBox { min: area.min - margin, max: area.max + margin }
}

/// The corners of the platform and the tips of undeflected whiskers (m, world frame).
fn corners(rig: &Rig, body: &Pose) -> Vec<Point2> {
    let tips =
        rig.whiskers.iter().map(|whisker| whisker.base_body + whisker.shaft.length * unit(whisker.direction_body));
    rig.platform.outline_body().into_iter().chain(tips).map(|corner| body.point_to_world(corner)).collect()
}
