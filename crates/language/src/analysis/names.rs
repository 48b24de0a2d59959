//! Names that parts of a policy use.

use std::collections::HashSet;

use crate::ast::{
    Argument, Compound, Connection, Contract, Expression, Guard, Kind, Name, State, Statement, Step, Target, Transition,
};

/// A set of used names.
#[derive(Debug, Default)]
pub(super) struct Names<'a> {
    used: HashSet<&'a str>,
    /// Names that the part itself declares. Outside of it they have no meaning, or another one.
    given: HashSet<&'a str>,
}

impl<'a> Names<'a> {
    pub(super) fn has(&self, name: &str) -> bool {
        self.used.contains(name)
    }

    /// The set that `add` builds.
    pub(super) fn of(add: impl FnOnce(&mut Self)) -> Self {
        let mut names = Self::default();
        add(&mut names);
        names
    }

    /// Records declared names.
    pub(super) fn give(&mut self, names: impl IntoIterator<Item = &'a Name>) {
        self.given.extend(names.into_iter().map(|name| name.text.as_str()));
    }

    /// Records the types of arguments.
    pub(super) fn types(&mut self, arguments: &'a [Argument]) {
        self.used.extend(arguments.iter().map(|argument| argument.type_name.base.text.as_str()));
    }

    /// Records the types that a record or a list consists of.
    pub(super) fn compound(&mut self, item: &'a Compound) {
        self.used.extend(item.types().map(|name| name.base.text.as_str()));
    }

    /// Adds the used names of an inner part, except those that it declares.
    pub(super) fn extend(&mut self, within: &Self) {
        self.used.extend(within.used.difference(&within.given));
    }

    /// Records a used behaviour or monitor and its values.
    pub(super) fn step(&mut self, step: &'a Step) {
        self.used.insert(&step.name.text);
        self.expressions(&step.values);
    }

    /// Records the names that a state uses, without those that its inner states use.
    pub(super) fn state(&mut self, state: &'a State) {
        if let Some(behaviour) = &state.behaviour {
            self.step(behaviour);
        }
        state.initial.iter().for_each(|step| self.expressions(&step.values));
        state.memory.iter().for_each(|(_, value)| self.expression(value));
        for statements in [&state.entry, &state.body, &state.exit] {
            self.statements(statements);
        }
        self.transitions(&state.transitions);
        self.targets(&state.failsafes);
        self.contracts(&state.contracts);
        for Connection { names, target, .. } in &state.connections {
            let within = Self::of(|within| {
                within.give(names);
                within.targets(std::slice::from_ref(target));
            });
            self.extend(&within);
        }
    }

    pub(super) fn contracts(&mut self, contracts: &'a [Contract]) {
        for Contract { condition, time, .. } in contracts {
            self.expression(condition);
            self.expressions(time);
        }
    }

    pub(super) fn transitions(&mut self, transitions: &'a [Transition]) {
        for Transition { guard, target } in transitions {
            match guard {
                Guard::When { condition, lasting } => {
                    self.expression(condition);
                    self.expressions(lasting);
                }
                Guard::After(time) => self.expression(time),
            }
            self.targets(std::slice::from_ref(target));
        }
    }

    pub(super) fn targets(&mut self, targets: &'a [Target]) {
        for target in targets {
            self.expressions(target.outer.iter().flat_map(|step| &step.values).chain(&target.values));
        }
    }

    pub(super) fn statements(&mut self, statements: &'a [Statement]) {
        for statement in statements {
            if let Statement::Let { name, .. } = statement {
                self.give([name]);
            }
            self.used.extend(statement.used().map(|name| name.text.as_str()));
            self.expressions(statement.expressions());
            statement.blocks().for_each(|block| self.statements(block));
        }
    }

    /// Adds the names that the defaults of arguments use.
    pub(super) fn defaults(&mut self, arguments: &'a [Argument]) {
        self.expressions(arguments.iter().filter_map(|argument| argument.default.as_ref()));
    }

    pub(super) fn expressions(&mut self, expressions: impl IntoIterator<Item = &'a Expression>) {
        expressions.into_iter().for_each(|expression| self.expression(expression));
    }

    pub(super) fn expression(&mut self, expression: &'a Expression) {
        match &expression.kind {
            Kind::Quantity(_) | Kind::Bool(_) => {}
            Kind::Root { name, values } => {
                self.used.insert(&name.text);
                self.expressions(values.iter().flatten());
            }
            Kind::Member { owner, values, .. } => {
                self.expression(owner);
                self.expressions(values.iter().flatten());
            }
            Kind::Norm(inner) | Kind::Negate(inner) | Kind::Not(inner) | Kind::Named { value: inner, .. } => {
                self.expression(inner);
            }
            Kind::If { condition, value, otherwise } => self.expressions([&**condition, value, otherwise]),
            Kind::Binary { left, right, .. } => {
                self.expression(left);
                self.expression(right);
            }
        }
    }
}
