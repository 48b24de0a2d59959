//! What is kept from tick to tick: by the machine itself, and by states.

use crate::policy::ast::{Expression, File, Name};
use crate::policy::types::Value;
use vibrissa_runtime::machine::Block;

use super::Compiler;
use super::scope::{Meaning, Scope};

impl<'f> Compiler<'f> {
    /// Writes what sets the machine's own memory. The names that all states know, and the code.
    pub(super) fn own_memory(&mut self, file: &'f File) -> (Scope<'f>, Block) {
        let mut scope = Scope::default();
        let start = self.code.here();
        for (name, value) in &file.memory {
            let memory = self.expression(&scope, value).map(|value| self.copied(value));
            self.note_type(name, memory);
            self.watch_growth(name.span);
            // That the name is not taken was seen to with those of the other items.
            scope.insert(name, memory);
        }
        (scope, self.code.since(start))
    }

    /// A place for a state's memory that is set to a value. That is written into the entry, which comes last, when it is known
    /// what else there is to reset.
    pub(super) fn remember(&mut self, scope: &Scope<'f>, value: &'f Expression) -> Meaning {
        let mark = self.code.mark();
        let value = self.expression(scope, value);
        self.code.rewind(mark);
        value.map(|Value { r#type, .. }| Value { r#type, register: self.code.place(r#type.width()) })
    }

    /// Writes what sets a state's memory to what it begins with.
    pub(super) fn set_memory(&mut self, scope: &Scope<'f>, memory: &'f [(Name, Expression)]) {
        for (name, value) in memory {
            // A fault of the value has been reported when its place was made.
            if let Some(memory) = scope.get(&name.text).flatten()
                && let Some(value) = self.expression(scope, value)
            {
                self.code.copy(memory.register, value.register, value.r#type.width());
            }
        }
    }
}
