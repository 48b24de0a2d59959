//! What is near is never missed.

use proptest::collection::vec;
use proptest::prelude::*;
use proptest::sample::Index;
use vibrissa::family::{Draw, FAMILIES};
use vibrissa::geometry::{Point2, Pose, Segment, Vector2, unit};
use vibrissa::mujoco::Reach;
use vibrissa::solid::{Part, Solid, convex_parts};

/// How many links the whiskers have.
const LINKS: usize = 16;

/// Into how many shares a link, and each side of the platform's body, is divided by the places that are looked at.
const SHARES: usize = 8;

/// Distance (m) of a place from a part; 0 within it.
fn distance(part: &Part, place: Point2) -> f64 {
    match part {
        Part::Cylinder { centre, radius } => ((place - centre).norm() - radius).max(0.0),
        Part::Prism { outline } => {
            let ends = outline.iter().zip(outline.iter().cycle().skip(1));
            let sides = ends.map(|(start, end)| Segment { start: *start, end: *end });
            let is_left = |side: Segment| (side.end - side.start).perp(&(place - side.start)) >= 0.0;
            if sides.clone().all(is_left) {
                0.0
            } else {
                sides.map(|side| side.distance(place)).fold(f64::INFINITY, f64::min)
            }
        }
    }
}

/// The parts, by their indices, that any of these places is as near to as `reach` (m).
fn near(solids: &[Solid], places: &[Point2], reach: f64) -> Vec<usize> {
    let parts = convex_parts(solids).unwrap().into_iter().enumerate();
    let is_near = |part: &Part| places.iter().any(|place| distance(part, *place) <= reach);
    parts.filter(|(_, part)| is_near(part)).map(|(index, _)| index).collect()
}

fn shares() -> impl Iterator<Item = f64> {
    (0..=SHARES).map(|share| share as f64 / SHARES as f64)
}

prop_compose! {
    /// A scene, and in it a pose by an outline: on it, within, or outside.
    fn places()(
        family in 0..FAMILIES.len(), trial in 0..1000_u64, solid: Index, along in 0.0..1.0_f64,
        aside in (-0.12..0.12_f64, -0.12..0.12_f64), heading in -3.2..3.2_f64,
    ) -> (Draw, Pose) {
        let draw = FAMILIES[family].draw(3, trial).unwrap();
        let outline = solid.get(&draw.scene.solids).outline();
        let position = outline.point_at(along * outline.length()) + Vector2::new(aside.0, aside.1);
        (draw, Pose { position, heading })
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(100))]

    #[test]
    fn a_part_that_a_link_is_near_is_found_however_the_whisker_bends(
        (draw, base) in places(), bends in vec((vec(-0.5..0.5_f64, LINKS), 0.0..5e-3_f64), 20),
    ) {
        let Draw { scene, .. } = draw;
        let mut whisker = scene.rig.whiskers[0].clone();
        whisker.shaft.links = LINKS;
        let (reach, length) = (Reach::new(&scene.rig, &scene.solids).unwrap(), whisker.shaft.link_length());
        for (turns, slack) in bends {
            let Pose { position: mut start, heading: mut direction } = base;
            let links: Vec<_> = turns.iter().map(|turn| {
                direction += turn;
                let link = (start, direction);
                start += length * unit(direction);
                link
            }).collect();
            let found: Vec<_> = reach.near_links(&whisker, links.iter().copied(), slack).collect();
            for (link, (start, direction)) in links.into_iter().enumerate() {
                let places: Vec<_> = shares().map(|share| start + share * length * unit(direction)).collect();
                for part in near(&scene.solids, &places, whisker.shaft.link_radius(link) + slack) {
                    prop_assert!(found.contains(&(link, part)), "{}: link {link}, part {part}", scene.name);
                }
            }
            prop_assert!(found.is_sorted(), "pairs ascend");
        }
    }

    #[test]
    fn a_part_that_the_body_is_near_is_found((draw, body) in places(), slack in 0.0..5e-3_f64) {
        let Draw { scene, .. } = draw;
        let [a, b, c, d] = scene.rig.platform.outline_body().map(|corner| body.point_to_world(corner));
        let place = |across: f64, ahead: f64| {
            let (right, left) = (a + ahead * (b - a), d + ahead * (c - d));
            right + across * (left - right)
        };
        let places: Vec<_> = shares().flat_map(|across| shares().map(move |ahead| place(across, ahead))).collect();
        let found = Reach::new(&scene.rig, &scene.solids).unwrap().near_body(&scene.rig.platform, &body, slack);
        for part in near(&scene.solids, &places, slack) {
            prop_assert!(found.contains(&part), "{}: part {part}", scene.name);
        }
    }
}
