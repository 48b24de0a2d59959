//! Families of random scenes, with geometry that no policy was tuned for.
//!
//! A scene is the text of a scenario and is read as any other. Thus it is checked, can be printed and can be run by
//! itself. It depends only on the family's name, the seed, its number, and explicit values of parameters.

mod concave_corner;
mod convex;
mod convex_corner;
mod draw;
mod feature;
mod floor;
mod furnished;
mod layout;
mod outline;
mod polygon;
mod position;
mod rooms;
mod run;
mod sampler;
mod shapes;
mod smooth_curve;
mod tally;
mod thin_wall;
mod tunnel_mouth;
mod two_objects;
mod values;
mod zigzag_tunnel;

pub use draw::{Draw, NoDraw, SPEEDS};
pub use run::FamilyRun;
pub use tally::FamilyTally;
pub use values::Values;

use layout::Layout;
use sampler::Sampler;
use vibrissa_declare::catalogue::{self, Entry, Parameter};

/// A kind of scene with random geometry.
#[derive(Debug, Clone, Copy)]
pub struct Family {
    /// Its name: letters and `-`.
    pub name: &'static str,
    /// Description of its scenes.
    pub about: &'static str,
    /// Its parameters. Together they determine a scene.
    pub parameters: &'static [Parameter],
    /// True if `vibrissa families` without names runs it.
    pub is_default: bool,
    lay: fn(&mut Sampler<'_>) -> Layout,
}

impl Family {
    const fn new(entry: &Entry, lay: fn(&mut Sampler<'_>) -> Layout) -> Self {
        Self { name: entry.name, about: entry.about, parameters: entry.parameters, is_default: true, lay }
    }

    /// The same family, which runs only where it is named. Its runs take minutes of computation each.
    const fn by_name(self) -> Self {
        Self { is_default: false, ..self }
    }

    /// The family with this name.
    #[must_use]
    pub fn named(name: &str) -> Option<Self> {
        FAMILIES.into_iter().find(|family| family.name == name)
    }
}

/// All families.
pub const FAMILIES: [Family; 10] = [
    Family::new(&catalogue::convex_corner::ENTRY, convex_corner::lay),
    Family::new(&catalogue::concave_corner::ENTRY, concave_corner::lay),
    Family::new(&catalogue::smooth_curve::ENTRY, smooth_curve::lay),
    Family::new(&catalogue::polygon::ENTRY, polygon::lay),
    Family::new(&catalogue::thin_wall::ENTRY, thin_wall::lay),
    Family::new(&catalogue::two_objects::ENTRY, two_objects::lay),
    Family::new(&catalogue::zigzag_tunnel::ENTRY, zigzag_tunnel::lay),
    Family::new(&catalogue::tunnel_mouth::ENTRY, tunnel_mouth::lay),
    Family::new(&catalogue::shapes::ENTRY, shapes::lay).by_name(),
    Family::new(&catalogue::rooms::ENTRY, rooms::lay).by_name(),
];
