//! The properties in which the true array may differ from the assumed one, with their keys in a mismatch.

mod difference;
mod property;

pub use difference::{Change, DIFFERENCES, Difference, Scope};
pub use property::Property;
