//! Starts that vary from run to run.

use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::SeedableRng;
use rand_distr::{Distribution, Uniform};

use super::Scene;
use crate::geometry::{Pose, Vector2};

/// How often a start is drawn at most until the rig stands clear.
const DRAWS: usize = 1000;

/// How far a start may be from the scenario's own.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Jitter {
    /// Along x and along y, to either side (m).
    pub position: f64,
    /// To either side (rad).
    pub heading: f64,
}

impl Jitter {
    /// The start that belongs to `seed`, evenly distributed over those at which the rig stands clear of the object; `None` if
    /// none was found. The same scene and seed give the same start.
    #[must_use]
    pub fn start(&self, scene: &Scene, seed: u64) -> Option<Pose> {
        let mut random = ChaCha8Rng::seed_from_u64(seed);
        // The sensors' noise has the stream 0 of the same seed.
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
