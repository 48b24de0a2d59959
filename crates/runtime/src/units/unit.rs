//! Units: the table of simple units and the parser of compound ones.

use super::Dimension;
use super::foreign::foreign;
use super::suggest;
use crate::math;
use std::ops::Range;
use thiserror::Error;

/// A unit of measurement: a dimension and a factor to SI units.
///
/// The factor is a quotient of two numbers. Both are exact for every unit except the degree, so that 72 mm is the f64
/// nearest to 0.072 m.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Unit {
    /// Dimension of the unit.
    dimension: Dimension,
    /// Numerator of the factor to SI units.
    numerator: f64,
    /// Denominator of this factor.
    denominator: f64,
}

/// All simple units, the most common of a dimension first.
const SIMPLE: &[(&str, Unit)] = &[
    ("mm", Unit::new(Dimension::LENGTH, 1.0, 1e3)),
    ("m", Unit::new(Dimension::LENGTH, 1.0, 1.0)),
    ("cm", Unit::new(Dimension::LENGTH, 1.0, 1e2)),
    ("um", Unit::new(Dimension::LENGTH, 1.0, 1e6)),
    ("deg", Unit::new(Dimension::ANGLE, std::f64::consts::PI / 180.0, 1.0)),
    ("rad", Unit::new(Dimension::ANGLE, 1.0, 1.0)),
    ("mrad", Unit::new(Dimension::ANGLE, 1.0, 1e3)),
    ("urad", Unit::new(Dimension::ANGLE, 1.0, 1e6)),
    ("s", Unit::new(Dimension::TIME, 1.0, 1.0)),
    ("ms", Unit::new(Dimension::TIME, 1.0, 1e3)),
    ("us", Unit::new(Dimension::TIME, 1.0, 1e6)),
    ("Hz", Unit::new(Dimension::FREQUENCY, 1.0, 1.0)),
    ("kHz", Unit::new(Dimension::FREQUENCY, 1e3, 1.0)),
    ("N", Unit::new(Dimension::FORCE, 1.0, 1.0)),
    ("mN", Unit::new(Dimension::FORCE, 1.0, 1e3)),
    ("kg", Unit::new(Dimension::MASS, 1.0, 1.0)),
    ("g", Unit::new(Dimension::MASS, 1.0, 1e3)),
    ("GPa", Unit::new(Dimension::PRESSURE, 1e9, 1.0)),
    ("MPa", Unit::new(Dimension::PRESSURE, 1e6, 1.0)),
    ("Pa", Unit::new(Dimension::PRESSURE, 1.0, 1.0)),
    ("%", Unit::new(Dimension::NUMBER, 1.0, 1e2)),
];

impl Unit {
    /// Creates a unit from its dimension and its factor.
    const fn new(dimension: Dimension, numerator: f64, denominator: f64) -> Self {
        Self { dimension, numerator, denominator }
    }

    /// The dimension of the unit.
    #[must_use]
    pub fn dimension(self) -> Dimension {
        self.dimension
    }

    /// Converts a value in this unit to SI units.
    #[must_use]
    pub fn to_si(self, value: f64) -> f64 {
        value * self.numerator / self.denominator
    }

    /// Converts a value in SI units to this unit.
    #[must_use]
    pub fn from_si(self, value_si: f64) -> f64 {
        value_si * self.denominator / self.numerator
    }

    /// A power of the unit. `None` on overflow.
    fn powi(self, exponent: i8) -> Option<Self> {
        let (numerator, denominator) =
            if exponent < 0 { (self.denominator, self.numerator) } else { (self.numerator, self.denominator) };
        let power = i32::from(exponent.unsigned_abs());
        Self::new(self.dimension.checked_powi(exponent)?, math::powi(numerator, power), math::powi(denominator, power))
            .if_finite()
    }

