//! The interface to watch a machine from outside while it executes a tick.

use super::contract::Contract;

/// Receives the guards that a machine tries and the transitions that it takes, in this order.
///
/// An observer changes nothing. `()` observes nothing, at no cost.
pub trait Observer {
    /// A guard was evaluated.
    fn guard(&mut self, tried: &TriedGuard<'_>) {
        let _ = tried;
    }

    /// A transition is taken. Its guard was evaluated before.
    fn taken(&mut self, transition: TransitionId) {
        let _ = transition;
    }

    /// A contract was violated.
    fn violated(&mut self, violated: &ViolatedContract<'_>) {
        let _ = violated;
    }

    /// A command with a number that is not finite was given in the state with this index. `registers` are those after the
    /// statements.
    fn not_finite(&mut self, state: usize, registers: &[f64]) {
        let _ = (state, registers);
    }
}

impl Observer for () {}

/// Passes everything on to an observer, if there is one.
impl<O: Observer> Observer for Option<O> {
    fn guard(&mut self, tried: &TriedGuard<'_>) {
        if let Some(observer) = self {
            observer.guard(tried);
        }
    }

    fn taken(&mut self, transition: TransitionId) {
        if let Some(observer) = self {
            observer.taken(transition);
        }
    }

    fn violated(&mut self, violated: &ViolatedContract<'_>) {
        if let Some(observer) = self {
            observer.violated(violated);
        }
    }

    fn not_finite(&mut self, state: usize, registers: &[f64]) {
        if let Some(observer) = self {
            observer.not_finite(state, registers);
        }
    }
}

/// Passes everything on to the first observer, and then to the second one.
impl<A: Observer, B: Observer> Observer for (A, B) {
    fn guard(&mut self, tried: &TriedGuard<'_>) {
        self.0.guard(tried);
        self.1.guard(tried);
    }

    fn taken(&mut self, transition: TransitionId) {
        self.0.taken(transition);
        self.1.taken(transition);
    }

    fn violated(&mut self, violated: &ViolatedContract<'_>) {
        self.0.violated(violated);
        self.1.violated(violated);
    }

    fn not_finite(&mut self, state: usize, registers: &[f64]) {
        self.0.not_finite(state, registers);
        self.1.not_finite(state, registers);
    }
}

/// Identifies a transition of a program.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct TransitionId {
    /// Index of the state to which it belongs. `None` for a global transition.
    pub state: Option<usize>,
    /// Index among the transitions of that state, or among the global ones.
    pub index: usize,
}

/// A guard with the result of its evaluation.
#[derive(Debug, Clone, Copy)]
pub struct TriedGuard<'a> {
    /// The transition of the guard.
    pub transition: TransitionId,
    /// The result.
    pub standing: Standing,
    /// All registers after the evaluation. In a program that is not optimised, they include the operands of the
    /// guard's comparisons.
    pub registers: &'a [f64],
}

/// Identifies a contract of a program.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct ContractId {
    /// Index of the state to which it belongs. `None` for a contract of the whole machine.
    pub state: Option<usize>,
    /// Index among the contracts of that state, or among those of the machine.
    pub index: usize,
}

/// A contract that is violated in this tick.
#[derive(Debug, Clone, Copy)]
pub struct ViolatedContract<'a> {
    /// Identifies the contract.
    pub id: ContractId,
    /// The contract.
    pub contract: &'a Contract,
    /// True if the previous evaluation found no violation.
    pub is_new: bool,
    /// All registers after the evaluation.
    pub registers: &'a [f64],
}

/// The result of the evaluation of a guard.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Standing {
    /// True if the condition holds. A guard `after` has none, and this is true.
    pub is_met: bool,
    /// For a guard with a time, that time.
    pub duration: Option<Duration>,
}

/// A time that has to elapse before a guard is enabled.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Duration {
    /// Time (s) since the condition holds, or since the state was entered. 0 if the condition does not hold.
    pub elapsed: f64,
    /// Time (s) that is needed.
    pub needed: f64,
}

impl Standing {
    /// True if the transition can be taken.
    #[must_use]
    pub fn is_enabled(&self) -> bool {
        self.is_met && self.duration.is_none_or(|time| time.elapsed >= time.needed - super::TIME_SLACK)
    }
}
