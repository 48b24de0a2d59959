//! Monitors: memory with statements that run first in every tick.

use crate::diagnostic::Diagnostic;
use crate::policy::ast::{Expression, File, Monitor, Name, Step};
use crate::policy::suggestion::did_you_mean;
use crate::policy::types::{Type, Value};

use super::scope::{Meaning, Scope};
use super::{Commandless, Compiler};

/// A monitor that runs.
pub(super) struct Running<'f> {
    /// The file that declares its content, and its content.
    file: usize,
    content: &'f Monitor,
    values: &'f [Expression],
    /// Its own declaration, and the number of names that precede it.
    declared: &'f Monitor,
    above: usize,
    /// Its memory.
    pub(super) memory: Vec<(&'f Name, Meaning)>,
}

impl<'f> Compiler<'f> {
    /// Lowers the initialisation of a monitor's memory, and adds its name to the machine's. A monitor with arguments runs
    /// only where another one uses it.
    pub(super) fn start_monitor(&mut self, scope: &mut Scope<'f>, declared: &'f Monitor) {
        if declared.used.is_none() && !declared.arguments.is_empty() {
            return;
        }
        let running = self.running(scope, declared);
        let meaning = running.map(|running| {
            self.running.push(running);
            Value { r#type: Type::Monitor(self.running.len() - 1), register: 0 }
        });
        self.memories.clear();
        self.check_size(declared.name.span);
        scope.insert(&declared.name, meaning);
    }

    fn running(&mut self, scope: &Scope<'f>, declared: &'f Monitor) -> Option<Running<'f>> {
        let (file, content, values) = match &declared.used {
            None => (self.current_file, declared, [].as_slice()),
            Some(Step { name, values, .. }) => {
                let Some((file, content)) = self.names().monitors.get(name.text.as_str()).copied() else {
                    let message = format!("there is no monitor `{}`", name.text);
                    let diagnostic = Diagnostic::error("P0201", message, name.span, "unknown monitor");
                    let known = self.names().monitors.keys().copied();
                    self.report(did_you_mean(diagnostic, &name.text, known));
                    return None;
                };
                (file, content, values.as_slice())
            }
        };
        let mut running = Running { file, content, values, declared, above: scope.len(), memory: Vec::new() };
        let mut inner = self.monitor_arguments(scope, &running)?;
        self.within(file, |compiler| compiler.monitor_memory(&mut inner, content));
        running.memory = content.memory.iter().map(|(name, _)| (name, inner.get(&name.text).flatten())).collect();
        Some(running)
    }

    fn monitor_arguments(&mut self, scope: &Scope<'f>, running: &Running<'f>) -> Option<Scope<'f>> {
        let Running { file, content, values, declared, .. } = running;
        let span = declared.used.as_ref().map_or(declared.name.span, |step| step.span);
        self.arguments(scope, *file, &content.name, &content.arguments, values, span)
    }

    /// Lowers the initial values of a monitor's memory.
    fn monitor_memory(&mut self, scope: &mut Scope<'f>, monitor: &'f Monitor) {
        let variables = std::mem::take(&mut self.variables);
        self.declaring = &monitor.memory;
        for (name, value) in &monitor.memory {
            let memory = self.expression(scope, value).map(|value| self.copied(value));
            self.bind(scope, 0, name, memory);
        }
        self.declaring = &[];
        self.variables = variables;
    }

    /// Lowers the statements of all monitors. `scope` has the names of the machine.
    pub(super) fn monitor_bodies(&mut self, scope: &Scope<'f>) {
        for running in std::mem::take(&mut self.running) {
            let mut above = scope.clone();
            above.truncate(running.above);
            if let Some(mut inner) = self.monitor_arguments(&above, &running) {
                running.memory.iter().for_each(|&(name, memory)| inner.insert(name, memory));
                self.within(running.file, |compiler| compiler.monitor_body(&mut inner, running.content));
            }
            self.check_size(running.declared.name.span);
            self.running.push(running);
        }
        self.memories.clear();
    }

    fn monitor_body(&mut self, scope: &mut Scope<'f>, monitor: &'f Monitor) {
        let own = monitor.memory.iter().map(|(name, _)| name).collect();
        let variables = std::mem::replace(&mut self.variables, own);
        self.commandless = Some(Commandless {
            construct: "a monitor",
            hint: "a monitor only remembers; move it to the statements of a state",
            allows_records: false,
        });
        self.statements(scope, &monitor.body);
        self.commandless = None;
        self.variables = variables;
    }

    /// Checks the monitors of a file alone, with unknown arguments, and discards the code.
    pub(super) fn check_monitors(&mut self, file: &'f File) {
        for monitor in file.monitors.iter().filter(|monitor| monitor.used.is_none()) {
            let (mark, faults) = (self.code.mark(), self.diagnostics.len());
            let mut scope = self.scope_of_arguments(&monitor.arguments);
            self.monitor_memory(&mut scope, monitor);
            self.monitor_body(&mut scope, monitor);
            self.memories.clear();
            self.check_size(monitor.name.span);
            self.code.rewind(mark);
            if self.diagnostics.len() > faults {
                self.erroneous.insert(monitor.name.span);
            }
        }
    }

    /// The value of a monitor's memory.
    pub(super) fn monitor_member(&mut self, monitor: usize, name: &Name) -> Option<Value> {
        let running = self.running.get(monitor)?;
        if let Some(&(_, value)) = running.memory.iter().find(|(known, _)| known.text == name.text) {
            return value;
        }
        let monitor = &running.declared.name.text;
        let message = format!("the monitor `{monitor}` has no `{}`", name.text);
        let known: Vec<&str> = running.memory.iter().map(|(name, _)| name.text.as_str()).collect();
        let diagnostic = Diagnostic::error("P0203", message, name.span, "unknown memory");
        let hint = if known.is_empty() { "it has no `var`".to_owned() } else { format!("it has {}", known.join(", ")) };
        let diagnostic = did_you_mean(diagnostic, &name.text, known).hint(hint);
        self.report(diagnostic);
        None
    }
}
