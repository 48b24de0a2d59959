//! The diagnostic.

use super::Span;
use serde::Serialize;

/// The maximum number of diagnostics per source. A text can have a hundred thousand, and nobody reads more than a few.
pub const FAULT_LIMIT: usize = 50;

/// The severity of a diagnostic.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(rename_all = "lowercase")]
pub enum Severity {
    /// The input cannot be used.
    Error,
    /// The input can be used, but is probably a mistake.
    Warning,
}

/// A note at a position.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Label {
    /// The position.
    pub span: Span,
    /// The note; may be empty.
    pub text: String,
}

/// One fault in a source: message, position and advice.
///
/// ```
/// use vibrissa_text::diagnostic::{Colour, Diagnostic, Source, Span, terminal};
/// let source = Source::new("a.yaml", "radius: -1 m\n");
/// let fault = Diagnostic::error("S0301", "the radius is negative", Span::new(8, 12), "must be more than 0 m")
///     .hint("write the radius of the circle, such as 300 mm");
/// assert!(terminal(&source, &[fault], Colour::Plain).contains("a.yaml:1:9"));
/// ```
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Diagnostic {
    /// The severity.
    pub severity: Severity,
    /// A stable code: `S0xxx` for scenarios, `P0xxx` for policies.
    pub code: &'static str,
    /// The message, in one line.
    pub message: String,
    /// The position of the fault.
    pub primary: Label,
    /// Related positions.
    pub secondary: Vec<Label>,
    /// Advice.
    pub hints: Vec<String>,
}

impl Diagnostic {
    /// An error at a position.
    #[must_use]
    pub fn error(code: &'static str, message: impl Into<String>, span: Span, label: impl Into<String>) -> Self {
        Self::new(Severity::Error, code, message.into(), Label { span, text: label.into() })
    }

    /// A warning at a position.
    #[must_use]
    pub fn warning(code: &'static str, message: impl Into<String>, span: Span, label: impl Into<String>) -> Self {
        Self::new(Severity::Warning, code, message.into(), Label { span, text: label.into() })
    }

    fn new(severity: Severity, code: &'static str, message: String, primary: Label) -> Self {
        Self { severity, code, message, primary, secondary: Vec::new(), hints: Vec::new() }
    }

    /// Adds a related position with a note.
    #[must_use]
    pub fn note(mut self, span: Span, text: impl Into<String>) -> Self {
        self.secondary.push(Label { span, text: text.into() });
        self
    }

    /// Adds a piece of advice.
    #[must_use]
    pub fn hint(mut self, text: impl Into<String>) -> Self {
        self.hints.push(text.into());
        self
    }

    /// Moves all positions by `by` bytes.
    #[must_use]
    pub fn moved(mut self, by: usize) -> Self {
        for Label { span, .. } in std::iter::once(&mut self.primary).chain(&mut self.secondary) {
            *span = Span::new(span.start + by, span.end + by);
        }
        self
    }
}
