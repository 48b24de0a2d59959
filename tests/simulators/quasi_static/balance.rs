//! From what its base feels, a whisker under one force is known from end to end. So readings can be checked for being those of a
//! whisker in balance, without knowing how they came about.

use std::f64::consts::PI;

use proptest::prelude::*;
use vibrissa::geometry::{Contour, Point2, Pose, Vector2, polygon, unit};
use vibrissa::physics::Physics;
use vibrissa::quasi_static::QuasiStaticWorld;
use vibrissa::world::{Fault, World};
use vibrissa_runtime::rig::{Rig, Whisker};
use vibrissa_runtime::signal::{Command, Reading, Sample};

use super::scene::{START, command, drive, one_whisker, outlines, solids};

/// A whisker followed from its base on.
struct Followed {
    /// The base and the ends of all links (m, world frame).
    ends: Vec<Point2>,
    along: Vec<Vector2>,
    /// The bending moment (N m) at the base of every link, and at the tip.
    moments: Vec<f64>,
    /// The force at the base (N, world frame).
    force: Vector2,
}

impl Followed {
    /// As if nothing touched it but at its tip.
    fn new(whisker: &Whisker, base: Pose, reading: &Reading) -> Self {
        let mut angle = base.heading + reading.base_angle;
        let force = reading.axial.unwrap() * unit(angle) + reading.shear.unwrap() * unit(angle + PI / 2.0);
        let mut moment = whisker.hinge.stiffness * reading.base_angle;
        let (mut ends, mut along, mut moments) = (vec![base.position], Vec::new(), Vec::new());
        for (stiffness, rest) in whisker.shaft.joint_stiffnesses().zip(whisker.shaft.rest_angles()) {
            moments.push(moment);
            angle += rest + moment / stiffness;
            along.push(unit(angle));
            moment -= whisker.shaft.link_length() * unit(angle).perp(&force);
            ends.push(ends[ends.len() - 1] + whisker.shaft.link_length() * unit(angle));
        }
        moments.push(moment);
        Self { ends, along, moments, force }
    }
}

fn base(whisker: &Whisker, body: Pose) -> Pose {
    Pose { position: body.point_to_world(whisker.base_body), heading: body.heading + whisker.direction_body }
}

/// Whether the moment comes down to nothing just where something without friction touches, and the whisker is outside of all.
/// `None` where more than one thing seems to touch. A whisker without a force has the shape at rest, but for what its hinge's damper is late
/// by: that fades from the sample before.
fn check(rig: &Rig, outlines: &[Contour], [before, sample]: [&Sample; 2]) -> Result<Option<()>, String> {
    let whisker = &rig.whiskers[0];
    let (reading, radius, link) = (&sample.whiskers[0], whisker.shaft.radius, whisker.shaft.link_length());
    let followed = Followed::new(whisker, base(whisker, sample.body), reading);
    let distance = |point: Point2| outlines.iter().map(|o| o.signed_distance(point)).fold(f64::INFINITY, f64::min);
    if distance(followed.ends[1]) < 2.0 * radius || distance(followed.ends[0]) < 2.0 * radius {
        // So near to its base it cannot give way.
        return Ok(None);
    }
    // The first link on which the moment comes down to nothing, and where on it.
    let touched = followed.moments.windows(2).position(|pair| pair[0] * pair[1] <= 0.0 || pair[1].abs() < 1e-11);
    let (touched, along) = if followed.force.norm() == 0.0 {
        let (before, passed) = (&before.whiskers[0], sample.time - before.time);
        let fading = (-passed * whisker.hinge.stiffness / whisker.hinge.damping).exp();
        if (before.axial, before.shear) != (Some(0.0), Some(0.0)) {
            // It has come off just now.
            return Ok(None);
        }
        if (reading.base_angle - fading * before.base_angle).abs() > 1e-12 {
            return Err("bent without a force".to_owned());
        }
        (followed.along.len() - 1, link)
    } else {
        let Some(touched) = touched else { return Ok(None) };
        let (before, after) = (followed.moments[touched], followed.moments[touched + 1]);
        let share = if after.abs() < 1e-11 { 1.0 } else { before / (before - after) };
        let place = followed.ends[touched] + share * link * followed.along[touched];
        if (distance(place) - radius).abs() > 2e-7 {
            // Two forces, which together are not where one would be.
            return Ok(None);
        }
        let push = followed.force.normalize();
        let probe = 1e-7;
        let rises = (distance(place + probe * push) - distance(place)) / probe;
        if rises < 0.999 {
            return Err(format!("the force is not square to what is touched: {rises}"));
        }
        if touched + 1 < followed.along.len() && share < 0.9999 && push.dot(&followed.along[touched]).abs() > 1e-4 {
            return Err("a force on the side that is not square to it".to_owned());
        }
        (touched, share * link)
    };
    // Behind the touch it has the shape at rest.
    let mut ends = followed.ends[..=touched].to_vec();
    let mut direction = followed.along[touched].y.atan2(followed.along[touched].x);
    for (behind, rest) in whisker.shaft.rest_angles().skip(touched).enumerate() {
        direction += if behind == 0 { 0.0 } else { rest };
        ends.push(ends[ends.len() - 1] + link * unit(direction));
    }
    for (from, to) in ends.iter().zip(&ends[1..]) {
        for step in 0..=20 {
            let place = from + (to - from) * (f64::from(step) / 20.0);
            if distance(place) < radius - 1e-6 {
                return Err(format!(
                    "{:.1} um inside, touched at link {touched}, {along} m",
                    (radius - distance(place)) * 1e6
                ));
            }
        }
    }
    Ok(Some(()))
}

