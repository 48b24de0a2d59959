//! The examples of the pages about the language are policies.

use vibrissa_language::compile;
use vibrissa_text::diagnostic::{Colour, Source, terminal};

/// The pages with examples in the language, one after the other.
pub(crate) const PAGES: &str = concat!(
    include_str!("../../docs/language.md"),
    include_str!("../../docs/language-semantics.md"),
    include_str!("../../docs/perception.md"),
    include_str!("../../docs/metrics.md"),
);

#[test]
fn every_example_of_the_pages_compiles() {
    let examples: Vec<&str> =
        PAGES.split("```fsm\n").skip(1).map(|behind| behind.split("```").next().unwrap()).collect();
    assert!(examples.len() >= 3);
    for example in examples {
        // What is no machine by itself is some of a machine's items.
        let text = if example.starts_with("machine") {
            example.to_owned()
        } else {
            format!("machine example whisker bound {example} initial Still state Still {{ stop }}")
        };
        let source = Source::new("language.md", text);
        compile(&source).unwrap_or_else(|faults| panic!("{}", terminal(&source, &faults, Colour::Plain)));
    }
}
