//! The touches of a whisker and their result.

use vibrissa_runtime::calibration::{
    Calibration, FreeMotion, MeasuredWhisker, TouchFit, TouchNoise, TouchReading, TouchRefusal,
};
use vibrissa_runtime::rig::Rig;

/// The touches of a whisker and their result.
#[derive(Debug, Clone)]
pub struct WhiskerTouches {
    /// Name of the whisker.
    pub whisker: String,
    /// The touches.
    pub readings: Vec<TouchReading>,
    /// What is uncertain in them.
    pub noise: TouchNoise,
    /// Number of touches in which the whisker slipped off.
    pub missed: usize,
    /// The fit, or the reason why there is none.
    pub fit: Result<TouchFit, TouchRefusal>,
    /// Standard deviation of tips (m) that the errors of the fit cause.
    pub tip_deviation: f64,
    /// The reading in the air at the start, before any whisker touches (rad).
    pub first_in_air: f64,
    /// The motion in the air, if it was measured.
    pub free_motion: Option<FreeMotion>,
    /// Duration (s). `None` if it is not known.
    pub time: Option<f64>,
}

/// A whisker that cannot be calibrated.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[error("whisker `{whisker}` is not calibrated: {refusal}")]
pub struct RefusedWhisker {
    /// Name of the whisker.
    pub whisker: String,
    /// The reason.
    pub refusal: TouchRefusal,
}

impl WhiskerTouches {
    /// Fits the whisker with an index in the assumed `rig` to touches in the order of time.
    #[must_use]
    pub fn fitted(rig: &Rig, index: usize, readings: Vec<TouchReading>, noise: TouchNoise) -> Self {
        let whisker = &rig.whiskers[index];
        let others = rig.whiskers.iter().enumerate().filter(|(other, _)| *other != index);
        let fit = TouchFit::accepted(whisker, &readings, &noise, others.map(|(_, other)| other));
        Self {
            whisker: whisker.name.clone(),
            missed: 0,
            tip_deviation: fit.as_ref().map_or(f64::INFINITY, TouchFit::tip_deviation),
            first_in_air: readings.first().map_or(0.0, |first| first.in_air),
            free_motion: None,
            time: None,
            readings,
            noise,
            fit,
        }
    }

    /// The calibration of the whisker. Its offset is that at the start, because a robot measures the offset again at every
    /// start, and the drift of a simulated sensor begins anew with every run.
    ///
    /// # Errors
    /// [`RefusedWhisker`] with the reason.
    pub fn calibration(&self) -> Result<Calibration, RefusedWhisker> {
        let Self { whisker, readings, fit, .. } = self;
        let refused = |refusal: &TouchRefusal| RefusedWhisker { whisker: whisker.clone(), refusal: refusal.clone() };
        let fit = fit.as_ref().map_err(refused)?;
        let about = format!("{whisker}, {} touches of a known object", readings.len());
        let measured = MeasuredWhisker { offset: self.first_in_air, ..fit.measured() };
        Ok(Calibration { measured: Some(measured), free_motion: self.free_motion, ..Calibration::new(about) })
    }
}
