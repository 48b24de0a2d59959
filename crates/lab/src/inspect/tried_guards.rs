//! The guards that a machine tries in a tick.

use vibrissa_runtime::machine::{Observer, Standing, TransitionId, TriedGuard};

/// The guards and the transitions of a tick. It observes the machine.
#[derive(Debug, Clone, Default)]
pub struct TriedGuards {
    /// The guards that were tried after the last transition, in the order in which they were tried.
    pub tried: Vec<(TransitionId, Standing)>,
    /// The registers after the evaluation of these guards.
    pub registers: Vec<f64>,
    /// The transitions that were taken.
    pub taken: Vec<TransitionId>,
}

impl TriedGuards {
    /// Begins the next tick.
    pub fn begin_tick(&mut self) {
        self.tried.clear();
        self.taken.clear();
    }
}

impl Observer for TriedGuards {
    fn guard(&mut self, tried: &TriedGuard<'_>) {
        self.tried.push((tried.transition, tried.standing));
        // All guards of a state are evaluated before the first of them is reported.
        if tried.transition.index == 0 {
            self.registers.clear();
            self.registers.extend_from_slice(tried.registers);
        }
    }

    fn taken(&mut self, transition: TransitionId) {
        self.taken.push(transition);
        self.tried.clear();
    }
}
