//! Renaming.

use thiserror::Error;

use crate::grammar::is_keyword;
use crate::lower::is_reserved;
use crate::path::standard;
use vibrissa_declare::catalogue::common::SPEED;
use vibrissa_text::diagnostic::Span;

use super::Index;
use super::symbol::{Meaning, Symbol, SymbolKind};

/// The reason for which a name cannot be changed.
#[derive(Debug, Clone, PartialEq, Eq, Error)]
pub enum RenameError {
    /// There is no name at the position.
    #[error("there is no name here; select the name of a state, a law, a value or a whisker")]
    NoName,
    /// The text has syntax errors.
    #[error("the policy has a syntax error, so not every use of the name is known; correct the error first")]
    Unreadable,
    /// The name belongs to the language.
    #[error("`{0}` is a name of the language and cannot be renamed")]
    BuiltIn(String),
    /// The name is not declared.
    #[error("there is no name `{0}`; correct that first")]
    Unknown(String),
    /// The new name is not a valid name.
    #[error("`{0}` cannot be a name; a name has letters from a to z, digits and `_`, and does not begin with a digit")]
    Malformed(String),
    /// The new name is a keyword or a built-in function.
    #[error("`{0}` is reserved; choose another name")]
    Reserved(String),
    /// The standard library declares the name.
    #[error(
        "`{name}` belongs to the standard library (`{module}`), which is part of the program, and cannot be renamed"
    )]
    Standard {
        /// The name.
        name: String,
        /// The module.
        module: String,
    },
    /// Scenes of a property set the parameter.
    #[error("the scenes of a property set the parameter `{0}`, so it keeps its name")]
    SetByScenes(String),
    /// The new name is imported from a file.
    #[error("the name `{name}` is imported from `{file}`; choose another name")]
    Imported {
        /// The new name.
        name: String,
        /// The file.
        file: String,
    },
    /// The new name is already declared.
    #[error("the name `{name}` is already declared in line {line}; choose another name")]
    Taken {
        /// The new name.
        name: String,
        /// The line, from 1.
        line: usize,
    },
}

impl Index {
    /// Span of the name at a byte, if it can be changed.
    ///
    /// # Errors
    /// The name cannot be changed, or its meaning is not certain.
    pub fn renamable(&self, at: usize) -> Result<Span, RenameError> {
        self.to_rename(at).map(|(span, _)| span)
    }

    /// The spans to replace with `name` when the name at a byte is changed. They are in this text only.
    /// [`rename_to`](Self::rename_to) returns those in other files.
    ///
    /// # Errors
    /// The name cannot be changed, or not to `name`.
    pub fn rename(&self, at: usize, name: &str) -> Result<Vec<Span>, RenameError> {
        self.to_rename(at).and_then(|(_, index)| self.renamed(index, name))
    }

    /// The spans to replace with `name` when a symbol is renamed.
    pub(super) fn renamed(&self, index: usize, name: &str) -> Result<Vec<Span>, RenameError> {
        let symbol = &self.symbols[index];
        if !self.is_read {
            return Err(RenameError::Unreadable);
        }
        let is_part = |letter: char| letter.is_ascii_alphanumeric() || letter == '_';
        if name.is_empty() || !name.chars().all(is_part) || name.starts_with(|first: char| first.is_ascii_digit()) {
            return Err(RenameError::Malformed(name.to_owned()));
        }
        if is_keyword(name) || is_reserved(name) {
            return Err(RenameError::Reserved(name.to_owned()));
        }
        if symbol.kind == SymbolKind::Parameter && symbol.name == SPEED.name && self.has_property() {
            return Err(RenameError::SetByScenes(symbol.name.clone()));
        }
        let others = self.symbols.iter().enumerate().filter(|&(other, _)| other != index);
        if let Some((_, other)) = others.into_iter().find(|(_, other)| other.name == name && meet(symbol, other)) {
            if let Some(file) = self.file_of(other) {
                return Err(RenameError::Imported { name: name.to_owned(), file: file.to_owned() });
            }
            let line = self.source.line_column(other.span.start).line;
            return Err(RenameError::Taken { name: name.to_owned(), line });
        }
        Ok(self.uses_of(index).into_iter().map(|(span, _)| span).collect())
    }

    /// True if the text names a family of scenes.
    fn has_property(&self) -> bool {
        self.resolved.uses.iter().any(|known| matches!(known.meaning, Meaning::Family(_)))
    }

    fn to_rename(&self, at: usize) -> Result<(Span, usize), RenameError> {
        let known = self.use_at(at).ok_or(RenameError::NoName)?;
        let text = self.source.slice(known.span).to_owned();
        match known.meaning {
            Meaning::Symbol(index, _) => match self.file_of(&self.symbols[index]) {
                Some(file) if standard(file).is_some() => {
                    Err(RenameError::Standard { name: text, module: file.to_owned() })
                }
                _ if self.is_read => Ok((known.span, index)),
                _ => Err(RenameError::Unreadable),
            },
            Meaning::File(_) => Err(RenameError::NoName),
            Meaning::Unknown => Err(RenameError::Unknown(text)),
            _ => Err(RenameError::BuiltIn(text)),
        }
    }
}

/// True if both names are visible at one position, so that they must differ. The machine's name is independent of all
/// others.
fn meet(a: &Symbol, b: &Symbol) -> bool {
    if [a.kind, b.kind].iter().any(|kind| matches!(kind, SymbolKind::Choice | SymbolKind::Field)) {
        return a.kind == b.kind && a.owner == b.owner;
    }
    let (a_reach, b_reach) = (a.visible.to(a.span), b.visible.to(b.span));
    let apart = a_reach.end <= b_reach.start || b_reach.end <= a_reach.start;
    !apart && a.kind != SymbolKind::Machine && b.kind != SymbolKind::Machine
}
