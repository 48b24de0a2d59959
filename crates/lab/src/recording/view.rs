//! What viewers draw: the scene, the body, its whiskers and the recorded contour, as messages of Foxglove.
//!
//! Foxglove and Lichtblick draw `SceneUpdate`. Rerun draws transforms, poses and clouds of points. A recording has both.

use foxglove::bytes::Bytes;
use foxglove::messages::packed_element_field::NumericType;
use foxglove::messages::{
    Color, FrameTransform, LinePrimitive, PackedElementField, Point3, PointCloud, Pose, PoseInFrame, Quaternion,
    SceneEntity, SceneUpdate, Timestamp, Vector3, line_primitive,
};
use vibrissa_runtime::math;
use vibrissa_runtime::rig::Rig;

use crate::run::TickRecord;
use crate::stream::{outline_points, shaft_points};
use vibrissa_world::geometry::{Contour, ContourSet, Point2};

/// The frame of the scene.
const WORLD: &str = "world";
/// The frame of the platform: its origin is the centre of mass, and its x axis the heading.
const BODY: &str = "body";

/// Drawn coordinates are multiples of this (m), 8 µm. Further digits cannot be seen and need space.
const RESOLUTION: f64 = 1.0 / 131_072.0;
/// The distance (m) of the points of an outline.
const POINT_DISTANCE: f64 = 3e-3;

/// The pose of what is drawn in its own frame.
const ORIGIN: Pose = Pose {
    position: Some(Vector3 { x: 0.0, y: 0.0, z: 0.0 }),
    orientation: Some(Quaternion { x: 0.0, y: 0.0, z: 0.0, w: 1.0 }),
};

const OBJECT: Color = Color { r: 0.45, g: 0.5, b: 0.56, a: 1.0 };
const PLATFORM: Color = Color { r: 0.2, g: 0.35, b: 0.6, a: 1.0 };
const WHISKER: Color = Color { r: 0.85, g: 0.45, b: 0.1, a: 1.0 };

/// Makes the messages of a run.
#[derive(Debug)]
pub(super) struct View {
    rig: Rig,
    /// For each whisker of the trace, its index in the rig.
    whiskers: Vec<usize>,
    /// The recorded tips.
    contour: Vec<Point2>,
    /// The number of points of the last message of the contour.
    sent: usize,
}

impl View {
    /// The view of a run whose trace has the whiskers with these names.
    pub(super) fn new(rig: Rig, names: &[String]) -> Self {
        let index = |name: &String| rig.whiskers.iter().position(|whisker| whisker.name == *name);
        let whiskers = names.iter().filter_map(index).collect();
        Self { rig, whiskers, contour: Vec::new(), sent: 0 }
    }

    /// The outlines of all objects.
    pub(super) fn scene(surfaces: &ContourSet) -> SceneUpdate {
        let outline = |contour: &Contour| line(&outline_points(contour), contour.is_closed(), 2e-3, OBJECT);
        update("scene", WORLD, 0.0, surfaces.contours().map(outline).collect())
    }

