//! Physical dimensions.

use std::fmt;

use serde::{Deserialize, Serialize};

/// A physical dimension: the exponents of length, angle, time and mass.
///
/// Angle is a separate dimension. An angle is therefore not a plain number, and a stiffness in N m/rad is not a moment
/// in N m.
///
/// ```
/// use vibrissa_runtime::units::Dimension;
/// assert_eq!(Dimension::LENGTH.checked_div(Dimension::TIME), Some(Dimension::SPEED));
/// assert_eq!(Dimension::SPEED.to_string(), "speed");
/// assert_eq!(Dimension::SPEED.si_unit(), "m/s");
/// ```
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default, Serialize, Deserialize)]
pub struct Dimension {
    /// Exponent of length (m).
    pub length: i8,
    /// Exponent of angle (rad).
    pub angle: i8,
    /// Exponent of time (s).
    pub time: i8,
    /// Exponent of mass (kg).
    pub mass: i8,
}

impl Dimension {
    /// A plain number, such as a ratio or a count.
    pub const NUMBER: Self = Self::new(0, 0, 0, 0);
    /// Length (m).
    pub const LENGTH: Self = Self::new(1, 0, 0, 0);
    /// Angle (rad).
    pub const ANGLE: Self = Self::new(0, 1, 0, 0);
    /// Time (s).
    pub const TIME: Self = Self::new(0, 0, 1, 0);
    /// Mass (kg).
    pub const MASS: Self = Self::new(0, 0, 0, 1);
    /// Area (m²).
    pub const AREA: Self = Self::new(2, 0, 0, 0);
    /// Curvature of a line (1/m).
    pub const CURVATURE: Self = Self::new(-1, 0, 0, 0);
    /// Speed (m/s).
    pub const SPEED: Self = Self::new(1, 0, -1, 0);
    /// Acceleration (m/s²).
    pub const ACCELERATION: Self = Self::new(1, 0, -2, 0);
    /// Angular speed (rad/s).
    pub const ANGULAR_SPEED: Self = Self::new(0, 1, -1, 0);
    /// Angular acceleration (rad/s²).
    pub const ANGULAR_ACCELERATION: Self = Self::new(0, 1, -2, 0);
    /// Frequency (Hz).
    pub const FREQUENCY: Self = Self::new(0, 0, -1, 0);
    /// Force (N).
    pub const FORCE: Self = Self::new(1, 0, -2, 1);
    /// Moment of a force (N m).
    pub const MOMENT: Self = Self::new(2, 0, -2, 1);
    /// Stiffness of a torsion spring (N m/rad).
    pub const TORSION_STIFFNESS: Self = Self::new(2, -1, -2, 1);
    /// Damping of a torsion spring (N m s/rad).
    pub const TORSION_DAMPING: Self = Self::new(2, -1, -1, 1);
    /// Stiffness of a spring (N/m).
    pub const STIFFNESS: Self = Self::new(0, 0, -2, 1);
    /// Moment of inertia (kg m²).
    pub const INERTIA: Self = Self::new(2, 0, 0, 1);
    /// Pressure or elastic modulus (Pa).
    pub const PRESSURE: Self = Self::new(-1, 0, -2, 1);
    /// Density (kg/m³).
    pub const DENSITY: Self = Self::new(-3, 0, 0, 1);

    /// Creates the dimension with these exponents of length, angle, time and mass.
    #[must_use]
    pub const fn new(length: i8, angle: i8, time: i8, mass: i8) -> Self {
        Self { length, angle, time, mass }
    }

    /// The dimension of a product. `None` if an exponent overflows, as for no physical quantity.
    #[must_use]
    pub fn checked_mul(self, other: Self) -> Option<Self> {
        self.combine(other, i8::checked_add)
    }

    /// The dimension of a quotient. `None` if an exponent overflows.
    #[must_use]
    pub fn checked_div(self, other: Self) -> Option<Self> {
        self.combine(other, i8::checked_sub)
    }

    /// The dimension of a power. `None` if an exponent overflows.
    #[must_use]
    pub fn checked_powi(self, exponent: i8) -> Option<Self> {
        self.combine(Self::new(exponent, exponent, exponent, exponent), i8::checked_mul)
    }

    /// Combines the exponents of two dimensions with `op`.
    fn combine(self, other: Self, op: fn(i8, i8) -> Option<i8>) -> Option<Self> {
        Some(Self {
            length: op(self.length, other.length)?,
            angle: op(self.angle, other.angle)?,
            time: op(self.time, other.time)?,
            mass: op(self.mass, other.mass)?,
        })
    }

