//! No text makes the compiler panic, exhaust a small stack, or go on for ever; each either compiles or is answered.
#![allow(clippy::unwrap_used, reason = "a test may panic")]
#![allow(clippy::disallowed_methods, reason = "a test may open files")]

#[path = "../common/allocator.rs"]
mod allocator;
mod answered;
mod campaign;
mod determinism;
#[path = "../policy/machine/artifact/erratic.rs"]
mod erratic;
mod generate;
mod mutate;
mod random;

use std::thread;

use answered::{is_answered, is_answered_the_same};
use proptest::prelude::*;
use vibrissa::diagnostic::Source;
use vibrissa::policy::compile;

const THESIS: &str = include_str!("../../policies/thesis.fsm");
/// A policy that only swipes: small enough to be broken thousands of times. The campaign breaks the others, `thesis.fsm` too.
const SWIPING: &str = include_str!("../fixtures/editor/thesis.fsm");
/// The stack (bytes) of a thread of Rust's that asks for no other.
const STACK: usize = 2 << 20;

/// Words and signs of the language, and some that it does not have.
const TOKENS: [&str; 117] = [
    "behaviour",
    "monitor",
    "is",
    "on",
    "var",
    "set",
    "entry",
    "exit",
    "resume",
    "\n----\n",
    "\"0.fsm\"",
    "std.guards",
    "contour",
    "ready",
    "failed",
    "of",
    "use",
    "library",
    "std",
    "swipe",
    "test",
    "expect",
    "run",
    "resume",
    "failsafe",
    "mark",
    "lost",
    "found",
    "machine",
    "whisker",
    "needs",
    "control_rate",
    "sample_age",
    "30 Hz",
    "param",
    "type",
    "Side",
    "left",
    "initial",
    "let",
    "law",
    "state",
    "always",
    "when",
    "after",
    "for",
    "in",
    "of",
    "if",
    "then",
    "else",
    "do",
    "record",
    "steer",
    "along",
    "at",
    "facing",
    "turning",
    "hold",
    "stop",
    "body",
    "and",
    "or",
    "not",
    "true",
    "false",
    "a",
    "b",
    "S",
    "T",
    "w",
    "Failure",
    "Success",
    "contour",
    "points",
    "apart",
    "time",
    "abs",
    "clamp",
    "unit",
    "vector",
    "position",
    "direction",
    "list of 3",
    "with",
    "length",
    "number",
    "tip_at",
    "touching",
    "yaw",
    "blocked",
    "1",
    "0.5",
    "3 mm",
    "2 deg/s",
    "1e9",
    "\"why\"",
    "\"",
    "(",
    ")",
    "{",
    "}",
    "|",
    ",",
    ":",
    ".",
    "..",
    "=",
    "==",
    "->",
    "-",
    "+",
    "*",
    "/",
    "<",
    "#",
    "\u{b5}",
];

fn slice(text: &str, start: usize, length: usize) -> &str {
    &text[start.min(text.len())..(start + length).min(text.len())]
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(2000))]

    #[test]
    fn any_text_is_answered(text in "(\\PC|\n|\t| ){0,80}") {
        is_answered(&text);
        is_answered(&format!("machine m {text}"));
    }

    #[test]
    fn any_soup_of_tokens_is_answered(tokens in prop::collection::vec(0..TOKENS.len(), 0..60)) {
        let soup: Vec<&str> = tokens.into_iter().map(|index| TOKENS[index]).collect();
        is_answered(&soup.join(" "));
        is_answered(&format!("machine m whisker w initial S let a = {}", soup.join(" ")));
        is_answered(&format!("machine m whisker w initial S state S {{ {}", soup.concat()));
    }

    #[test]
    fn any_mutation_of_a_good_policy_is_answered(
        (start, length, other, other_length) in (0..SWIPING.len(), 0_usize..40, 0..SWIPING.len(), 0_usize..40),
        insert in "[-a-z0-9:{}()|\"#*/.,<>= \n\u{b5}]{0,6}",
    ) {
        prop_assert!(SWIPING.is_ascii());
        let (cut, piece) = (slice(SWIPING, start, length), slice(SWIPING, other, other_length));
        let (before, behind) = (&SWIPING[..start], &SWIPING[start + cut.len()..]);
        is_answered(&format!("{before}{behind}"));
        is_answered(&format!("{before}{cut}{cut}{behind}"));
        is_answered(&format!("{before}{insert}{behind}"));
        is_answered(&format!("{before}{piece}{behind}"));
    }

    #[test]
    fn any_word_in_the_place_of_another_is_answered(at in any::<prop::sample::Index>(), token in 0..TOKENS.len()) {
        let words: Vec<&str> = SWIPING.split_inclusive(char::is_whitespace).collect();
        let at = at.index(words.len());
        is_answered_the_same(&[&words[..at], &[TOKENS[token], " "], &words[at + 1..]].concat().concat());
    }
}

