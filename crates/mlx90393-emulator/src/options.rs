//! Options of an emulated sensor.

/// Properties of an emulated sensor. The default has neither noise nor offset, and a nominal oscillator.
#[derive(Debug, Clone, PartialEq)]
pub struct SensorOptions {
    /// The 7-bit address.
    pub address: u8,
    /// The index for the [`FieldSource`](crate::FieldSource).
    pub field_index: usize,
    /// Frequency of the oscillator as a ratio to the nominal one. The data sheet permits 0.9 to 1.1.
    pub clock_ratio: f64,
    /// Standard deviation of the noise of a conversion along each axis (µT).
    pub noise_microtesla: [f64; 3],
    /// Offset of each axis at time 0 (µT).
    pub offset_microtesla: [f64; 3],
    /// Drift of this offset (µT/s).
    pub offset_drift_microtesla_per_second: [f64; 3],
    /// Temperature of the chip (°C).
    pub temperature_celsius: f64,
    /// Bits 15 to 9 of register 0, which are calibrated in the factory. Higher bits are ignored.
    pub factory_trim: u8,
    /// Seed of the noise.
    pub seed: u64,
}

impl Default for SensorOptions {
    fn default() -> Self {
        Self {
            address: 0x0C,
            field_index: 0,
            clock_ratio: 1.0,
            noise_microtesla: [0.0; 3],
            offset_microtesla: [0.0; 3],
            offset_drift_microtesla_per_second: [0.0; 3],
            temperature_celsius: 25.0,
            factory_trim: 0x2D,
            seed: 0,
        }
    }
}
