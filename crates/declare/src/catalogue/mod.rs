//! Names and parameters of the scene families. `family` makes their scenes, and policies name them in properties.

pub mod common;
pub mod concave_corner;
pub mod convex_corner;
mod entry;
mod parameter;
pub mod polygon;
pub mod rooms;
pub mod shapes;
pub mod smooth_curve;
pub mod thin_wall;
pub mod tunnel_mouth;
pub mod two_objects;
pub mod zigzag_tunnel;

pub use entry::Entry;
pub use parameter::Parameter;

/// The entries of all families.
pub static ENTRIES: [&Entry; 10] = [
    &convex_corner::ENTRY,
    &concave_corner::ENTRY,
    &smooth_curve::ENTRY,
    &polygon::ENTRY,
    &thin_wall::ENTRY,
    &two_objects::ENTRY,
    &zigzag_tunnel::ENTRY,
    &tunnel_mouth::ENTRY,
    &shapes::ENTRY,
    &rooms::ENTRY,
];

/// The entry of a family.
#[must_use]
pub fn entry(family: &str) -> Option<&'static Entry> {
    ENTRIES.into_iter().find(|entry| entry.name == family)
}
