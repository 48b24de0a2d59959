//! The rig: a platform, its whiskers, its sensors, and how they are simulated.
//!
//! Body frame: origin at the platform's centre of mass, first axis forward (the heading), second axis to the left.

use nalgebra::Point2;

/// A platform with whiskers, and the settings of its simulation.
///
/// [`Rig::default`] is the reference rig: the thesis's platform with one whisker of 100 mm a side, swept back by 15°.
#[derive(Debug, Clone, PartialEq)]
pub struct Rig {
    /// The body that carries the whiskers.
    pub platform: Platform,
    /// The whiskers, in the order in which samples list them.
    pub whiskers: Vec<Whisker>,
    /// How the simulator steps and resolves contact.
    pub physics: Physics,
    /// What a sample reports, and how noisily.
    pub sensing: Sensing,
}

/// The body that carries the whiskers: a trapezoid in plan, symmetric about its axis.
#[derive(Debug, Clone, PartialEq)]
pub struct Platform {
    /// Width at the tail (m).
    pub tail_width: f64,
    /// Width at the nose (m).
    pub nose_width: f64,
    /// Length from tail to nose (m).
    pub length: f64,
    /// Distance of the centre of mass ahead of the tail (m).
    pub centre_of_mass: f64,
    /// Mass (kg).
    pub mass: f64,
    /// Moment of inertia about the vertical through the centre of mass (kg m²).
    pub inertia: f64,
    /// Time constant with which the servos take up a commanded velocity or yaw rate (s).
    pub servo: f64,
    /// The controller that turns the platform to a heading.
    pub yaw: YawController,
}

/// The controller that turns the platform to a heading: proportional and integral, with a limit.
#[derive(Debug, Clone, PartialEq)]
pub struct YawController {
    /// Yaw rate for a unit of error (1/s).
    pub proportional: f64,
    /// Growth of the yaw rate for a unit of error (1/s²).
    pub integral: f64,
    /// Greatest yaw rate (rad/s).
    pub limit: f64,
}

/// One whisker: where it sits, its shaft, and the spring at its base.
#[derive(Debug, Clone, PartialEq)]
pub struct Whisker {
    /// The name by which policies bind to it.
    pub name: String,
    /// Where the base sits, in the body frame (m).
    pub base_body: Point2<f64>,
    /// Direction of the undeflected shaft in the body frame (rad, counter-clockwise from the heading).
    pub direction_body: f64,
    /// The shaft.
    pub shaft: Shaft,
    /// The base hinge, whose angle is the sensor's reading.
    pub hinge: Hinge,
}

/// An elastic shaft of round wire, straight at rest.
#[derive(Debug, Clone, PartialEq)]
pub struct Shaft {
    /// Length from the base to the tip (m).
    pub length: f64,
    /// Radius of the wire (m).
    pub radius: f64,
    /// Density (kg/m³).
    pub density: f64,
    /// Young's modulus (Pa).
    pub young_modulus: f64,
    /// Ratio of the material's damping to its stiffness (s).
    pub damping: f64,
    /// Rigid links that stand for the shaft in a simulation.
    pub links: usize,
}

/// A torsion spring at a whisker's base.
#[derive(Debug, Clone, PartialEq)]
pub struct Hinge {
    /// Stiffness (N m/rad).
    pub stiffness: f64,
    /// Damping (N m s/rad).
    pub damping: f64,
    /// Inertia of the moving part of the suspension (kg m²).
    pub armature: f64,
}

/// How the simulator steps and resolves contact.
#[derive(Debug, Clone, PartialEq)]
pub struct Physics {
    /// Length of one simulation step (s); a whole number of them makes up a sample.
    pub step: f64,
    /// Time constant of the contact constraint (s).
    pub contact_time: f64,
    /// Impedance of the contact constraint: at the surface, at full depth, and the depth at which it is full (m).
    pub contact_impedance: [f64; 3],
    /// Coefficient of sliding friction between whisker and object; 0 is frictionless.
    pub friction: f64,
    /// A contact deeper than this (m) ends the run: the physics can no longer be trusted.
    pub penetration_limit: f64,
}

/// What a sample reports, and how noisily.
#[derive(Debug, Clone, PartialEq)]
pub struct Sensing {
    /// Samples a second (Hz).
    pub sample_rate: f64,
    /// Control ticks a second (Hz); a whole number of samples makes up a tick.
    pub control_rate: f64,
    /// Standard deviation of the noise on a base angle (rad).
    pub angle_noise: f64,
    /// Smallest step of a base angle's reading (rad); 0 is continuous.
    pub angle_resolution: f64,
    /// Cutoff of the low-pass filter that base angles go through (Hz).
    pub filter_cutoff: f64,
    /// A base angle beyond this (rad) counts as touching.
    pub contact_threshold: f64,
    /// Whether samples carry shear and axial force at each base.
    pub forces: bool,
}

impl Platform {
    /// The corners in the body frame (m), counter-clockwise from the right end of the tail.
    #[must_use]
    pub fn outline_body(&self) -> [Point2<f64>; 4] {
        let (tail, nose) = (-self.centre_of_mass, self.length - self.centre_of_mass);
        let (tail_side, nose_side) = (0.5 * self.tail_width, 0.5 * self.nose_width);
        [
            Point2::new(tail, -tail_side),
            Point2::new(nose, -nose_side),
            Point2::new(nose, nose_side),
            Point2::new(tail, tail_side),
        ]
    }
}

