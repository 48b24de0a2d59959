//! Solids: an exact outline, and convex parts that cover it.

mod composition;
mod convex_parts;
mod decompose;
mod part;
mod parts_fault;
mod rough;
#[expect(clippy::module_inception, reason = "one noun a file, and this one is the module's name")]
mod solid;
mod wall;

pub use convex_parts::convex_parts;
pub use part::Part;
pub use parts_fault::{PartsError, PartsFault};
pub use solid::{Solid, SolidError};
