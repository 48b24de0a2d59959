//! Physical dimensions, units and quantities, as the scenario format and the policy language write them.
//!
//! Inside the program every number is in SI units and radians; this module is the edge where text with a unit becomes
//! such a number, and back.

mod dimension;
mod foreign;
mod format;
mod quantity;
mod suggestion;
mod unit;

pub use dimension::Dimension;
pub use format::format_si;
pub use quantity::{Quantity, QuantityError, parse_quantity};
pub use suggestion::suggest;
pub use unit::{Instead, Unit, UnitError, parse_unit, simple_units, unit_hint, units_of};
