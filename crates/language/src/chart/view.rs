//! Views: parts of a chart, or a chart with fewer levels.

use vibrissa_runtime::units::suggest;

use super::{Chart, Exit, Guard, Origin, State, Target, Transition};

/// The visible part of a chart.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct View<'n> {
    /// The state whose inner states and targets are shown. All states if `None`.
    pub state: Option<&'n str>,
    /// The number of visible levels. 1 shows only the outermost states, or the direct inner states of `state`.
    pub depth: Option<usize>,
}

/// The error for a chart without a state of this name.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[error("there is no state `{name}`; {advice}")]
pub struct UnknownState {
    /// The name.
    pub name: String,
    /// A similar name, or the list of names.
    pub advice: String,
}

impl Chart {
    /// The part of the chart that `view` shows.
    ///
    /// A transition of a hidden state is shown at the nearest visible ancestor, and its target likewise. Transitions
    /// within one such ancestor are omitted, and so are duplicates. With a named state, its targets outside are shown,
    /// too. Each is represented by its outermost ancestor that does not contain the named state.
    ///
    /// # Errors
    /// [`UnknownState`] if the chart has no state of that name.
    pub fn view(&self, view: View<'_>) -> Result<Self, UnknownState> {
        let root = view.state.map(|name| self.find(name)).transpose()?;
        let selection = Selection { chart: self, root, depth: view.depth.unwrap_or(usize::MAX) };
        Ok(selection.chart())
    }

    fn find(&self, name: &str) -> Result<usize, UnknownState> {
        let names = || self.states.iter().map(|state| state.name.as_str());
        names().position(|known| known == name).ok_or_else(|| {
            let advice = suggest(name, names()).map_or_else(
                || format!("there are {}", names().collect::<Vec<_>>().join(", ")),
                |near| format!("do you mean `{near}`?"),
            );
            UnknownState { name: name.to_owned(), advice }
        })
    }
}

struct Selection<'c> {
    chart: &'c Chart,
    /// The state whose content is shown. `None` for all states.
    root: Option<usize>,
    /// The number of visible levels below the root.
    depth: usize,
}

/// Maps a state of the whole chart to its index among the visible ones.
type Index<'i> = &'i dyn Fn(usize) -> Option<usize>;

/// Transitions with the visible states of the whole chart between which they are drawn: from and to.
type Shown<'c> = Vec<(&'c Transition, Option<usize>, Option<usize>)>;

