//! What is kept from tick to tick: by the machine itself, and by states.

use crate::policy::ast::{Expression, File, Name};
use crate::policy::types::Value;

use super::Compiler;
use super::scope::{Meaning, Scope};

impl<'f> Compiler<'f> {
    /// Gives the machine's own memory its places. The names that all states know.
    pub(super) fn own_memory(&mut self, file: &'f File) -> Scope<'f> {
        let mut scope = Scope::default();
        for (name, value) in &file.memory {
            let memory = self.remember(&scope, value);
            self.note_type(name, memory);
            // That the name is not taken was seen to with those of the other items.
            scope.insert(name, memory);
        }
        scope
    }

    /// A place for memory that is set to a value. That is written into the entry, which of a state comes last, when it is known
    /// what else there is to reset.
    pub(super) fn remember(&mut self, scope: &Scope<'f>, value: &'f Expression) -> Meaning {
        let mark = self.code.mark();
        let value = self.expression(scope, value);
        self.code.rewind(mark);
        value.map(|Value { r#type, .. }| Value { r#type, register: self.code.place(r#type.width()) })
    }

    /// Writes what sets memory, the machine's or a state's, to what it begins with.
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
