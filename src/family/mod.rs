//! Families of random scenes, with geometry that no policy was tuned for.
//!
//! A scene is the text of a scenario and is read as any other. Thus it is checked, can be printed and can be run by
//! itself. It depends only on the family's name, the seed and its number.

mod concave_corner;
mod convex_corner;
mod draw;
mod layout;
mod outline;
mod polygon;
mod position;
mod run;
mod sampler;
mod smooth_curve;
mod tally;
mod thin_wall;
mod tunnel_mouth;
mod two_objects;
mod zigzag_tunnel;

pub use draw::{Draw, NoDraw, SPEEDS};
pub(crate) use run::FamilyRun;
pub(crate) use tally::FamilyTally;

use layout::Layout;
use sampler::Sampler;

/// A kind of scene with random geometry.
#[derive(Debug, Clone, Copy)]
pub struct Family {
    /// Its name: letters and `-`.
    pub name: &'static str,
    /// Description of its scenes.
    pub about: &'static str,
    lay: fn(&mut Sampler) -> Layout,
}

/// All families.
pub const FAMILIES: [Family; 8] = [
    convex_corner::FAMILY,
    concave_corner::FAMILY,
    smooth_curve::FAMILY,
    polygon::FAMILY,
    thin_wall::FAMILY,
    two_objects::FAMILY,
    zigzag_tunnel::FAMILY,
    tunnel_mouth::FAMILY,
];
