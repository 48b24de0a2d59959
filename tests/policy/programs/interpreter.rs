//! Machines, interpreted as docs/language-semantics.md explains them.

use std::collections::{BTreeMap, BTreeSet, HashMap};
use std::sync::Arc;

use vibrissa_runtime::machine::{Action, ActionPart, Cause, Failure, NonFinite, Senses, Turn};

use super::evaluate::{Place, Value};
use super::filter::Filter;
use super::signal::Signal;
use super::tree::{Contract, Guard, Monitor, Program, Rule, Target};
use crate::common::Script;

/// What a tick gave.
#[derive(Debug, Default, PartialEq)]
pub(crate) struct Done {
    pub(crate) action: Option<Action>,
    pub(crate) state: String,
    pub(crate) end: Option<End>,
    pub(crate) failsafe: Option<(String, Cause)>,
    /// The violated contracts, in the order in which they are looked at: their states and texts.
    pub(crate) violated: Vec<(String, String)>,
    /// The plots that were set, with their values.
    pub(crate) plotted: BTreeMap<String, String>,
    /// The messages in their order, with their values.
    pub(crate) logged: Vec<(String, String)>,
}

/// A state, and the uses of laws and derived values in it that lead to a statement.
pub(crate) type Use = (Option<usize>, Vec<usize>);

/// How a machine ended its run.
#[derive(Debug, Clone, PartialEq)]
pub(crate) enum End {
    Failure(Failure),
    Success(String),
}

pub(crate) struct Interpreter<'p> {
    pub(crate) program: &'p Program,
    pub(crate) senses: Script,
    /// What every state was entered with last, and its memory.
    pub(crate) kept: Vec<HashMap<String, Value>>,
    /// The machine's own memory.
    pub(crate) own: HashMap<String, Value>,
    /// By the state in which it stands and the uses that lead to it.
    pub(crate) filters: HashMap<(Option<usize>, Vec<usize>), Filter>,
    /// The same for what remembers a signal.
    pub(crate) signals: HashMap<(Option<usize>, Vec<usize>), Signal>,
    /// From the outermost to the innermost.
    active: Vec<usize>,
    pub(crate) entered_at: Vec<f64>,
    /// Of a rule, since when its condition has held.
    since: HashMap<(Option<usize>, usize), f64>,
    /// For every state, the one in it that was active last.
    last: HashMap<usize, usize>,
    end: Option<End>,
    /// The contracts that this tick has violated.
    violated: Vec<(String, String)>,
    /// The plots that this tick has set.
    pub(crate) plotted: BTreeMap<String, String>,
    /// The messages of this tick: the state and the uses that lead to them, their texts and values.
    pub(crate) logged: Vec<(Use, String, String)>,
    /// Of a contract, since when it has not been as it should.
    failing_since: HashMap<(Option<usize>, usize), f64>,
    /// What was executed, and as part of what.
    pub(crate) executed: BTreeSet<(&'static str, &'static str)>,
}

/// Times are compared so that ten ticks of a thirtieth of a second make a third.
const SLACK: f64 = 1e-9;

impl<'p> Interpreter<'p> {
    pub(crate) fn new(program: &'p Program, senses: Script) -> Self {
        Self {
            program,
            senses,
            kept: vec![HashMap::new(); program.states.len()],
            own: HashMap::new(),
            filters: HashMap::new(),
            signals: HashMap::new(),
            active: Vec::new(),
            entered_at: vec![0.0; program.states.len()],
            since: HashMap::new(),
            last: HashMap::new(),
            end: None,
            violated: Vec::new(),
            plotted: BTreeMap::new(),
            logged: Vec::new(),
            failing_since: HashMap::new(),
            executed: BTreeSet::new(),
        }
    }

    /// Notes that something was executed, if it was as part of something.
    pub(crate) fn seen(&mut self, what: &'static str, part: Option<&'static str>) {
        self.executed.extend(part.map(|part| (what, part)));
    }

