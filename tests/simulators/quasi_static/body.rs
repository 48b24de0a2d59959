//! The platform's body among the solids.

use proptest::prelude::*;
use vibrissa::geometry::{Contour, Point2, Segment, polygon};
use vibrissa::physics::Physics;
use vibrissa::quasi_static::QuasiStaticWorld;
use vibrissa::world::{Fault, World};
use vibrissa_runtime::rig::{Platform, Rig};

use super::scene::{START, command, drive, one_whisker, outlines, points, solids};

/// A wall 20 mm before the nose, out of the whiskers' reach.
fn wall_ahead() -> Vec<vibrissa::solid::Solid> {
    solids([polygon(&points(&[(0.1, 0.2), (0.1, 0.3), (-0.1, 0.3), (-0.1, 0.2)])).unwrap()])
}

/// A rig without whiskers.
fn bare(nose_width: f64) -> Rig {
    Rig { whiskers: Vec::new(), platform: Platform { nose_width, ..Platform::default() }, ..Rig::default() }
}

#[test]
fn a_nose_that_is_a_point_stays_at_the_wall_that_it_runs_into() {
    let mut world = QuasiStaticWorld::new(&bare(0.0), &Physics::default(), &wall_ahead(), START, 0).unwrap();
    let body = drive(&mut world, &command(0.0, 0.02, 0.0), 90).unwrap().body;
    assert!(world.body_touches() && (body.position.y + 0.108 - 0.2).abs() < 1e-6, "{body:?}");
}

#[test]
fn a_body_that_runs_into_a_wall_is_seen_and_stays_there_and_one_that_passes_is_not() {
    let mut world = QuasiStaticWorld::new(&Rig::default(), &Physics::default(), &wall_ahead(), START, 0).unwrap();
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

    let mut world = QuasiStaticWorld::new(&Rig::default(), &Physics::default(), &wall_ahead(), START, 0).unwrap();
    for _ in 0..60 {
        world.advance(&command(0.0, -0.02, 0.0)).unwrap();
        assert!(!world.body_touches());
    }
}

