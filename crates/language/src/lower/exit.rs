//! Exits of behaviours, and their connections to targets.

use std::sync::Arc;

use crate::ast::{Connection, Exit, State, Target};
use crate::suggestion::did_you_mean;
use vibrissa_runtime::machine;
use vibrissa_text::diagnostic::Diagnostic;

use super::Compiler;
use super::call::{Callee, Given};
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
            if self.is_told("P0201", target.name.span) {
                return None;
            }
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
        let what = format!("the exit `{}`", exit.name.text);
        let given =
            match (Callee { what: &what, label: "left here" }).values(&exit.arguments, &target.values, target.span) {
                Ok(given) => given,
                Err(diagnostic) => {
                    self.report(diagnostic.note(exit.name.span, "declared here"));
                    return None;
                }
            };
        let (mark, start) = (self.code.mark(), self.code.here());
        let mut values: Vec<Meaning> = Vec::with_capacity(given.len());
        for (argument, Given { value, is_default }) in exit.arguments.iter().zip(given) {
            let none = Scope::default();
            let scope = if is_default { &none } else { scope };
            let value = match self.within(instance.file, |compiler| compiler.named_type(&argument.type_name)) {
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
        let Some(instance) = self.hierarchy.content(user) else { return };
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
            let outer = &compiler.scopes[user];
            let hidable = outer.len();
            let mut scope = Scope::inside(outer, hidable);
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
