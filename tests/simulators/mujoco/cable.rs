//! The peer's cable in the MuJoCo world, against the elastica.

use std::f64::consts::FRAC_PI_2;

use nalgebra::{Matrix2, Vector2};
use vibrissa::geometry::{Point2, Pose, circle, rotate, unit, wrap};
use vibrissa::mujoco::MujocoWorld;
use vibrissa::mujoco::{Reach, may_be_rigid};
use vibrissa::physics::Physics;
use vibrissa::physics::Preset;
use vibrissa::solid::Solid;
use vibrissa::world::World;
use vibrissa_runtime::mechanics::{Elastica, ShaftShape};
use vibrissa_runtime::rig::Rig;
use vibrissa_runtime::signal::{Command, Sample};

const CENTRE: Point2 = Point2::new(0.4, 0.4);
const RADIUS: f64 = 0.3;
/// A little before the right whisker touches the disk.
const START: Pose = Pose { position: Point2::new(0.0, 0.25), heading: FRAC_PI_2 };
/// How fast it goes ahead (m/s).
const SPEED: f64 = 0.05;
/// So many ticks farther back, 150 mm, both whiskers are out of reach of the disk.
const BACK: u16 = 90;

fn disk() -> [Solid; 1] {
    [Solid::inside(circle(CENTRE, RADIUS).unwrap()).unwrap()]
}

/// The peer's rig, whose cables have so many links.
fn rig(links: usize) -> (Rig, Physics) {
    let (mut rig, physics) = Preset::PeerCable.rig();
    for whisker in &mut rig.whiskers {
        whisker.shaft.links = links;
    }
    (rig, physics)
}

/// Goes ahead to [`START`] for so many ticks, then on for a second and a half, which bends the right whisker; and stands still for a second.
fn press(world: &mut MujocoWorld, before: u16) -> Vec<Sample> {
    let ahead = Command { velocity_world: SPEED * unit(FRAC_PI_2), yaw_rate: 0.0 };
    let commands = (0..before + 45).map(|_| ahead).chain([Command::STOP; 30]);
    commands.flat_map(|command| world.advance(&command).unwrap().to_vec()).collect()
}

/// How far the tip of a pressed cable is from the elastica's against the same disk (m), and by which share its base moment is off.
fn off_the_elastica(links: usize) -> (f64, f64) {
    let (rig, physics) = rig(links);
    let whisker = &rig.whiskers[0];
    let mut world = MujocoWorld::pruned(&rig, &physics, &disk(), START, 0).unwrap();
    let sample = *press(&mut world, 0).last().unwrap();
    let (touched, along) = world.whisker_contact(0).unwrap();
    assert!(along > whisker.shaft.length - 1e-3, "it is the tip that touches");

    // The middle of the wire's end is this far from the disk's; the place of a contact is half as deep as the contact.
    let depth = 2.0 * (RADIUS - (touched - CENTRE).norm());
    let from_centre = RADIUS - depth + whisker.shaft.radius;
    assert!((0.05e-3..0.4e-3).contains(&depth), "it sinks in by {depth} m");

    // A frame at the base in which the whisker bends to the left.
    let heading = sample.body.heading + whisker.direction_body;
    let base = sample.body.point_to_world(whisker.base_body);
    let to_base = |vector: Vector2<f64>| rotate(vector, -heading).component_mul(&Vector2::new(1.0, -1.0));
    let centre = to_base(CENTRE - base);
    let normal = to_base(touched - CENTRE);
    let elastica = Elastica::new(whisker);
    let shape = |angle: f64, direction: f64| -> ShaftShape {
        let mut bend = elastica.straight();
        for share in 1..=10 {
            bend = elastica.solve_tip(angle * f64::from(share) / 10.0, wrap(direction), &bend).unwrap();
        }
        bend
    };
    let gap = |angle: f64, direction: f64| shape(angle, direction).tip_base - (centre + from_centre * unit(direction));
    let (mut angle, mut direction) = (-sample.whiskers[0].base_angle, normal.y.atan2(normal.x));
    let cable = (angle, centre + from_centre * unit(direction));
    for _ in 0..8 {
        let here = gap(angle, direction);
        let by_angle = (gap(angle + 1e-7, direction) - here) / 1e-7;
        let by_direction = (gap(angle, direction + 1e-4) - here) / 1e-4;
        let step = Matrix2::from_columns(&[by_angle, by_direction]).try_inverse().unwrap() * here;
        (angle, direction) = (angle - step.x, direction - step.y);
    }
    assert!(gap(angle, direction).norm() < 1e-9);
    ((shape(angle, direction).tip_base - cable.1).norm(), cable.0 / angle - 1.0)
}

#[test]
fn a_clamped_cable_is_off_the_elastica_by_half_as_much_with_twice_the_links() {
    let [(tip_20, moment_20), (tip_40, moment_40)] = [20, 40].map(off_the_elastica);
    assert!((0.05e-3..0.4e-3).contains(&tip_40) && (0.01..0.04).contains(&moment_40), "{tip_40} m, {moment_40}");
    assert!((1.7..2.3).contains(&(tip_20 / tip_40)), "{tip_20} m, {tip_40} m");
    assert!((1.7..2.3).contains(&(moment_20 / moment_40)), "{moment_20}, {moment_40}");
}

#[test]
fn a_cable_that_was_rigid_in_the_air_feels_the_same_as_one_that_never_was() {
    let (rig, physics) = rig(12);
    let right = &rig.whiskers[0];
    let reach = Reach::new(&rig, &disk()).unwrap();
    let way = SPEED * f64::from(BACK) / rig.sensing.control_rate;
    let start = Pose { position: START.position - way * unit(FRAC_PI_2), ..START };
    let rigid_at = |body: &Pose| may_be_rigid(right, reach.clearance(right, body), 0.0, false);
    assert!(rigid_at(&start) && !rigid_at(&START));

    let bending = Physics { rigid_in_air: false, ..physics.clone() };
    let base_angles = |physics: &Physics, pruned: bool| -> Vec<f64> {
        let build = if pruned { MujocoWorld::pruned } else { MujocoWorld::new };
        let samples = press(&mut build(&rig, physics, &disk(), start, 0).unwrap(), BACK);
        samples.iter().map(|sample| sample.whiskers[0].base_angle).collect()
    };
    let [rigid, bending] = [&physics, &bending].map(|physics| base_angles(physics, true));
    assert_eq!(rigid, base_angles(&physics, false), "what is left out changes nothing");
    // The hinge of a rigid whisker does not turn at all; another's does as soon as the platform goes.
    let still =
        |angles: &[f64]| angles.iter().take_while(|angle| **angle == 0.0).count() as f64 / rig.sensing.sample_rate;
    assert!(still(&rigid) > 1.0 && still(&bending) < 0.1, "{} s, {} s", still(&rigid), still(&bending));
    let (rigid, bending) = (rigid.last().unwrap(), bending.last().unwrap());
    assert!((rigid / bending - 1.0).abs() < 1e-4, "{rigid}, {bending}");
}