/// Compiles a text in a thread with a small stack, and gives the codes of its faults.
fn codes_on_a_small_stack(text: String) -> Vec<&'static str> {
    let worker = thread::Builder::new().stack_size(STACK).spawn(move || {
        is_answered(&text);
        compile(&Source::new("policy.fsm", text)).err().unwrap_or_default().iter().map(|fault| fault.code).collect()
    });
    worker.unwrap().join().unwrap()
}

fn expression(text: &str) -> String {
    format!("machine m whisker a initial S let v = {text} state S {{ stop }}")
}

fn body(text: &str) -> String {
    format!("machine m whisker a initial S state S {{ {text} }}")
}

#[test]
fn nesting_up_to_the_limit_compiles_on_a_small_stack() {
    let deep =
        |open: &str, inside: &str, close: &str, depth| format!("{}{inside}{}", open.repeat(depth), close.repeat(depth));
    let none: [&str; 0] = [];
    assert_eq!(codes_on_a_small_stack(expression(&deep("(", "1", ")", 63))), none);
    assert_eq!(codes_on_a_small_stack(expression(&deep("|1 + ", "1", "|", 63))), none);
    assert_eq!(codes_on_a_small_stack(expression(&deep("-abs(1 + ", "1", ")", 63))), none);
    assert_eq!(codes_on_a_small_stack(expression(&deep("max(1 - 2 * ", "1", ", 3)", 60))), none);
    assert_eq!(codes_on_a_small_stack(body(&deep("if true { ", "hold", " } else { stop }", 62))), none);
    assert_eq!(codes_on_a_small_stack(body(&deep("if not a.touching { } else { ", "hold", " }", 62))), none);
    assert_eq!(codes_on_a_small_stack(expression(&vec!["1"; 190].join(" + "))), none);
    assert_eq!(codes_on_a_small_stack(expression(&deep("- - -(", "1", ")", 60))), none);
    let laws: Vec<String> = (1..240).map(|index| format!("law l{index}() {{ do l{}() }}", index - 1)).collect();
    assert_eq!(
        codes_on_a_small_stack(format!(
            "machine m initial S law l0() {{ }} {} state S {{ do l239() }}",
            laws.join(" ")
        )),
        none
    );
    let chain: Vec<String> = (1..80).map(|index| format!("let v{index}(x: number) = 1 + v{}(x)", index - 1)).collect();
    assert_eq!(
        codes_on_a_small_stack(format!("machine m initial S let v0(x: number) = x {} state S {{ }}", chain.join(" "))),
        none
    );
}

#[test]
fn nesting_without_end_is_answered_on_a_small_stack() {
    for unit in [
        "(",
        "|",
        "-",
        "- ",
        "not ",
        "-(",
        "not (",
        "abs(",
        "|1 + ",
        "a.",
        "a(",
        "1 + (",
        "{",
        "[",
        "\"",
        "(|",
        "-|",
        "a.tip_at(",
    ] {
        for count in [5, 100, 5000, 60_000] {
            let nested = unit.repeat(count);
            if nested.len() < 250_000 {
                assert_ne!(codes_on_a_small_stack(expression(&nested)), [""; 0], "{unit}");
            }
        }
    }
    for unit in ["if true { ", "if a.touching { } else { ", "when true -> S(", "do l(", "steer a along ", "if "] {
        for count in [5, 100, 5000] {
            assert_ne!(codes_on_a_small_stack(body(&unit.repeat(count))), [""; 0], "{unit}");
        }
    }
}

