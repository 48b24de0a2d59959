//! Memory of states and of the machine, kept from tick to tick.

use std::cell::OnceCell;
use std::collections::HashSet;
use std::ops::Deref;

use crate::ast::{Expression, File, Name};
use crate::types::Value;
use vibrissa_runtime::machine::Block;

use super::Compiler;
use super::scope::{Meaning, Scope};

/// The names of memory that the current statements can set.
#[derive(Default)]
pub(super) struct Variables<'f> {
    names: Vec<&'f Name>,
    /// The same names, to find one. Determined when it is needed, because thousands of states may have thousands of names each.
    texts: OnceCell<HashSet<&'f str>>,
}

impl Variables<'_> {
    pub(super) fn contains(&self, name: &str) -> bool {
        self.texts.get_or_init(|| self.names.iter().map(|known| known.text.as_str()).collect()).contains(name)
    }
}

impl<'f> Deref for Variables<'f> {
    type Target = [&'f Name];

    fn deref(&self) -> &[&'f Name] {
        &self.names
    }
}

impl<'f> FromIterator<&'f Name> for Variables<'f> {
    fn from_iter<I: IntoIterator<Item = &'f Name>>(names: I) -> Self {
        Self { names: names.into_iter().collect(), texts: OnceCell::new() }
    }
}

impl<'f> Compiler<'f> {
    /// Lowers the initialisation of the memory of the machine and of its monitors, and the statements of the monitors.
    /// Returns the names that all states know, and both codes.
    pub(super) fn own_memory(&mut self, file: &'f File) -> (Scope<'f>, Block, Block) {
        let mut scope = Scope::default();
        // Those of parts that were checked alone end with these.
        self.running.clear();
        self.monitor_registers.clear();
        let start = self.code.here();
        let mut monitors = file.monitors.iter().peekable();
        for (name, value) in &file.memory {
            while let Some(monitor) = monitors.next_if(|monitor| monitor.name.span.start < name.span.start) {
                self.start_monitor(&mut scope, monitor);
            }
            let memory = self.expression(&scope, value).map(|value| self.copied(value));
            self.note_type(name, memory);
            self.check_size(name.span);
            // The check of item names has already refused duplicates.
            scope.insert(name, memory);
        }
        monitors.for_each(|monitor| self.start_monitor(&mut scope, monitor));
        let (entry, start) = (self.code.since(start), self.code.here());
        self.monitor_bodies(&scope);
        (scope, entry, self.code.since(start))
    }

    /// A register for a state's memory with an initial value. The entry code sets it, and is generated last, when all
    /// memory is known.
    pub(super) fn remember(&mut self, scope: &Scope<'f>, value: &'f Expression) -> Meaning {
        let mark = self.code.mark();
        let value = self.expression(scope, value);
        self.code.rewind(mark);
        value.map(|Value { r#type, .. }| Value { r#type, register: self.code.allocate(r#type.width()) })
    }

    /// Lowers the initialisation of a state's memory.
    pub(super) fn set_memory(&mut self, scope: &Scope<'f>, memory: &'f [(Name, Expression)]) {
        for (name, value) in memory {
            // An error of the value was reported when the register was created.
            if let Some(memory) = scope.get(&name.text).flatten()
                && let Some(value) = self.expression(scope, value)
            {
                self.code.copy(memory.register, value.register, value.r#type.width());
            }
        }
    }
}
