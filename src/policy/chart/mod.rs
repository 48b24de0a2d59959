//! The statechart of a policy: its states and transitions with their texts, for people to look at.

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
    /// The transitions: those of any state first, then those of every state. Those of one origin are tried in this order.
    pub transitions: Vec<Transition>,
    /// The state that each state of the machine lies in, by their indices there, also of those that a [`View`] leaves out.
    pub parents: Vec<Option<usize>>,
    /// Whether a [`View`] leaves out levels of it, so that a picture should tell little of each transition.
    pub is_overview: bool,
}

impl Chart {
    /// Whether the state `inner` is the state `outer` or lies in it.
    #[must_use]
    pub fn contains(&self, outer: usize, inner: usize) -> bool {
        std::iter::successors(Some(inner), |&state| self.states[state].parent).any(|state| state == outer)
    }

    /// The states that lie in `parent`, or in none, with their indices.
    pub fn inside(&self, parent: Option<usize>) -> impl Iterator<Item = (usize, &State)> {
        self.states.iter().enumerate().filter(move |(_, state)| state.parent == parent)
    }

    /// Whether there are transitions of any state.
    #[must_use]
    pub fn has_any_state(&self) -> bool {
        self.transitions.iter().any(|transition| transition.origin == Origin::AnyState)
    }

    /// Whether a transition leads to failure.
    #[must_use]
    pub fn has_failure(&self) -> bool {
        self.transitions.iter().any(|transition| matches!(transition.target, Target::Failure(_)))
    }
}

/// A state.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct State {
    /// Its index in the machine.
    pub index: usize,
    /// Its name.
    pub name: String,
    /// What it is entered with.
    pub arguments: Vec<Argument>,
    /// Index of the state that it lies in; `None` if it lies in none.
    pub parent: Option<usize>,
    /// Whether it is entered first: at the start, or when the state that it lies in is entered.
    pub initial: bool,
    /// The values of its arguments when it is entered first.
    pub values: Vec<String>,
    /// How many states lie in it that are not shown.
    pub hidden: usize,
}

/// An argument of a state.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Argument {
    /// Its name.
    pub name: String,
    /// Its type, as written.
    pub type_name: String,
}

/// A transition. Expressions are texts of the policy, on one line and without comments.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Transition {
    /// Where it comes from.
    pub origin: Origin,
    /// As the how manyth of its origin it is tried, from 1; `None` if it is the only one, a failsafe, or shown for a state that is not.
    pub number: Option<usize>,
    /// When it is taken.
    pub guard: Guard,
    /// Where it leads.
    pub target: Target,
}

/// Where a transition comes from.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Origin {
    /// Every state: an `always` rule or the machine's failsafe.
    AnyState,
    /// The state with this index.
    State(usize),
}

/// When a transition is taken.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Guard {
    /// When a condition holds.
    When {
        /// The condition.
        condition: String,
        /// For how long it must have held.
        lasting: Option<String>,
    },
    /// When the state has been active for this time.
    After(String),
    /// When the machine cannot go on in the state: the failsafe.
    Failsafe,
}

/// Where a transition leads.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Target {
    /// Into a state.
    State {
        /// Its index.
        state: usize,
        /// Outer states that are entered with it, by their indices, with the values of their arguments.
        outer: Vec<(usize, Vec<String>)>,
        /// The values of its arguments.
        values: Vec<String>,
        /// Whether it goes on in the inner state that was active last.
        resume: bool,
    },
    /// To the end of the run, in failure, for this reason.
    Failure(String),
}
