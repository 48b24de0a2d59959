//! A map by touch: which places are proved free, which are surface, and which are unknown.
//!
//! Objects are taken as static, and poses as known up to a bound. `docs/map.md` of the repository derives the margins.

mod bits;
mod cells;
mod clearance;
mod contour_ends;
mod contours;
mod grid;
mod margins;
mod polygon;
mod settings;
mod shaft_sweep;
mod touch_map;

pub use cells::Cell;
pub use clearance::Ground;
pub use contour_ends::{ContourEnd, EndKind};
pub use contours::ContourPoint;
pub use settings::{MapError, MapSettings};
pub use touch_map::Map;
