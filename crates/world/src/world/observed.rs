//! A world whose samples pass through a function.

use super::{Fault, OutOfPlane, Posture, World};
use crate::geometry::Point2;
use vibrissa_runtime::signal::{Command, Sample};

/// A world whose samples pass through a function, which may read the world, and change or keep the samples.
pub struct Observed<F> {
    world: Box<dyn World>,
    observe: F,
    samples: Vec<Sample>,
}

impl<F: FnMut(&dyn World, &mut Vec<Sample>) + Send> Observed<F> {
    /// Passes the samples of every control period of `world` to `observe`.
    #[must_use]
    pub fn new(world: Box<dyn World>, observe: F) -> Self {
        Self { world, observe, samples: Vec::new() }
    }
}

impl<F: FnMut(&dyn World, &mut Vec<Sample>) + Send> World for Observed<F> {
    fn advance(&mut self, command: &Command) -> Result<&[Sample], Fault> {
        self.samples.clear();
        self.samples.extend_from_slice(self.world.advance(command)?);
        (self.observe)(&*self.world, &mut self.samples);
        Ok(&self.samples)
    }

    fn body_touches(&self) -> bool {
        self.world.body_touches()
    }

    fn snapped_off(&self, whisker: usize) -> bool {
        self.world.snapped_off(whisker)
    }

    fn out_of_plane(&self, whisker: usize) -> Option<OutOfPlane> {
        self.world.out_of_plane(whisker)
    }

    fn tip(&self, whisker: usize) -> Point2 {
        self.world.tip(whisker)
    }

    fn posture(&self) -> Option<Posture> {
        self.world.posture()
    }
}
