//! Physical dimensions, units and quantities of the scenario format and the policy language.
//!
//! Internally, every number is in SI units and radians. This module converts between such numbers and text with units.

mod dimension;
mod foreign;
mod format;
mod key;
mod quantity;
mod suggestion;
mod unit;

pub use dimension::Dimension;
pub use format::format_si;
pub use key::Key;
pub use quantity::{Quantity, QuantityError, parse_quantity};
pub use suggestion::suggest;
pub use unit::{Instead, Unit, UnitError, parse_unit, simple_units, unit_hint, units_of};
