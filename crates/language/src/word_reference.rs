//! The words of the reference page, generated from the table of words.

use std::fmt::Write;

use super::word::{Position, Word};
use super::words::WORDS;

const INTRODUCTION: &str = "
## Words

Every word with the positions in which it is allowed, its notation and its meaning. Names and values in a notation stand for \
your own. [Semantics](language-semantics.md) has the rules that concern several words.
";

/// The sections of the words, each with the positions of its words. The last position of a word decides its section.
const SECTIONS: [(&str, &[Position]); 7] = [
    ("Items", &[Position::File, Position::Item, Position::Library, Position::Type]),
    ("States and transitions", &[Position::State, Position::Target]),
    ("Statements and commands", &[Position::Statement]),
    ("Parts of items and statements", &[Position::Inside, Position::Mark, Position::Need, Position::Property]),
    ("Values", &[Position::Value, Position::Run]),
    ("Contact estimators", &[Position::TipModel]),
    ("Tests and properties", &[Position::Test]),
];

/// Appends the section with all words to the reference page.
pub(crate) fn words(page: &mut String) {
    *page += INTRODUCTION;
    for (title, positions) in SECTIONS {
        let _ = write!(page, "\n### {title}\n\n| word | allowed | notation | meaning |\n|---|---|---|---|\n");
        for word in WORDS.iter().filter(|word| word.positions().last().is_some_and(|last| positions.contains(last))) {
            let allowed = word.positions().iter().map(|&position| place(position)).collect::<Vec<_>>().join(", ");
            let _ = writeln!(page, "| `{}` | {allowed} | `{}` | {} |", word.text, notation(word), word.meaning);
        }
    }
}

/// The notation of a word on one line.
fn notation(word: &Word) -> String {
    word.usage().split_whitespace().collect::<Vec<_>>().join(" ")
}

/// A position in words.
fn place(position: Position) -> &'static str {
    match position {
        Position::File => "at the beginning of a file",
        Position::Item => "outside of braces",
        Position::Library => "in a library",
        Position::State => "in a state",
        Position::Test => "in a test or a property",
        Position::Statement => "in any braces",
        Position::Inside => "within a statement",
        Position::Value => "at a value",
        Position::Run => "at a value in a test",
        Position::Target => "at a target",
        Position::Mark => "after `mark`",
        Position::Need => "after `needs`",
        Position::TipModel => "after `by`",
        Position::Property => "after the title of a property",
        Position::Type => "after the `=` of a type",
    }
}

#[test]
fn every_word_is_in_one_section() {
    let mut page = String::new();
    words(&mut page);
    let rows = page.lines().filter(|line| line.starts_with("| `"));
    assert_eq!(rows.count(), WORDS.len());
}
