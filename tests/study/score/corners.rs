//! Corners, and what they cost, against closed forms.

use std::f64::consts::{FRAC_PI_2, PI};

use crate::runs::run_with;
use proptest::prelude::*;
use vibrissa::geometry::{Contour, Piece, Point2, Pose, Vector2, perpendicular, polygon, regular_polygon, rotate};
use vibrissa::run::{MarkRecord, Trace};
use vibrissa::score::{CornerFigures, Score, excursions, traced_corners};
use vibrissa_runtime::machine::Mark;
use vibrissa_runtime::rig::Rig;

/// How far tips go in a tick at 50 mm/s and 30 Hz (m).
const STEP: f64 = 0.05 / 30.0;

fn square() -> Contour {
    polygon(&[(0.0, 0.0), (0.2, 0.0), (0.2, 0.2), (0.0, 0.2)].map(|(x, y)| Point2::new(x, y))).unwrap()
}

/// Tips all along an outline, `off` (m) to its right: a function of the index of its piece and the arc length from its start.
fn tips_along(outline: &Contour, off: impl Fn(usize, f64) -> f64) -> Vec<Option<Point2>> {
    let mut tips = Vec::new();
    for (index, piece) in outline.pieces().iter().enumerate() {
        let mut along = 0.3 * STEP;
        while along < piece.length() {
            let right = -perpendicular(piece.tangent_at(along));
            tips.push(Some(piece.point_at(along) + off(index, along) * right));
            along += STEP;
        }
    }
    tips
}

fn trace(tips: Vec<Option<Point2>>) -> Trace {
    run_with(&[tips]).trace
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(64))]

    #[test]
    fn exact_tips_give_exact_corners_wherever_the_outline_stands(
        sides in 3..12_usize, x in -2.0..2.0_f64, y in -2.0..2.0_f64, heading in -PI..PI,
    ) {
        let outline = regular_polygon(Point2::origin(), 0.2, sides, 0.1).unwrap();
        let outline = outline.transformed(&Pose { position: Point2::new(x, y), heading });
        let (corners, count) = traced_corners(&trace(tips_along(&outline, |_, _| 0.0)), &outline.clone().into());
        prop_assert_eq!((corners.len(), count), (sides, sides));
        for corner in corners {
            prop_assert!(corner.place_error() < 1e-9 && corner.turn_error.abs() < 1e-9);
            prop_assert_eq!((corner.edge, corner.time, corner.path), (None, 0.0, 0.0));
        }
    }

    #[test]
    fn sides_that_are_off_move_their_corners_by_as_much(off in prop::array::uniform4(-1e-3..1e-3_f64)) {
        let outline = square();
        let (corners, _) = traced_corners(&trace(tips_along(&outline, |side, _| off[side])), &outline.clone().into());
        prop_assert_eq!(corners.len(), 4);
        for (index, corner) in corners.iter().enumerate() {
            // The corner at the start of a side is where this side and the one before it meet.
            let due = off[index].hypot(off[(index + 3) % 4]);
            prop_assert!((corner.place_error() - due).abs() < 1e-9 && corner.turn_error.abs() < 1e-9);
        }
    }

    #[test]
    fn a_side_that_is_turned_turns_both_its_corners(slope in -0.02..0.02_f64) {
        let outline = square();
        let trace = trace(tips_along(&outline, |side, along| if side == 0 { slope * along } else { 0.0 }));
        let (corners, _) = traced_corners(&trace, &outline.clone().into());
        // To the right means that the corner where the side begins turns less.
        prop_assert!((corners[0].turn_error + slope.atan()).abs() < 1e-9);
        prop_assert!((corners[1].turn_error - slope.atan()).abs() < 1e-9);
        prop_assert!(corners[0].place_error() < 1e-9);
        prop_assert!((corners[1].place_error() - 0.2 * slope.abs()).abs() < 1e-9);
    }

    #[test]
    fn concave_corners_and_curved_sides_count_as_well(radius in 0.08..0.5_f64, off in -1e-3..1e-3_f64) {
        // A disk with a bite of a quarter out of it: two convex corners and one concave one.
        let outline = Contour::closed(vec![
            Piece::arc(Point2::origin(), radius, 0.0, 1.5 * PI),
            Piece::segment(Point2::new(0.0, -radius), Point2::origin()),
            Piece::segment(Point2::origin(), Point2::new(radius, 0.0)),
        ]).unwrap();
        let (corners, count) = traced_corners(&trace(tips_along(&outline, |_, _| off)), &outline.clone().into());
        prop_assert_eq!((corners.len(), count), (3, 3));
        let concave = corners.iter().filter(|corner| corner.corner.turn < 0.0).count();
        prop_assert_eq!(concave, 1);
        for corner in corners {
            prop_assert!((corner.place_error() - off.abs() * 2.0_f64.sqrt()).abs() < 1e-6, "{corner:?}");
        }
    }
}

#[test]
fn a_few_tips_that_are_far_off_do_not_move_a_corner() {
    let outline = square();
    let mut tips = tips_along(&outline, |_, _| 0.0);
    for tip in tips.iter_mut().step_by(6) {
        *tip = tip.map(|tip| tip + Vector2::new(0.003, 0.004));
    }
    let (corners, _) = traced_corners(&trace(tips), &outline.clone().into());
    assert!(corners.iter().all(|corner| corner.place_error() < 1e-4 && corner.turn_error.abs() < 1e-3), "{corners:?}");
}