#[test]
fn long_chains_are_answered_on_a_small_stack() {
    assert_eq!(codes_on_a_small_stack(expression(&vec!["1"; 60_000].join("+"))), ["P0104"]);
    assert_eq!(codes_on_a_small_stack(expression(&vec!["true"; 25_000].join(" and "))), ["P0104"]);
    assert_eq!(codes_on_a_small_stack(expression(&format!("a{}", ".a".repeat(100_000)))), ["P0104"]);
    let branches = " else if true { hold }".repeat(10_000);
    assert_eq!(codes_on_a_small_stack(body(&format!("if true {{ }} {branches}"))), [""; 0]);
    assert_eq!(codes_on_a_small_stack(body(&"when true for 1 s -> S ".repeat(10_000))), [""; 0]);
    assert_eq!(codes_on_a_small_stack(expression(&format!("max({})", vec!["1"; 60_000].join(", ")))), ["P0304"]);
}

#[test]
fn large_texts_and_texts_that_double_with_every_line_are_answered() {
    let list = |count: usize, item: &dyn Fn(usize) -> String| (0..count).map(item).collect::<Vec<_>>().join("\n");
    let answered = |text: String| {
        codes_on_a_small_stack(text);
    };
    answered(body(&list(12_000, &|index| format!("let x{index} = {index}"))));
    answered(body(&list(8_000, &|index| format!("let x{index} = y{index}"))));
    answered(body(&list(8_000, &|index| format!("when nothing{index} -> S"))));
    answered(body(&list(8_000, &|index| format!("when true -> S{index}"))));
    answered(format!("machine m initial S {}", list(12_000, &|index| format!("param p{index} = {index}"))));
    answered(format!("machine m initial S {}", list(8_000, &|index| format!("state S{index} {{ stop }}"))));
    answered(format!("machine m initial S {}", list(5_000, &|index| format!("let v{} = v{index}", index + 1))));
    answered(format!(
        "machine m initial S {}",
        list(5_000, &|index| format!("law l{}() {{ do l{index}() }}", index + 1))
    ));
    answered(format!(
        "machine m initial S {}",
        list(3_000, &|index| format!("let v{} = v{index} + v{index}", index + 1))
    ));
    answered(body(&list(3_000, &|index| format!("when a.deflection > {index} urad -> S"))));
    answered(
        body(&list(3_000, &|index| format!("when a.deflection > {index} urad and time > {index} s -> T{}", index % 7)))
            + &list(7, &|index| {
                format!("state T{index} {{ when not a.touching -> S when a.touching -> T{} }}", (index + 1) % 7)
            }),
    );
    let all = |index: usize| list(60, &|other| format!("when a.deflection > {} urad -> S{other}", index * other));
    answered(format!(
        "machine m whisker a initial S0 {}",
        list(60, &|index| format!("state S{index} {{ {} }}", all(index)))
    ));
    let name = "n".repeat(100_000);
    answered(format!("machine m initial S let {name} = 1 let other = {name}x"));
    answered(format!("machine m initial S let a = 1 {name}"));
    answered(format!("machine m initial S let a = {}", "9".repeat(200_000)));
    answered(format!("machine m initial S let a = 1 m{}", "*m".repeat(100_000)));
    answered(format!("machine m initial S let a = 1 {}", "#".repeat(200_000)));
    answered(format!("machine m initial S {}", "\u{1F980}".repeat(60_000)));
    let doubling = list(40, &|index| format!("law l{}(x: number) {{ do l{index}(x + x) do l{index}(x) }}", index + 1));
    answered(format!("machine m initial S law l0(x: number) {{ }} {doubling} state S {{ do l40(1) }}"));
}
