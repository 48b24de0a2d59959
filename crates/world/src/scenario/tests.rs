//! Tests of scenarios and the scenes that they describe.

#![allow(clippy::unwrap_used, reason = "a test may panic")]
use super::*;
use crate::geometry::Point2;
use crate::geometry::Pose;
use crate::physics::{Integrator, Physics, Preset, ShaftModel, Solver};
use crate::scene::{Expectation, Stop};
use crate::scene::{LoopClosed, Outcome, Stalled};
use crate::solid::Solid;
use std::f64::consts::{FRAC_PI_2, PI};
use std::path::Path;
use vibrissa_declare::figures::Metric;
use vibrissa_runtime::rig::{Estimation, Hinge, Platform, Rig, Sensing, Shaft, Whisker, YawController};
use vibrissa_text::diagnostic::{Colour, terminal};

fn read(text: &str) -> Scene {
    let source = Source::new("scenario.yaml", text);
    super::read(&source).map_err(|faults| terminal(&source, &faults, Colour::Plain)).unwrap()
}

fn with_object(object: &str) -> Solid {
    let start = "start: {position: [-1 m, 0 m], heading: 180 deg}";
    read(&format!("name: x\n{start}\nstop: {{time: 1 s}}\nobjects: [{object}]\n")).solids.remove(0)
}

fn with_rig(rig: &str) -> Scene {
    let object = "objects: [{circle: {centre: [4 m, 4 m], radius: 3 cm}}]";
    let start = "start: {position: [0 m, 0 m], heading: 0 deg}";
    read(&format!("name: x\n{start}\nstop: {{time: 1 s}}\n{object}\nrig: {rig}\n"))
}

#[test]
fn the_disk_of_the_thesis_reads_as_its_figures() {
    let scene = read(include_str!("../../../../scenarios/disk.yaml"));
    assert_eq!(scene.name, "disk");
    assert_eq!(scene.rig, Rig::default());
    assert_eq!(scene.solids.len(), 1);
    let outline = scene.solids[0].outline();
    assert!((outline.length() - 0.6 * PI).abs() < 1e-12);
    assert!(outline.signed_distance(Point2::new(0.1, 0.4)).abs() < 1e-15);
    assert_eq!(scene.start, Pose { position: Point2::new(0.0, 0.072), heading: FRAC_PI_2 });
    let loop_closed = Some(LoopClosed { within: 0.005, after: 5.0 });
    let stop = Stop { loop_closed, stalled: Some(Stalled::default()), ..Stop::at(120.0) };
    assert_eq!(scene.stop, stop);
    assert_eq!(
        scene.expect,
        [
            Expectation::Outcome(Outcome::Completed),
            Expectation::Bound { metric: Metric::ErrorMean, bound: 0.0008 },
            Expectation::Bound { metric: Metric::Coverage, bound: 0.95 },
        ]
    );
    assert_eq!(scene.policy.unwrap().file.path, Path::new("../policies/thesis.fsm"));
    assert_eq!(scene.seed, 0);
}

#[test]
fn a_scene_that_is_to_be_mapped_expects_a_true_map_of_what_is_in_reach() {
    let object = "objects: [{circle: {centre: [4 m, 4 m], radius: 3 cm}}]";
    let start = "start: {position: [0 m, 0 m], heading: 0 deg}";
    let of = |mapped: bool| read(&format!("name: x\n{start}\nstop: {{time: 5 s, mapped: {mapped}}}\n{object}\n"));
    let (scene, plain) = (of(true), of(false));
    assert_eq!(scene.stop, Stop { mapped: true, stalled: Some(Stalled::default()), ..Stop::at(5.0) });
    let bound = |metric, bound| Expectation::Bound { metric, bound };
    let truth = [bound(Metric::CoverageInReach, 0.9), bound(Metric::MapWrongFreeArea, 0.0)];
    let completed = [Expectation::Outcome(Outcome::Completed)];
    assert_eq!(scene.expect, [&completed[..], &truth, &[bound(Metric::Collisions, 0.0)]].concat());
    assert_eq!((plain.stop, plain.expect), (Stop::at(5.0), completed.to_vec()));
}

