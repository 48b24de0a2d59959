//! Whiskers that bend out of the plane: their weight, and the inclination beyond which they leave the plane.

use std::f64::consts::FRAC_PI_2;

use vibrissa::geometry::{Path, Point2, Pose, Vector2, perpendicular, rotate};
use vibrissa::mujoco::MujocoWorld;
use vibrissa::physics::{Physics, ShaftModel};
use vibrissa::solid::Solid;
use vibrissa::world::World;
use vibrissa_runtime::mechanics::out_of_plane_margin;
use vibrissa_runtime::rig::{Rig, Shaft};
use vibrissa_runtime::signal::Command;

/// Gravitational acceleration (m/s²).
const GRAVITY: f64 = 9.81;
/// The wall lies along y to the right of the platform, with its face at this x (m).
const FACE: f64 = 0.14;
/// The wall is nearer to the base than the tip of the straight whisker, by this distance (m).
const PRESSED: f64 = 3e-3;
/// The inclination of the right whisker beside a wall that is parallel to the heading (rad).
const PARALLEL: f64 = 75.0 * std::f64::consts::PI / 180.0;

fn rig(friction: f64) -> (Rig, Physics) {
    let mut rig = Rig::default();
    rig.whiskers.truncate(1);
    let spatial = Physics { shafts: ShaftModel::SpatialChain, ..Physics::default() };
    let steps = Physics { step: 1.0 / 3600.0, contact_time: 1.25e-3, friction, ..spatial.clone() };
    (rig, if friction > 0.0 { steps } else { spatial })
}

/// The deflection (m) of the tip of a horizontal cantilever under its own weight.
fn droop(shaft: &Shaft) -> f64 {
    let mass: f64 = (0..shaft.links).map(|link| shaft.link_mass(link)).sum();
    mass * GRAVITY * shaft.length.powi(3) / (8.0 * shaft.out_of_plane * shaft.bending_stiffness())
}

/// The largest distances (m) of the tip from the plane, in a tick of one second and of the next second, without objects.
fn in_the_air(rig: &Rig, physics: &Physics) -> [f64; 2] {
    let mut world = MujocoWorld::pruned(rig, physics, &[], Pose::default(), 0).unwrap();
    [30, 30].map(|ticks| {
        let distances = (0..ticks).map(|_| {
            world.advance(&Command::STOP).unwrap();
            world.out_of_plane(0).unwrap().distance
        });
        distances.fold(0.0, f64::max)
    })
}

#[test]
fn a_whisker_at_rest_droops_like_a_cantilever_and_is_in_equilibrium_from_the_start() {
    for stiffer in [1.0, 4.0] {
        let (mut rig, physics) = rig(0.0);
        let shaft = &mut rig.whiskers[0].shaft;
        shaft.out_of_plane = stiffer;
        let expected = droop(shaft);
        let [first, second] = in_the_air(&rig, &physics);
        assert!((second / expected - 1.0).abs() < 0.02, "{second} m, expected {expected} m");
        assert!((first / second - 1.0).abs() < 0.02, "it vibrates: {first} m, then {second} m");
    }
}

#[test]
fn a_pitch_lifts_the_tip_by_its_angle() {
    let (mut rig, physics) = rig(0.0);
    let shaft = rig.whiskers[0].shaft.clone();
    rig.whiskers[0].pitch = (2.0 * droop(&shaft) / shaft.length).asin();
    let [_, above] = in_the_air(&rig, &physics);
    assert!((above / droop(&shaft) - 1.0).abs() < 0.03, "{above} m");
}

/// Presses the whisker against a wall at an inclination of 75°, turns the platform to another inclination (rad) while the tip slides,
/// and slides on. The result is the largest distance (m) of the tip from the plane. It ends at 10 mm.
fn slide_at(inclination: f64, friction: f64) -> f64 {
    let (mut rig, physics) = rig(friction);
    // A tip that droops less shows the instability and not the weight.
    rig.whiskers[0].pitch = 1.2_f64.to_radians();
    let corner = Pose { position: Point2::new(FACE, 2.0), heading: -FRAC_PI_2 };
    let wall = Path::from(corner).straight(4.0).turn(FRAC_PI_2).straight(0.2).turn(FRAC_PI_2).straight(4.0);
    let wall = [Solid::inside(wall.close().unwrap()).unwrap()];
    let base_body = rig.whiskers[0].base_body.coords;
    let start = Pose { position: Point2::new(0.0, -0.5), heading: FRAC_PI_2 };
    let mut world = MujocoWorld::pruned(&rig, &physics, &wall, start, 0).unwrap();
    let length = rig.whiskers[0].shaft.length;
    let (mut body, mut distance) = (start, 0.0_f64);
    for tick in 0..240 {
        let base = rotate(base_body, body.heading);
        let inclination_now = body.heading - FRAC_PI_2 + PARALLEL;
        let yaw_rate = if tick < 60 { 0.0 } else { (4.0 * (inclination - inclination_now)).clamp(-0.5, 0.5) };
        let distance_of_base = FACE - (body.position + base).x;
        let inwards = 4.0 * (distance_of_base - length * inclination_now.sin() + PRESSED);
        let of_base = Vector2::new(inwards.clamp(-0.03, 0.03), 0.05);
        let command = Command { velocity_world: of_base - yaw_rate * perpendicular(base), yaw_rate };
        body = world.advance(&command).unwrap().last().unwrap().body;
        distance = distance.max(world.out_of_plane(0).unwrap().distance);
        if distance > 10e-3 {
            break;
        }
    }
    distance
}

#[test]
fn a_sliding_whisker_stays_in_the_plane_if_and_only_if_its_inclination_has_a_margin() {
    let without_friction = [75.0_f64, 88.0, 92.0, 105.0].map(|inclination| (inclination, 0.0));
    let cases = without_friction.into_iter().chain([(75.0, 0.3), (95.0, 0.3), (105.0, 0.3), (105.0, 0.1)]);
    for (inclination, friction) in cases {
        let distance = slide_at(inclination.to_radians(), friction);
        let stays = out_of_plane_margin(inclination.to_radians(), friction) > 0.0;
        assert_eq!(
            distance < 10e-3,
            stays,
            "an inclination of {inclination} deg with friction {friction}: {distance} m"
        );
    }
}
