//! The state hierarchy.

use std::collections::HashMap;

use crate::ast::State;
use crate::expand::{Expanded, Instance};

/// The state hierarchy of a machine.
#[derive(Debug, Default)]
pub(super) struct Hierarchy<'f> {
    /// An outer state precedes its inner states.
    pub(super) states: &'f [State],
    pub(super) instances: &'f [Instance],
    /// For every state, its direct inner states.
    inner: Vec<Vec<usize>>,
    /// The instance of the behaviour that is the content of a state.
    contents: HashMap<usize, &'f Instance>,
}

impl<'f> Hierarchy<'f> {
    pub(super) fn new(expanded: &'f Expanded) -> Self {
        let states = expanded.states.as_slice();
        let mut inner = vec![Vec::new(); states.len()];
        for (index, state) in states.iter().enumerate() {
            if let Some(parent) = state.parent {
                inner[parent].push(index);
            }
        }
        let contents = expanded.instances.iter().rev().filter_map(|instance| Some((instance.user?, instance)));
        Self { states, instances: &expanded.instances, inner, contents: contents.collect() }
    }

    /// The instance of the behaviour that is the content of a state.
    pub(super) fn content(&self, state: usize) -> Option<&'f Instance> {
        self.contents.get(&state).copied()
    }

    /// The instance of the state `from`. The machine's own is 0.
    pub(super) fn instance(&self, from: Option<usize>) -> usize {
        from.and_then(|from| self.states.get(from)).map_or(0, |state| state.instance)
    }

    /// True if the states of an instance are those of a behaviour.
    pub(super) fn is_behaviour(&self, instance: usize) -> bool {
        let name = self.instances.get(instance).map(|instance| instance.name.span);
        instance > 0 || self.states.first().map(|state| state.name.span) == name
    }

    /// The file that contains the text of a state.
    pub(super) fn file(&self, state: usize) -> usize {
        self.instances[self.states[state].instance].file
    }

    /// The name of a state in the whole machine: `Following.Swiping`.
    pub(super) fn path(&self, state: usize) -> String {
        let state = &self.states[state];
        format!("{}{}", self.instances[state.instance].prefix, state.name.text)
    }

    /// The direct inner states of a state.
    pub(super) fn inner(&self, state: usize) -> &[usize] {
        &self.inner[state]
    }

    /// A state and its ancestors, the innermost first.
    pub(super) fn outward(&self, state: usize) -> impl Iterator<Item = usize> + use<'f> {
        let states = self.states;
        std::iter::successors(Some(state), move |&state| states[state].parent)
    }

    /// True if a state is `outer` or inside it.
    pub(super) fn contains(&self, outer: usize, state: usize) -> bool {
        self.outward(state).any(|state| state == outer)
    }

    /// The states that a transition of the state `from`, or a global one, enters: from the outermost state that does
    /// not stay active to `target`.
    pub(super) fn entered(&self, from: Option<usize>, target: usize) -> Vec<usize> {
        let stays = |outer: usize| outer != target && from.is_some_and(|from| self.contains(outer, from));
        let mut entered: Vec<usize> = self.outward(target).take_while(|&outer| !stays(outer)).collect();
        entered.reverse();
        entered
    }
}
