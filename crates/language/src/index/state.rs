//! Completion of states.

use std::collections::HashSet;

use vibrissa_runtime::machine::NESTING_LIMIT;

use super::Index;
use super::candidate::{Candidate, of_keyword};
use super::context::Context;
use super::declare::behaviour_around;
use super::symbol::SymbolKind;
use crate::word::Position;
use crate::words::words_at;

impl Index {
    /// Candidates after `->`.
    pub(super) fn targets(&self, context: &Context) -> Vec<Candidate> {
        let can_resume = !self.nesting().is_empty();
        let words = words_at(Position::Target).filter(|word| can_resume || word.text != "resume");
        let states = self.states_around(context).into_iter().map(|state| self.target(state, context));
        let exits = self.known(context).filter(|symbol| symbol.kind == SymbolKind::Exit).map(|exit| {
            let candidate = self.symbol(exit);
            let (label, snippet) = (format!("exit {}", candidate.label), format!("exit {}", candidate.snippet));
            Candidate { label, snippet, ..candidate }
        });
        states.chain(exits).chain(words.map(of_keyword)).collect()
    }

    /// Candidates after `resume`.
    pub(super) fn resumable(&self, context: &Context) -> Vec<Candidate> {
        let nesting = self.nesting();
        let states = self.states_around(context).into_iter().filter(|state| nesting.contains(state));
        states.map(|state| self.target(state, context)).collect()
    }

    /// The exits of the behaviour that the state around the position uses.
    pub(super) fn connected(&self, context: &Context) -> Vec<Candidate> {
        let used = self.state_around(context).and_then(|state| self.resolved.behaviours.get(&state).copied());
        let of_used = |&exit: &usize| {
            self.symbols[exit].kind == SymbolKind::Exit && behaviour_around(&self.symbols, exit) == used
        };
        let exits = (0..self.symbols.len()).filter(|_| used.is_some()).filter(of_used);
        exits.map(|exit| self.symbol(&self.symbols[exit])).collect()
    }

    /// The states that transitions around the position can have as targets: those of the same behaviour, or of the
    /// machine.
    fn states_around(&self, context: &Context) -> Vec<usize> {
        let around = self.state_around(context);
        let behaviour = around.and_then(|around| match self.symbols[around].kind {
            SymbolKind::Behaviour => Some(around),
            _ => behaviour_around(&self.symbols, around),
        });
        self.states().filter(|&state| behaviour_around(&self.symbols, state) == behaviour).collect()
    }

    /// Candidates after `initial`: direct inner states in a state, and outermost states outside.
    pub(super) fn beginnings(&self, context: &Context) -> Vec<Candidate> {
        let around = self.state_around(context);
        let states = self.states().filter(|&state| {
            let symbol = &self.symbols[state];
            symbol.owner == around && (around.is_some() || symbol.arguments.is_empty())
        });
        states.map(|state| self.symbol(&self.symbols[state])).collect()
    }

    /// Candidates after a state and `.`: its inner states, unless a state between them takes values.
    pub(super) fn inner_states(&self, outer: usize) -> Vec<Candidate> {
        let is_near = |state: usize| {
            let mut between = self.outward(state).skip(1).skip_while(|&on_way| {
                on_way != outer && self.symbols.get(on_way).is_some_and(|on_way| on_way.arguments.is_empty())
            });
            between.next() == Some(outer)
        };
        self.states().filter(|&state| is_near(state)).map(|state| self.symbol(&self.symbols[state])).collect()
    }

    /// A state as a target, with the entered outer states that take values.
    fn target(&self, target: usize, context: &Context) -> Candidate {
        let around = self.state_around(context);
        let stays = |outer: usize| {
            outer != target && around.is_some_and(|around| self.outward(around).any(|active| active == outer))
        };
        let mut entered: Vec<usize> = self.outward(target).take_while(|&outer| !stays(outer)).collect();
        entered.reverse();
        entered.retain(|&state| state == target || !self.symbols[state].arguments.is_empty());
        let mut fields = 0;
        let steps = entered.into_iter().map(|state| {
            let state = &self.symbols[state];
            let values = state.arguments.iter().map(|argument| {
                fields += 1;
                format!("${{{fields}:{argument}}}")
            });
            let values = values.collect::<Vec<_>>().join(", ");
            if values.is_empty() { state.name.clone() } else { format!("{}({values})", state.name) }
        });
        let snippet = steps.collect::<Vec<_>>().join(".");
        Candidate { snippet, ..self.symbol(&self.symbols[target]) }
    }

    fn states(&self) -> impl Iterator<Item = usize> {
        (0..self.own).filter(|&index| self.symbols[index].kind == SymbolKind::State)
    }

    /// The states that have inner states.
    fn nesting(&self) -> HashSet<usize> {
        self.states().filter_map(|state| self.symbols[state].owner).collect()
    }

    /// The innermost state around the position.
    fn state_around(&self, context: &Context) -> Option<usize> {
        (0..self.own).find(|&state| Some(self.symbols[state].span) == context.state)
    }

    /// A state and its ancestors, the innermost first. The number is limited to that of a valid policy.
    fn outward(&self, state: usize) -> impl Iterator<Item = usize> {
        std::iter::successors(Some(state), |&state| self.symbols.get(state)?.owner).take(NESTING_LIMIT)
    }
}
