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
    /// Whether samples carry shear and axial force at each base.
    pub forces: bool,
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
