//! The calibration of a simulated array by its own touches of a pin.

use vibrissa_runtime::calibration::{Calibration, Parameter, Parameters};
use vibrissa_runtime::rig::{Rig, Whisker};

use super::touch_procedure::{Pin, TouchLimits, start_beside_pin, touch_pin};
use super::whisker_touches::{RefusedWhisker, WhiskerTouches};
use crate::trial::{ExecuteError, build_world};
use vibrissa_world::geometry::{Point2, ShapeError, circle};
use vibrissa_world::scene::{Scene, Truth, WorldSetup};
use vibrissa_world::solid::{Solid, SolidError};
use vibrissa_world::world::Fault;

/// The touches of all whiskers of an array, and what they have measured.
#[derive(Debug, Clone)]
pub struct ArrayCalibration {
    /// The pin.
    pub pin: Pin,
    /// The whiskers, in the order of the rig.
    pub whiskers: Vec<WhiskerTouches>,
    /// The true parameters of each whisker, as differences from the rig. They serve verdicts alone.
    pub truths: Vec<Parameters>,
}

/// The error of a calibration of an array.
#[derive(Debug, thiserror::Error)]
pub enum ArrayCalibrationError {
    /// The world cannot be built.
    #[error(transparent)]
    World(#[from] ExecuteError),
    /// The pin cannot be built.
    #[error("the whiskers are too small for a pin: {0}")]
    Pin(#[from] ShapeError),
    /// The pin cannot be simulated.
    #[error("the whiskers are too small for a pin: {0}")]
    Solid(#[from] SolidError),
    /// The simulation failed.
    #[error("the calibration stopped: {0}")]
    Fault(#[from] Fault),
    /// A whisker cannot be calibrated.
    #[error(transparent)]
    Refused(#[from] RefusedWhisker),
}

/// Radius of the pin, as a share of the longest whisker.
const PIN: f64 = 0.1;

/// Largest penetration (m) of a whisker that slips off the pin. It springs back against it once, and no touch is measured meanwhile.
const PENETRATION_LIMIT: f64 = 3e-3;

/// Number of parameters of a whisker that do not drift. They are the first ones.
const CONSTANT: usize = Parameter::Offset as usize;
/// The 95 % quantile of chi-square with so many degrees of freedom.
const CHI_SQUARE: f64 = 14.067;

/// The true parameters of the whiskers of a scene, as differences from its rig. A stiffer shaft and a greater gain have the
/// effect of a softer hinge.
fn true_parameters(scene: &Scene) -> Vec<Parameters> {
    let array = scene.true_array();
    let parameters = |(index, assumed): (usize, &Whisker)| {
        let mut parameters = Parameters::zeros();
        let Some((true_one, sensor)) =
            array.as_ref().and_then(|array| Some((array.rig.whiskers.get(index)?, array.sensors.get(index)?)))
        else {
            return parameters;
        };
        let stiffer = true_one.shaft.bending_stiffness() / assumed.shaft.bending_stiffness();
        let hinge = true_one.hinge.stiffness / assumed.hinge.stiffness;
        let base = true_one.base_body - assumed.base_body;
        for (parameter, value) in [
            (Parameter::Stiffness, hinge / (stiffer * (1.0 + sensor.gain)) - 1.0),
            (Parameter::Length, true_one.shaft.length - assumed.shaft.length),
            (Parameter::Direction, true_one.direction_body - assumed.direction_body),
            (Parameter::BaseX, base.x),
            (Parameter::BaseY, base.y),
            (Parameter::Curvature, true_one.shaft.curvature - assumed.shaft.curvature),
            (Parameter::Taper, true_one.shaft.taper() - assumed.shaft.taper()),
        ] {
            parameters[parameter.index()] = value;
        }
        parameters
    };
    scene.rig.whiskers.iter().enumerate().map(parameters).collect()
}

impl ArrayCalibration {
    /// Calibrates the true array of a scene in a world with nothing but a pin. `seed` fixes the noise.
    ///
    /// # Errors
    /// [`ArrayCalibrationError`] if the simulation fails. A refused whisker is no error.
    pub fn run(
        scene: &Scene,
        world: WorldSetup,
        seed: u64,
        limits: &TouchLimits,
    ) -> Result<Self, ArrayCalibrationError> {
        let lengths = scene.rig.whiskers.iter().map(|whisker| whisker.shaft.length);
        let pin = Pin { centre: Point2::origin(), radius: PIN * lengths.fold(0.0, f64::max) };
        let outline = circle(pin.centre, pin.radius)?;
        let mut scene = Scene {
            solids: vec![Solid::inside(outline.clone())?],
            truth: Truth::from(outline),
            start: start_beside_pin(&scene.rig, pin, 0.0),
            ..scene.clone()
        };
        for whisker in &mut scene.rig.whiskers {
            whisker.calibration = None;
        }
        scene.physics.penetration_limit = scene.physics.penetration_limit.max(PENETRATION_LIMIT);
        let mut simulated = build_world(&scene, world, seed)?;
        let whiskers = touch_pin(simulated.as_mut(), &scene.rig, pin, limits)?;
        Ok(Self { pin, whiskers, truths: true_parameters(&scene) })
    }

    /// True for each whisker whose true parameters are within the ellipsoid of its fit with a probability of 95 %. The offset
    /// does not count, because it drifts. `None` for a refused whisker.
    #[must_use]
    pub fn within(&self) -> Vec<Option<bool>> {
        let is_within = |(touches, truth): (&WhiskerTouches, &Parameters)| {
            let fit = touches.fit.as_ref().ok()?;
            let difference = (fit.parameters - truth).fixed_rows::<CONSTANT>(0).into_owned();
            let inverse = fit.covariance.fixed_view::<CONSTANT, CONSTANT>(0, 0).try_inverse()?;
            Some(difference.dot(&(inverse * difference)) <= CHI_SQUARE)
        };
        self.whiskers.iter().zip(&self.truths).map(is_within).collect()
    }

    /// The calibration of every whisker, in the order of the rig.
    ///
    /// # Errors
    /// [`ArrayCalibrationError::Refused`] with the first whisker that was refused.
    pub fn calibrations(&self) -> Result<Vec<Calibration>, ArrayCalibrationError> {
        Ok(self.whiskers.iter().map(WhiskerTouches::calibration).collect::<Result<_, _>>()?)
    }

    /// Gives the whiskers of a rig their calibrations.
    ///
    /// # Errors
    /// [`ArrayCalibrationError::Refused`] with the first whisker that was refused.
    pub fn apply(&self, rig: &mut Rig) -> Result<(), ArrayCalibrationError> {
        for (whisker, calibration) in rig.whiskers.iter_mut().zip(self.calibrations()?) {
            whisker.calibration = Some(calibration);
        }
        Ok(())
    }
}
