//! The samples of a recorded run as a world.

use vibrissa_runtime::signal::{Command, Sample};
use vibrissa_world::geometry::Point2;
use vibrissa_world::world::{Fault, World};

/// A world that gives recorded samples, whatever the command is.
pub(super) struct SampledWorld<'s> {
    /// The samples before each tick that is still to come.
    ticks: std::slice::Iter<'s, Vec<Sample>>,
}

impl<'s> SampledWorld<'s> {
    /// The world of the samples before each tick.
    pub(super) fn new(ticks: &'s [Vec<Sample>]) -> Self {
        Self { ticks: ticks.iter() }
    }
}

impl World for SampledWorld<'_> {
    fn advance(&mut self, _: &Command) -> Result<&[Sample], Fault> {
        Ok(self.ticks.next().map(Vec::as_slice).unwrap_or_default())
    }

    fn body_touches(&self) -> bool {
        false
    }

    fn snapped_off(&self, _: usize) -> bool {
        false
    }

    /// The true tips are not recorded.
    fn tip(&self, _: usize) -> Point2 {
        Point2::new(f64::NAN, f64::NAN)
    }
}
