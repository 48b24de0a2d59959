//! Exits of behaviours, and their connections to targets.

use std::sync::Arc;

use crate::diagnostic::Diagnostic;
use crate::policy::ast::{Connection, Exit, State, Target};
use crate::policy::suggestion::did_you_mean;
use vibrissa_runtime::machine;

use super::Compiler;
use super::function::count;
use super::scope::{Meaning, Scope};

impl<'f> Compiler<'f> {
    /// Lowers an exit as the target of a transition of the state `from`: the values of the exit, then the target to which
    /// the state that uses the behaviour connects it.
    pub(super) fn exit(
        &mut self,
        scope: &Scope<'f>,
        from: Option<usize>,
        target: &'f Target,
    ) -> Option<machine::Target> {
        self.exit_of(scope, self.hierarchy.instance(from), from, target)
    }

    /// Lowers an exit of an instance.
    fn exit_of(
        &mut self,
        scope: &Scope<'f>,
        instance: usize,
        from: Option<usize>,
        target: &'f Target,
    ) -> Option<machine::Target> {
        let instance = self.hierarchy.instances.get(instance)?;
        let Some(exit) = instance.exits.iter().find(|exit| exit.name.text == target.name.text) else {
            let message = format!("there is no exit `{}`", target.name.text);
            let diagnostic = Diagnostic::error("P0201", message, target.name.span, "unknown exit");
            let known = instance.exits.iter().map(|exit| exit.name.text.as_str());
            self.report(
                did_you_mean(diagnostic, &target.name.text, known).hint(
                    "a behaviour declares its exits in its braces: `exit name(value: type)`; the machine has none",
                ),
            );
            return None;
        };
        if exit.arguments.len() != target.values.len() {
            let (takes, given) = (count(exit.arguments.len()), target.values.len());
            let message = format!("the exit `{}` takes {takes}, not {given}", exit.name.text);
            let diagnostic = Diagnostic::error("P0304", message, target.span, "left here");
            self.report(diagnostic.note(exit.name.span, "declared here"));
            return None;
        }
        let (mark, start) = (self.code.mark(), self.code.here());
        let mut values: Vec<Meaning> = Vec::with_capacity(target.values.len());
        for (argument, value) in exit.arguments.iter().zip(&target.values) {
            let value = match self.type_of(&argument.type_name) {
                Some(r#type) => self.expect(scope, value, r#type),
                None => self.expression(scope, value).and(None),
            };
            values.push(value);
        }
        let Some(user) = instance.user else {
            // A behaviour that is checked alone. Its code is discarded.
            return Some(machine::Target::Success(Arc::from("")));
        };
        let state = &self.hierarchy.states[user];
        // A missing connection has been reported.
        let connection = state.connections.iter().find(|connection| connection.exit.text == exit.name.text)?;
        let lowered = self.connection((user, state), from, connection, values)?;
        Some(match lowered {
            machine::Target::State { state, arguments, resume } => {
                machine::Target::State { state, arguments: start..arguments.end, resume }
            }
            // The end of a run has no values.
            end => {
                self.code.rewind(mark);
                end
            }
        })
    }

    /// Checks the connections of a state, with unknown values, and discards the code. No transition may lead to some of
    /// them.
    pub(super) fn connections(&mut self, user: usize, state: &'f State) {
        let instance = self.hierarchy.instances.iter().position(|instance| instance.user == Some(user));
        let Some(instance) = instance.and_then(|number| self.hierarchy.instances.get(number)) else { return };
        for connection in &state.connections {
            let exit = instance.exits.iter().find(|exit| exit.name.text == connection.exit.text);
            // An unknown exit has been reported.
            let Some(Exit { arguments, .. }) = exit else { continue };
            let mark = self.code.mark();
            let values = self.within(instance.file, |compiler| {
                let scope = compiler.scope_of_arguments(arguments);
                arguments.iter().map(|argument| scope.get(&argument.name.text).flatten()).collect()
            });
            let _ = self.connection((user, state), Some(user), connection, values);
            self.code.rewind(mark);
        }
    }

    /// Lowers the target of a connection. `from` is the state whose transition leads to the exit.
    fn connection(
        &mut self,
        (user, state): (usize, &'f State),
        from: Option<usize>,
        connection: &'f Connection,
        values: Vec<Meaning>,
    ) -> Option<machine::Target> {
        self.within(self.hierarchy.file(user), |compiler| {
            let mut scope = compiler.scopes[user].clone();
            let hidable = scope.len();
            for (name, value) in connection.names.iter().zip(values) {
                compiler.bind(&mut scope, hidable, name, value);
            }
            if connection.target.is_exit {
                // An exit of the behaviour that contains the state.
                return compiler.exit_of(&scope, state.instance, from, &connection.target);
            }
            compiler.target_in(&scope, (state.instance, from), &connection.target)
        })
    }
}
