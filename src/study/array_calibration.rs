//! The calibration of a simulated array by its own touches of a pin.

use vibrissa_runtime::calibration::{Calibration, TouchRefusal};
use vibrissa_runtime::rig::Rig;

use crate::calibration::{Pin, TouchLimits, WhiskerTouches, start_beside_pin, touch_pin};
use crate::geometry::{Point2, ShapeError, circle};
use crate::scene::{Scene, Truth, WorldSetup};
use crate::solid::{Solid, SolidError};
use crate::trial::{ExecuteError, build_world};
use crate::world::Fault;

/// The touches of all whiskers of an array, and what they have measured.
#[derive(Debug, Clone)]
pub struct ArrayCalibration {
    /// The pin.
    pub pin: Pin,
    /// The whiskers, in the order of the rig.
    pub whiskers: Vec<WhiskerTouches>,
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
    #[error("whisker `{whisker}` is not calibrated: {refusal}")]
    Refused {
        /// Name of the whisker.
        whisker: String,
        /// The reason.
        refusal: TouchRefusal,
    },
}

/// Radius of the pin, as a share of the longest whisker.
const PIN: f64 = 0.1;

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
        let mut simulated = build_world(&scene, world, seed)?;
        Ok(Self { pin, whiskers: touch_pin(simulated.as_mut(), &scene.rig, pin, limits)? })
    }

    /// The calibration of every whisker, in the order of the rig.
    ///
    /// # Errors
    /// [`ArrayCalibrationError::Refused`] with the first whisker that was refused.
    pub fn calibrations(&self) -> Result<Vec<Calibration>, ArrayCalibrationError> {
        let calibration = |touches: &WhiskerTouches| {
            let WhiskerTouches { whisker, readings, fit, .. } = touches;
            let fit = fit.as_ref().map_err(|refusal| ArrayCalibrationError::Refused {
                whisker: whisker.clone(),
                refusal: refusal.clone(),
            })?;
            let about = format!("{whisker}, {} touches of a pin", readings.len());
            Ok(Calibration { measured: Some(fit.measured()), ..Calibration::new(about) })
        };
        self.whiskers.iter().map(calibration).collect()
    }

    /// Gives the whiskers of a rig their calibrations, for runs that begin when the touches began. So the offset is that
    /// before the first touch.
    ///
    /// # Errors
    /// [`ArrayCalibrationError::Refused`] with the first whisker that was refused.
    pub fn apply(&self, rig: &mut Rig) -> Result<(), ArrayCalibrationError> {
        for ((whisker, mut calibration), touches) in
            rig.whiskers.iter_mut().zip(self.calibrations()?).zip(&self.whiskers)
        {
            if let Some(measured) = &mut calibration.measured {
                measured.offset = touches.first_in_air;
            }
            whisker.calibration = Some(calibration);
        }
        Ok(())
    }
}
