//! Families of random scenes, with geometry that no policy was tuned for.
//!
//! A scene is the text of a scenario and is read as any other. Thus it is checked, can be printed and can be run by
//! itself. It depends only on the family's name, the seed, its number, and explicit values of parameters.
//!
//! A family is built in, or a file of its user: a scenario whose values are drawn.

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

use std::borrow::Cow;
use std::sync::Arc;

use layout::Layout;
use sampler::Sampler;
use vibrissa_declare::catalogue::{self, Entry, Parameter};
use vibrissa_world::scenario::DrawnScenario;

/// A kind of scene with random geometry.
#[derive(Debug, Clone)]
pub struct Family {
    /// Its name: letters, digits, `_` and `-`.
    pub name: Cow<'static, str>,
    /// Its parameters. Together they determine a scene. Those of a file have no names outside of it.
    pub parameters: &'static [Parameter],
    /// True if `vibrissa families` without names runs it.
    pub is_default: bool,
    scenes: Scenes,
}

/// Where the scenes of a family come from.
#[derive(Debug, Clone)]
enum Scenes {
    /// A layout in Rust.
    Laid(fn(&mut Sampler<'_>) -> Layout),
    /// A scenario whose values are drawn.
    Written(Arc<DrawnScenario>),
}

impl Family {
    const fn new(entry: &Entry, lay: fn(&mut Sampler<'_>) -> Layout) -> Self {
        let (name, scenes) = (Cow::Borrowed(entry.name), Scenes::Laid(lay));
        Self { name, parameters: entry.parameters, is_default: true, scenes }
    }

    /// The same family, which runs only where it is named. Its runs take minutes of computation each.
    const fn by_name(mut self) -> Self {
        self.is_default = false;
        self
    }

    /// The family of a file, with the name of its scenario.
    #[must_use]
    pub fn written(scenario: DrawnScenario) -> Self {
        let name = Cow::Owned(scenario.name().to_owned());
        Self { name, parameters: &[], is_default: false, scenes: Scenes::Written(Arc::new(scenario)) }
    }

    /// The family with this name.
    #[must_use]
    pub fn named(name: &str) -> Option<Self> {
        FAMILIES.into_iter().find(|family| family.name == name)
    }
}

/// The families that are built in.
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
