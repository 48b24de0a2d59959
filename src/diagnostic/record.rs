//! Diagnostics for programs.

use super::{Diagnostic, Label, Position, Severity, Source};
use serde::Serialize;

/// A diagnostic with its places as lines and columns, to be serialised.
#[derive(Debug, Clone, PartialEq, Eq, Serialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
pub struct Record {
    /// How bad it is.
    pub severity: Severity,
    /// The stable code.
    pub code: &'static str,
    /// What is wrong.
    pub message: String,
    /// Where it is wrong.
    #[serde(flatten)]
    pub primary: RecordLabel,
    /// Other places that have to do with it.
    pub secondary: Vec<RecordLabel>,
    /// What to do.
    pub hints: Vec<String>,
}

/// A note at a place, in lines and columns from 1; columns count characters.
#[derive(Debug, Clone, PartialEq, Eq, Serialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
pub struct RecordLabel {
    /// The name of the source, or of the part of it.
    pub file: String,
    /// The note.
    pub label: String,
    /// Line of the first character.
    pub line: usize,
    /// Column of the first character.
    pub column: usize,
    /// Line of the place behind the last character.
    pub end_line: usize,
    /// Column of the place behind the last character.
    pub end_column: usize,
}

/// The diagnostics of a source as records, in the order given.
#[must_use]
pub fn records(source: &Source, diagnostics: &[Diagnostic]) -> Vec<Record> {
    let place = |label: &Label| {
        let range = source.clamp(label.span);
        let Position { line, column } = source.line_column(range.start);
        let end = source.line_column(range.end);
        RecordLabel {
            file: source.part_name(source.part_at(range.start)).to_owned(),
            label: label.text.clone(),
            line,
            column,
            end_line: end.line,
            end_column: end.column,
        }
    };
    let record = |diagnostic: &Diagnostic| Record {
        severity: diagnostic.severity,
        code: diagnostic.code,
        message: diagnostic.message.clone(),
        primary: place(&diagnostic.primary),
        secondary: diagnostic.secondary.iter().map(place).collect(),
        hints: diagnostic.hints.clone(),
    };
    diagnostics.iter().map(record).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::diagnostic::Span;

    #[test]
    fn a_record_serialises_with_file_and_place() {
        let source = Source::new("a.yaml", "name: x\nseed: -1\n");
        let fault = Diagnostic::error("S0300", "negative", Span::new(14, 16), "here").hint("leave it out");
        let expected = serde_json::json!([{
            "file": "a.yaml", "severity": "error", "code": "S0300", "message": "negative", "label": "here",
            "line": 2, "column": 7, "end_line": 2, "end_column": 9, "secondary": [], "hints": ["leave it out"],
        }]);
        assert_eq!(serde_json::to_value(records(&source, &[fault])).ok(), Some(expected));
    }
}
