//! The keys of a rig in files, with their ranges. Scenarios and the configuration of a robot have the same ones.

use crate::units::{Dimension, Key};

/// Keys of the platform.
pub mod platform {
    use super::{Dimension, Key};

    /// Width of the body at its tail.
    pub const TAIL_WIDTH: Key = Key::new("tail_width", Dimension::LENGTH, (1e-3, 2.0), "120 mm");
    /// Width of the body at its nose.
    pub const NOSE_WIDTH: Key = Key::new("nose_width", Dimension::LENGTH, (0.0, 2.0), "30 mm");
    /// Length of the body.
    pub const LENGTH: Key = Key::new("length", Dimension::LENGTH, (1e-3, 2.0), "180 mm");
    /// Distance of the centre of mass from the tail.
    pub const CENTRE_OF_MASS: Key = Key::new("centre_of_mass", Dimension::LENGTH, (0.0, 2.0), "72 mm");
    /// Mass.
    pub const MASS: Key = Key::new("mass", Dimension::MASS, (1e-3, 100.0), "0.51 kg");
    /// Moment of inertia about the vertical axis.
    pub const INERTIA: Key = Key::new("inertia", Dimension::INERTIA, (1e-9, 100.0), "0.0015 kg m^2");
    /// Time constant of the servos, for velocities.
    pub const SERVO: Key = Key::new("servo", Dimension::TIME, (1e-3, 10.0), "50 ms");
    /// Time constant of the servos for yaw rates.
    pub const YAW_SERVO: Key = Key::new("yaw_servo", Dimension::TIME, (1e-3, 10.0), "50 ms");
    /// Largest speed.
    pub const SPEED_LIMIT: Key = Key::new("speed_limit", Dimension::SPEED, (1e-3, 100.0), "1 m/s");
    /// Largest yaw rate.
    pub const YAW_RATE_LIMIT: Key = Key::new("yaw_rate_limit", Dimension::ANGULAR_SPEED, (1e-3, 100.0), "180 deg/s");
}

/// Keys of a whisker, its shaft and its hinge.
pub mod whisker {
    use std::f64::consts::PI;

    use super::{Dimension, Key};

    /// A coordinate of the base in the body frame.
    pub const BASE: Key = Key::new("base", Dimension::LENGTH, (-2.0, 2.0), "[53 mm, 30 mm]");
    /// Direction of the undeflected shaft.
    pub const DIRECTION: Key = Key::new("direction", Dimension::ANGLE, (-PI, PI), "105 deg");
    /// Length of the shaft.
    pub const LENGTH: Key = Key::new("length", Dimension::LENGTH, (1e-3, 1.0), "100 mm");
    /// Radius of the shaft at its base.
    pub const RADIUS: Key = Key::new("radius", Dimension::LENGTH, (1e-6, 1e-2), "0.125 mm");
    /// Young's modulus of the shaft.
    pub const YOUNG_MODULUS: Key = Key::new("young_modulus", Dimension::PRESSURE, (1e3, 1e13), "100 GPa");
    /// Damping of the shaft.
    pub const DAMPING: Key = Key::new("damping", Dimension::TIME, (0.0, 1.0), "1 ms");
    /// Stiffness of the hinge.
    pub const HINGE_STIFFNESS: Key = Key::new("stiffness", Dimension::TORSION_STIFFNESS, (1e-6, 1e6), "1 N m/rad");
    /// Armature of the hinge.
    pub const HINGE_ARMATURE: Key = Key::new("armature", Dimension::INERTIA, (0.0, 1.0), "1e-5 kg m^2");
}

/// Keys of the sensing.
pub mod sensing {
    use super::{Dimension, Key};

    /// Sample rate.
    pub const SAMPLE_RATE: Key = Key::new("sample_rate", Dimension::FREQUENCY, (1.0, 1e5), "300 Hz");
    /// Control rate.
    pub const CONTROL_RATE: Key = Key::new("control_rate", Dimension::FREQUENCY, (0.1, 1e4), "30 Hz");
    /// Cutoff of the filter.
    pub const FILTER_CUTOFF: Key = Key::new("filter_cutoff", Dimension::FREQUENCY, (0.1, 1e5), "20 Hz");
    /// Least base angle of a contact.
    pub const CONTACT_THRESHOLD: Key = Key::new("contact_threshold", Dimension::ANGLE, (1e-9, 1.0), "20 urad");
    /// Roughness of surfaces.
    pub const SURFACE_ROUGHNESS: Key = Key::new("surface_roughness", Dimension::LENGTH, (0.0, 0.1), "0.05 mm");
    /// Noise of a base angle.
    pub const ANGLE_NOISE: Key = Key::new("angle_noise", Dimension::ANGLE, (0.0, 1.0), "2 urad");
}