impl Shaft {
    /// Bending stiffness `E I` (N m²) of the round wire, `I = π r⁴ / 4`.
    #[must_use]
    pub fn bending_stiffness(&self) -> f64 {
        self.young_modulus * std::f64::consts::FRAC_PI_4 * self.radius.powi(4)
    }

    /// Length of one link (m).
    #[must_use]
    pub fn link_length(&self) -> f64 {
        self.length / self.links as f64
    }

    /// Mass of one link (kg).
    #[must_use]
    pub fn link_mass(&self) -> f64 {
        self.density * std::f64::consts::PI * self.radius.powi(2) * self.link_length()
    }

    /// Stiffness of every joint between links (N m/rad), from the root to the tip.
    ///
    /// The trapezoid rule for the bending energy: `EI / l` at a joint between two links of length `l`, and `2 EI / l` at the
    /// root, where only half a link's length bends.
    pub fn joint_stiffnesses(&self) -> impl Iterator<Item = f64> {
        let between = self.bending_stiffness() / self.link_length();
        (0..self.links).map(move |joint| if joint == 0 { 2.0 * between } else { between })
    }
}

impl Default for Rig {
    fn default() -> Self {
        Self {
            platform: Platform::default(),
            whiskers: vec![Whisker::reference("r0", -1.0), Whisker::reference("l0", 1.0)],
            physics: Physics::default(),
            sensing: Sensing::default(),
        }
    }
}

impl Default for Platform {
    fn default() -> Self {
        Self {
            tail_width: 0.12,
            nose_width: 0.03,
            length: 0.18,
            centre_of_mass: 0.072,
            mass: 0.51,
            inertia: 0.0015,
            servo: 0.05,
            yaw: YawController::default(),
        }
    }
}

impl Default for YawController {
    fn default() -> Self {
        Self { proportional: 2.0, integral: 0.8, limit: std::f64::consts::FRAC_PI_4 }
    }
}

impl Whisker {
    /// The reference whisker on one side of the reference platform: `side` is −1 for right, +1 for left.
    fn reference(name: &str, side: f64) -> Self {
        Self {
            name: name.to_owned(),
            base_body: Point2::new(0.053, side * 0.030),
            direction_body: side * 105_f64.to_radians(),
            shaft: Shaft::default(),
            hinge: Hinge::default(),
        }
    }

    /// Which side of the platform the whisker points to: −1 for right, +1 for left.
    #[must_use]
    pub fn side(&self) -> f64 {
        if self.direction_body < 0.0 { -1.0 } else { 1.0 }
    }
}

impl Default for Shaft {
    fn default() -> Self {
        Self { length: 0.1, radius: 0.125e-3, density: 6450.0, young_modulus: 100e9, damping: 1e-3, links: 16 }
    }
}

impl Default for Hinge {
    fn default() -> Self {
        Self { stiffness: 1.0, damping: 0.01, armature: 1e-5 }
    }
}

impl Default for Physics {
    fn default() -> Self {
        Self {
            step: 1.0 / 300.0,
            contact_time: 0.005,
            contact_impedance: [0.95, 0.99, 1e-4],
            friction: 0.0,
            penetration_limit: 1e-3,
        }
    }
}

impl Default for Sensing {
    fn default() -> Self {
        Self {
            sample_rate: 300.0,
            control_rate: 30.0,
            angle_noise: 0.0,
            angle_resolution: 0.0,
            filter_cutoff: 20.0,
            contact_threshold: 2e-5,
            forces: false,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_outline_runs_counter_clockwise_about_the_centre_of_mass() {
        let outline = Platform::default().outline_body();
        let area: f64 = (0..4).map(|corner| outline[corner].coords.perp(&outline[(corner + 1) % 4].coords) / 2.0).sum();
        assert!((area - 0.18 * (0.12 + 0.03) / 2.0).abs() < 1e-12);
        assert!((outline[1].x - outline[0].x - 0.18).abs() < 1e-12 && (outline[0].x + 0.072).abs() < 1e-12);
    }

    #[test]
    fn the_reference_whiskers_are_mirror_images() {
        let [right, left] =
            <[Whisker; 2]>::try_from(Rig::default().whiskers).unwrap_or_else(|_| panic!("two whiskers"));
        assert_eq!(right.base_body, Point2::new(left.base_body.x, -left.base_body.y));
        assert!((right.direction_body + left.direction_body).abs() < 1e-15);
        assert!(right.side() < 0.0 && left.side() > 0.0);
        assert_eq!(right.shaft, left.shaft);
    }

    #[test]
    fn the_joints_bend_as_much_as_the_shaft_but_for_the_last_half_link() {
        for links in [1, 2, 7, 16] {
            let shaft = Shaft { links, ..Shaft::default() };
            let compliance: f64 = shaft.joint_stiffnesses().map(f64::recip).sum();
            let bending = (shaft.length - 0.5 * shaft.link_length()) / shaft.bending_stiffness();
            assert!((compliance / bending - 1.0).abs() < 1e-12);
        }
    }

    #[test]
    fn the_links_weigh_as_much_as_the_wire() {
        let shaft = Shaft::default();
        let mass = shaft.links as f64 * shaft.link_mass();
        assert!((mass - 6450.0 * std::f64::consts::PI * 0.125e-3_f64.powi(2) * 0.1).abs() < 1e-15);
    }
}