impl Selection<'_> {
    fn chart(&self) -> Chart {
        let shown: Shown<'_> = self.chart.transitions.iter().filter_map(|transition| self.shown(transition)).collect();
        let is_shown = |&state: &usize| {
            if self.is_inside(state) {
                self.ancestor(state) == state
            } else {
                shown.iter().any(|(.., to)| *to == Some(state))
            }
        };
        let kept: Vec<usize> = (0..self.chart.states.len()).filter(is_shown).collect();
        let index = |state: usize| kept.binary_search(&state).ok();
        let mut transitions: Vec<Transition> = Vec::with_capacity(shown.len());
        for (transition, from, to) in shown {
            let transition = self.between(transition, from.and_then(index), to.and_then(index), &index);
            if !transitions.contains(&transition) {
                transitions.push(transition);
            }
        }
        let machine = &self.chart.machine;
        Chart {
            machine: self.root.map_or(machine.clone(), |root| format!("{machine}: {}", self.chart.states[root].name)),
            states: kept.iter().map(|&state| self.state(state, &index)).collect(),
            transitions,
            contracts: if self.root.is_none() { self.chart.contracts.clone() } else { Vec::new() },
            parents: self.chart.parents.clone(),
            is_overview: (0..self.chart.states.len())
                .any(|state| self.is_inside(state) && self.ancestor(state) != state),
        }
    }

    /// A visible state.
    fn state(&self, state: usize, index: Index<'_>) -> State {
        let whole = &self.chart.states[state];
        let is_whole = self.root.is_none_or(|root| root != state && self.is_inside(state));
        let holds = |inner: &usize| *inner != state && self.chart.contains(state, *inner);
        let hidden = (0..self.chart.states.len()).filter(holds).filter(|&inner| index(inner).is_none()).count();
        State {
            parent: whole.parent.filter(|_| is_whole).and_then(index),
            initial: whole.initial && is_whole,
            hidden: whole.hidden + hidden,
            ..whole.clone()
        }
    }

    /// The visible ends of a transition, if it is visible. An end is a state, or `None` for every state or for the end of the run.
    fn shown<'t>(&self, transition: &'t Transition) -> Option<(&'t Transition, Option<usize>, Option<usize>)> {
        let from = match transition.origin {
            Origin::AnyState if self.root.is_some() => return None,
            Origin::AnyState => None,
            Origin::State(state) if !self.is_inside(state) => return None,
            Origin::State(state) => Some(self.ancestor(state)),
        };
        let Target::State { state: target, .. } = transition.target else { return Some((transition, from, None)) };
        let to = self.ancestor(target);
        let is_within = from == Some(to) && to != target;
        (!is_within).then_some((transition, from, Some(to)))
    }

    /// A transition between visible states, given by their indices in the view.
    fn between(&self, transition: &Transition, from: Option<usize>, to: Option<usize>, index: Index<'_>) -> Transition {
        let (origin, number) = match (transition.origin, from) {
            (Origin::State(whole), Some(from)) if self.ancestor(whole) == whole => {
                (Origin::State(from), transition.number)
            }
            // Its number among the transitions of a hidden state has no meaning in the view.
            (Origin::State(_), Some(from)) => (Origin::State(from), None),
            _ => (Origin::AnyState, transition.number),
        };
        let target = match (&transition.target, to) {
            (Target::State { state, outer, values, resume }, Some(to)) => {
                let shown = self.ancestor(*state);
                let given = outer.iter().find(|(outer, _)| *outer == shown).map(|(_, values)| values.clone());
                let around = outer.iter().filter(|(outer, _)| *outer != shown);
                Target::State {
                    state: to,
                    outer: around.filter_map(|(outer, values)| Some((index(*outer)?, values.clone()))).collect(),
                    values: if shown == *state { values.clone() } else { given.unwrap_or_default() },
                    resume: *resume,
                }
            }
            (target, _) => target.clone(),
        };
        // The exits of a behaviour whose content is not shown.
        let is_closed = |state: usize| {
            (0..self.chart.states.len()).any(|inner| self.chart.contains(state, inner) && index(inner).is_none())
        };
        let of_origin = |exit: &&Exit| from.is_some() && from == index(exit.state) && is_closed(exit.state);
        let guard = match transition.exits.iter().find(of_origin) {
            Some(exit) => Guard::Exit(exit.name.clone()),
            None => transition.guard.clone(),
        };
        let exits = transition.exits.iter().filter(|exit| !of_origin(exit));
        let exits = exits.filter_map(|exit| Some(Exit { state: index(exit.state)?, ..exit.clone() }));
        Transition { origin, number, guard, exits: exits.collect(), target }
    }

    /// True if a state is the root or inside it.
    fn is_inside(&self, state: usize) -> bool {
        self.root.is_none_or(|root| self.chart.contains(root, state))
    }

    /// The visible state that represents a state: itself or an ancestor.
    fn ancestor(&self, state: usize) -> usize {
        let around = |state: &usize| self.chart.states[*state].parent;
        let mut path: Vec<usize> = std::iter::successors(Some(state), around).collect();
        path.reverse();
        // From the outermost state inwards: the first that does not contain the root, or the deepest visible level.
        let root = self.root.and_then(|root| path.iter().position(|&outer| outer == root));
        let last = match (self.root, root) {
            (None, _) => self.depth.saturating_sub(1),
            (Some(_), Some(root)) => root.saturating_add(self.depth),
            (Some(root), None) => {
                path.iter().position(|&outer| !self.chart.contains(outer, root)).unwrap_or(path.len() - 1)
            }
        };
        path[last.min(path.len() - 1)]
    }
}