    /// The outlines of all objects as points, for viewers that draw no lines.
    pub(super) fn objects(surfaces: &ContourSet) -> PointCloud {
        let points = |contour: &Contour| {
            let length = contour.length();
            #[expect(
                clippy::cast_possible_truncation,
                clippy::cast_sign_loss,
                reason = "clamped to a small positive number"
            )]
            let count = (length / POINT_DISTANCE).clamp(1.0, 1e5) as u32;
            let point = |k: u32| contour.point_at(length * f64::from(k) / f64::from(count));
            (0..=count).map(point).collect::<Vec<_>>()
        };
        cloud(&surfaces.contours().flat_map(points).collect::<Vec<_>>(), 0.0)
    }

    /// The outline of the platform.
    pub(super) fn platform(&self) -> SceneUpdate {
        let outline = self.rig.platform.outline_body();
        update("platform", BODY, 0.0, vec![line(&outline, true, 2e-3, PLATFORM)])
    }

    /// The whiskers of a tick, bent to their true tips.
    pub(super) fn whiskers(&self, tick: &TickRecord) -> SceneUpdate {
        let shafts = self.whiskers.iter().enumerate().filter_map(|(index, &in_rig)| {
            let whisker = self.rig.whiskers.get(in_rig)?;
            // A replay knows no true tips.
            let tip_world =
                tick.whiskers[index].tip_end.filter(|tip| tip.coords.iter().all(|part| part.is_finite()))?;
            let tip = tick.body.point_from_world(tip_world);
            Some(line(&shaft_points(whisker, tick.whiskers[index].deflection, tip), false, 1.5e-3, WHISKER))
        });
        update("whiskers", BODY, tick.time, shafts.collect())
    }

    /// The pose of the platform, as transform and as pose.
    pub(super) fn pose(tick: &TickRecord) -> (FrameTransform, PoseInFrame) {
        let [x, y] = [tick.body.position.x, tick.body.position.y].map(rounded);
        let half = math::atan2(math::sin_cos(tick.body.heading).0, math::cos(tick.body.heading)) / 2.0;
        let rotation = Quaternion { x: 0.0, y: 0.0, z: math::sin(half), w: math::cos(half) };
        let translation = Vector3 { x, y, z: 0.0 };
        let timestamp = Some(timestamp(tick.time));
        (
            FrameTransform {
                timestamp,
                parent_frame_id: WORLD.to_owned(),
                child_frame_id: BODY.to_owned(),
                translation: Some(translation),
                rotation: Some(rotation),
            },
            PoseInFrame {
                timestamp,
                frame_id: WORLD.to_owned(),
                pose: Some(Pose { position: Some(translation), orientation: Some(rotation) }),
            },
        )
    }

    /// The estimated tips of the whiskers that touch.
    pub(super) fn tips(&self, tick: &TickRecord) -> PointCloud {
        let contacts = tick.whiskers.iter().take(self.whiskers.len()).map(|whisker| whisker.contact);
        let tips: Vec<Point2> =
            contacts.filter(|contact| contact.is_touching).filter_map(|contact| contact.tip_world).collect();
        cloud(&tips, tick.time)
    }

    /// Adds recorded tips.
    pub(super) fn add(&mut self, tips: impl IntoIterator<Item = Point2>) {
        self.contour.extend(tips);
    }

    /// Adds the recorded tips of a tick. The result is the contour, if it has grown by an eighth since the last message. So all
    /// messages together are at most nine times as long as the last one.
    pub(super) fn grown(&mut self, tick: &TickRecord) -> Option<PointCloud> {
        self.contour.extend(tick.tips());
        (self.contour.len() > self.sent + self.sent / 8 + 8).then(|| self.contour(tick.time))
    }

    /// The recorded contour, if it has points that no message has.
    pub(super) fn rest(&mut self, time: f64) -> Option<PointCloud> {
        (self.contour.len() > self.sent).then(|| self.contour(time))
    }

    fn contour(&mut self, time: f64) -> PointCloud {
        self.sent = self.contour.len();
        cloud(&self.contour, time)
    }
}

fn line(points: &[Point2], is_closed: bool, thickness: f64, color: Color) -> LinePrimitive {
    let kind = if is_closed { line_primitive::Type::LineLoop } else { line_primitive::Type::LineStrip };
    LinePrimitive {
        r#type: kind.into(),
        pose: Some(ORIGIN),
        thickness,
        scale_invariant: false,
        points: points.iter().map(|point| Point3 { x: rounded(point.x), y: rounded(point.y), z: 0.0 }).collect(),
        color: Some(color),
        colors: Vec::new(),
        indices: Vec::new(),
    }
}

fn update(id: &str, frame: &str, time: f64, lines: Vec<LinePrimitive>) -> SceneUpdate {
    let entity = SceneEntity {
        timestamp: Some(timestamp(time)),
        frame_id: frame.to_owned(),
        id: id.to_owned(),
        frame_locked: true,
        lines,
        ..SceneEntity::default()
    };
    SceneUpdate { deletions: Vec::new(), entities: vec![entity] }
}

