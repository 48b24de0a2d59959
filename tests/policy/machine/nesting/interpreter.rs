//! Machines of states in states, interpreted as they are explained: recursively, over the tree, with values by name.

use std::collections::HashMap;

use super::tree::{Guard, Rule, Tree, Value};

/// What is done with a state.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Event {
    Entry,
    Body,
    Exit,
}

/// A tick: what was done, to which state, with which memory.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub(crate) struct Done {
    pub(crate) events: Vec<(usize, usize, usize)>,
    /// The innermost active state; `None` after a failure.
    pub(crate) state: Option<usize>,
    /// The state whose command counts.
    pub(crate) commander: Option<usize>,
}

/// A rule of a state, or one that holds always, by its number among those.
pub(crate) type Which = (Option<usize>, usize);

/// An active state, and the one in it.
struct Active {
    state: usize,
    entered_at: usize,
    /// Of each of its rules, since when its condition has held.
    since: Vec<Option<usize>>,
    inner: Option<Box<Active>>,
}

pub(crate) struct Interpreter<'t> {
    tree: &'t Tree,
    active: Option<Box<Active>>,
    always_since: Vec<Option<usize>>,
    memory: HashMap<usize, usize>,
    arguments: HashMap<usize, usize>,
    /// For every state, the one in it that was left last.
    left: HashMap<usize, usize>,
    now: usize,
    touching: [bool; 8],
    done: Done,
    has_failed: bool,
    /// All rules that were taken.
    pub(crate) taken: Vec<Which>,
}

impl<'t> Interpreter<'t> {
    pub(crate) fn new(tree: &'t Tree) -> Self {
        Self {
            tree,
            active: None,
            always_since: vec![None; tree.always.len()],
            memory: HashMap::new(),
            arguments: HashMap::new(),
            left: HashMap::new(),
            now: 0,
            touching: [false; 8],
            done: Done::default(),
            has_failed: false,
            taken: Vec::new(),
        }
    }

    pub(crate) fn tick(&mut self, now: usize, touching: [bool; 8]) -> Done {
        (self.now, self.touching, self.done) = (now, touching, Done::default());
        if self.has_failed {
            return Done::default();
        }
        if self.active.is_none() {
            self.active = Some(Box::new(self.enter(&[0], false)));
        }
        let mut since = std::mem::take(&mut self.always_since);
        let mut due = self.due(None, &self.tree.always, 0, &mut since);
        self.always_since = since;
        let mut taken = 0;
        loop {
            due = due.or_else(|| {
                let mut active = self.active.take();
                let due = self.due_inside(active.as_deref_mut());
                self.active = active;
                due
            });
            let Some((from, rule)) = due.take() else { break };
            taken += 1;
            if taken > 8 {
                self.has_failed = true;
                return Done { state: None, commander: None, ..std::mem::take(&mut self.done) };
            }
            let rules = from.map_or(&self.tree.always, |from| &self.tree.states[from].rules);
            self.taken.extend(rules.iter().position(|known| std::ptr::eq(known, rule)).map(|index| (from, index)));
            self.take(from, rule);
        }
        let active = self.active.take();
        self.act(active.as_deref());
        self.active = active;
        std::mem::take(&mut self.done)
    }

    fn do_it(&mut self, event: Event, state: usize) {
        self.done.events.push((event as usize, state, self.memory[&state]));
        if let Some((of, value)) = self.tree.states[state].sets[event as usize] {
            let value = self.value(value);
            self.memory.insert(of, value);
        }
    }

    fn value(&self, value: Value) -> usize {
        match value {
            Value::Bound(whisker) => whisker,
            Value::Argument(state) => self.arguments[&state],
            Value::Memory(state) => self.memory[&state],
        }
    }