    /// The product of two units. `None` on overflow.
    fn checked_mul(self, other: Self) -> Option<Self> {
        let dimension = self.dimension.checked_mul(other.dimension)?;
        Self::new(dimension, self.numerator * other.numerator, self.denominator * other.denominator).if_finite()
    }

    /// The unit, if its factor is a normal number.
    fn if_finite(self) -> Option<Self> {
        [self.numerator, self.denominator].iter().all(|factor| factor.is_normal()).then_some(self)
    }
}

/// A replacement for a name that is not a unit.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Instead {
    /// The unit exists but is not supported. This is its value in a supported unit.
    Same(&'static str),
    /// The supported unit that was probably meant.
    Meant(String),
}

impl Instead {
    /// Returns a replacement for `name` among these units.
    pub fn of<'u>(name: &str, units: impl IntoIterator<Item = &'u str>) -> Option<Self> {
        let same = foreign(name).map(Self::Same);
        same.or_else(|| suggest(name, units).map(|meant| Self::Meant(meant.to_owned())))
    }

    /// Formats the replacement as a hint.
    #[must_use]
    pub fn hint(&self, name: &str) -> String {
        match self {
            Self::Same(same) => format!("1 {name} is {same}"),
            Self::Meant(meant) => format!("did you mean `{meant}`?"),
        }
    }
}

/// An error of parsing a unit. Ranges are byte ranges of that text.
#[derive(Debug, Clone, PartialEq, Eq, Error)]
pub enum UnitError {
    /// The unit is missing.
    #[error("a unit is missing")]
    Missing {
        /// Expected position of the unit.
        range: Range<usize>,
    },
    /// A name is not a unit.
    #[error("there is no unit `{name}`")]
    Unknown {
        /// The name in the text.
        name: String,
        /// Its position.
        range: Range<usize>,
        /// Replacement, if there is a probable one.
        instead: Option<Instead>,
    },
    /// An exponent is not a small whole number.
    #[error("an exponent must be a whole number from -9 to 9")]
    Exponent {
        /// Its position.
        range: Range<usize>,
    },
    /// A product follows a slash, which is ambiguous.
    #[error("this factor may be in the numerator or the denominator")]
    Ambiguous {
        /// The ambiguous factor.
        range: Range<usize>,
    },
    /// The factor or the dimension of the unit overflows.
    #[error("the unit has too many factors")]
    TooLarge {
        /// The whole unit.
        range: Range<usize>,
    },
}

impl UnitError {
    /// The byte range of the error.
    #[must_use]
    pub fn range(&self) -> Range<usize> {
        match self {
            Self::Missing { range }
            | Self::Unknown { range, .. }
            | Self::Exponent { range }
            | Self::Ambiguous { range }
            | Self::TooLarge { range } => range.clone(),
        }
    }

    /// A hint: the text to write instead.
    #[must_use]
    pub fn hint(&self) -> String {
        match self {
            Self::Missing { .. } => "write a unit such as mm, deg, s or mm/s".to_owned(),
            Self::Unknown { name, instead: Some(instead), .. } => instead.hint(name),
            Self::Unknown { instead: None, .. } => {
                format!("the units are {}", simple_units().collect::<Vec<_>>().join(", "))
            }
            Self::Exponent { .. } => "write it like m^2 or s^-1".to_owned(),
            Self::Ambiguous { .. } => {
                "write products first, and a slash before each divisor: N m/rad, kg/m/s".to_owned()
            }
            Self::TooLarge { .. } => "use fewer factors or smaller exponents".to_owned(),
        }
    }

    /// Shifts the ranges of the error by `offset` bytes.
    #[must_use]
    pub(super) fn shifted(mut self, offset: usize) -> Self {
        match &mut self {
            Self::Missing { range }
            | Self::Unknown { range, .. }
            | Self::Exponent { range }
            | Self::Ambiguous { range }
            | Self::TooLarge { range } => *range = range.start + offset..range.end + offset,
        }
        self
    }
}