    pub(crate) fn tick(&mut self) -> Done {
        let mut failsafe = None;
        self.violated.clear();
        self.plotted.clear();
        self.logged.clear();
        let action = match &self.end {
            Some(_) => Action::Stop,
            None => self.try_tick(&mut failsafe).unwrap_or_else(|end| {
                self.end = Some(end);
                Action::Stop
            }),
        };
        let state = match &self.end {
            None => name(self.innermost()),
            Some(End::Failure(_)) => "Failure".to_owned(),
            Some(End::Success(_)) => "Success".to_owned(),
        };
        Done {
            action: Some(action),
            state,
            end: self.end.clone(),
            failsafe,
            violated: self.violated.clone(),
            plotted: self.plotted.clone(),
            logged: self.logged.iter().map(|(_, text, values)| (text.clone(), values.clone())).collect(),
        }
    }

    fn innermost(&self) -> usize {
        *self.active.last().unwrap()
    }

    fn try_tick(&mut self, failsafe: &mut Option<(String, Cause)>) -> Result<Action, End> {
        if self.active.is_empty() {
            for Monitor { arguments, values, memory, .. } in &self.program.monitors {
                let values = self.values(values, &mut Place::of_monitor(true, &Vec::new(), Vec::new()));
                let mut place = Place::of_monitor(true, arguments, values);
                for (name, _, value) in memory {
                    let value = self.value(value, &mut place);
                    self.own.insert(name.clone(), value);
                }
            }
            for (name, _, value) in &self.program.memory {
                let value = self.value(value, &mut Place::new(None, "a memory"));
                self.own.insert(name.clone(), value);
            }
        }
        for Monitor { arguments, values, body, .. } in &self.program.monitors {
            let values = self.values(values, &mut Place::of_monitor(false, &Vec::new(), Vec::new()));
            self.run(body, &mut Place::of_monitor(false, arguments, values));
        }
        if self.active.is_empty() {
            self.look_at(None, true);
            self.enter(0, false);
        }
        let mut due = self.due(None);
        for taken in 0.. {
            let active = self.active.clone();
            due = due.or_else(|| active.iter().find_map(|&state| self.due(Some(state))));
            let Some((from, target)) = due.take() else { break };
            if taken == 8 && matches!(target, Target::State { .. }) {
                return self.leave(self.innermost(), Cause::MicrostepLimit, failsafe);
            }
            self.seen("a chain", (taken == 1).then_some("a tick"));
            self.seen("a transition", Some(if from.is_some() { "a state" } else { "the machine" }));
            self.take(from, target)?;
        }
        self.look_at(None, false);
        for state in self.active.clone() {
            self.look_at(Some(state), false);
        }
        self.run_own();
        match self.act(0) {
            Err((stuck, flaw)) => self.leave(stuck, Cause::NotFinite(flaw), failsafe),
            Ok(action) => Ok(action.unwrap_or(Action::Hold)),
        }
    }

    /// The target of the first rule that holds, of a state or of the machine. One that leads where the machine is already has what
    /// it wants, and those behind it wait, but for one that ends the run.
    fn due(&mut self, from: Option<usize>) -> Option<(Option<usize>, &'p Target)> {
        let program = self.program;
        let rules = from.map_or(&program.always, |state| &program.states[state].rules);
        // All conditions are computed, so that what they remember knows of every tick.
        let holding: Vec<&Rule> = rules
            .iter()
            .enumerate()
            .filter(|(index, rule)| self.holds(from, *index, &rule.guard))
            .map(|(_, rule)| rule)
            .collect();
        let first = &holding.first()?.target;
        let is_there = match first {
            Target::Failure(_) | Target::Success(_) => false,
            Target::State { way, .. } => {
                let target = way.last().unwrap().0;
                let is_within = from.is_none_or(|from| from != target && program.way(target).contains(&from));
                is_within && self.active.contains(&target)
            }
        };
        self.seen("what is there already", is_there.then_some("a guard"));
        let end = holding.iter().map(|rule| &rule.target).find(|target| !matches!(target, Target::State { .. }));
        if is_there { end } else { Some(first) }.map(|target| (from, target))
    }