fn commands() -> impl Strategy<Value = Vec<(Command, usize)>> {
    let command = (-0.06..0.09_f64, -0.09..0.09_f64, -0.6..0.6_f64).prop_map(|(x, y, yaw)| command(x, y, yaw));
    proptest::collection::vec((command, 5..60_usize), 3..9)
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(120))]

    #[test]
    fn a_whisker_that_has_come_to_rest_is_in_balance_and_outside_of_all(
        commands in commands(), which in 0..11_usize, curvature in prop_oneof![Just(0.0), -0.4..0.4_f64],
    ) {
        let mut rig = one_whisker();
        rig.whiskers[0].shaft.curvature = curvature;
        let (name, outline) = outlines().swap_remove(which);
        let outlines = [outline];
        let mut world = QuasiStaticWorld::new(&rig, &Physics::default(), &solids(outlines.clone()), START, 0).unwrap();
        for (command, ticks) in commands {
            let mut resting = None;
            for command in std::iter::repeat_n(command, ticks).chain(std::iter::repeat_n(Command::STOP, 30)) {
                match world.advance(&command) {
                    Ok(samples) => {
                        // The base is a part of the platform, and may be in a solid up to the permitted depth. There, and
                        // after it has gone around a corner that way, the whisker has no equilibrium outside of the solid.
                        let is_outside = |sample: &Sample| {
                            outlines[0].signed_distance(base(&rig.whiskers[0], sample.body).position) > 0.0
                        };
                        if !samples.iter().all(is_outside) {
                            return Ok(());
                        }
                        resting = samples.last_chunk().copied();
                    }
                    Err(Fault::Crash { .. }) => return Ok(()),
                    Err(fault) => {
                        // What is driven into something by its first two links cannot give way.
                        let base = resting.map(|[_, sample]: [Sample; 2]| base(&rig.whiskers[0], sample.body));
                        let is_base = base.is_some_and(|base| outlines[0].signed_distance(base.position) < 12.5e-3);
                        prop_assert!(is_base && matches!(fault, Fault::Penetration { .. }), "{name}: {fault}");
                        return Ok(());
                    }
                }
            }
            let [before, sample] = resting.unwrap();
            let checked = check(&rig, &outlines, [&before, &sample]);
            prop_assert!(checked.is_ok(), "{name} at {} s: {}", sample.time, checked.unwrap_err());
        }
    }
}

/// What presses on the first link turns it about its base alone.
#[test]
fn a_whisker_rests_with_its_first_link_on_a_corner() {
    let rig = one_whisker();
    let base = base(&rig.whiskers[0], START);
    let (along, right) = (unit(base.heading), unit(base.heading - PI / 2.0));
    let at = |ahead: f64, aside: f64| base.position + ahead * along + aside * right;
    let spike = polygon(&[at(3e-3, 1e-3), at(0.06, 0.05), at(0.06, 0.02)]).unwrap();
    let mut world = QuasiStaticWorld::new(&rig, &Physics::default(), &solids([spike]), START, 0).unwrap();
    let command = command(5e-3 * right.x, 5e-3 * right.y, 0.0);
    drive(&mut world, &command, 30).unwrap();
    for _ in 0..90 {
        let sample = drive(&mut world, &command, 1).unwrap();
        let (reading, base) = (&sample.whiskers[0], self::base(&rig.whiskers[0], sample.body));
        let force = Followed::new(&rig.whiskers[0], base, reading).force;
        let (moment, held) =
            (rig.whiskers[0].hinge.stiffness * reading.base_angle, (at(3e-3, 1e-3) - base.position).perp(&force));
        assert!(moment > 0.0 && (held / moment - 1.0).abs() < 0.01, "{moment} {held}");
    }
}

/// Forces on one link by a circle all go through its centre, so that a third can only take the place of another.
#[test]
fn a_whisker_that_a_pin_has_bent_comes_to_rest() {
    let ways = [
        (-0.01195, 0.03536, 0.48353, 34),
        (0.03236, -0.01679, -0.1596, 48),
        (-0.04919, -0.08545, 0.1453, 12),
        (0.05683, 0.03978, -0.424, 41),
    ];
    let (_, pin) = outlines().swap_remove(1);
    let mut world = QuasiStaticWorld::new(&one_whisker(), &Physics::default(), &solids([pin]), START, 0).unwrap();
    for (x, y, yaw_rate, ticks) in ways {
        drive(&mut world, &command(x, y, yaw_rate), ticks).unwrap();
        drive(&mut world, &Command::STOP, 30).unwrap();
    }
}
