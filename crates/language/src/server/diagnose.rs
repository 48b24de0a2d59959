//! Diagnostics of a policy for the editor.

use std::fmt::Write;

use gen_lsp_types::{
    Code, Diagnostic, DiagnosticRelatedInformation, DiagnosticSeverity, DiagnosticTag, PublishDiagnosticsParams, Uri,
};

use vibrissa_text::diagnostic::{self, Severity};

use super::capabilities::Client;
use super::document::Document;

/// Warnings about unused names, which editors show faded.
const UNUSED: [&str; 4] = ["P0504", "P0505", "P0506", "P0507"];

/// All diagnostics of a document.
pub(super) fn diagnostics(uri: &Uri, document: &Document, client: Client) -> PublishDiagnosticsParams {
    let faults = document.faults.iter().filter_map(|fault| diagnostic(document, fault, client));
    PublishDiagnosticsParams { uri: uri.clone(), version: Some(document.version), diagnostics: faults.collect() }
}

/// One diagnostic. Its message contains everything that a terminal shows, one line each.
///
/// A fault in another file is shown at the `use` of that file. Returns `None` if the document no longer uses the file.
pub(super) fn diagnostic(document: &Document, fault: &diagnostic::Diagnostic, client: Client) -> Option<Diagnostic> {
    let source = document.index.source();
    let part = source.part_at(fault.primary.span.start);
    let span = if part == 0 { fault.primary.span } else { document.index.use_leading_to(part)? };
    let mut message = fault.message.clone();
    // Writing to a string cannot fail.
    if !fault.primary.text.is_empty() {
        let _ = write!(message, ": {}", fault.primary.text);
    }
    if part > 0 {
        let line = source.line_column(fault.primary.span.start).line;
        let _ = write!(message, "\nin line {line} of `{}`", source.part_name(part));
    }
    let itself = (part > 0).then_some(&fault.primary);
    let mut others = Vec::new();
    for label in itself.into_iter().chain(&fault.secondary) {
        match document.location(label.span).filter(|_| client.related) {
            Some(location) => others.push(DiagnosticRelatedInformation { location, message: label.text.clone() }),
            None if Some(label) == itself => {}
            None => {
                let (line, part) = (source.line_column(label.span.start).line, source.part_at(label.span.start));
                let file = if part == 0 { String::new() } else { format!(" of `{}`", source.part_name(part)) };
                let _ = write!(message, "\nline {line}{file}: {}", label.text);
            }
        }
    }
    for hint in &fault.hints {
        let _ = write!(message, "\nhelp: {hint}");
    }
    Some(Diagnostic {
        range: document.range(span),
        severity: Some(match fault.severity {
            Severity::Error => DiagnosticSeverity::Error,
            Severity::Warning => DiagnosticSeverity::Warning,
        }),
        code: Some(Code::String(fault.code.to_owned())),
        source: Some("vibrissa".to_owned()),
        message: message.into(),
        tags: UNUSED.contains(&fault.code).then(|| vec![DiagnosticTag::Unnecessary]),
        related_information: (!others.is_empty()).then_some(others),
        ..Default::default()
    })
}
