//! How a run went through a tunnel, against closed forms.

use crate::runs::run_with;
use proptest::prelude::*;
use vibrissa::geometry::{Contour, ContourSet, Piece, Point2, Pose, TunnelAxis};
use vibrissa::run::Run;
use vibrissa::scene::Truth;
use vibrissa::score::{Passage, Score};
use vibrissa_runtime::rig::Rig;

/// The walls of a straight tunnel up the y axis, 1 m long.
fn tunnel(clear: f64) -> Truth {
    let up = |x: f64| Contour::open(vec![Piece::segment(Point2::new(x, 0.0), Point2::new(x, 1.0))]).unwrap();
    let (left, right) = (up(-0.5 * clear), up(0.5 * clear));
    let reference = ContourSet::new([left.clone(), right.clone()]).unwrap();
    Truth { surfaces: reference.clone(), reference, axes: vec![TunnelAxis::new(up(0.0), left, right)] }
}

/// A run of the platform along x = `aside`, from below the tunnel to above it at 50 mm/s. Its whiskers record tips at these places
/// aside, each from and to a place along the tunnel (m).
fn run_through(aside: f64, whiskers: &[(f64, [f64; 2])]) -> Run {
    let place = |tick: u32| -0.1 + 0.05 / 30.0 * f64::from(tick);
    let tips = |&(x, [from, to]): &(f64, [f64; 2])| {
        let tip = |tick| (from..=to).contains(&place(tick)).then(|| Point2::new(x, place(tick)));
        (0..720).map(tip).collect::<Vec<_>>()
    };
    let mut run = run_with(&whiskers.iter().map(tips).collect::<Vec<_>>());
    for (tick, place) in run.trace.ticks.iter_mut().zip((0..).map(place)) {
        tick.body = Pose { position: Point2::new(aside, place), heading: std::f64::consts::FRAC_PI_2 };
    }
    run
}

fn passage(run: &Run, clear: f64) -> Passage {
    Score::new(run, &tunnel(clear), &Rig::default()).passage.unwrap()
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(16))]

    #[test]
    fn who_goes_along_the_outside_of_a_tunnel_does_not_go_through(clear in 0.18..0.26_f64, off in 0.13..0.3_f64) {
        let outside = [(0.5 * clear + 0.02, [0.0, 1.0]), (0.5 * clear + 0.02, [0.0, 1.0])];
        let passage = passage(&run_through(0.5 * clear + off, &outside), clear);
        prop_assert_eq!((passage.share, passage.wall_coverage()), (0.0, 0.0));
    }

    #[test]
    fn who_goes_through_is_between_the_walls_all_the_way(clear in 0.18..0.26_f64, aside in -0.08..0.08_f64) {
        let both = [(0.5 * clear, [0.0, 1.0]), (-0.5 * clear, [0.0, 1.0])];
        let passage = passage(&run_through(aside, &both), clear);
        prop_assert!(passage.share > 0.99 && passage.wall_coverage() > 0.99, "{:?}", passage);
    }

    /// A side counts from the first contact with either wall to the last one.
    #[test]
    fn a_wall_counts_between_the_first_and_the_last_contact(from in 0.0..0.3_f64, to in 0.6..1.0_f64, part in 0.1..0.9_f64) {
        let whiskers = [(0.11, [from, to]), (-0.11, [from, from + part * (to - from)])];
        let passage = passage(&run_through(0.0, &whiskers), 0.22);
        prop_assert!(passage.right_coverage > 0.99, "{:?}", passage);
        // At the end of what is traced are a tick of the way and the tolerance of coverage.
        prop_assert!((passage.left_coverage - part).abs() < 0.003 / (to - from), "{:?} of {part}", passage);
        prop_assert!(passage.wall_coverage() <= passage.left_coverage);
    }
}

#[test]
fn one_wall_is_enough_where_the_whiskers_do_not_reach_both() {
    // The tips of the reference rig are 253 mm apart.
    for (clear, reaches_both) in [(0.2, true), (0.24, true), (0.26, false), (0.4, false)] {
        let passage = passage(&run_through(0.0, &[(0.5 * clear, [0.0, 1.0])]), clear);
        assert_eq!(passage.reaches_both, reaches_both, "{clear} m");
        assert!((passage.wall_coverage() > 0.99) != reaches_both, "{clear} m: {passage:?}");
    }
}

#[test]
fn without_a_contact_nothing_is_covered_and_without_a_tunnel_there_is_no_passage() {
    let run = run_through(0.0, &[(0.11, [2.0, 3.0])]);
    assert!(passage(&run, 0.22).wall_coverage() <= 0.0);
    let disk: Truth = vibrissa::geometry::circle(Point2::origin(), 0.05).unwrap().into();
    assert_eq!(Score::new(&run, &disk, &Rig::default()).passage, None);
}
