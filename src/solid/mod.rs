//! Solids: an exact outline, and convex parts that cover it.

mod decompose;
mod part;
mod solid;
mod wall;

pub use part::Part;
pub use solid::{Solid, SolidError};
