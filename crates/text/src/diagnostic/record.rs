//! Diagnostics for other programs.

use super::{Diagnostic, Label, Position, Severity, Source};
use serde::Serialize;

/// A diagnostic with its positions as lines and columns, for serialisation.
#[derive(Debug, Clone, PartialEq, Eq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct Record {
    /// The severity.
    pub severity: Severity,
    /// The stable code.
    pub code: &'static str,
    /// The message.
    pub message: String,
    /// The position of the fault.
    #[serde(flatten)]
    pub primary: RecordLabel,
    /// Related positions.
    pub secondary: Vec<RecordLabel>,
    /// Advice.
    pub hints: Vec<String>,
}

/// A note at a position. Lines and columns count from 1, and columns count characters.
#[derive(Debug, Clone, PartialEq, Eq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct RecordLabel {
    /// The name of the source, or of its part.
    pub file: String,
    /// The note.
    pub label: String,
    /// Line of the first character.
    pub line: usize,
    /// Column of the first character.
    pub column: usize,
    /// Line of the position after the last character.
    pub end_line: usize,
    /// Column of the position after the last character.
    pub end_column: usize,
}

/// The diagnostics of a source as records, in the order given.
#[must_use]
pub fn records(source: &Source, diagnostics: &[Diagnostic]) -> Vec<Record> {
    let position = |label: &Label| {
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
        primary: position(&diagnostic.primary),
        secondary: diagnostic.secondary.iter().map(position).collect(),
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