/// Parses a unit: simple units (`mm`, `deg`, `%`), powers (`m^2`), products (`N m`) and quotients (`mm/s`, `N m/rad`,
/// `1/s`). A slash applies to exactly one factor. `µ` is read as `u`.
///
/// # Errors
/// [`UnitError`] with the position of the error and a replacement for a misspelt unit.
///
/// ```
/// use vibrissa_runtime::units::{Dimension, parse_unit};
/// let unit = parse_unit("mm/s").unwrap();
/// assert_eq!(unit.dimension(), Dimension::SPEED);
/// assert_eq!(unit.to_si(50.0), 0.05);
/// ```
pub fn parse_unit(text: &str) -> Result<Unit, UnitError> {
    // Most units are simple, and need no parsing.
    if let Some(unit) = simple(text) {
        return Ok(unit);
    }
    let mut unit = Unit::new(Dimension::NUMBER, 1.0, 1.0);
    let mut multiply = |factor: Option<Unit>| {
        unit =
            factor.and_then(|factor| unit.checked_mul(factor)).ok_or(UnitError::TooLarge { range: 0..text.len() })?;
        Ok(())
    };
    let mut offset = 0;
    for (index, part) in text.split('/').enumerate() {
        let mut factors = words(part, offset).peekable();
        if factors.peek().is_none() {
            return Err(UnitError::Missing { range: offset..offset + part.len() });
        }
        let only_divides = index == 0 && part.trim() == "1" && text.len() > part.len();
        if index == 0 && !only_divides {
            for (word, start) in factors {
                multiply(Some(parse_power(word, start)?))?;
            }
        } else if !only_divides {
            for (position, (word, start)) in factors.enumerate() {
                if position > 0 {
                    return Err(UnitError::Ambiguous { range: start..start + word.len() });
                }
                multiply(parse_power(word, start)?.powi(-1))?;
            }
        }
        offset += part.len() + 1;
    }
    Ok(unit)
}

/// Returns the simple unit with this symbol.
fn simple(symbol: &str) -> Option<Unit> {
    SIMPLE.iter().find(|(known, _)| *known == symbol).map(|&(_, unit)| unit)
}

/// The words of a text, each with its byte offset plus `offset`.
fn words(text: &str, offset: usize) -> impl Iterator<Item = (&str, usize)> {
    text.split_inclusive(char::is_whitespace)
        .scan(offset, |start, piece| {
            let here = *start;
            *start += piece.len();
            Some((piece.trim_end(), here))
        })
        .filter(|(word, _)| !word.is_empty())
}

/// Parses one factor at byte `start`: a simple unit with an optional exponent.
fn parse_power(text: &str, start: usize) -> Result<Unit, UnitError> {
    let (name, exponent) = text.split_once('^').map_or((text, None), |(name, exponent)| (name, Some(exponent)));
    let spelt = name.replace(['\u{b5}', '\u{3bc}'], "u");
    let Some(unit) = simple(&spelt) else {
        let instead = Instead::of(&spelt, simple_units());
        return Err(UnitError::Unknown { name: name.to_owned(), range: start..start + name.len(), instead });
    };
    let Some(exponent) = exponent else { return Ok(unit) };
    let range = start + name.len() + 1..start + text.len();
    let power = exponent.parse().ok().filter(|power| (-9..=9).contains(power)).ok_or(UnitError::Exponent { range })?;
    unit.powi(power).ok_or(UnitError::TooLarge { range: start..start + text.len() })
}

/// The common units of a dimension, the most common first.
#[must_use]
pub fn units_of(dimension: Dimension) -> Vec<String> {
    let simple = SIMPLE.iter().filter(|(_, unit)| unit.dimension == dimension).map(|(symbol, _)| (*symbol).to_owned());
    let simple: Vec<String> = simple.collect();
    match dimension {
        _ if !simple.is_empty() => simple,
        Dimension::SPEED => ["mm/s", "m/s", "cm/s"].map(str::to_owned).to_vec(),
        Dimension::ANGULAR_SPEED => ["deg/s", "rad/s"].map(str::to_owned).to_vec(),
        _ => vec![dimension.si_unit()],
    }
}

