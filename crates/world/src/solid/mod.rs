//! Solids: an exact outline, and convex parts that cover it.

mod decompose;
mod part;
mod rough;
#[expect(clippy::module_inception, reason = "one noun a file, and this one is the module's name")]
mod solid;
mod wall;

pub use part::Part;
pub use solid::{Solid, SolidError};
