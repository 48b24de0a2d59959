//! Ways from state to state within one tick.

use vibrissa_runtime::machine::CHAIN_LIMIT;

use super::model::{Edge, Model};
use super::reach::reachable;
use super::region::Region;
use super::search::{Goal, Search};

/// Transitions, times where they lead, that are looked at.
const STEP_LIMIT: usize = 1_000_000;
/// Cycles that are looked for.
const CYCLE_LIMIT: usize = 100;

/// A transition, and the innermost state in which it is taken.
pub(super) type Step<'a> = (usize, &'a Edge<'a>);

/// A way from state to state, and what is left of all that can be felt when it is gone.
#[derive(Clone)]
struct Way<'a> {
    path: Vec<Step<'a>>,
    goals: Vec<Goal<'a>>,
    region: Region<'a>,
}

/// Transitions that wait for nothing, among innermost states that can be reached.
struct Graph<'a> {
    /// Of every state, its transitions and where they can lead.
    steps: Vec<Vec<(&'a Edge<'a>, Vec<usize>)>>,
    /// For every state, those from which a transition can lead there.
    sources: Vec<Vec<usize>>,
    /// Transitions, times where they lead, that were looked at.
    work: usize,
}

/// Cycles of transitions that wait for nothing, among innermost states that can be reached, the shortest first. A way that
/// nothing that can be felt leads along is not gone on with: there are more ways among many states than can be looked at.
pub(super) fn walk<'a>(model: &'a Model<'_>) -> Vec<Vec<Step<'a>>> {
    let mut graph = Graph::new(model);
    let mut search = Search::new(model);
    let mut found = Vec::new();
    'walk: for start in 0..model.states.len() {
        // Each cycle begins at the first of its states, and passes none twice.
        let leads_back = graph.leading_to(start);
        // Ways that are yet to be gone on, and where they have come to.
        let whole = Way { path: Vec::new(), goals: Vec::new(), region: Region::whole(model) };
        let mut open = vec![(start, whole)];
        while let Some((state, way)) = open.pop() {
            let is_new = |target: usize| {
                leads_back[target]
                    && way.path.len() + 1 < CHAIN_LIMIT
                    && way.path.iter().all(|&(passed, _)| passed != target)
            };
            for &(edge, ref targets) in &graph.steps[state] {
                if graph.work > STEP_LIMIT || found.len() >= CYCLE_LIMIT || search.is_exhausted() {
                    break 'walk;
                }
                graph.work += 1 + targets.len();
                let mut targets = targets.iter().filter(|&&target| target == start || is_new(target)).peekable();
                if targets.peek().is_none() {
                    continue;
                }
                let mut way = way.clone();
                way.path.push((state, edge));
                way.goals.extend(goals(model, (state, edge)));
                search.bounds.work += way.goals.len();
                if !search.may_meet(&way.goals, &mut way.region) {
                    continue;
                }
                for &target in targets {
                    if target == start {
                        found.push(way.path.clone());
                    } else {
                        open.push((target, way.clone()));
                    }
                }
            }
        }
    }
    found.sort_by_key(Vec::len);
    found
}

/// What it takes for a transition to be taken in a state: its guard holds, and none that is tried before it keeps it from being
/// taken. In its own state all before it fail. In an outer one all do that would be taken, unless one comes before them that
/// holds and has led where it leads: then those written after it wait, but for a failure.
pub(super) fn goals<'a>(model: &Model<'a>, (state, edge): Step<'a>) -> Vec<Goal<'a>> {
    let mut goals: Vec<Goal<'_>> = edge.condition().map(Goal::holds).into_iter().collect();
    let before = model.tried_before(edge, state);
    for of_source in before.chunk_by(|one, next| one.from == next.from) {
        let mut have_led = Vec::new();
        for before in of_source.iter().filter(|before| before.is_immediate()) {
            let Some(condition) = before.condition() else { continue };
            let has_led = before.leads_to().is_some() && model.leads_to_one(before, state).is_none();
            if before.from != edge.from && has_led {
                have_led.push(condition);
            } else if before.leads_to().is_none() {
                goals.push(Goal::fails(condition));
            } else {
                goals.push(Goal::fails(condition).or_any_holds(have_led.iter().copied()));
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

    /// From which of the states behind `goal` it can be reached by way of those.
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