#[test]
fn every_kind_of_object_is_the_contour_of_its_name() {
    let centre = "centre: [40 cm, 40 cm]";
    let area = |object: &str| with_object(object).outline().area();
    let square = "[[0 cm, 0 cm], [20 cm, 0 cm], [20 cm, 20 cm], [0 cm, 20 cm]]";
    assert!((area(&format!("{{circle: {{{centre}, radius: 10 cm}}}}")) - 0.01 * PI).abs() < 1e-12);
    assert!((area(&format!("{{polygon: {{vertices: {square}}}}}")) - 0.04).abs() < 1e-12);
    let rounded = format!("{{rounded_rectangle: {{{centre}, width: 20 cm, height: 20 cm, corner_radius: 10 cm}}}}");
    assert!((area(&rounded) - 0.01 * PI).abs() < 1e-12);
    let sharp = with_object(&format!("{{rectangle: {{{centre}, width: 20 cm, height: 10 cm, heading: 30 deg}}}}"));
    assert!((sharp.outline().area() - 0.02).abs() < 1e-12 && sharp.outline().corners().len() == 4);
    let regular = format!("{{regular_polygon: {{{centre}, circumradius: 1 m, sides: 4, heading: 45 deg}}}}");
    assert!((area(&regular.replace("1 m", "10 cm")) - 0.02).abs() < 1e-12);
    let start = "start: {position: [0 m, 0 m], heading: 0 deg}";
    let side = "{straight: 20 cm}, {arc: {radius: 10 cm, angle: 180 deg}}";
    let stadium = format!("{{path: {{{start}, moves: [{side}, {side}]}}}}");
    assert!((area(&stadium) - (0.04 + 0.01 * PI)).abs() < 1e-12);
    let corner = format!("{{path: {{{start}, moves: [{{straight: 20 cm}}, {{turn: 90 deg}}, {{straight: 10 cm}}]");
    assert!((area(&format!("{corner}}}}}")) - 0.01).abs() < 1e-12);
}

#[test]
fn what_a_rig_leaves_out_is_as_in_the_reference_rig() {
    let rig = with_rig("{whiskers: {l0: {length: 75 mm}, front: {base: [108 mm, 0 mm], direction: 0 deg}}}").rig;
    let [left, front] = rig.whiskers.as_slice() else { panic!("two whiskers, found {:?}", rig.whiskers) };
    let reference = &Rig::default().whiskers[1];
    assert_eq!((left.name.as_str(), left.base_body), ("l0", reference.base_body));
    assert!((left.shaft.length - 0.075).abs() < 1e-15);
    assert_eq!(front.shaft, reference.shaft);
    assert_eq!(with_rig("{}").rig, Rig::default());
    assert_eq!(with_rig("{preset: reference}").rig, Rig::default());
}

#[test]
fn what_a_rig_with_a_preset_leaves_out_is_as_in_that() {
    let (rig, preset) = Preset::PeerCable.rig();
    let scene = with_rig("{preset: peer_cable}");
    assert_eq!((scene.rig, &scene.physics), (rig, &preset));
    let whiskers = "{l0: {length: 75 mm}, front: {base: [108 mm, 0 mm], direction: 0 deg}, r0: {links: 9}}";
    let scene = with_rig(&format!("{{whiskers: {whiskers}, physics: {{friction: 1}}, preset: peer_cable}}"));
    assert_eq!(scene.rig.whiskers.iter().map(|whisker| whisker.shaft.links).collect::<Vec<_>>(), [40, 40, 9]);
    assert_eq!(scene.physics, Physics { friction: 1.0, ..preset });
}

#[test]
fn the_preset_of_the_thesis_has_three_whiskers_a_side_that_a_scenario_can_change() {
    let scene = with_rig("{preset: thesis_array}");
    assert_eq!((scene.rig, scene.physics), Preset::ThesisArray.rig());
    let rig = with_rig("{preset: thesis_array, platform: {nose_width: 0 mm}, whiskers: {r1: {length: 80 mm}}}").rig;
    assert_eq!(rig.platform.nose_width.to_bits(), 0.0_f64.to_bits());
    let [whisker] = rig.whiskers.as_slice() else { panic!("one whisker, found {:?}", rig.whiskers) };
    assert_eq!((whisker.name.as_str(), whisker.base_body), ("r1", Rig::thesis_array().whiskers[1].base_body));
}