/// Points as 32-bit numbers.
fn cloud(points: &[Point2], time: f64) -> PointCloud {
    let field =
        |name: &str, offset| PackedElementField { name: name.to_owned(), offset, r#type: NumericType::Float32.into() };
    #[expect(clippy::cast_possible_truncation, reason = "only to be drawn")]
    let data: Vec<u8> = points
        .iter()
        .flat_map(|point| [point.x, point.y, 0.0])
        .flat_map(|x| (rounded(x) as f32).to_le_bytes())
        .collect();
    PointCloud {
        timestamp: Some(timestamp(time)),
        frame_id: WORLD.to_owned(),
        pose: Some(ORIGIN),
        point_stride: 12,
        fields: vec![field("x", 0), field("y", 4), field("z", 8)],
        data: Bytes::from(data),
    }
}

fn rounded(coordinate: f64) -> f64 {
    (coordinate / RESOLUTION).round() * RESOLUTION
}

fn timestamp(time: f64) -> Timestamp {
    let nanoseconds = nanoseconds(time);
    let seconds = u32::try_from(nanoseconds / 1_000_000_000).unwrap_or(u32::MAX);
    Timestamp::new(seconds, u32::try_from(nanoseconds % 1_000_000_000).unwrap_or(0))
}

/// A time since the start of the run (s) in nanoseconds. A time that is no number is 0.
pub(super) fn nanoseconds(time: f64) -> u64 {
    #[expect(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "such a cast saturates, and NaN becomes 0"
    )]
    let nanoseconds = (time * 1e9).round() as u64;
    nanoseconds
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "a test may panic")]
    use super::*;
    use crate::run::WhiskerRecord;
    use proptest::prelude::*;
    use vibrissa_runtime::signal::Command;
    use vibrissa_world::geometry::Pose as BodyPose;

    /// A tick of a platform at `body` whose first whisker has its tip at `tip_world` and has recorded it.
    fn tick(body: BodyPose, tip_world: Point2) -> TickRecord {
        let whisker = WhiskerRecord { tip: Some(tip_world), tip_end: Some(tip_world), ..WhiskerRecord::default() };
        TickRecord {
            time: 1.25,
            body,
            state: None,
            whiskers: Box::new([whisker]),
            command: Command::STOP,
            fallback: None,
            body_touches: false,
        }
    }

    fn view() -> View {
        let rig = Rig::default();
        let names = vec![rig.whiskers[0].name.clone()];
        View::new(rig, &names)
    }

    proptest! {
        #[test]
        fn a_drawn_whisker_begins_at_its_base_and_ends_at_its_tip(
            (x, y, heading) in (-1.0..1.0, -1.0..1.0, -3.0..3.0_f64),
            (forward, aside) in (-0.05..0.05, -0.16..-0.1),
        ) {
            let body = BodyPose { position: Point2::new(x, y), heading };
            let tip_body = Point2::new(forward, aside);
            let view = view();
            let update = view.whiskers(&tick(body, body.point_to_world(tip_body)));
            let points = &update.entities[0].lines[0].points;
            let is_at = |point: &Point3, other: Point2| (Point2::new(point.x, point.y) - other).norm() < 2.0 * RESOLUTION;
            prop_assert!(is_at(&points[0], view.rig.whiskers[0].base_body));
            prop_assert!(is_at(&points[points.len() - 1], tip_body));
            prop_assert_eq!(&update.entities[0].frame_id, BODY);
        }

        #[test]
        fn the_frame_of_the_body_is_its_pose((x, y, heading) in (-1.0..1.0, -1.0..1.0, -9.0..9.0_f64)) {
            let body = BodyPose { position: Point2::new(x, y), heading };
            let (transform, pose) = View::pose(&tick(body, Point2::origin()));
            let rotation = transform.rotation.unwrap();
            let turned = 2.0 * math::atan2(rotation.z, rotation.w);
            prop_assert!(math::sin(turned - heading).abs() < 1e-9 && math::cos(turned - heading) > 0.0);
            prop_assert_eq!(pose.pose.unwrap().orientation, transform.rotation);
            prop_assert!((transform.translation.unwrap().x - x).abs() <= RESOLUTION);
        }
    }

    #[test]
    fn all_messages_of_the_contour_together_are_bounded_by_the_last_one() {
        let mut view = view();
        let tick = tick(BodyPose { position: Point2::origin(), heading: 0.0 }, Point2::new(0.1, 0.1));
        let sizes: Vec<usize> = (0..10_000).filter_map(|_| view.grown(&tick)).map(|cloud| cloud.data.len()).collect();
        let rest = view.rest(1.0).unwrap().data.len();
        assert_eq!(rest, 10_000 * 12);
        assert!(sizes.iter().sum::<usize>() < 10 * rest, "{} of {rest}", sizes.iter().sum::<usize>());
        assert!(view.rest(1.0).is_none());
    }
}
