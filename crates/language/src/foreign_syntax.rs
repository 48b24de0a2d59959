//! Constructs of other languages, with their equivalents in policies.

/// Words of other languages, with advice.
const WORDS: [(&[&str], &str); 16] = [
    (
        &["while", "loop", "until", "repeat", "break", "continue", "foreach"],
        "there are no loops: a state executes its statements in every tick; write `if condition { \u{2026} }`, or a state with the transition `when condition -> State`",
    ),
    (
        &["print", "println", "printf", "echo", "log"],
        "a policy cannot print; `vibrissa run --ticks FILE` writes the perception and the command of every tick",
    ),
    (&["elif", "elseif", "elsif"], "write `else if condition { \u{2026} }`"),
    (&["endif", "end", "fi"], "a block ends with `}`"),
    (
        &["return"],
        "a law has no result and always runs to its `}`; `let name(w: whisker) = expression` is a value with arguments",
    ),
    (
        &["def", "fn", "func", "function", "fun", "proc"],
        "write `law name(w: whisker) { \u{2026} }` for statements, or `let name(w: whisker) = expression` for a value",
    ),
    (&["goto", "goTo", "transition", "switch_to"], "write `when condition -> State`, or `after 1 s -> State`"),
    (&["switch", "match", "case"], "write `if condition { \u{2026} } else if condition { \u{2026} }`"),
    (&["wait", "sleep", "delay"], "a tick cannot wait; `after 1 s -> State` leaves the state after that time"),
    (
        &["import", "include", "require", "from"],
        "write `use \"file.fsm\"`, or `use std.swipe` for a module of the standard library",
    ),
    (
        &["mut", "const", "int", "float", "double", "bool", "auto", "local"],
        "write `let name = value` for a value, `var name = value` for memory, or `param name = 50 mm/s` for a value that a run can set; types are inferred",
    ),
    (&["pass", "noop"], "leave it out: a block may be empty"),
    (&["True", "TRUE"], "write `true`"),
    (&["False", "FALSE"], "write `false`"),
    (
        &["null", "NULL", "None", "nil", "undefined"],
        "there are no missing values; mark validity in a separate `var`: `var is_known = false`",
    ),
    (&["pi", "PI"], "write an angle with its unit: `180 deg`"),
];

/// Advice for a word of another language.
pub(super) fn advice_for(word: &str) -> Option<&'static str> {
    WORDS.iter().find(|(words, _)| words.contains(&word)).map(|&(_, advice)| advice)
}

/// Advice for a target that other languages use for a successful end.
pub(super) fn target_advice(state: &str) -> Option<&'static str> {
    ["success", "succeeded", "done", "end", "finish", "finished", "completed", "exit"].contains(&state.to_lowercase().as_str()).then_some(
        "a policy completes a run by `Success(\"reason\")`, and ends it otherwise by `Failure(\"reason\")`; `state Done { stop }` only stops \
         the platform",
    )
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::grammar::is_keyword;

    #[test]
    fn a_word_is_there_once_and_none_is_a_word_of_the_language() {
        let words: Vec<&str> = WORDS.iter().flat_map(|(words, _)| words.iter().copied()).collect();
        for (index, word) in words.iter().enumerate() {
            assert!(!is_keyword(word) && !words[..index].contains(word), "{word}");
        }
    }
}
