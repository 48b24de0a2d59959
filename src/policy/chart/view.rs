//! A part of a chart, or a chart with fewer levels.

use vibrissa_runtime::units::suggest;

use super::{Chart, Origin, State, Target, Transition};

/// What of a chart to show.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct View<'n> {
    /// Only what lies in the state of this name, and where that leads.
    pub state: Option<&'n str>,
    /// Only states of so many levels: with 1 those that lie in no other, or directly in the state that is named.
    pub depth: Option<usize>,
}

/// A chart has no state of a name.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[error("there is no state `{name}`; {advice}")]
pub struct UnknownState {
    /// The name.
    pub name: String,
    /// Which name may be meant, or which there are.
    pub advice: String,
}

impl Chart {
    /// The part of the chart that `view` shows.
    ///
    /// A transition of a state that is not shown comes from the state around it that is, and so for its target. Those within one
    /// such state are left out, and of equal ones all but the first. Of the states outside of a named one, those are shown that
    /// its transitions lead to, each by its outermost state that does not hold the named one as well.
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
    /// The state that is shown with what lies in it; `None` for all.
    root: Option<usize>,
    /// How many levels below it are shown.
    depth: usize,
}

/// The place of a state of the whole chart among those that are shown.
type Index<'i> = &'i dyn Fn(usize) -> Option<usize>;

/// Transitions with the states of the whole chart that they are shown between: from and to.
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
            parents: self.chart.parents.clone(),
            is_overview: (0..self.chart.states.len())
                .any(|state| self.is_inside(state) && self.ancestor(state) != state),
        }
    }

    /// A state as it is shown.
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

    /// The ends between which a transition is shown, if it is: its states, or `None` for every state and for failure.
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

    /// A transition between shown states, told by their indices among them.
    fn between(&self, transition: &Transition, from: Option<usize>, to: Option<usize>, index: Index<'_>) -> Transition {
        let (origin, number) = match (transition.origin, from) {
            (Origin::State(whole), Some(from)) if self.ancestor(whole) == whole => {
                (Origin::State(from), transition.number)
            }
            // Its place among the transitions of a state that is not shown says nothing.
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
        Transition { origin, number, guard: transition.guard.clone(), target }
    }

    /// Whether a state is the root or lies in it.
    fn is_inside(&self, state: usize) -> bool {
        self.root.is_none_or(|root| self.chart.contains(root, state))
    }

    /// The state that stands for a state: itself or one around it.
    fn ancestor(&self, state: usize) -> usize {
        let around = |state: &usize| self.chart.states[*state].parent;
        let mut path: Vec<usize> = std::iter::successors(Some(state), around).collect();
        path.reverse();
        // From the outermost state inwards: what does not hold the root, or what is as deep as is shown.
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