    fn holds(&mut self, from: Option<usize>, index: usize, guard: &Guard) -> bool {
        let mut place = Place::new(from, "a guard");
        let now = self.senses.time();
        match guard {
            Guard::When(condition) => {
                self.seen("when", Some("a guard"));
                self.value(condition, &mut place).truth()
            }
            Guard::WhenFor(condition, time) => {
                self.seen("for", Some("a guard"));
                let holds = self.value(condition, &mut place).truth();
                let time = self.value(time, &mut place).number();
                if !holds {
                    self.since.remove(&(from, index));
                    return false;
                }
                let since = *self.since.entry((from, index)).or_insert(now);
                now - since >= time - SLACK
            }
            Guard::After(time) => {
                self.seen("after", Some("a guard"));
                let time = self.value(time, &mut place).number();
                now - self.entered_at[from.unwrap()] >= time - SLACK
            }
        }
    }

    fn take(&mut self, from: Option<usize>, target: &Target) -> Result<(), End> {
        let (way, resume) = match target {
            Target::Failure(reason) => {
                self.seen("a failure", Some("a target"));
                return Err(End::Failure(Failure::Policy(Arc::from(reason.as_str()))));
            }
            Target::Success(reason) => {
                self.seen("a success", Some("a target"));
                return Err(End::Success(reason.clone()));
            }
            Target::State { way, resume } => (way, *resume),
        };
        let stays = self.program.states[way[0].0].parent;
        while self.active.last().copied() != stays {
            let left = self.active.pop().unwrap();
            self.run(&self.program.states[left].exit, &mut Place::new(Some(left), "an exit"));
        }
        let mut place = Place::new(from, "a target");
        let values: Vec<Vec<Value>> = way.iter().map(|(_, values)| self.values(values, &mut place)).collect();
        for ((state, _), values) in way.iter().zip(values) {
            self.hand_over(*state, values);
        }
        let (last, outer) = way.split_last().unwrap();
        for (state, _) in outer {
            self.enter_alone(*state);
        }
        self.enter(last.0, resume);
        Ok(())
    }

    fn hand_over(&mut self, state: usize, values: Vec<Value>) {
        self.seen("arguments", (!values.is_empty()).then_some("a target"));
        let names = self.program.states[state].arguments.iter().map(|(name, _)| name.clone());
        self.kept[state].extend(names.zip(values));
    }

    /// Enters a state, and in it the one that it begins in, or was in last.
    fn enter(&mut self, state: usize, resume: bool) {
        self.enter_alone(state);
        let last = if resume { self.last.get(&state).copied() } else { None };
        match (&self.program.states[state].initial, last) {
            (None, _) => {}
            (Some(_), Some(last)) => {
                self.seen("resume", Some("a target"));
                self.enter(last, true);
            }
            (Some((initial, values)), None) => {
                let values = self.values(values, &mut Place::new(Some(state), "an initial"));
                self.hand_over(*initial, values);
                self.enter(*initial, resume);
            }
        }
    }

    fn enter_alone(&mut self, state: usize) {
        if let Some(&outer) = self.active.last() {
            self.last.insert(outer, state);
        }
        self.active.push(state);
        self.entered_at[state] = self.senses.time();
        self.since.retain(|(of, _), _| *of != Some(state));
        self.filters.retain(|(of, _), _| *of != Some(state));
        self.signals.retain(|(of, _), _| *of != Some(state));
        for (name, _, value) in &self.program.states[state].memory {
            let value = self.value(value, &mut Place::new(Some(state), "a memory"));
            self.kept[state].insert(name.clone(), value);
        }
        self.run(&self.program.states[state].entry, &mut Place::new(Some(state), "an entry"));
        self.failing_since.retain(|(of, _), _| *of != Some(state));
        self.look_at(Some(state), true);
    }

