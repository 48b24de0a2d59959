//! The table of the keys. Its order is that of messages and of the documentation.

use std::f64::consts::{FRAC_PI_4, PI};

use vibrissa_runtime::units::Dimension as D;

use super::key::Access::{Calibration, Choice as Word, Count, Flag, Number, Optional, Point, Triple};
use super::key::Place::{Physics as InPhysics, Platform, Sensing, Whisker};
use super::{Choice, Refusal, RigKey};
use crate::mismatch::Change;
use crate::physics::{Integrator, Physics, ShaftModel, Solver};

type K = RigKey;

/// Growth of the yaw rate per error of the heading.
const YAW_INTEGRAL: D = D::new(0, 0, -2, 0);

/// All keys of a rig. A key needs an entry here and a field in the rig of the runtime or in [`Physics`].
#[rustfmt::skip] // A key is a line, as in a table.
pub static KEYS: &[RigKey] = &[
    K::new("platform.tail_width", Platform(Number(|it| &mut it.tail_width)), D::LENGTH, (1e-3, 2.0), "120 mm", "width at the rear"),
    K::new("platform.nose_width", Platform(Number(|it| &mut it.nose_width)), D::LENGTH, (0.0, 2.0), "30 mm",
        "width at the front. 0 makes the nose a point"),
    K::new("platform.length", Platform(Number(|it| &mut it.length)), D::LENGTH, (1e-3, 2.0), "180 mm", "from the tail to the nose"),
    K::new("platform.centre_of_mass", Platform(Number(|it| &mut it.centre_of_mass)), D::LENGTH, (0.0, 2.0), "72 mm",
        "distance of the centre of mass from the tail"),
    K::new("platform.mass", Platform(Number(|it| &mut it.mass)), D::MASS, (1e-3, 100.0), "0.51 kg", "mass"),
    K::new("platform.inertia", Platform(Number(|it| &mut it.inertia)), D::INERTIA, (1e-9, 100.0), "0.0015 kg m^2",
        "moment of inertia about the vertical axis through the centre of mass"),
    K::new("platform.servo", Platform(Number(|it| &mut it.servo)), D::TIME, (1e-3, 10.0), "50 ms", "time constant of the servos, for velocities"),
    K::new("platform.yaw_servo", Platform(Optional(|it| &mut it.yaw_servo)), D::TIME, (1e-3, 10.0), "50 ms",
        "time constant of the servos for yaw rates. Without it, it is that of `servo`").differs(Change::Replaced, (1e-3, 10.0), "20 ms"),
    K::new("platform.speed_limit", Platform(Number(|it| &mut it.speed_limit)), D::SPEED, (1e-3, 100.0), "1 m/s", "largest speed of a command"),
    K::new("platform.yaw_rate_limit", Platform(Number(|it| &mut it.yaw_rate_limit)), D::ANGULAR_SPEED, (1e-3, 100.0), "180 deg/s",
        "largest yaw rate of a command"),
    K::new("platform.yaw.proportional", Platform(Number(|it| &mut it.yaw.proportional)), D::FREQUENCY, (0.0, 100.0), "2 Hz",
        "yaw rate of the yaw controller per error of the heading"),
    K::new("platform.yaw.integral", Platform(Number(|it| &mut it.yaw.integral)), YAW_INTEGRAL, (0.0, 1000.0), "0.8 Hz^2",
        "growth of its yaw rate per error of the heading"),
    K::new("platform.yaw.limit", Platform(Number(|it| &mut it.yaw.limit)), D::ANGULAR_SPEED, (1e-3, 100.0), "45 deg/s",
        "largest yaw rate of the yaw controller"),
    K::new("whiskers.*.base", Whisker(Point(|it| &mut it.base_body)), D::LENGTH, (-2.0, 2.0), "[53 mm, 30 mm]",
        "position of the base in the body frame"),
    K::new("whiskers.*.direction", Whisker(Number(|it| &mut it.direction_body)), D::ANGLE, (-PI, PI), "105 deg",
        "direction of the undeflected shaft in the body frame"),
    K::new("whiskers.*.pitch", Whisker(Number(|it| &mut it.pitch)), D::ANGLE, (-FRAC_PI_4, FRAC_PI_4), "1.2 deg",
        "angle of the undeflected shaft above the plane, for [spatial whiskers](worlds.md#spatial-whiskers)").simulated(),
    K::new("whiskers.*.length", Whisker(Number(|it| &mut it.shaft.length)), D::LENGTH, (1e-3, 1.0), "100 mm", "from the base to the tip"),
    K::new("whiskers.*.radius", Whisker(Number(|it| &mut it.shaft.radius)), D::LENGTH, (1e-6, 1e-2), "0.125 mm", "radius of the wire at the base"),
    K::new("whiskers.*.tip_radius", Whisker(Optional(|it| &mut it.shaft.tip_radius)), D::LENGTH, (1e-6, 1e-2), "0.05 mm",
        "radius of the wire at the tip of a tapered shaft. Without it, the shaft has one radius"),
    K::new("whiskers.*.density", Whisker(Number(|it| &mut it.shaft.density)), D::DENSITY, (1.0, 1e5), "6450 kg/m^3", "density of the material"),
    K::new("whiskers.*.young_modulus", Whisker(Number(|it| &mut it.shaft.young_modulus)), D::PRESSURE, (1e3, 1e13), "100 GPa",
        "Young's modulus of the material"),
    K::new("whiskers.*.damping", Whisker(Number(|it| &mut it.shaft.damping)), D::TIME, (0.0, 1.0), "1 ms",
        "damping of the material relative to its stiffness").differs(Change::Relative, (-0.9, 10.0), "20 %"),
    K::new("whiskers.*.out_of_plane", Whisker(Number(|it| &mut it.shaft.out_of_plane)), D::NUMBER, (1e-3, 1e3), "4",
        "ratio of the bending stiffness out of the plane to that in the plane, for spatial whiskers. It is more than 1 for a ribbon on edge").simulated(),
    K::new("whiskers.*.links", Whisker(Count(|it| &mut it.shaft.links)), D::NUMBER, (4.0, 64.0), "16",
        "number of rigid links in the [model of the shaft](decisions/whisker-model.md#the-whisker-is-a-chain-of-links)"),
    K::new("whiskers.*.hinge.stiffness", Whisker(Number(|it| &mut it.hinge.stiffness)), D::TORSION_STIFFNESS, (1e-6, 1e6), "1 N m/rad",
        "stiffness of the hinge"),
    K::new("whiskers.*.hinge.damping", Whisker(Number(|it| &mut it.hinge.damping)), D::TORSION_DAMPING, (0.0, 1e3), "0.01 N m s/rad",
        "damping of the hinge"),
    K::new("whiskers.*.hinge.armature", Whisker(Number(|it| &mut it.hinge.armature)), D::INERTIA, (0.0, 1.0), "1e-5 kg m^2",
        "moment of inertia of the moving part of the hinge"),
    K::new("whiskers.*.first_mode", Whisker(Optional(|it| &mut it.first_mode)), D::FREQUENCY, (0.1, 1e4), "8.6 Hz",
        "frequency of the [first mode](worlds.md#first-mode) of the free whisker. Without it, it is that of the mechanics")
        .differs(Change::Replaced, (0.1, 1e4), "8.6 Hz"),
    K::new("whiskers.*.decay", Whisker(Optional(|it| &mut it.decay)), D::TIME, (1e-4, 1e3), "0.3 s",
        "time in which the amplitude of this mode decreases to 1/e. Without it, it is that of the mechanics")
        .differs(Change::Replaced, (1e-4, 1e3), "0.3 s"),
    K::other("whiskers.*.calibration", Whisker(Calibration(|it| &mut it.calibration)), "r0.yaml",
        "[calibration](calibration.md) that perception uses: the path of a file, or its values"),
    K::new("physics.step", InPhysics(Number(|it| &mut it.step)), D::TIME, (1e-6, 1.0), "3.33 ms", "step of the simulation"),
    K::other("physics.whiskers", InPhysics(Word(MODEL)), "spatial",
        "`planar`, or `spatial` for [whiskers that also bend out of the plane](worlds.md#spatial-whiskers)"),
    K::new("physics.object_height", InPhysics(Number(|it| &mut it.object_height)), D::LENGTH, (1e-3, 10.0), "80 mm",
        "height of all objects, half of it below the bases, for spatial whiskers"),
    K::other("physics.integrator", InPhysics(Word(INTEGRATOR)), "discrete", "integrator of MuJoCo. Others than `discrete` need shorter steps"),
    K::other("physics.solver", InPhysics(Word(SOLVER)), "PGS", "solver of MuJoCo: `PGS`, `CG` or `Newton`"),
    K::new("physics.calm_step", InPhysics(Number(|it| &mut it.calm_step)), D::TIME, (1e-6, 1.0), "3.33 ms",
        "longest step while no whisker moves fast"),
    K::other("physics.rigid_in_air", InPhysics(Flag(|it| &mut it.rigid_in_air)), "true",
        "true if a whisker at rest and out of reach of all objects is simulated as rigid"),
    K::new("physics.contact_time", InPhysics(Number(|it| &mut it.contact_time)), D::TIME, (1e-6, 1.0), "3.33 ms", "time constant of contacts")
        .differs(Change::Relative, (0.0, 100.0), "100 %"),
    K::new("physics.contact_impedance", InPhysics(Triple(|it| &mut it.contact_impedance, D::LENGTH, (1e-9, 0.1))), D::NUMBER, (1e-4, 0.9999), "[0.95, 0.99, 0.1 mm]",
        "impedance of contacts at the surface and at full depth, and the full depth"),
    K::new("physics.friction", InPhysics(Number(|it| &mut it.friction)), D::NUMBER, (0.0, 10.0), "0.3", "coefficient of friction of all surfaces"),
    K::new("physics.penetration_limit", InPhysics(Number(|it| &mut it.penetration_limit)), D::LENGTH, (1e-6, 0.1), "1 mm",
        "a larger penetration depth ends the run"),
    K::new("sensing.sample_rate", Sensing(Number(|it| &mut it.sample_rate)), D::FREQUENCY, (1.0, 1e5), "300 Hz", "rate of samples"),
    K::new("sensing.control_rate", Sensing(Number(|it| &mut it.control_rate)), D::FREQUENCY, (0.1, 1e4), "30 Hz", "rate of ticks"),
    K::new("sensing.filter_cutoff", Sensing(Number(|it| &mut it.filter_cutoff)), D::FREQUENCY, (0.1, 1e5), "20 Hz",
        "cutoff of the low-pass filter of base angles"),
    K::new("sensing.contact_threshold", Sensing(Number(|it| &mut it.contact_threshold)), D::ANGLE, (1e-9, 1.0), "20 urad",
        "magnitude of the base angle above which a whisker counts as touching"),
    K::new("sensing.friction", Sensing(Number(|it| &mut it.friction)), D::NUMBER, (0.0, 10.0), "0.3",
        "coefficient of friction that contact estimators assume"),
    K::new("sensing.surface_roughness", Sensing(Number(|it| &mut it.surface_roughness)), D::LENGTH, (0.0, 0.1), "0.05 mm",
        "standard deviation of surfaces about their outlines. It is [noise of the contact](scenarios.md#rough-surfaces)"),
    K::new("sensing.angle_noise", Sensing(Number(|it| &mut it.angle_noise)), D::ANGLE, (0.0, 1.0), "2 urad",
        "standard deviation of the noise of a base angle"),
    K::new("sensing.angle_resolution", Sensing(Number(|it| &mut it.angle_resolution)), D::ANGLE, (0.0, 1.0), "1 urad",
        "resolution of a base angle. 0 means continuous"),
    K::other("sensing.forces", Sensing(Flag(|it| &mut it.forces)), "true", "true if forces at the bases are measured").simulated(),
    K::new("sensing.force_noise", Sensing(Number(|it| &mut it.force_noise)), D::FORCE, (0.0, 1.0), "0.002 mN",
        "standard deviation of the noise of both forces").simulated(),
    estimate("sensing.estimation.lost_readings", Flag(|it| &mut it.estimation.lost_readings)),
    estimate("sensing.estimation.offset", Flag(|it| &mut it.estimation.offset)),
    estimate("sensing.estimation.noise", Flag(|it| &mut it.estimation.noise)),
    estimate("sensing.estimation.delay", Flag(|it| &mut it.estimation.delay)),
    estimate("sensing.estimation.friction", Flag(|it| &mut it.estimation.friction)),
    estimate("sensing.estimation.pose_noise", Flag(|it| &mut it.estimation.pose_noise)),
];

