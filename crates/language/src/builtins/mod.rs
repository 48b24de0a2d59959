//! Built-in members and functions. The compiler and the reference page use the same tables.

mod function;
mod member;
#[cfg(test)]
mod reference;

pub(super) use function::{FUNCTIONS, Function, function};
pub(super) use member::{At, LIST_MEMBERS, MAP_EVENTS, Member, MemberSource, map_event_usage, members};

#[cfg(test)]
mod tests {
    use super::FUNCTIONS;
    use crate::types::{DIMENSIONS, PLAIN_TYPES};

    #[test]
    fn the_editors_grammar_lists_the_functions_and_types_of_the_language() {
        let grammar = include_str!("../../../../editors/vscode/syntaxes/fsm.tmLanguage.json");
        let list =
            |words: &mut dyn Iterator<Item = &'static str>| format!(r"\\b({})\\b", words.collect::<Vec<_>>().join("|"));
        assert!(grammar.contains(&list(&mut FUNCTIONS.iter().map(|&(name, ..)| name))));
        let types = PLAIN_TYPES.into_iter().filter(|&name| name != "whisker").chain(DIMENSIONS.map(|(name, _)| name));
        assert!(grammar.contains(&list(&mut { types })));
    }
}
