//! Spacing between two tokens on a line.

use super::structure::{Element, Role};
use crate::token::{Kind, Token};

/// Marks with a blank on both sides, apart from exceptions. Around other marks the author's blanks stay, so that two
/// marks cannot become one with another meaning.
const MARKS: [&str; 22] = [
    "+", "-", "*", "/", "<", ">", "<=", ">=", "==", "!=", "=", "->", "..", ",", ":", "(", ")", "{", "}", "|", "[", "]",
];

/// True if a blank separates two neighbours on one line.
pub(super) fn is_apart(before: &Element<'_>, element: &Element<'_>) -> bool {
    let (left, right) = (&before.token, &element.token);
    if left.kind == Kind::Comment || right.kind == Kind::Comment {
        return true;
    }
    let tight = matches!(before.role, Role::Opens | Role::Prefix)
        || element.role == Role::Closes
        || right.is(",")
        || right.is(":")
        || left.is(".")
        || right.is(".")
        || (right.is("(") && before.role == Role::Operand)
        || (left.is("{") && right.is("}"));
    !tight && ((is_known(left) && is_known(right)) || right.apart)
}

fn is_known(token: &Token<'_>) -> bool {
    token.kind != Kind::Mark || MARKS.contains(&token.text)
}

/// True if the author may end a line between two neighbours of one statement.
pub(super) fn may_break(before: &Element<'_>, element: &Element<'_>) -> bool {
    let (left, right) = (&before.token, &element.token);
    let head = before.begins || left.text == "else" || left.is("}") || right.is("{");
    let breakable = left.is("(") || left.is("[") || right.is(")") || right.is("]") || right.is(".");
    !head && (breakable || is_apart(before, element))
}