    /// Enters the first state of a way, in it the second, and so on; then where the last begins or was left.
    fn enter(&mut self, way: &[usize], resume: bool) -> Active {
        let (state, rest) = (way[0], &way[1..]);
        let node = &self.tree.states[state];
        let begin = if node.has_argument { self.arguments[&state] } else { state % 8 };
        self.memory.insert(state, begin);
        self.do_it(Event::Entry, state);
        let inner = match (rest.is_empty(), self.left.get(&state).copied(), node.initial) {
            (false, ..) => Some(self.enter(rest, resume)),
            (true, _, None) => None,
            (true, Some(left), _) if resume => Some(self.enter(&[left], true)),
            (true, _, Some((initial, value))) => {
                let value = self.value(value);
                self.arguments.insert(initial, value);
                Some(self.enter(&[initial], resume))
            }
        };
        Active { state, entered_at: self.now, since: vec![None; node.rules.len()], inner: inner.map(Box::new) }
    }

    fn exit(&mut self, active: Active) {
        if let Some(inner) = active.inner {
            self.left.insert(active.state, inner.state);
            self.exit(*inner);
        }
        self.do_it(Event::Exit, active.state);
    }

    fn act(&mut self, active: Option<&Active>) {
        let Some(active) = active else { return };
        self.do_it(Event::Body, active.state);
        if self.tree.states[active.state].commands {
            self.done.commander = Some(active.state);
        }
        self.done.state = Some(active.state);
        self.act(active.inner.as_deref());
    }

    /// The first rule that holds of an active state, or else of the one in it; none if it has led where it leads.
    fn due_inside(&self, active: Option<&mut Active>) -> Option<(Option<usize>, &'t Rule)> {
        let active = active?;
        let rules = &self.tree.states[active.state].rules;
        let own = first(self.holding(rules, active.entered_at, &mut active.since));
        own.filter(|rule| {
            // Whether one of the states in it that are active is the target.
            let mut inside = std::iter::successors(active.inner.as_ref(), |inner| inner.inner.as_ref());
            !inside.any(|inner| inner.state == rule.target)
        })
        .map(|rule| (Some(active.state), rule))
        .or_else(|| self.due_inside(active.inner.as_deref_mut()))
    }

    fn due(
        &self,
        from: Option<usize>,
        rules: &'t [Rule],
        entered_at: usize,
        since: &mut [Option<usize>],
    ) -> Option<(Option<usize>, &'t Rule)> {
        let rule = first(self.holding(rules, entered_at, since))?;
        let mut active = std::iter::successors(self.active.as_ref(), |active| active.inner.as_ref());
        (!active.any(|active| active.state == rule.target)).then_some((from, rule))
    }

    /// The rules that hold. All of them are looked at.
    fn holding(&self, rules: &'t [Rule], entered_at: usize, since: &mut [Option<usize>]) -> Vec<&'t Rule> {
        let mut holding = Vec::new();
        for (rule, since) in rules.iter().zip(since) {
            let holds = match rule.guard {
                Guard::When(whisker) => self.touching[whisker],
                Guard::WhenFor(whisker, ticks) => {
                    *since = if self.touching[whisker] { since.or(Some(self.now)) } else { None };
                    since.is_some_and(|since| self.now - since >= ticks)
                }
                Guard::After(ticks) => self.now - entered_at >= ticks,
            };
            holding.extend(holds.then_some(rule));
        }
        holding
    }

    fn take(&mut self, from: Option<usize>, rule: &Rule) {
        let entered = self.tree.entered(from, rule.target);
        // Everything at the level of the first state entered and below it is left.
        let level = self.tree.way(entered[0]).len() - 1;
        let mut place = &mut self.active;
        for _ in 0..level {
            place = &mut place.as_mut().unwrap().inner;
        }
        if let Some(left) = place.take() {
            if let Some(parent) = self.tree.states[left.state].parent {
                self.left.insert(parent, left.state);
            }
            self.exit(*left);
        }
        let values: Vec<usize> = entered
            .iter()
            .map(|state| {
                let value = rule.values.iter().find(|(of, _)| of == state).unwrap().1;
                self.value(value)
            })
            .collect();
        self.arguments.extend(entered.iter().copied().zip(values));
        let inner = self.enter(&entered, rule.resume);
        let mut place = &mut self.active;
        for _ in 0..level {
            place = &mut place.as_mut().unwrap().inner;
        }
        *place = Some(Box::new(inner));
    }
}

fn first<T>(items: Vec<T>) -> Option<T> {
    items.into_iter().next()
}
