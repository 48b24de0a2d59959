//! First bytes of statements and items. Tokens alone do not determine them.

use pest::iterators::Pairs;

use crate::grammar::Rule;

/// The first bytes of all items of a file and of all elements in its braces, in ascending order.
///
/// Every element that the grammar has between an opening and a closing brace counts. Therefore this code names no
/// construct.
pub(super) fn starts(pairs: Pairs<'_, Rule>) -> Vec<usize> {
    let mut starts = Vec::new();
    for pair in pairs.flatten() {
        let mut inside = pair.as_rule() == Rule::file;
        for part in pair.into_inner() {
            match part.as_rule() {
                Rule::open_brace => inside = true,
                Rule::close_brace => inside = false,
                _ if inside => starts.push(part.as_span().start()),
                _ => {}
            }
        }
    }
    starts.sort_unstable();
    starts
}
