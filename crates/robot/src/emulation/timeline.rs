//! The states of a plant over time.

use std::collections::VecDeque;

use vibrissa_runtime::geometry::{Point2, Pose};
use vibrissa_runtime::signal::{Command, MAX_WHISKERS};

use super::plant::{Plant, PlantFault, PlantState};

/// States that are kept, for sensors that look back over a conversion and for late poses.
const CAPACITY: usize = 128;

/// A plant and its newest states. It is simulated as far as its sensors need it.
#[derive(Debug)]
pub(super) struct Timeline<P> {
    pub(super) plant: P,
    states: VecDeque<PlantState>,
    /// Index of the first kept state. Its time is the index times the period.
    first: u64,
    period_ns: u64,
    /// The command that the plant follows now.
    pub(super) command: Command,
    pub(super) fault: Option<PlantFault>,
    /// Base moments (N m) that replace those of the plant.
    pub(super) bent: [Option<f64>; MAX_WHISKERS],
}

impl<P: Plant> Timeline<P> {
    pub(super) fn new(plant: P, period_ns: u64) -> Self {
        let states = VecDeque::from([plant.start()]);
        Self { plant, states, first: 0, period_ns, command: Command::STOP, fault: None, bent: [None; MAX_WHISKERS] }
    }

    /// The state at a time (ns), with the moments that are replaced.
    pub(super) fn at(&mut self, time_ns: u64) -> PlantState {
        let mut state = self.simulated(time_ns);
        for (moment, bent) in state.base_moments.iter_mut().zip(self.bent) {
            *moment = bent.unwrap_or(*moment);
        }
        state
    }

    /// The state at a time (ns), interpolated between the ends of sample periods.
    fn simulated(&mut self, time_ns: u64) -> PlantState {
        let (index, rest) = (time_ns / self.period_ns, time_ns % self.period_ns);
        let last = if rest == 0 { index } else { index + 1 };
        while self.first + (self.states.len() as u64) <= last && self.fault.is_none() {
            self.advance();
        }
        let before = self.state(index);
        if rest == 0 {
            return before;
        }
        let after = self.state(index + 1);
        let share = rest as f64 / self.period_ns as f64;
        let between = |from: f64, to: f64| from + share * (to - from);
        let mut state = before;
        for (moment, next) in state.base_moments.iter_mut().zip(after.base_moments) {
            *moment = between(*moment, next);
        }
        state.pose = Pose {
            position: Point2::new(
                between(before.pose.position.x, after.pose.position.x),
                between(before.pose.position.y, after.pose.position.y),
            ),
            heading: between(before.pose.heading, after.pose.heading),
        };
        state
    }

    fn advance(&mut self) {
        match self.plant.advance(&self.command) {
            Ok(state) => {
                if self.states.len() == CAPACITY {
                    self.states.pop_front();
                    self.first += 1;
                }
                self.states.push_back(state);
            }
            // The last state remains, and the scheduler ends the run.
            Err(fault) => self.fault = Some(fault),
        }
    }

    /// The state with this index, or the nearest one that is kept.
    fn state(&self, index: u64) -> PlantState {
        let offset = usize::try_from(index.saturating_sub(self.first)).unwrap_or(usize::MAX);
        let last = self.states.len().saturating_sub(1);
        self.states.get(offset.min(last)).copied().unwrap_or_else(|| self.plant.start())
    }
}
