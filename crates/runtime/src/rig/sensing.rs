//! What a sample reports.

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
    /// Coefficient of sliding friction that the tip model reckons with; what is touched has its own, in `Physics`.
    pub friction: f64,
    /// Whether samples carry shear and axial force at each base.
    pub forces: bool,
    /// Standard deviation of the noise on each of these forces (N).
    pub force_noise: f64,
}

/// Noise of the real sensor (rad), as a standard deviation, and its resolution (rad): an estimate, nobody has measured them.
///
/// The sensor's paper (Dang et al. 2025) keeps its whisker bent by a reading of 8760, taken for counts of an MLX90393 at its most
/// sensitive, 0.15 µT each; the thesis calls the same bend 300 µrad. So a count is 0.034 µrad. With 1 to 2 µT for the chip's noise at
/// 300 Hz, that is up to 13 counts.
const REAL_NOISE: f64 = 0.5e-6;
const REAL_RESOLUTION: f64 = 0.034e-6;
/// Noise of a sensor of force (N) that is as fine as that of base angles: both are a 600th of what a target bend has. Nobody has built
/// one.
const REAL_FORCE_NOISE: f64 = 2e-6;

impl Sensing {
    /// Whether readings have noise.
    #[must_use]
    pub fn is_noisy(&self) -> bool {
        self.angle_noise > 0.0 || (self.forces && self.force_noise > 0.0)
    }

    /// Gives the readings the noise and the resolution of the real sensor.
    pub fn make_real(&mut self) {
        (self.angle_noise, self.angle_resolution) = (REAL_NOISE, REAL_RESOLUTION);
        self.force_noise = REAL_FORCE_NOISE;
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
            friction: 0.0,
            forces: false,
            force_noise: 0.0,
        }
    }
}