#[test]
fn smooth_outlines_and_slight_corners_have_no_figures() {
    let many = regular_polygon(Point2::origin(), 0.2, 19, 0.0).unwrap();
    assert_eq!(CornerFigures::new(&trace(tips_along(&many, |_, _| 0.0)), &many.clone().into()), None);
    let run = run_with(&[]);
    let figures = Score::new(&run, &square().into(), &Rig::default()).corners.unwrap();
    assert_eq!((figures.count, figures.traced, figures.place, figures.time), (4, 0, None, None));
}

#[test]
fn a_corner_that_was_traced_on_one_side_only_does_not_count() {
    let outline = square();
    let tips = tips_along(&outline, |_, _| 0.0);
    let half = tips.len() / 2;
    let (corners, count) = traced_corners(&trace(tips[..half].to_vec()), &outline.clone().into());
    assert_eq!((corners.len(), count), (1, 4));
    assert!((corners[0].corner.point - Point2::new(0.2, 0.0)).norm() < 1e-12);
}

#[test]
fn the_ends_of_a_thin_wall_have_two_corners_each() {
    let wall = polygon(&[(0.0, 0.0), (0.3, 0.0), (0.3, 0.01), (0.0, 0.01)].map(|(x, y)| Point2::new(x, y))).unwrap();
    let (corners, _) = traced_corners(&trace(tips_along(&wall, |_, _| 0.0)), &wall.clone().into());
    assert_eq!(corners.len(), 4);
}

/// Tips along the square with a break of `missing` ticks at its second corner, and the index of the last tick before it.
fn broken(missing: usize) -> (Trace, usize) {
    let mut tips = tips_along(&square(), |_, _| 0.0);
    let last = tips.iter().rposition(|tip| tip.unwrap().y.abs() < 1e-12 && tip.unwrap().x <= 0.2).unwrap();
    tips.splice(last + 1..=last, vec![None; missing]);
    (trace(tips), last)
}

#[test]
fn a_break_in_the_tips_at_a_corner_is_what_the_corner_costs() {
    let (trace, last) = broken(59);
    let (corners, _) = traced_corners(&trace, &square().into());
    let costly: Vec<_> = corners.iter().filter(|corner| corner.edge.is_some()).collect();
    assert_eq!(costly.len(), 1);
    assert!((costly[0].corner.point - Point2::new(0.2, 0.0)).norm() < 1e-12);
    // The platform of these runs goes at 50 mm/s.
    assert!((costly[0].time - 2.0).abs() < 1e-9 && (costly[0].path - 0.1).abs() < 1e-9);
    let edge = trace.ticks[last].whiskers[0].tip.unwrap();
    assert!((costly[0].edge.unwrap() - (0.2 - edge.x)).abs() < 1e-12);
    let figures = CornerFigures::new(&trace, &square().into()).unwrap();
    assert!((figures.time.unwrap().moments.mean - 0.5).abs() < 1e-9 && (figures.time.unwrap().max - 2.0).abs() < 1e-9);
    assert_eq!(excursions(&broken(2).0), []);
}

#[test]
fn marks_say_when_the_way_round_a_corner_ends() {
    let (mut trace, last) = broken(59);
    // A contact is recorded, and lost again, before the whisker is back for good.
    trace.ticks[last + 30].whiskers[0].tip = Some(Point2::new(0.2, 0.01));
    assert_eq!(excursions(&trace).len(), 2);
    let mark = |mark, tick| MarkRecord { mark, whisker: 0, tick, tip_world: Point2::new(0.2, 0.01) };
    trace.marks = vec![mark(Mark::Lost, last + 4), mark(Mark::Found, last + 31)];
    let marked = excursions(&trace);
    assert_eq!(marked.len(), 1);
    assert!((marked[0].time - 2.0).abs() < 1e-9 && (marked[0].path - 0.1).abs() < 1e-9);
    trace.marks.pop();
    assert_eq!(excursions(&trace).len(), 2, "without `found` the breaks alone say when it was back");
}

#[test]
fn a_way_that_is_marked_twice_is_counted_once() {
    let (mut trace, last) = broken(59);
    let mark = |mark, tick| MarkRecord { mark, whisker: 0, tick, tip_world: Point2::new(0.2, 0.01) };
    let marks = [(Mark::Lost, 4), (Mark::Found, 20), (Mark::Lost, 21), (Mark::Found, 40)];
    let plain = excursions(&trace);
    trace.marks = marks.map(|(kind, tick)| mark(kind, last + tick)).to_vec();
    assert_eq!(excursions(&trace), plain);
}

#[test]
fn an_estimate_turned_about_a_corner_keeps_its_place_and_its_angle() {
    let outline = square();
    let about = Point2::new(0.2, 0.0);
    let turned = |tip: Point2| about + rotate(tip - about, 0.02);
    let tips = tips_along(&outline, |_, _| 0.0).into_iter().map(|tip| tip.map(turned)).collect();
    let (corners, _) = traced_corners(&trace(tips), &outline.clone().into());
    assert!(corners[1].place_error() < 1e-9 && corners[1].turn_error.abs() < 1e-9);
    assert!((corners[1].corner.turn - FRAC_PI_2).abs() < 1e-12);
}
