//! Near misses: how closely transitions that were not taken came to being taken.

use std::collections::BTreeMap;
use std::ops::ControlFlow;

use serde::Serialize;
use vibrissa_runtime::machine::{Observer, TIME_SLACK, Target, TransitionId, TriedGuard};
use vibrissa_runtime::units::{Dimension, format_si};

use super::breakpoint::Breakpoints;
use super::records::Margin;
use crate::results::Document;
use crate::run::{Trace, Watcher};

/// The closest that a transition came to being taken, while its state was active and was not left by it.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct NearMiss {
    /// Name of the policy.
    pub policy: String,
    /// The state to which the transition belongs. `None` for a global transition.
    pub state: Option<String>,
    /// The guard, as in the policy.
    pub guard: String,
    /// The file that contains it. `None` for the policy itself.
    pub file: Option<String>,
    /// Its line in that file.
    pub line: usize,
    /// The target.
    pub target: String,
    /// The only part of the guard that was missing, or `for` if only time was missing.
    pub part: String,
    /// What was missing.
    pub margin: Margin,
    /// Ratio of the margin to the largest one that was seen. It compares margins in different units.
    pub share: f64,
    /// Name of the scenario of the run.
    pub scenario: String,
    /// Number of the run, from 0.
    pub run: usize,
    /// Time since the start of the run.
    pub time_s: f64,
}

impl Document for NearMiss {
    const FORMAT: &'static str = "near-miss";
}

/// A transition, and the text of the part of its guard that was missing.
type Key = (TransitionId, String);

/// The smallest margin of a key until now.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Smallest {
    margin: f64,
    dimension: Dimension,
    run: usize,
    tick: usize,
    time: f64,
}

/// Collects the near misses of the runs of a policy.
#[derive(Debug)]
pub struct NearMisses<'b> {
    policy: &'b Breakpoints,
    /// Those of the states that are active. They count once the state is left by another transition.
    pending: BTreeMap<Key, Smallest>,
    found: BTreeMap<Key, Smallest>,
    /// The largest margin of each key.
    largest: BTreeMap<Key, f64>,
    /// The names of the scenarios of the runs.
    scenarios: BTreeMap<usize, String>,
    run: usize,
    tick: usize,
    /// The time of the last tick.
    time: f64,
}

impl<'b> NearMisses<'b> {
    /// No near misses of a policy, before its run with this number in the scenario with this name.
    #[must_use]
    pub fn new(policy: &'b Breakpoints, run: usize, scenario: &str) -> Self {
        Self {
            policy,
            pending: BTreeMap::new(),
            found: BTreeMap::new(),
            largest: BTreeMap::new(),
            scenarios: BTreeMap::from([(run, scenario.to_owned())]),
            run,
            tick: 0,
            time: 0.0,
        }
    }

    /// Ends the run: no state is left any more.
    pub fn end_run(&mut self) {
        for (key, smallest) in std::mem::take(&mut self.pending) {
            keep(&mut self.found, key, smallest);
        }
    }

    /// Adds those of other runs of the same policy.
    pub fn add(&mut self, other: Self) {
        for (key, smallest) in other.found {
            keep(&mut self.found, key, smallest);
        }
        for (key, margin) in other.largest {
            let largest = self.largest.entry(key).or_default();
            *largest = largest.max(margin);
        }
        self.scenarios.extend(other.scenarios);
    }

    /// The near misses, the closest one first.
    #[must_use]
    pub fn list(&self) -> Vec<NearMiss> {
        let explained = &self.policy.explained;
        let miss = |(key, smallest): (&Key, &Smallest)| {
            let (id, part) = key;
            let transition = explained.transition(*id)?;
            let largest = self.largest.get(key).copied().unwrap_or_default();
            Some(NearMiss {
                policy: explained.program.name.clone(),
                state: id
                    .state
                    .and_then(|state| explained.program.states.get(state))
                    .map(|state| state.name.to_string()),
                guard: transition.text.clone(),
                file: transition.file.clone(),
                line: transition.position.line,
                target: transition.target.clone(),
                part: part.clone(),
                margin: Margin {
                    value: smallest.margin,
                    unit: smallest.dimension.si_unit(),
                    text: format_si(smallest.margin, smallest.dimension),
                },
                share: if largest > 0.0 { smallest.margin / largest } else { 0.0 },
                scenario: self.scenarios.get(&smallest.run).cloned().unwrap_or_default(),
                run: smallest.run,
                time_s: smallest.time,
            })
        };
        let mut all: Vec<NearMiss> = self.found.iter().filter_map(miss).collect();
        all.sort_by(|a, b| a.share.total_cmp(&b.share));
        all
    }

    fn see(&mut self, id: TransitionId, part: &str, margin: f64, dimension: Dimension) {
        // A margin of zero is that of a number with few values, such as a count. Without one, an earlier transition was taken.
        if !(margin > TIME_SLACK && margin.is_finite()) {
            return;
        }
        let key = (id, part.to_owned());
        let largest = self.largest.entry(key.clone()).or_default();
        *largest = largest.max(margin);
        // The time of the tick is known at its end.
        let smallest = Smallest { margin, dimension, run: self.run, tick: self.tick, time: self.time };
        keep(&mut self.pending, key, smallest);
    }
}

/// Keeps the smaller one of two margins.
fn keep(all: &mut BTreeMap<Key, Smallest>, key: Key, smallest: Smallest) {
    let kept = all.entry(key).or_insert(smallest);
    if smallest.margin < kept.margin {
        *kept = smallest;
    }
}

impl Observer for NearMisses<'_> {
    fn guard(&mut self, tried: &TriedGuard<'_>) {
        let (id, standing) = (tried.transition, tried.standing);
        let policy = self.policy;
        let Some(transition) = policy.explained.transition(id) else { return };
        if standing.is_met {
            if let Some(duration) = standing.duration {
                self.see(id, "for", duration.needed - duration.elapsed, Dimension::TIME);
            }
            return;
        }
        let missing = transition.condition.as_ref().map(|condition| condition.missing(tried.registers));
        if let Some([only]) = missing.as_deref()
            && let Some((margin, dimension)) = only.margin
        {
            self.see(id, &only.leaf.text, margin.abs(), dimension);
        }
    }

    fn taken(&mut self, id: TransitionId) {
        let program = &self.policy.explained.program;
        let transitions =
            id.state.map_or(Some(&program.always), |state| program.states.get(state).map(|s| &s.transitions));
        let target = transitions.and_then(|all| all.get(id.index)).and_then(|transition| match transition.target {
            Target::State { state, .. } => Some(state),
            Target::Success(_) | Target::Failure(_) => None,
        });
        let is_left = |state: usize| target.is_none_or(|target| state == target || !program.contains(state, target));
        let pending = std::mem::take(&mut self.pending);
        for (key, smallest) in pending {
            let (transition, _) = &key;
            if *transition == id {
                continue;
            }
            if transition.state.is_some_and(is_left) {
                keep(&mut self.found, key, smallest);
            } else {
                self.pending.insert(key, smallest);
            }
        }
    }
}

impl Watcher for NearMisses<'_> {
    fn after_tick(&mut self, trace: &Trace) -> ControlFlow<()> {
        self.time = trace.ticks.last().map_or(self.time, |tick| tick.time);
        let (tick, time) = (self.tick, self.time);
        let of_tick = self.pending.values_mut().chain(self.found.values_mut()).filter(|smallest| smallest.tick == tick);
        for smallest in of_tick {
            smallest.time = time;
        }
        self.tick += 1;
        ControlFlow::Continue(())
    }
}
