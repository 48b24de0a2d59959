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
mod shared;

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
    answered(body(&list(3_000, &|index| format!("when a.base_angle > {index} urad -> S"))));
    answered(
        body(&list(3_000, &|index| format!("when a.base_angle > {index} urad and time > {index} s -> T{}", index % 7)))
            + &list(7, &|index| {
                format!("state T{index} {{ when not a.touching -> S when a.touching -> T{} }}", (index + 1) % 7)
            }),
    );
    let all = |index: usize| list(60, &|other| format!("when a.base_angle > {} urad -> S{other}", index * other));
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

/// How a text of about 64 kB begins, and lines of which it has as many as fit.
fn filled(begin: &str, line: impl Fn(usize) -> String, end: &str) -> String {
    let mut text = begin.to_owned();
    for index in 0.. {
        let line = line(index);
        if text.len() + line.len() + end.len() >= 64 << 10 {
            break;
        }
        text += &line;
        text.push('\n');
    }
    text + end
}

#[test]
fn texts_whose_parts_double_with_every_line_take_little_time_and_memory() {
    let machine = "machine m whisker r0 initial A\n";
    let state = "state A { stop after 1 s -> Failure(\"late\") }";
    let list = |line: &str| (0..2500).map(|index| line.replace('#', &index.to_string())).collect::<String>();
    let chain = |base: &str, line: &dyn Fn(usize) -> String| filled(&format!("{machine}{base}\n"), line, state);
    let texts = [
        include_str!("../fixtures/policies/bad/type_bomb.fsm").to_owned(),
        include_str!("../fixtures/policies/bad/law_bomb.fsm").to_owned(),
        include_str!("../fixtures/policies/bad/monitor_endless.fsm").to_owned(),
        // Types: over an unknown one, as an argument, in a list, in reverse, around in a circle, and with more numbers than a register has.
        chain("type R0(a: Nope, b: Nope)", &|index| {
            format!("type R{}(a: R{index}, b: R{index}) state S{index}(r: R{index}) {{ }}", index + 1)
        }),
        chain("type R0(a: number)", &|index| {
            format!("type R{}(a: R{index}, b: R{index}) type L{index} = list of 16 R{index}", index + 1)
        }),
        chain("", &|index| format!("type R{index}(a: R{})", index + 1)),
        chain("type R5(a: R0)", &|index| format!("type R{index}(a: R{})", (index + 1) % 5)),
        format!(
            "{machine}type R({}) {state}",
            (0..3000).map(|index| format!("a{index}: position")).collect::<Vec<_>>().join(", ")
        ),
        // Laws, derived values and defaults over what fails.
        chain("", &|index| format!("law l{index}() {{ do l{0}() do l{0}() }}", index + 1)),
        chain("", &|index| format!("let v{index} = v{0} + v{0}", index + 1)),
        chain("let v0(x: number = nope) = x", &|index| {
            format!("let v{}(x: number = v{index}() + v{index}()) = x", index + 1)
        }),
        chain("type R0(x: number = nope)", &|index| {
            format!("type R{}(x: number = R{index}().x + R{index}().x)", index + 1)
        }),
        // Monitors as arguments.
        chain("monitor m0(x: number) { }", &|index| {
            format!("monitor m{}(p: m{index}, q: m{index}) {{ }} law l{index}(m: m{index}) {{ }}", index + 1)
        }),
        chain("monitor m0(x: number) { }", &|index| format!("monitor m{}(p: m{index}) {{ }}", index + 1)),
        // Behaviours: wide and deep, and each of them alone.
        chain("behaviour b0 { initial S state S { } }", &|index| {
            let states = (0..30).map(|place| format!("state S{place} is b{} {{ }}", index.min(2))).collect::<Vec<_>>();
            format!("behaviour b{} {{ initial S0 {} }}", index + 1, states.join(" "))
        }),
        // Conditions whose parts are arguments.
        chain("let t0(x: bool) = x and x", &|index| format!("let t{}(x: bool) = t0(t{index}(x))", index + 1))
            + " never t90(time > 1 s)",
        // Many choices, each in many parameters; much memory in many states; much memory and many values.
        {
            let choices = (0..3000).map(|index| format!("e{index}")).collect::<Vec<_>>().join(" or ");
            chain(&format!("type E = {choices}"), &|index| format!("param p{index} = E.e1"))
        },
        format!("{machine}{}{}{state}", list("var a# = 1\n"), list("state S# { }\n")),
        format!("{machine}{}state A {{ stop\n{}}}", list("var a# = 1\n"), list("let b# = 1\n")),
        format!("{machine}{}state A {{ stop\n{}}}", list("var a# = 1\n"), list("let b# = a1\n")),
        format!("{machine}{}state A {{ stop\n{}}}", list("var a# = 1\n"), list("set a# = 1\n")),
    ];
    for text in texts {
        let worker = thread::Builder::new().stack_size(STACK).spawn(move || {
            let start = campaign::worked();
            let ((), peak) = allocator::peak(|| {
                is_answered(&text);
            });
            (campaign::worked().saturating_sub(start), peak, text)
        });
        let (time, peak, text) = worker.unwrap().join().unwrap();
        let begin: String = text.chars().take(300).collect();
        assert!(time < campaign::MOST_SHARED_TIME, "{time:?}: {begin}");
        assert!(peak < campaign::MOST_MEMORY, "{peak} bytes: {begin}");
    }
}