/// Returns a hint for a unit that does not exist, if a quantity of `dimension` is expected.
#[must_use]
pub fn unit_hint(name: &str, dimension: Dimension) -> Option<String> {
    let units = units_of(dimension);
    Instead::of(name, units.iter().map(String::as_str)).map(|instead| instead.hint(name))
}

/// The symbols of all simple units, such as `mm`, `deg` and `%`.
pub fn simple_units() -> impl Iterator<Item = &'static str> {
    SIMPLE.iter().map(|&(symbol, _)| symbol)
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "a test may panic")]
    use super::*;
    use proptest::prelude::*;

    fn si(text: &str) -> (f64, Dimension) {
        let unit = parse_unit(text).unwrap();
        (unit.to_si(1.0), unit.dimension())
    }

    #[test]
    fn compounds_multiply_and_divide_their_factors() {
        assert_eq!(si("N m/rad"), (1.0, Dimension::TORSION_STIFFNESS));
        assert_eq!(si("N m s/rad"), (1.0, Dimension::TORSION_DAMPING));
        assert_eq!(si("kg m^2"), (1.0, Dimension::INERTIA));
        assert_eq!(si("g/cm^3"), (1000.0, Dimension::DENSITY));
        assert_eq!(si("1 / ms"), (1000.0, Dimension::FREQUENCY));
        assert_eq!(si("m/s/s"), (1.0, Dimension::ACCELERATION));
        assert_eq!(si("m s^-1"), (1.0, Dimension::SPEED));
        assert_eq!(si("\u{b5}m"), si("um"));
    }

    #[test]
    fn a_factor_behind_a_quotient_is_ambiguous() {
        assert_eq!(parse_unit("N/m s"), Err(UnitError::Ambiguous { range: 4..5 }));
    }

    #[test]
    fn a_misspelt_unit_is_placed_and_the_right_one_suggested() {
        let instead = Some(Instead::Meant("rad".to_owned()));
        let expected = UnitError::Unknown { name: "radd".to_owned(), range: 3..7, instead };
        assert_eq!(parse_unit("mm/radd"), Err(expected));
    }

    #[test]
    fn a_suggestion_knows_what_is_measured() {
        assert_eq!(unit_hint("mn", Dimension::LENGTH).as_deref(), Some("did you mean `mm`?"));
        assert_eq!(unit_hint("mn", Dimension::FORCE).as_deref(), Some("did you mean `mN`?"));
    }

    #[test]
    fn a_unit_that_exists_elsewhere_is_not_taken_for_a_misspelt_one() {
        assert_eq!(parse_unit("km/h").unwrap_err().hint(), "1 km is 1000 m");
        assert_eq!(parse_unit("m/h").unwrap_err().hint(), "1 h is 3600 s");
        assert_eq!(unit_hint("min", Dimension::TIME).as_deref(), Some("1 min is 60 s"));
    }

    #[test]
    fn a_unit_that_no_number_holds_is_an_error() {
        assert_eq!(parse_unit(&["m^9"; 20].join(" ")), Err(UnitError::TooLarge { range: 0..79 }));
        assert_eq!(parse_unit(&["Pa", "rad"].join("^99 ")), Err(UnitError::Exponent { range: 3..5 }));
    }

    proptest! {
        #[test]
        fn no_text_panics_and_every_error_lies_within_it(text in "[ /^0-9a-z\u{b5}\u{2003}%-]{0,12}|\\PC{0,12}") {
            if let Err(error) = parse_unit(&text) {
                prop_assert!(text.get(error.range()).is_some(), "{error:?}");
            }
        }
    }
}
