//! The values of arguments: worlds, parameters, quantities.

use std::num::NonZeroUsize;

use clap::ValueEnum;

use crate::scene::{Scene, WorldKind};
use crate::study::processors;
use crate::study::tiers::Tier;
use crate::units::{Dimension, parse_quantity};

/// The worlds, as the command line names them.
#[derive(Debug, Clone, Copy, ValueEnum)]
pub(super) enum World {
    /// The simulation by MuJoCo
    Mujoco,
    /// Static equilibria, one after the other: no inertia, no friction, and many times as fast
    #[value(name = "quasistatic")]
    QuasiStatic,
}

impl World {
    /// The world to run a scene in when this is asked for, if anything is.
    pub(super) fn of(asked: Option<Self>, scene: &Scene) -> WorldKind {
        let asked = asked.map(|world| match world {
            Self::Mujoco => WorldKind::Mujoco,
            Self::QuasiStatic => WorldKind::QuasiStatic,
        });
        asked.or(scene.world).unwrap_or_default()
    }
}

/// The tiers of worlds that are compared with MuJoCo's chains, as the command line names them.
#[derive(Debug, Clone, Copy, ValueEnum)]
pub(super) enum TierName {
    /// The same chains in static equilibrium
    #[value(name = "quasistatic")]
    QuasiStatic,
    /// Cables of 40 links, by MuJoCo: tens of times as slow
    #[value(name = "peer_cable")]
    PeerCable,
}

impl TierName {
    pub(super) fn of(self, scene: &Scene) -> Tier {
        match self {
            Self::QuasiStatic => Tier::quasi_static(scene),
            Self::PeerCable => Tier::peer_cable(scene),
        }
    }
}

/// The most runs at a time for each processor. More of them only take memory.
const JOBS_PER_PROCESSOR: usize = 32;
/// The most times that something is measured.
const MOST_REPEATS: usize = 1000;

/// How many runs to do at a time.
pub(super) fn parse_jobs(text: &str) -> Result<NonZeroUsize, String> {
    let most = processors().get().saturating_mul(JOBS_PER_PROCESSOR);
    let jobs = parse_count(text, most).map_err(|range| format!("{range}, {JOBS_PER_PROCESSOR} for each processor"))?;
    Ok(NonZeroUsize::new(jobs).unwrap_or(NonZeroUsize::MIN))
}

/// How often to measure something.
pub(super) fn parse_repeats(text: &str) -> Result<usize, String> {
    parse_count(text, MOST_REPEATS)
}

fn parse_count(text: &str, most: usize) -> Result<usize, String> {
    let count = text.trim().parse().ok().filter(|count| (1..=most).contains(count));
    count.ok_or_else(|| format!("write a whole number from 1 to {most}"))
}

/// A coefficient of friction from 0 to 1.
pub(super) fn parse_friction(text: &str) -> Result<f64, String> {
    let friction = text.trim().parse().ok().filter(|friction| (0.0..=1.0).contains(friction));
    friction.ok_or_else(|| "write a number from 0 to 1, such as 0.3".to_owned())
}

/// A length (m) that is not negative.
pub(super) fn parse_length(text: &str) -> Result<f64, String> {
    parse_size(text, Dimension::LENGTH, "20 mm")
}

/// An angle (rad) that is not negative.
pub(super) fn parse_angle(text: &str) -> Result<f64, String> {
    parse_size(text, Dimension::ANGLE, "10 deg")
}

/// A quantity (SI) of this dimension that is not negative.
fn parse_size(text: &str, dimension: Dimension, example: &str) -> Result<f64, String> {
    let quantity = parse_quantity(text.trim()).map_err(|error| format!("{error}; {}", error.hint()))?;
    let fits = quantity.dimension == dimension && quantity.value_si >= 0.0;
    fits.then_some(quantity.value_si)
        .ok_or_else(|| format!("write {} that is not negative: \"{example}\"", dimension.phrase()))
}
