//! The magnet at the base of a whisker.

/// The field of the magnet at the sensor as a function of the base moment: `B = g M (1 + c M²)`, beside the neutral
/// field. The base rotates against its suspension by an angle in proportion to the moment, and the magnet with it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Magnet {
    /// Field per base moment `g` (T/(N m)). It is negative if the board is turned around.
    pub field_per_moment: f64,
    /// Relative growth `c` of the field (1/(N m)²).
    pub cubic: f64,
}

/// Newton steps of [`Magnet::moment`]. The field is nearly linear, so three steps reach the last bit.
const STEPS: usize = 4;

impl Magnet {
    /// The field (µT) beside the neutral one under a base moment (N m).
    ///
    /// ```
    /// use vibrissa_robot::array::Magnet;
    /// let magnet = Magnet { field_per_moment: 4.38, cubic: 0.0 };
    /// assert!((magnet.field_microtesla(300e-6) - 1314.0).abs() < 1e-9);
    /// ```
    #[must_use]
    pub fn field_microtesla(&self, moment: f64) -> f64 {
        self.field_per_moment * moment * (1.0 + self.cubic * moment * moment) * 1e6
    }

    /// The base moment (N m) at a field (µT) beside the neutral one. NaN where the field is not invertible.
    #[must_use]
    pub fn moment(&self, field_microtesla: f64) -> f64 {
        let linear = field_microtesla * 1e-6 / self.field_per_moment;
        let mut moment = linear;
        for _ in 0..STEPS {
            let square = self.cubic * moment * moment;
            let slope = 1.0 + 3.0 * square;
            if slope <= 0.0 {
                return f64::NAN;
            }
            moment -= (moment * (1.0 + square) - linear) / slope;
        }
        moment
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn the_moment_is_the_inverse_of_the_field(
            moment in -1e-3..1e-3, gain in prop_oneof![-10.0..-0.5, 0.5..10.0], growth in -0.2..0.5,
        ) {
            let magnet = Magnet { field_per_moment: gain, cubic: growth / 1e-6 };
            let found = magnet.moment(magnet.field_microtesla(moment));
            prop_assert!((found - moment).abs() < 1e-9 + 1e-4 * moment.abs(), "{found} for {moment}");
        }
    }
}