#[test]
fn every_key_of_a_rig_can_be_set() {
    let text = "
  preset: peer_cable
  platform:
    {tail_width: 1 cm, nose_width: 2 cm, length: 3 cm, centre_of_mass: 1 cm, mass: 2 kg, inertia: 3 kg m^2, servo: 4 ms,
     yaw_servo: 5 ms, speed_limit: 8 m/s, yaw_rate_limit: 9 rad/s, yaw: {proportional: 5 Hz, integral: 6 Hz^2, limit: 7 rad/s}}
  whiskers:
    a:
      {base: [1 mm, 2 mm], direction: 3 rad, pitch: 0.5 rad, out_of_plane: 3, length: 4 cm, radius: 50 um, tip_radius: 20 um, density: 6 g/cm^3,
       young_modulus: 7 GPa, damping: 8 ms, links: 9, hinge: {stiffness: 2 N m/rad, damping: 3 N m s/rad, armature: 0.4 kg m^2},
       first_mode: 12 Hz, decay: 200 ms}
  physics: {step: 1 ms, calm_step: 2 ms, rigid_in_air: false, integrator: implicitfast, solver: PGS, contact_time: 2 ms,
     contact_impedance: [0.3, 40 %, 5 mm], friction: 6, penetration_limit: 7 mm, object_height: 8 mm}
  sensing: {sample_rate: 1 kHz, control_rate: 50 Hz, filter_cutoff: 60 Hz, contact_threshold: 7 urad, friction: 0.2,
     surface_roughness: 0.3 mm,
     angle_noise: 3 urad, angle_resolution: 4 mrad, forces: true, force_noise: 5 mN,
     estimation: {lost_readings: false, offset: false, noise: false, delay: false, friction: false, pose_noise: false}}";
    let expected = Rig {
        platform: Platform {
            tail_width: 0.01,
            nose_width: 0.02,
            length: 0.03,
            centre_of_mass: 0.01,
            mass: 2.0,
            inertia: 3.0,
            servo: 0.004,
            yaw_servo: Some(0.005),
            speed_limit: 8.0,
            yaw_rate_limit: 9.0,
            yaw: YawController { proportional: 5.0, integral: 6.0, limit: 7.0 },
        },
        whiskers: vec![Whisker {
            name: "a".to_owned(),
            base_body: Point2::new(0.001, 0.002),
            direction_body: 3.0,
            pitch: 0.5,
            shaft: Shaft {
                length: 0.04,
                radius: 5e-5,
                tip_radius: Some(2e-5),
                density: 6e3,
                young_modulus: 7e9,
                damping: 8e-3,
                out_of_plane: 3.0,
                links: 9,
                ..Shaft::default()
            },
            hinge: Hinge { stiffness: 2.0, damping: 3.0, armature: 0.4 },
            first_mode: Some(12.0),
            decay: Some(0.2),
            calibration: None,
        }],
        sensing: Sensing {
            sample_rate: 1e3,
            control_rate: 50.0,
            filter_cutoff: 60.0,
            contact_threshold: 7e-6,
            friction: 0.2,
            surface_roughness: 3e-4,
            angle_noise: 3e-6,
            angle_resolution: 4e-3,
            forces: true,
            force_noise: 5e-3,
            estimation: Estimation::OFF,
        },
    };
    let physics = Physics {
        shafts: ShaftModel::Cable,
        step: 1e-3,
        integrator: Integrator::ImplicitFast,
        solver: Solver::ProjectedGaussSeidel,
        calm_step: 2e-3,
        rigid_in_air: false,
        contact_time: 2e-3,
        contact_impedance: [0.3, 0.4, 5e-3],
        friction: 6.0,
        object_height: 8e-3,
        penetration_limit: 7e-3,
    };
    let scene = with_rig(text);
    assert_eq!((scene.rig, scene.physics), (expected, physics));
}

#[test]
fn whiskers_are_planar_unless_the_physics_make_them_spatial() {
    assert_eq!(with_rig("{physics: {whiskers: planar}}").physics, Physics::default());
    let spatial = with_rig("{preset: thesis_array, physics: {whiskers: spatial}}").physics;
    assert_eq!(spatial, Physics { shafts: ShaftModel::SpatialChain, ..Preset::ThesisArray.rig().1 });
}

#[test]
fn a_step_that_is_rounded_is_fitted_into_the_sample_period() {
    assert_eq!(with_rig("{physics: {step: 3.33 ms}}").physics.step.to_bits(), (1.0_f64 / 300.0).to_bits());
    assert_eq!(with_rig("{physics: {step: 1.667 ms}}").physics.step.to_bits(), (1.0_f64 / 600.0).to_bits());
}
