//! The true field.

/// Source of the true magnetic field. Closures of the same form implement it.
pub trait FieldSource {
    /// The field at a sensor and a time (µT), along X, Y and Z of the sensor's package.
    ///
    /// `sensor` is [`SensorOptions::field_index`](crate::SensorOptions::field_index). Times do not have to increase, because a
    /// conversion is evaluated when it is read.
    fn field_microtesla(&mut self, sensor: usize, time_ns: u64) -> [f64; 3];
}

impl<F: FnMut(usize, u64) -> [f64; 3]> FieldSource for F {
    fn field_microtesla(&mut self, sensor: usize, time_ns: u64) -> [f64; 3] {
        self(sensor, time_ns)
    }
}