#[test]
fn a_body_that_is_forced_into_a_wall_crashes() {
    let mut rig = Rig::default();
    rig.platform.servo = 1e-3;
    let mut world = QuasiStaticWorld::new(&rig, &Physics::default(), &wall_ahead(), START, 0).unwrap();
    let fault = drive(&mut world, &command(0.0, 1.0, 0.0), 30).unwrap_err();
    assert!(matches!(fault, Fault::Crash { depth, .. } if depth > Physics::default().penetration_limit), "{fault}");
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(60))]

    #[test]
    fn a_body_never_enters_what_it_touches(
        commands in proptest::collection::vec((-0.1..0.1_f64, -0.1..0.1_f64, -1.0..1.0_f64, 5..50_usize), 2..8),
        which in 0..11_usize, nose_width in prop_oneof![Just(0.0), Just(0.03)],
    ) {
        let rig = bare(nose_width);
        let (name, outline) = outlines().swap_remove(which);
        let mut world = QuasiStaticWorld::new(&rig, &Physics::default(), &solids([outline.clone()]), START, 0).unwrap();
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

proptest! {
    /// No point of a blade is as deep as the limit. The base is 1.2 mm beside the body, which does not touch the blade first.
    #[test]
    fn a_base_that_passes_through_a_blade_ends_the_run(
        thickness in 5e-5..1.9e-3_f64, end in 2e-4..1e-3_f64, speed in 0.01..0.2_f64,
    ) {
        let rig = one_whisker();
        let base = START.point_to_world(rig.whiskers[0].base_body);
        let (left, near) = (base.x - end, base.y + 0.02);
        let far = near + thickness;
        let blade = polygon(&points(&[(left, near), (0.3, near), (0.3, far), (left, far)])).unwrap();
        let mut world = QuasiStaticWorld::new(&rig, &Physics::default(), &solids([blade]), START, 0).unwrap();
        let fault = drive(&mut world, &command(0.0, speed, 0.0), 150).unwrap_err();
        prop_assert!(matches!(fault, Fault::Crash { .. }), "{fault}");
    }
}

/// A command along x and y (m/s) with a yaw rate (rad/s), and for how many ticks.
type Way = (f64, f64, f64, usize);

/// What a whisker passes on to its base is some hundredths of a newton, also while it springs from one place to another. Only its
/// first two links cannot give way.
fn is_hardly_moved(outline: &Contour, ways: &[Way]) -> Result<(), String> {
    let (rig, tick) = (one_whisker(), 1.0 / 30.0);
    let mut world = QuasiStaticWorld::new(&rig, &Physics::default(), &solids([outline.clone()]), START, 0).unwrap();
    let mut before = START;
    for &(x, y, yaw, ticks) in ways {
        for _ in 0..ticks {
            let Ok(samples) = world.advance(&command(x, y, yaw)) else { return Ok(()) };
            let body = samples.last().unwrap().body;
            if outline.signed_distance(body.point_to_world(rig.whiskers[0].base_body)) < 12.5e-3 {
                return Ok(());
            }
            let (way, turn) = ((body.position - before.position).norm(), (body.heading - before.heading).abs());
            if way > 0.15 * tick || turn > 3.0 * tick {
                return Err(format!("{way} m and {turn} rad in a tick at {}", before.position));
            }
            before = body;
        }
    }
    Ok(())
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(200))]

    #[test]
    fn a_whisker_hardly_moves_the_body(
        ways in proptest::collection::vec((-0.05..0.08_f64, -0.05..0.05_f64, -2.5..2.5_f64, 1..12_usize), 5..40),
        which in 0..11_usize,
    ) {
        let (name, outline) = outlines().swap_remove(which);
        let checked = is_hardly_moved(&outline, &ways);
        prop_assert!(checked.is_ok(), "{name}: {}", checked.unwrap_err());
    }
}

/// The steps of Newton's method on its way had forces that threw the body by 8e18 m, on these ways to the last digit.
#[test]
fn a_whisker_on_its_way_does_not_throw_the_body() {
    let ways = [
        (0.051_926_605_045_687_2, -0.049_042_736_207_302_776, 1.582_215_286_059_265_3, 5),
        (-0.036_538_541_814_679_144, -0.004_984_581_526_597_484, 1.149_537_223_473_597_2, 11),
        (0.023_061_157_033_956_673, 0.0, 0.083_982_564_740_736_58, 8),
        (-0.024_286_107_811_164_01, -0.019_824_797_162_098_704, 1.686_332_591_199_371_8, 2),
        (0.034_827_003_692_326_21, -0.033_376_948_497_490_525, -2.106_316_839_960_619_4, 2),
        (-0.036_923_884_155_557_93, 0.049_589_930_036_984_1, -1.716_746_340_926_260_4, 7),
        (0.018_286_341_719_507_923, 0.033_903_920_597_261_133, 0.326_431_926_386_248_1, 9),
        (0.053_199_465_541_979_92, 0.047_842_371_908_134_666, -2.048_793_860_560_445_4, 7),
        (0.052_651_959_495_132_42, 0.011_595_505_054_570_491, -1.819_179_081_767_776_2, 7),
        (0.070_556_407_842_455_93, 0.0, 0.0, 2),
        (0.068_594_331_248_054_6, 0.0, -1.919_040_883_720_802_6, 11),
        (0.047_036_307_726_561_574, 0.0, -0.043_862_496_893_682_44, 3),
        (0.033_871_230_200_776_09, 0.0, 2.368_968_715_748_646_8, 5),
        (-0.022_192_383_330_070_203, -0.041_232_946_851_410_414, 1.412_481_184_574_206_7, 8),
    ];
    let (_, notch) = outlines().swap_remove(8);
    assert_eq!(is_hardly_moved(&notch, &ways), Ok(()));
}
