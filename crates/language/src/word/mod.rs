//! A word of the language: allowed positions, notation, meaning.

mod class;
mod position;

pub(super) use class::{Class, Role};
pub(super) use position::Position;

use crate::index::Expected;

/// A word of the language.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct Word {
    pub(crate) text: &'static str,
    class: Class,
    /// The text to insert, with placeholders `${1:…}`.
    pub(crate) snippet: &'static str,
    pub(crate) meaning: &'static str,
}

impl Word {
    pub(crate) const fn new(text: &'static str, class: Class, snippet: &'static str, meaning: &'static str) -> Self {
        Self { text, class, snippet, meaning }
    }

    /// The role of the word.
    pub(crate) fn role(&self) -> Role {
        self.class.role
    }

    /// Where the word is allowed.
    pub(crate) fn positions(&self) -> &'static [Position] {
        self.class.positions
    }

    pub(crate) fn is_at(&self, position: Position) -> bool {
        self.positions().contains(&position)
    }

    /// True if the word is allowed in this position only.
    pub(crate) fn is_only_at(&self, position: Position) -> bool {
        self.class.positions == [position]
    }

    /// What follows the word. `None` if the word may end a statement.
    pub(crate) fn next(&self) -> Option<Expected> {
        self.class.next
    }

    /// True if a statement, a transition or an item begins with the word.
    pub(crate) fn begins(&self) -> bool {
        self.begins_item() || self.begins_part() || self.is_at(Position::Statement)
    }

    /// True if an item begins with the word.
    pub(crate) fn begins_item(&self) -> bool {
        self.class.role == Role::Declaration && (self.is_at(Position::File) || self.is_at(Position::Item))
    }

    /// True if a statement other than a declaration begins with the word.
    pub(crate) fn begins_statement(&self) -> bool {
        self.class.role != Role::Declaration && self.is_at(Position::Statement)
    }

    /// True if a part of a state or a test begins with the word.
    pub(crate) fn begins_part(&self) -> bool {
        self.is_at(Position::State) || self.is_at(Position::Test)
    }

    /// True if the word can begin a continuation line.
    pub(crate) fn continues(&self) -> bool {
        self.is_at(Position::Inside) || self.is_at(Position::Value)
    }

    /// True if the word is a value by itself.
    pub(crate) fn is_value(&self) -> bool {
        self.is_at(Position::Value) && self.next().is_none()
    }

    /// True if the word is an operator.
    pub(crate) fn is_operator(&self) -> bool {
        self.class.role == Role::Operator
    }

    /// The notation: the snippet without its placeholders' marks.
    pub(crate) fn usage(&self) -> String {
        let mut usage = String::new();
        for (index, part) in self.snippet.split("${").enumerate() {
            match part.split_once('}').filter(|_| index > 0) {
                Some((field, rest)) => {
                    usage += field.split_once(':').map_or("\u{2026}", |(_, name)| name);
                    usage += rest;
                }
                None => usage += part,
            }
        }
        usage
    }
}

#[cfg(test)]
mod tests {
    use super::Word;
    use crate::words::word;

    #[test]
    fn the_usage_of_a_word_is_its_snippet_in_plain_text() {
        let usage = |text| word(text).map(Word::usage);
        assert_eq!(usage("do").as_deref(), Some("do law(w)"));
        assert_eq!(usage("hold").as_deref(), Some("hold"));
        assert_eq!(usage("if").as_deref(), Some("if condition {\n  \u{2026}\n}"));
    }
}
