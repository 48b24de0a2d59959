//! What stands between two tokens: nothing, a blank, or a line end.

use super::structure::{Place, Role};
use super::token::{Kind, Token};

/// Marks that have a blank on both sides unless a rule says otherwise. Around any other mark the author's blanks stay, so that
/// two marks never become one that means something else.
const MARKS: [&str; 22] = [
    "+", "-", "*", "/", "<", ">", "<=", ">=", "==", "!=", "=", "->", "..", ",", ":", "(", ")", "{", "}", "|", "[", "]",
];

/// Whether a blank stands between two neighbours on one line.
pub(super) fn is_apart(before: &Place<'_>, place: &Place<'_>) -> bool {
    let (left, right) = (&before.token, &place.token);
    if left.kind == Kind::Comment || right.kind == Kind::Comment {
        return true;
    }
    let tight = matches!(before.role, Role::Opens | Role::Prefix)
        || place.role == Role::Closes
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

/// Whether the author may end a line between two neighbours of one statement.
pub(super) fn may_break(before: &Place<'_>, place: &Place<'_>) -> bool {
    let (left, right) = (&before.token, &place.token);
    let head = before.begins || left.text == "else" || left.is("}") || right.is("{");
    let breakable = left.is("(") || left.is("[") || right.is(")") || right.is("]") || right.is(".");
    !head && (breakable || is_apart(before, place))
}
