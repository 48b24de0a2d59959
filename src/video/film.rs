//! What a run leaves for its video.

use vibrissa_runtime::machine::Observer;

use vibrissa_lab::run::{Trace, Watcher};
use vibrissa_world::geometry::Pose;
use vibrissa_world::world::{Posture, World};

use super::settings::Settings;

/// The largest number of frames: 33 minutes at 50 frames per second.
pub(super) const MOST_FRAMES: usize = 100_000;
/// A share of a frame that rounding may move a time by.
const ROUNDING: f64 = 1e-6;

/// Watches a run, and keeps the postures that its frames show.
#[derive(Debug)]
pub struct Film {
    /// Simulated time between two frames (s).
    step: f64,
    /// The true pose of the platform at every tick.
    bodies: Vec<Pose>,
    shots: Vec<Shot>,
    /// The shots of the frames, by their indices.
    frames: Vec<usize>,
    newest: Option<Shot>,
}

/// The posture of a tick.
#[derive(Debug, Clone)]
pub(super) struct Shot {
    /// Index of the tick.
    pub(super) tick: usize,
    pub(super) posture: Posture,
}

impl Film {
    /// A film of a run that has not begun.
    #[must_use]
    pub fn new(settings: &Settings) -> Self {
        Self { step: settings.step(), bodies: Vec::new(), shots: Vec::new(), frames: Vec::new(), newest: None }
    }

    /// The shot of each frame, in order. The last one shows the last tick.
    pub(super) fn frames(&self) -> Vec<&Shot> {
        let last = self.newest.as_ref().filter(|newest| self.shots.last().is_none_or(|shot| shot.tick < newest.tick));
        self.frames.iter().filter_map(|index| self.shots.get(*index)).chain(last).collect()
    }

    /// The true pose of the platform at every tick (world frame).
    pub(super) fn bodies(&self) -> &[Pose] {
        &self.bodies
    }
}

impl Observer for Film {}

impl Watcher for Film {
    fn in_world(&mut self, trace: &Trace, world: &dyn World) {
        let (Some(newest), Some(posture)) = (trace.ticks.last(), world.posture()) else { return };
        self.bodies.push(posture.body);
        let shot = Shot { tick: trace.ticks.len() - 1, posture };
        // The first tick is the first frame.
        let start = trace.ticks.first().map_or(0.0, |first| first.time);
        let due = ((newest.time - start) / self.step + ROUNDING).floor();
        let mut is_shown = false;
        // A video with more frames is refused.
        while self.frames.len() as f64 <= due && self.frames.len() <= MOST_FRAMES {
            self.frames.push(self.shots.len());
            is_shown = true;
        }
        if is_shown {
            self.shots.push(shot.clone());
        }
        self.newest = Some(shot);
    }
}
