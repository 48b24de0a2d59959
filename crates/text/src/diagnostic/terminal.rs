//! Diagnostics for a terminal.

use super::printable::same_length;
use super::{Diagnostic, Label, Severity, Source, printable};
use annotate_snippets::{AnnotationKind, Level, Renderer, Snippet};

/// The choice between plain text and terminal colours.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Colour {
    /// Plain text.
    #[default]
    Plain,
    /// ANSI escape sequences.
    Ansi,
}

/// Renders diagnostics, each with its message, its position, the line with its label, and the advice. The text ends
/// with a newline unless there are no diagnostics.
///
/// Control characters are replaced: by their codes in messages, and by other characters in lines of the source.
#[must_use]
pub fn terminal(source: &Source, diagnostics: &[Diagnostic], colour: Colour) -> String {
    let renderer = match colour {
        Colour::Plain => Renderer::plain(),
        Colour::Ansi => Renderer::styled(),
    };
    let rendered: Vec<String> = diagnostics.iter().map(|diagnostic| render(source, diagnostic, &renderer)).collect();
    rendered.join("\n")
}

fn render(source: &Source, diagnostic: &Diagnostic, renderer: &Renderer) -> String {
    let level = match diagnostic.severity {
        Severity::Error => Level::ERROR,
        Severity::Warning => Level::WARNING,
    };
    let mut labels = vec![(AnnotationKind::Primary, &diagnostic.primary)];
    labels.extend(diagnostic.secondary.iter().map(|label| (AnnotationKind::Context, label)));
    let part = |label: &Label| source.part_at(source.clamp(label.span).start);
    // The part with the fault comes first, then the parts with related positions.
    let mut parts: Vec<usize> = Vec::new();
    for part in labels.iter().map(|(_, label)| part(label)) {
        if !parts.contains(&part) {
            parts.push(part);
        }
    }
    let snippets = parts.iter().map(|&index| {
        let within = source.part_span(index);
        let of_part = labels.iter().filter(|(_, label)| part(label) == index);
        let annotations = of_part.map(|(kind, label)| {
            let span = source.clamp(label.span);
            kind.span(span.start - within.start..span.end - within.start).label(printable(&label.text).into_owned())
        });
        Snippet::source(same_length(source.slice(within)))
            .path(printable(source.part_name(index)))
            .annotations(annotations)
    });
    let group = level
        .primary_title(printable(&diagnostic.message))
        .id(diagnostic.code)
        .elements(snippets)
        .elements(diagnostic.hints.iter().map(|hint| Level::HELP.message(printable(hint))));
    renderer.render(&[group]) + "\n"
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::diagnostic::Span;
    use proptest::prelude::*;

    #[test]
    fn the_line_is_shown_with_its_label_and_the_hint() {
        let source = Source::new("disk.yaml", "object:\n  circle: {radius: -1 m}\n");
        let fault = Diagnostic::error("S0301", "the radius is negative", Span::new(27, 31), "must be more than 0 m")
            .note(Span::new(10, 16), "of this circle")
            .hint("write the radius, such as 300 mm");
        let expected = "\
error[S0301]: the radius is negative
 --> disk.yaml:2:20
  |
2 |   circle: {radius: -1 m}
  |   ------           ^^^^ must be more than 0 m
  |   |
  |   of this circle
  |
  = help: write the radius, such as 300 mm
";
        assert_eq!(terminal(&source, &[fault], Colour::Plain), expected);
    }

    #[test]
    fn places_in_parts_are_shown_with_the_names_and_lines_of_these() {
        let mut source = Source::new("a.fsm", "machine a\nuse \"b.fsm\"\n");
        source.add("b.fsm", Ok("library b\n\nlet x = 1 m\n"));
        let start = source.part_span(1).start;
        let fault = Diagnostic::error("P0000", "clash", Span::new(14, 21), "used here")
            .note(Span::new(start + 15, start + 16), "made here")
            .note(Span::new(8, 9), "in this machine");
        let expected = "\
error[P0000]: clash
 --> a.fsm:2:5
  |
1 | machine a
  |         - in this machine
2 | use \"b.fsm\"
  |     ^^^^^^^ used here
  |
 ::: b.fsm:3:5
  |
3 | let x = 1 m
  |     - made here
";
        assert_eq!(terminal(&source, &[fault], Colour::Plain), expected);
    }

    #[test]
    fn colour_is_only_there_when_asked_for() {
        let source = Source::new("a", "b");
        let fault = [Diagnostic::warning("S0000", "m", Span::new(0, 1), "l")];
        assert!(terminal(&source, &fault, Colour::Ansi).contains('\u{1b}'));
        assert!(!terminal(&source, &fault, Colour::Plain).contains('\u{1b}'));
    }

    #[test]
    fn nothing_that_is_quoted_reaches_the_terminal_as_an_order() {
        let evil = "a\u{1b}]0;x\u{7}\u{9b}31m\u{202e}b";
        let source = Source::new(evil, format!("# {evil}\nlet {evil}\n"));
        let fault = Diagnostic::error("S0000", evil, Span::new(2, 6), evil).note(Span::new(24, 26), evil).hint(evil);
        let shown = terminal(&source, &[fault], Colour::Plain);
        assert!(!shown.contains(['\u{1b}', '\u{7}', '\u{9b}', '\u{202e}']), "{shown:?}");
        assert!(shown.contains("a\\u{1b}]0;x\\u{7}\\u{9b}31m\\u{202e}b"), "{shown}");
    }

    proptest! {
        #[test]
        fn any_span_of_any_text_can_be_rendered(text in "(\\PC|\n|\r|\t){0,40}", start in 0_usize..60, end in 0_usize..60) {
            let fault = Diagnostic::error("S0000", "m", Span { start, end }, "l").note(Span { start: end, end: start }, "n");
            let _ = terminal(&Source::new("a", text), &[fault], Colour::Plain);
        }
    }
}
