//! Cycles in the graph of immediate transitions.

use vibrissa_runtime::machine::MICROSTEP_LIMIT;

use super::model::{Edge, Model};
use super::reachability::reachable;
use super::region::Region;
use super::search::{Goal, Search};

/// The maximum number of transitions, counted once per possible target.
const STEP_LIMIT: usize = 1_000_000;
/// The maximum number of cycles in the search.
const CYCLE_LIMIT: usize = 100;

/// A transition, and the innermost state in which it is taken.
pub(super) type Step<'a> = (usize, &'a Edge<'a>);

/// A path through states, and the region of inputs that permit it.
#[derive(Clone)]
struct PartialPath<'a> {
    path: Vec<Step<'a>>,
    goals: Vec<Goal<'a>>,
    region: Region<'a>,
}

/// The graph of immediate transitions between reachable innermost states.
struct Graph<'a> {
    /// For every state, its transitions with their possible targets.
    steps: Vec<Vec<(&'a Edge<'a>, Vec<usize>)>>,
    /// For every state, the states from which a transition leads to it.
    sources: Vec<Vec<usize>>,
    /// Number of transitions so far, counted once per possible target.
    work: usize,
}

/// The cycles of immediate transitions between reachable innermost states, the shortest first. A path is abandoned when
/// no input permits it, because there are too many paths to enumerate all.
pub(super) fn immediate_cycles<'a>(model: &'a Model<'_>) -> Vec<Vec<Step<'a>>> {
    let mut graph = Graph::new(model);
    let mut search = Search::new(model);
    let mut found = Vec::new();
    'search: for start in 0..model.states.len() {
        // Each cycle begins at the first of its states, and visits none twice.
        let leads_back = graph.leading_to(start);
        // Paths that must still be extended, with their last states.
        let whole = PartialPath { path: Vec::new(), goals: Vec::new(), region: Region::whole(model) };
        let mut open = vec![(start, whole)];
        while let Some((state, partial)) = open.pop() {
            let is_new = |target: usize| {
                leads_back[target]
                    && partial.path.len() + 1 < MICROSTEP_LIMIT
                    && partial.path.iter().all(|&(passed, _)| passed != target)
            };
            for &(edge, ref targets) in &graph.steps[state] {
                if graph.work > STEP_LIMIT || found.len() >= CYCLE_LIMIT || search.is_exhausted() {
                    break 'search;
                }
                graph.work += 1 + targets.len();
                let mut targets = targets.iter().filter(|&&target| target == start || is_new(target)).peekable();
                if targets.peek().is_none() {
                    continue;
                }
                let mut partial = partial.clone();
                partial.path.push((state, edge));
                partial.goals.extend(goals(model, (state, edge)));
                search.bounds.work += partial.goals.len();
                if !search.may_meet(&partial.goals, &mut partial.region) {
                    continue;
                }
                for &target in targets {
                    if target == start {
                        found.push(partial.path.clone());
                    } else {
                        open.push((target, partial.clone()));
                    }
                }
            }
        }
    }
    found.sort_by_key(Vec::len);
    found
}

/// The goals for a transition to be taken in a state: its guard holds, and no preceding transition prevents it.
///
/// All preceding transitions of its own state must fail. Those of outer states must fail if they would be taken. A
/// transition whose target is already active pre-empts the later ones of its state, except those that end the run.
pub(super) fn goals<'a>(model: &Model<'a>, (state, edge): Step<'a>) -> Vec<Goal<'a>> {
    let mut goals: Vec<Goal<'_>> = edge.condition().map(Goal::holds).into_iter().collect();
    let before = model.tried_before(edge, state);
    for of_source in before.chunk_by(|one, next| one.from == next.from) {
        let mut settled = Vec::new();
        for before in of_source.iter().filter(|before| before.is_immediate()) {
            let Some(condition) = before.condition() else { continue };
            let is_settled = before.leads_to().is_some() && model.leads_to_one(before, state).is_none();
            if before.from != edge.from && is_settled {
                settled.push(condition);
            } else if before.leads_to().is_none() {
                goals.push(Goal::fails(condition));
            } else {
                goals.push(Goal::fails(condition).or_any_holds(settled.iter().copied()));
            }
        }
    }
    goals
}

impl<'a> Graph<'a> {
    fn new(model: &'a Model<'_>) -> Self {
        let count = model.states.len();
        let mut graph = Self { steps: vec![Vec::new(); count], sources: vec![Vec::new(); count], work: 0 };
        let reached = reachable(model);
        for state in (0..count).filter(|&state| reached[state] && model.is_innermost(state)) {
            for edge in model.active_edges(state).into_iter().filter(|edge| edge.is_immediate()) {
                if graph.work > STEP_LIMIT {
                    return graph;
                }
                let targets = model.leads_on(edge, state);
                graph.work += 1 + targets.len();
                for &target in &targets {
                    graph.sources[target].push(state);
                }
                graph.steps[state].push((edge, targets));
            }
        }
        graph
    }

    /// For each state after `goal`, true if `goal` is reachable from it through such states.
    fn leading_to(&mut self, goal: usize) -> Vec<bool> {
        let (mut leads, mut open) = (vec![false; self.sources.len()], vec![goal]);
        while let Some(target) = open.pop() {
            self.work += self.sources[target].len();
            let new = self.sources[target].iter().filter(|&&source| source > goal);
            open.extend(new.filter(|&&source| !std::mem::replace(&mut leads[source], true)));
        }
        leads
    }
}