    /// Looks at the contracts of a state or of the machine: at what they assume when it is entered, or else at the others.
    fn look_at(&mut self, of: Option<usize>, is_entered: bool) {
        let program = self.program;
        let contracts = of.map_or(&program.contracts, |state| &program.states[state].contracts);
        let now = self.senses.time();
        for (index, contract) in contracts.iter().enumerate() {
            if matches!(contract, Contract::Assume(_)) != is_entered {
                continue;
            }
            let mut place = Place::new(of, "a contract");
            let (is_failing, time) = match contract {
                Contract::Assume(condition) => (!self.value(condition, &mut place).truth(), None),
                Contract::Never(condition, time) => (self.value(condition, &mut place).truth(), time.as_ref()),
                Contract::Always(condition, time) => (!self.value(condition, &mut place).truth(), Some(time)),
            };
            let time = time.map(|time| self.value(time, &mut place).number());
            if !is_failing {
                self.failing_since.remove(&(of, index));
                continue;
            }
            let since = *self.failing_since.entry((of, index)).or_insert(now);
            if time.is_none_or(|time| now - since >= time - SLACK) {
                let kind = match contract {
                    Contract::Assume(_) => "assume",
                    Contract::Never(_, None) => "never",
                    Contract::Never(..) => "never for",
                    Contract::Always(..) => "always",
                };
                self.seen(kind, Some(if of.is_some() { "a state" } else { "the machine" }));
                self.violated.push((of.map_or_else(String::new, name), shown(&contract.text())));
            }
        }
    }

    /// Runs what the machine itself does, which gives no command.
    fn run_own(&mut self) {
        self.run(&self.program.body, &mut Place::new(None, "the machine"));
    }

    /// Runs the active states' statements, but for the `done` outermost ones; the last command that they give. If it is not
    /// finite, the state that gave it, and which of its numbers is not.
    fn act(&mut self, done: usize) -> Result<Option<Action>, (usize, NonFinite)> {
        let mut given = None;
        for state in self.active.clone().split_off(done) {
            let command = self.run(&self.program.states[state].body, &mut Place::new(Some(state), "a body"));
            given = command.map(|command| (state, command)).or(given);
        }
        match given.map(|(state, command)| (state, flaw(command))) {
            Some((state, Some(flaw))) => Err((state, flaw)),
            _ => Ok(given.map(|(_, command)| command)),
        }
    }

    /// Leaves a state that cannot go on by its failsafe, or that of a state around it, or that of the machine.
    fn leave(&mut self, stuck: usize, cause: Cause, failsafe: &mut Option<(String, Cause)>) -> Result<Action, End> {
        let around = self.program.way(stuck).into_iter().rev();
        let own = around.map(|state| (Some(state), &self.program.states[state].failsafe));
        let found =
            own.chain([(None, &self.program.failsafe)]).find_map(|(from, target)| Some((from, target.as_ref()?)));
        let name = |state: usize| Arc::from(name(state));
        let Some((from, target)) = found else {
            self.seen("a failure", Some("a command"));
            return Err(End::Failure(match cause {
                Cause::NotFinite(flaw) => Failure::NotFinite { state: name(stuck), non_finite: flaw },
                Cause::MicrostepLimit => Failure::MicrostepLimit { state: name(stuck) },
            }));
        };
        let whose = ["the machine", "a state around", "the state"];
        self.seen("failsafe", Some(whose[usize::from(from.is_some()) + usize::from(from == Some(stuck))]));
        *failsafe = Some((self::name(stuck), cause));
        self.take(from, target)?;
        // The machine and those that stay active have run in this tick.
        let done = if let (Target::State { way, .. }, Cause::NotFinite(_)) = (target, cause) {
            self.program.way(way[0].0).len() - 1
        } else {
            self.run_own();
            0
        };
        let failure = |(state, flaw)| End::Failure(Failure::NotFinite { state: name(state), non_finite: flaw });
        let action = self.act(done).map_err(failure)?;
        Ok(action.unwrap_or(Action::Hold))
    }
}

/// The beginning of the text of a contract, which a program may cut.
pub(crate) fn shown(text: &str) -> String {
    text.chars().take(100).collect()
}

fn name(state: usize) -> String {
    format!("S{state}")
}

/// The first of a command's numbers that is not finite: along, at, facing or turning.
fn flaw(action: Action) -> Option<NonFinite> {
    let of = |part, numbers: &[f64]| {
        let bad = numbers.iter().find(|number| !number.is_finite());
        bad.map(|bad| NonFinite { part, is_nan: bad.is_nan() })
    };
    let Action::Steer { along_world, speed, turn, .. } = action else { return None };
    of(ActionPart::Along, &[along_world.x, along_world.y]).or(of(ActionPart::Speed, &[speed])).or(match turn {
        Turn::Facing(heading) => of(ActionPart::Heading, &[heading]),
        Turn::Rate(rate) => of(ActionPart::YawRate, &[rate]),
    })
}