const fn estimate(path: &'static str, access: super::Access<vibrissa_runtime::rig::Sensing>) -> RigKey {
    K::other(
        path,
        Sensing(access),
        "false",
        "this [estimate](mismatch.md#estimates-during-a-run) corrects the rig during a run",
    )
}

/// Selects whiskers that bend out of the plane.
fn spatial(physics: &mut Physics) -> Result<(), Refusal> {
    if physics.shafts == ShaftModel::Chain {
        physics.shafts = ShaftModel::SpatialChain;
        return Ok(());
    }
    Err(Refusal {
        message: "cables have no spatial model under gravity",
        label: "the preset has cables",
        hint: "leave out `preset: peer_cable`, or this key",
    })
}

const MODEL: Choice<Physics> = Choice {
    what: "a model of the whiskers",
    words: || vec!["planar", "spatial"],
    get: |it| if it.shafts == ShaftModel::SpatialChain { "spatial" } else { "planar" },
    set: |it, word| if word == 1 { spatial(it) } else { Ok(()) },
};

const INTEGRATOR: Choice<Physics> = Choice {
    what: "an integrator",
    words: || Integrator::ALL.map(Integrator::name).to_vec(),
    get: |it| it.integrator.name(),
    set: |it, word| {
        it.integrator = Integrator::ALL.get(word).copied().unwrap_or_default();
        Ok(())
    },
};

const SOLVER: Choice<Physics> = Choice {
    what: "a solver",
    words: || Solver::ALL.map(Solver::name).to_vec(),
    get: |it| it.solver.name(),
    set: |it, word| {
        it.solver = Solver::ALL.get(word).copied().unwrap_or_default();
        Ok(())
    },
};
