//! Random starts.

use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::SeedableRng;
use rand_distr::{Distribution, Uniform};

use super::Scene;
use crate::geometry::{Pose, Vector2};

/// The largest number of samples until the rig is clear of all solids.
const DRAWS: usize = 1000;

/// The range of random displacements of a start.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Jitter {
    /// The largest displacement along x and along y, in both directions (m).
    pub position: f64,
    /// The largest rotation, in both directions (rad).
    pub heading: f64,
}

impl Jitter {
    /// Samples a start uniformly from those at which the rig is clear of all solids. `None` if none was found. The same
    /// scene and seed give the same start.
    #[must_use]
    pub fn start(&self, scene: &Scene, seed: u64) -> Option<Pose> {
        let mut random = ChaCha8Rng::seed_from_u64(seed);
        // Stream 0 of the same seed is the noise of the sensors.
        random.set_stream(1);
        let side = Uniform::new_inclusive(-1.0, 1.0).ok()?;
        (0..DRAWS).find_map(|_| {
            let [x, y, turn] = std::array::from_fn(|_| side.sample(&mut random));
            let start = Pose {
                position: scene.start.position + self.position * Vector2::new(x, y),
                heading: scene.start.heading + self.heading * turn,
            };
            scene.is_clear_at(&start).then_some(start)
        })
    }
}
