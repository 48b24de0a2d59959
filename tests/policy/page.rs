//! The examples of the language's page are policies.

use vibrissa_language::compile;
use vibrissa_text::diagnostic::{Colour, Source, terminal};

const PAGE: &str = include_str!("../../docs/language.md");

#[test]
fn every_example_of_the_page_compiles() {
    let examples: Vec<&str> =
        PAGE.split("```fsm\n").skip(1).map(|behind| behind.split("```").next().unwrap()).collect();
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
