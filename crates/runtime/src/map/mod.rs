//! A map by touch: which positions are proved free, which are surface, and which are unknown.
//!
//! Objects are taken as static, and poses as known up to a bound. `docs/map.md` of the repository derives the margins.

mod bits;
mod cell_span;
mod cells;
mod clearance;
mod contour_ends;
mod contours;
mod first_touch;
mod frontier;
mod grid;
mod lattice;
mod mapped_whisker;
mod margins;
mod polygon;
mod queries;
mod route;
mod route_follow;
mod route_search;
mod senses;
mod settings;
mod shaft_contact;
mod shaft_sweep;
mod targets;
mod touch_map;

pub use cell_span::CellSpan;
pub use cells::Cell;
pub use clearance::Ground;
pub use contour_ends::{ContourEnd, EndKind};
pub use contours::ContourPoint;
pub use first_touch::FirstTouch;
pub use route::{RouteStatus, RouteStep};
pub use route_follow::RouteMotion;
pub use route_search::{Pace, RouteError};
pub use senses::MappedPerception;
pub use settings::{MapError, MapSettings};
pub use shaft_contact::ShaftContact;
pub use targets::{Target, TargetKind};
pub use touch_map::Map;
