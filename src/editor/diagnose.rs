//! Faults and warnings of a policy, for the editor.

use std::fmt::Write;

use gen_lsp_types::{
    Code, Diagnostic, DiagnosticRelatedInformation, DiagnosticSeverity, DiagnosticTag, Location,
    PublishDiagnosticsParams, Uri,
};

use crate::diagnostic::{self, Severity};

use super::capabilities::Client;
use super::document::Document;

/// Warnings of what nothing uses, which editors show faded.
const UNUSED: [&str; 4] = ["P0504", "P0505", "P0506", "P0507"];

/// All that is wrong with a document.
pub(super) fn diagnostics(uri: &Uri, document: &Document, client: Client) -> PublishDiagnosticsParams {
    let faults = document.faults.iter().map(|fault| diagnostic(uri, document, fault, client));
    PublishDiagnosticsParams { uri: uri.clone(), version: Some(document.version), diagnostics: faults.collect() }
}

/// One fault. What a terminal shows below the message stands in it, a line each.
pub(super) fn diagnostic(uri: &Uri, document: &Document, fault: &diagnostic::Diagnostic, client: Client) -> Diagnostic {
    let mut message = fault.message.clone();
    // Writing to a string cannot fail.
    if !fault.primary.text.is_empty() {
        let _ = write!(message, ": {}", fault.primary.text);
    }
    let others = fault.secondary.iter().map(|label| DiagnosticRelatedInformation {
        location: Location { uri: uri.clone(), range: document.range(label.span) },
        message: label.text.clone(),
    });
    let others: Vec<DiagnosticRelatedInformation> = others.collect();
    if !client.related {
        for other in &others {
            let _ = write!(message, "\nline {}: {}", u64::from(other.location.range.start.line) + 1, other.message);
        }
    }
    for hint in &fault.hints {
        let _ = write!(message, "\nhelp: {hint}");
    }
    Diagnostic {
        range: document.range(fault.primary.span),
        severity: Some(match fault.severity {
            Severity::Error => DiagnosticSeverity::Error,
            Severity::Warning => DiagnosticSeverity::Warning,
        }),
        code: Some(Code::String(fault.code.to_owned())),
        source: Some("vibrissa".to_owned()),
        message: message.into(),
        tags: UNUSED.contains(&fault.code).then(|| vec![DiagnosticTag::Unnecessary]),
        related_information: (client.related && !others.is_empty()).then_some(others),
        ..Default::default()
    }
}
