//! Parameters of scene families.

use std::f64::consts::PI;

use vibrissa_runtime::units::{Dimension, format_si};

/// A parameter of a family of scenes: a number that determines its scenes.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Parameter {
    /// The name: lower-case letters, digits and `_`.
    pub name: &'static str,
    /// Description of the value.
    pub about: &'static str,
    /// The dimension.
    pub dimension: Dimension,
    /// The range of random values (SI).
    pub range: (f64, f64),
    /// The range of explicit values (SI). It contains the range of random values.
    pub limits: (f64, f64),
    /// The value of the simplest scene (SI).
    pub simplest: f64,
    /// Distance between the values that a property tries (SI). All values are multiples of it if `is_stepped`.
    pub step: f64,
    /// True if there are no values between the steps from the lower limit.
    pub is_stepped: bool,
}

impl Parameter {
    const fn new(name: &'static str, about: &'static str, dimension: Dimension, range: (f64, f64), step: f64) -> Self {
        let (limits, simplest) = (range, range.0);
        Self { name, about, dimension, range, limits, simplest, step, is_stepped: false }
    }

    /// A length (m) in steps of 1 mm.
    pub(super) const fn length(name: &'static str, about: &'static str, range: (f64, f64)) -> Self {
        Self::new(name, about, Dimension::LENGTH, range, 1e-3)
    }

    /// An angle (rad) in steps of half a degree.
    pub(super) const fn angle(name: &'static str, about: &'static str, range: (f64, f64)) -> Self {
        Self::new(name, about, Dimension::ANGLE, range, PI / 360.0)
    }

    /// A speed (m/s) in steps of 1 mm/s.
    pub(super) const fn speed(name: &'static str, about: &'static str, range: (f64, f64)) -> Self {
        Self::new(name, about, Dimension::SPEED, range, 1e-3)
    }

    /// A share of another value, in steps of 0.01.
    pub(super) const fn share(name: &'static str, about: &'static str, range: (f64, f64)) -> Self {
        Self::new(name, about, Dimension::NUMBER, range, 0.01)
    }

    /// A number with no values between its steps.
    pub(super) const fn stepped(name: &'static str, about: &'static str, range: (f64, f64), step: f64) -> Self {
        Self { is_stepped: true, ..Self::new(name, about, Dimension::NUMBER, range, step) }
    }

    pub(super) const fn within(self, limits: (f64, f64)) -> Self {
        Self { limits, ..self }
    }

    pub(super) const fn simplest(self, simplest: f64) -> Self {
        Self { simplest, ..self }
    }

    pub(super) const fn in_steps(self, step: f64) -> Self {
        Self { step, ..self }
    }

    /// The reason why an explicit value (SI) is not possible. `None` if it is.
    #[must_use]
    pub fn fault(&self, value: f64) -> Option<String> {
        let (low, high) = self.limits;
        // The ends are written in other units.
        let rounding = 1e-9 * (high - low);
        if !(low - rounding..=high + rounding).contains(&value) {
            return Some(format!("must be from {} to {}", self.text(low), self.text(high)));
        }
        let steps = (value - low) / self.step;
        (self.is_stepped && (steps - steps.round()).abs() > 1e-9).then(|| {
            if self.step > 1.0 {
                format!("must be {} or {}", self.text(low), self.text(high))
            } else {
                "must be a whole number".to_owned()
            }
        })
    }

    /// A value (SI) with its unit.
    #[must_use]
    pub fn text(&self, value: f64) -> String {
        if self.dimension == Dimension::ANGLE {
            // Small angles are not written in radians.
            return format!("{} deg", format_si(value.to_degrees(), Dimension::NUMBER));
        }
        format_si(value, self.dimension)
    }
}
