//! The statechart of a policy: states and transitions with their texts, for drawing.

mod build;
mod view;

pub(super) use build::build;
pub use view::{UnknownState, View};

/// States and the transitions between them, in the order of the policy.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Chart {
    /// The machine's name.
    pub machine: String,
    /// The states.
    pub states: Vec<State>,
    /// The transitions: global ones first, then those of every state. Those of one origin are tried in this order.
    pub transitions: Vec<Transition>,
    /// The contracts of the machine, as in the text.
    pub contracts: Vec<String>,
    /// For each state of the machine, the index of the state that contains it. It includes the states that a [`View`]
    /// omits.
    pub parents: Vec<Option<usize>>,
    /// True if a [`View`] omits levels, so that drawings should shorten the labels.
    pub is_overview: bool,
}

impl Chart {
    /// True if the state `inner` is the state `outer` or inside it.
    #[must_use]
    pub fn contains(&self, outer: usize, inner: usize) -> bool {
        std::iter::successors(Some(inner), |&state| self.states[state].parent).any(|state| state == outer)
    }

    /// The direct inner states of `parent` with their indices, or the outermost states.
    pub fn inside(&self, parent: Option<usize>) -> impl Iterator<Item = (usize, &State)> {
        self.states.iter().enumerate().filter(move |(_, state)| state.parent == parent)
    }

    /// True if there are global transitions, or contracts of the machine.
    #[must_use]
    pub fn has_any_state(&self) -> bool {
        !self.contracts.is_empty() || self.transitions.iter().any(|transition| transition.origin == Origin::AnyState)
    }

    /// True if a transition leads to failure.
    #[must_use]
    pub fn has_failure(&self) -> bool {
        self.transitions.iter().any(|transition| matches!(transition.target, Target::Failure(_)))
    }

    /// The exits of behaviours that are drawn by themselves: the names of the behaviour and of the exit, each once.
    #[must_use]
    pub fn ends(&self) -> Vec<(&str, &str)> {
        let mut ends = Vec::new();
        for transition in &self.transitions {
            if let Target::Exit { behaviour, name, .. } = &transition.target
                && !ends.contains(&(behaviour.as_str(), name.as_str()))
            {
                ends.push((behaviour, name));
            }
        }
        ends
    }

    /// True if a transition leads to success.
    #[must_use]
    pub fn has_success(&self) -> bool {
        self.transitions.iter().any(|transition| matches!(transition.target, Target::Success(_)))
    }
}

/// A state.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct State {
    /// Its index in the machine.
    pub index: usize,
    /// Its name.
    pub name: String,
    /// The arguments.
    pub arguments: Vec<Argument>,
    /// The behaviour that is its content, with the values of the arguments: `follow(w, 50 mm/s)`.
    pub behaviour: Option<String>,
    /// Index of the state that contains it. `None` for an outermost state.
    pub parent: Option<usize>,
    /// True if it is the initial state of the machine or of the state that contains it.
    pub initial: bool,
    /// Its contracts, then those of its behaviour, as in the text.
    pub contracts: Vec<String>,
    /// The values of its arguments as an initial state.
    pub values: Vec<String>,
    /// Number of inner states that are not shown.
    pub hidden: usize,
}

/// An argument of a state.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Argument {
    /// Its name.
    pub name: String,
    /// The type with the default, as in the text.
    pub type_name: String,
}

/// A transition. Expressions are texts of the policy, on one line and without comments.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Transition {
    /// The origin.
    pub origin: Origin,
    /// The position in the order of the transitions of its origin, from 1. `None` if it is the only one, a fallback
    /// transition, or drawn for a hidden state.
    pub number: Option<usize>,
    /// The guard.
    pub guard: Guard,
    /// The exits of behaviours through which it leads to the target, from the innermost to the outermost.
    pub exits: Vec<Exit>,
    /// The target.
    pub target: Target,
}

/// An exit of a behaviour that a state uses.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Exit {
    /// Index of the state that uses the behaviour.
    pub state: usize,
    /// The name of the exit.
    pub name: String,
    /// The values of the exit.
    pub values: Vec<String>,
}

/// The origin of a transition.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Origin {
    /// Every state: a global transition, or the machine's fallback transition.
    AnyState,
    /// The state with this index.
    State(usize),
}

/// The guard of a transition.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Guard {
    /// The condition holds.
    When {
        /// The condition.
        condition: String,
        /// The time for which the condition must have held.
        lasting: Option<String>,
    },
    /// The state has been active for this time.
    After(String),
    /// The machine cannot continue in the state (fallback transition).
    Failsafe,
    /// The behaviour of the state ends by this exit. Its inner states are not shown.
    Exit(String),
}

/// The target of a transition.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Target {
    /// A state.
    State {
        /// Its index.
        state: usize,
        /// Outer states that are entered with it, by their indices, with the values of their arguments.
        outer: Vec<(usize, Vec<String>)>,
        /// The values of the arguments.
        values: Vec<String>,
        /// True if it enters the inner state that was active last (history).
        resume: bool,
    },
    /// The end of the run as a failure, with this reason.
    Failure(String),
    /// The end of the run as a success, with this reason.
    Success(String),
    /// An exit of a behaviour that is drawn by itself.
    Exit {
        /// The name of the behaviour.
        behaviour: String,
        /// The name of the exit.
        name: String,
        /// The values of the exit.
        values: Vec<String>,
    },
}
