//! The fault itself.

use super::Span;
use serde::Serialize;

/// The most faults that are told of one source: nobody reads more, and a text can hold a hundred thousand.
pub const FAULT_LIMIT: usize = 50;

/// How bad it is.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Serialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[serde(rename_all = "lowercase")]
pub enum Severity {
    /// The input cannot be used.
    Error,
    /// The input can be used, and is probably not what was meant.
    Warning,
}

/// A note at a place.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Label {
    /// The place.
    pub span: Span,
    /// The note; may be empty.
    pub text: String,
}

/// One fault in a source: what, where, and what to do about it.
///
/// ```
/// use vibrissa::diagnostic::{Colour, Diagnostic, Source, Span, terminal};
/// let source = Source::new("a.yaml", "radius: -1 m\n");
/// let fault = Diagnostic::error("S0301", "the radius is negative", Span::new(8, 12), "must be more than 0 m")
///     .hint("write the radius of the circle, such as 300 mm");
/// assert!(terminal(&source, &[fault], Colour::Plain).contains("a.yaml:1:9"));
/// ```
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Diagnostic {
    /// How bad it is.
    pub severity: Severity,
    /// A stable code: `S0xxx` for scenarios, `P0xxx` for policies.
    pub code: &'static str,
    /// What is wrong, in one line.
    pub message: String,
    /// Where it is wrong.
    pub primary: Label,
    /// Other places that have to do with it.
    pub secondary: Vec<Label>,
    /// What to do.
    pub hints: Vec<String>,
}

impl Diagnostic {
    /// An error at a place.
    #[must_use]
    pub fn error(code: &'static str, message: impl Into<String>, span: Span, label: impl Into<String>) -> Self {
        Self::new(Severity::Error, code, message.into(), Label { span, text: label.into() })
    }

    /// A warning at a place.
    #[must_use]
    pub fn warning(code: &'static str, message: impl Into<String>, span: Span, label: impl Into<String>) -> Self {
        Self::new(Severity::Warning, code, message.into(), Label { span, text: label.into() })
    }

    fn new(severity: Severity, code: &'static str, message: String, primary: Label) -> Self {
        Self { severity, code, message, primary, secondary: Vec::new(), hints: Vec::new() }
    }

    /// The same with one more place that has to do with it.
    #[must_use]
    pub fn note(mut self, span: Span, text: impl Into<String>) -> Self {
        self.secondary.push(Label { span, text: text.into() });
        self
    }

    /// The same with one more piece of advice.
    #[must_use]
    pub fn hint(mut self, text: impl Into<String>) -> Self {
        self.hints.push(text.into());
        self
    }

    /// The same with all places `by` bytes farther on.
    #[must_use]
    pub fn moved(mut self, by: usize) -> Self {
        for Label { span, .. } in std::iter::once(&mut self.primary).chain(&mut self.secondary) {
            *span = Span::new(span.start + by, span.end + by);
        }
        self
    }
}
