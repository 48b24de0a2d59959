//! The map of a run, and how it grew.

use vibrissa_runtime::control::Control;
use vibrissa_runtime::map::{CellSpan, Map};

/// Ticks between the first stages of a map.
const FIRST_INTERVAL: usize = 30;
/// Number of stages from which on every second one is dropped.
const MOST_STAGES: usize = 24;

/// The map of a finished run, and how it grew.
#[derive(Debug, Clone)]
pub struct RunMap {
    /// The map at the end.
    pub last: Map,
    /// Stages of its growth at equal intervals, the oldest first. The end is not among them.
    pub stages: Vec<MapStage>,
}

/// What was proved free at a time.
#[derive(Debug, Clone, PartialEq)]
pub struct MapStage {
    /// Index of the tick.
    pub tick: usize,
    /// The cells that were proved free.
    pub free: Vec<CellSpan>,
}

/// Records how the map of a run grows, in bounded memory and time.
#[derive(Debug)]
pub(super) struct GrowthRecord {
    stages: Vec<MapStage>,
    /// Ticks between the stages.
    interval: usize,
}

impl GrowthRecord {
    pub(super) fn new() -> Self {
        Self { stages: Vec::new(), interval: FIRST_INTERVAL }
    }

    /// Receives the map after the tick with this index.
    pub(super) fn add(&mut self, tick: usize, map: &Map) {
        if !(tick + 1).is_multiple_of(self.interval) {
            return;
        }
        self.stages.push(MapStage { tick, free: map.free_spans().collect() });
        if self.stages.len() == MOST_STAGES {
            self.interval *= 2;
            self.stages.retain(|stage| (stage.tick + 1).is_multiple_of(self.interval));
        }
    }

    /// The map of a finished run. `None` without one.
    pub(super) fn finish(self, control: &Control) -> Option<Box<RunMap>> {
        Some(Box::new(RunMap { last: control.map()?.clone(), stages: self.stages }))
    }
}
