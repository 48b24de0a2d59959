//! The platform's body among the solids.

use proptest::prelude::*;
use vibrissa::geometry::{Point2, Segment, polygon};
use vibrissa::rig::Rig;
use vibrissa::world::{Fault, QuasiStaticWorld, World};

use super::scene::{START, command, drive, outlines, points, solids};

/// A wall 20 mm before the nose, out of the whiskers' reach.
fn wall_ahead() -> Vec<vibrissa::scene::Solid> {
    solids([polygon(&points(&[(0.1, 0.2), (0.1, 0.3), (-0.1, 0.3), (-0.1, 0.2)])).unwrap()])
}

/// A rig without whiskers.
fn bare() -> Rig {
    Rig { whiskers: Vec::new(), ..Rig::default() }
}

#[test]
fn a_body_that_runs_into_a_wall_is_seen_and_stays_there_and_one_that_passes_is_not() {
    let mut world = QuasiStaticWorld::new(&Rig::default(), &wall_ahead(), START, 0).unwrap();
    let touched: Vec<bool> = (0..90)
        .map(|_| {
            world.advance(&command(0.0, 0.02, 0.0)).unwrap();
            world.body_touches()
        })
        .collect();
    let first = touched.iter().position(|&touches| touches).unwrap();
    assert!(!touched[..30].contains(&true) && touched[first..].iter().all(|&touches| touches));
    let nose = drive(&mut world, &command(0.0, 0.02, 0.0), 1).unwrap().body.position.y + 0.108;
    assert!((nose - 0.2).abs() < 1e-6, "{nose}");

    let mut world = QuasiStaticWorld::new(&Rig::default(), &wall_ahead(), START, 0).unwrap();
    for _ in 0..60 {
        world.advance(&command(0.0, -0.02, 0.0)).unwrap();
        assert!(!world.body_touches());
    }
}

#[test]
fn a_body_that_is_forced_into_a_wall_crashes() {
    let mut rig = Rig::default();
    rig.platform.servo = 1e-3;
    let mut world = QuasiStaticWorld::new(&rig, &wall_ahead(), START, 0).unwrap();
    let fault = drive(&mut world, &command(0.0, 1.0, 0.0), 30).unwrap_err();
    assert!(matches!(fault, Fault::Crash { depth, .. } if depth > rig.physics.penetration_limit), "{fault}");
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(60))]

    #[test]
    fn a_body_never_enters_what_it_touches(
        commands in proptest::collection::vec((-0.1..0.1_f64, -0.1..0.1_f64, -1.0..1.0_f64, 5..50_usize), 2..8),
        which in 0..11_usize,
    ) {
        let rig = bare();
        let (name, outline) = outlines().swap_remove(which);
        let mut world = QuasiStaticWorld::new(&rig, &solids([outline.clone()]), START, 0).unwrap();
        for (x, y, yaw, ticks) in commands {
            for _ in 0..ticks {
                let body = match world.advance(&command(x, y, yaw)) {
                    Ok(samples) => samples.last().unwrap().body,
                    Err(fault) => {
                        prop_assert!(matches!(fault, Fault::Crash { .. }), "{name}: {fault}");
                        return Ok(());
                    }
                };
                let corners = rig.platform.outline_body().map(|corner| body.point_to_world(corner));
                for side in 0..4 {
                    let side = Segment { start: corners[side], end: corners[(side + 1) % 4] };
                    for step in 0..=60 {
                        let place: Point2 = side.point_at(side.length() * f64::from(step) / 60.0);
                        let depth = -outline.signed_distance(place);
                        prop_assert!(depth < 2e-4, "{name}: {depth} m at {place}");
                    }
                }
            }
        }
    }
}