    /// The name of a common dimension.
    #[must_use]
    pub fn name(self) -> Option<&'static str> {
        Some(match self {
            Self::NUMBER => "plain number",
            Self::LENGTH => "length",
            Self::ANGLE => "angle",
            Self::TIME => "time",
            Self::MASS => "mass",
            Self::AREA => "area",
            Self::CURVATURE => "curvature",
            Self::SPEED => "speed",
            Self::ACCELERATION => "acceleration",
            Self::ANGULAR_SPEED => "angular speed",
            Self::ANGULAR_ACCELERATION => "angular acceleration",
            Self::FREQUENCY => "frequency",
            Self::FORCE => "force",
            Self::MOMENT => "moment",
            Self::TORSION_STIFFNESS => "torsion stiffness",
            Self::TORSION_DAMPING => "torsion damping",
            Self::STIFFNESS => "stiffness",
            Self::INERTIA => "moment of inertia",
            Self::PRESSURE => "pressure",
            Self::DENSITY => "density",
            _ => return None,
        })
    }

    /// The dimension with its article, for a sentence: "a length", "an angle", "a quantity in kg m".
    #[must_use]
    pub fn phrase(self) -> String {
        match self.name() {
            Some(name) if name.starts_with(['a', 'e', 'i', 'o', 'u']) => format!("an {name}"),
            Some(name) => format!("a {name}"),
            None => format!("a quantity in {}", self.si_unit()),
        }
    }

    /// The SI unit of the dimension, in the syntax of [`parse_unit`](super::parse_unit). It is empty for a plain
    /// number.
    #[must_use]
    pub fn si_unit(self) -> String {
        match self {
            Self::FREQUENCY => "Hz".to_owned(),
            Self::FORCE => "N".to_owned(),
            Self::MOMENT => "N m".to_owned(),
            Self::TORSION_STIFFNESS => "N m/rad".to_owned(),
            Self::TORSION_DAMPING => "N m s/rad".to_owned(),
            Self::STIFFNESS => "N/m".to_owned(),
            Self::PRESSURE => "Pa".to_owned(),
            _ => self.base_units(),
        }
    }

    /// The unit as a product of kg, m, rad and s.
    fn base_units(self) -> String {
        let factors = [("kg", self.mass), ("m", self.length), ("rad", self.angle), ("s", self.time)];
        let powers = |positive: bool| {
            factors.iter().filter(move |(_, exponent)| *exponent != 0 && (*exponent > 0) == positive).map(
                |(symbol, exponent)| match exponent.unsigned_abs() {
                    1 => (*symbol).to_owned(),
                    power => format!("{symbol}^{power}"),
                },
            )
        };
        let numerator = powers(true).collect::<Vec<_>>().join(" ");
        let first = if numerator.is_empty() && self != Self::NUMBER { "1".to_owned() } else { numerator };
        std::iter::once(first).chain(powers(false)).collect::<Vec<_>>().join("/")
    }
}

impl fmt::Display for Dimension {
    /// Writes the name of a common dimension, and the SI unit of any other one.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self.name() {
            Some(name) => f.write_str(name),
            None => f.write_str(&self.si_unit()),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::units::parse_unit;
    use proptest::prelude::*;

    #[test]
    fn a_dimension_out_of_range_is_none_and_never_wraps() {
        let steep = Dimension::new(100, 0, 0, 0);
        assert_eq!(steep.checked_mul(steep), None);
        assert_eq!(Dimension::LENGTH.checked_div(Dimension::new(-128, 0, 0, 0)), None);
        assert_eq!(steep.checked_powi(2), None);
    }

    #[test]
    fn a_dimension_stands_in_a_sentence() {
        assert_eq!(Dimension::ANGLE.phrase(), "an angle");
        assert_eq!(Dimension::LENGTH.phrase(), "a length");
        assert_eq!(Dimension::new(3, 0, 0, 1).phrase(), "a quantity in kg m^3");
    }

    fn dimension() -> impl Strategy<Value = Dimension> {
        [-9_i8..10, -9..10, -9..10, -9..10].prop_map(|[l, a, t, m]| Dimension::new(l, a, t, m))
    }

    proptest! {
        #[test]
        fn the_si_unit_of_a_dimension_reads_back_as_that_dimension(dimension in dimension()) {
            prop_assume!(dimension != Dimension::NUMBER);
            let unit = parse_unit(&dimension.si_unit());
            prop_assert_eq!(unit.map(|unit| (unit.dimension(), unit.to_si(1.0))), Ok((dimension, 1.0)));
        }

        #[test]
        fn division_undoes_multiplication(a in dimension(), b in dimension()) {
            prop_assert_eq!(a.checked_mul(b).and_then(|product| product.checked_div(b)), Some(a));
        }

        #[test]
        fn a_power_is_repeated_multiplication(a in dimension()) {
            prop_assert_eq!(a.checked_powi(3), a.checked_mul(a).and_then(|square| square.checked_mul(a)));
        }
    }
}
