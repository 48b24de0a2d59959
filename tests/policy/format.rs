//! The formatter changes how a policy looks and nothing else.

use std::path::{Path, PathBuf};
use std::sync::LazyLock;

use crate::snapshots::snapshots;
use proptest::prelude::*;
use vibrissa_language::{compile, format};
use vibrissa_runtime::machine::Program;
use vibrissa_text::diagnostic::{Colour, Source, terminal};

const ROOT: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../..");

fn formatted(text: &str) -> String {
    let source = Source::new("policy.fsm", text);
    format(&source).unwrap_or_else(|faults| panic!("{}", terminal(&source, &faults, Colour::Plain)))
}

/// What items look like, laid out.
fn items(text: &str) -> String {
    formatted(&format!("machine m\n{text}")).strip_prefix("machine m\n").unwrap().to_owned()
}

fn files(directory: &Path) -> Vec<PathBuf> {
    let entries = std::fs::read_dir(directory).unwrap().map(|entry| entry.unwrap().path());
    let (directories, files): (Vec<_>, Vec<_>) = entries.partition(|path| path.is_dir());
    let deeper = directories.iter().flat_map(|directory| self::files(directory));
    files.into_iter().chain(deeper).filter(|path| path.extension().is_some_and(|ending| ending == "fsm")).collect()
}

/// All policies that can be read, good or at fault.
static POLICIES: LazyLock<Vec<String>> = LazyLock::new(|| {
    let paths = [files(&Path::new(ROOT).join("policies")), files(&Path::new(ROOT).join("tests/fixtures/policies"))];
    let texts = paths.concat().into_iter().map(|path| std::fs::read_to_string(path).unwrap());
    texts.filter(|text| format(&Source::new("policy.fsm", text)).is_ok()).collect()
});

/// A stretch of a text, as blanks, comments and texts divide it.
#[derive(Debug, Clone, Copy)]
enum Stretch<'t> {
    Blank(&'t str),
    Comment(&'t str),
    Text(&'t str),
    Rest(char),
}

fn stretches(mut text: &str) -> Vec<Stretch<'_>> {
    let mut stretches = Vec::new();
    while let Some(first) = text.chars().next() {
        let until = |end: &dyn Fn(char) -> bool| text[1..].find(end).map_or(text.len(), |end| end + 1);
        let (stretch, length) = match first {
            ' ' | '\t' | '\r' | '\n' => {
                let length = until(&|letter| ![' ', '\t', '\r', '\n'].contains(&letter));
                (Stretch::Blank(&text[..length]), length)
            }
            '#' => {
                let length = until(&|letter| letter == '\n');
                (Stretch::Comment(&text[..length]), length)
            }
            '"' => {
                let length = (until(&|letter| letter == '"') + 1).min(text.len());
                (Stretch::Text(&text[..length]), length)
            }
            _ => (Stretch::Rest(first), first.len_utf8()),
        };
        stretches.push(stretch);
        text = &text[length..];
    }
    stretches
}

/// All that a text says: everything but the blanks between words and those at the ends of comments.
fn content(text: &str) -> String {
    let content = stretches(text).into_iter().map(|stretch| match stretch {
        Stretch::Blank(_) => String::new(),
        Stretch::Comment(comment) => format!("{}\n", comment.trim_end()),
        Stretch::Text(text) => text.to_owned(),
        Stretch::Rest(letter) => letter.to_string(),
    });
    content.collect()
}

fn machine(text: &str) -> Option<Program> {
    compile(&Source::new("policy.fsm", text)).ok()
}

/// The properties that hold of every text which can be read.
fn is_laid_out_faithfully(text: &str) {
    let once = formatted(text);
    assert_eq!(formatted(&once), once, "formatting twice is formatting once, of:\n{text}");
    assert_eq!(content(&once), content(text));
    assert!(machine(&once) == machine(text), "the machine changes, of:\n{text}");
    assert!(once.ends_with('\n') && !once.ends_with("\n\n") && !once.starts_with('\n'), "{once}");
    assert!(once.lines().all(|line| line == line.trim_end()), "{once}");
    assert!(!once.contains("\n\n\n"), "{once}");
}

#[test]
fn policies_are_formatted() {
    for path in files(&Path::new(ROOT).join("policies")) {
        let text = std::fs::read_to_string(&path).unwrap();
        assert_eq!(text, formatted(&text), "run `vibrissa fmt {}`", path.display());
    }
}

#[test]
fn the_examples_of_the_documentation_are_formatted() {
    let pages = [
        "README.md",
        "docs/language.md",
        "docs/language-semantics.md",
        "docs/perception.md",
        "docs/metrics.md",
        "docs/tutorial.md",
    ];
    for page in pages {
        let page = std::fs::read_to_string(Path::new(ROOT).join(page)).unwrap();
        for example in page.split("```fsm\n").skip(1).map(|behind| behind.split("```").next().unwrap()) {
            // What is no machine by itself is some of a machine's items.
            let head = if example.starts_with("machine") { "" } else { "machine m\n\n" };
            let text = format!("{head}{example}");
            assert_eq!(text, formatted(&text));
        }
    }
}

#[test]
fn an_ugly_policy_becomes_as_reviewed() {
    let text = include_str!("../fixtures/policies/format/ugly.fsm");
    assert!(machine(text).is_some());
    snapshots("policies").bind(|| insta::assert_snapshot!("formatted", formatted(text)));
}

#[test]
fn every_policy_is_laid_out_faithfully() {
    assert!(POLICIES.len() >= 20);
    for text in &*POLICIES {
        is_laid_out_faithfully(text);
    }
}

#[test]
fn a_text_that_cannot_be_read_is_refused_with_its_faults() {
    let faults = format(&Source::new("policy.fsm", "machine m state S {")).unwrap_err();
    assert_eq!(faults.iter().map(|fault| fault.code).collect::<Vec<_>>(), ["P0101"]);
}

#[test]
fn a_text_that_would_become_too_long_to_be_read_is_refused() {
    let nested = format!("{}hold{}", "if a { ".repeat(60), " }".repeat(60));
    let states: Vec<String> = (0..200).map(|index| format!("state S{index} {{ {nested} }}")).collect();
    let source = Source::new("policy.fsm", format!("machine m\n{}\n", states.join("\n")));
    let faults = format(&source).unwrap_err();
    assert_eq!(faults.iter().map(|fault| fault.code).collect::<Vec<_>>(), ["P0102"]);
    snapshots("policies")
        .bind(|| insta::assert_snapshot!("laid_out_too_long", terminal(&source, &faults, Colour::Plain)));
}

#[test]
fn a_block_on_one_line_stays_there_as_long_as_it_fits() {
    assert_eq!(items("state S{stop when a->T}"), "state S { stop when a -> T }\n");
    assert_eq!(items("state S{}"), "state S {}\n");
    let name = "n".repeat(75);
    let fits = format!("state {name} {{ stop hold }}\n");
    assert_eq!(fits.len(), 96);
    assert_eq!(items(&fits), fits);
    let wide = format!("state {name} {{ stop hold if a {{ hold }} }}\n");
    assert_eq!(items(&wide), format!("\nstate {name} {{\n  stop\n  hold\n  if a {{ hold }}\n}}\n"));
}

#[test]
fn a_block_that_the_author_broke_has_a_line_for_every_statement() {
    assert_eq!(items("state S { stop hold\n}"), "\nstate S {\n  stop\n  hold\n}\n");
}

#[test]
fn all_blocks_of_a_statement_are_broken_or_none() {
    let expected = "\nlaw l() {\n  if a {\n    hold\n  } else if b {\n    stop\n  } else {}\n}\n";
    assert_eq!(items("law l() { if a { hold } else if b {\nstop } else { } }"), expected);
}

#[test]
fn items_of_several_lines_stand_apart_with_the_comments_above_them() {
    let text = "param a = 1\n# of the state\nstate S {\n  stop\n}\n# of b\nlet b = 1\nlet c = 1\n";
    let expected = "param a = 1\n\n# of the state\nstate S {\n  stop\n}\n\n# of b\nlet b = 1\nlet c = 1\n";
    assert_eq!(items(text), expected);
}

#[test]
fn what_the_machine_remembers_and_does_is_laid_out_as_in_a_state() {
    let text = "var a=1 m\nvar other=2\nset a=2 m\nset other=3 if b{set a=c}else{set other=1}\nif b{\nset a=c}\nrecord w do l()";
    let expected = "var a     = 1 m\nvar other = 2\nset a     = 2 m\nset other = 3\nif b { set a = c } else { set other = 1 }\n\n\
                    if b {\n  set a = c\n}\n\nrecord w\ndo l()\n";
    assert_eq!(items(text), expected);
}

#[test]
fn blank_lines_are_one_at_most_and_none_at_the_edges_of_a_block() {
    let text = "\n\n\nstate S {\n\n\n  hold\n\n\n\n  stop\n\n}\n\n\n";
    assert_eq!(items(text), "\nstate S {\n  hold\n\n  stop\n}\n");
}

#[test]
fn a_minus_before_a_value_is_tight_and_between_values_is_not() {
    assert_eq!(items("let a=-b- -c*-(1-d)-|-e|-1"), "let a = -b - -c * -(1 - d) - |-e| - 1\n");
    assert_eq!(items("let a=not-b<c"), "let a = not -b < c\n");
}

#[test]
fn bars_are_tight_around_what_they_hold() {
    assert_eq!(items("let a=| |b|-1 |*|c|"), "let a = ||b| - 1| * |c|\n");
}

#[test]
fn a_unit_stays_one_word_and_a_quotient_does_not_become_one() {
    assert_eq!(items("let a=50mm/s+50 mm/t2+50 mm / s"), "let a = 50 mm/s + 50 mm / t2 + 50 mm / s\n");
}

#[test]
fn values_of_consecutive_statements_are_aligned_unless_a_line_becomes_too_wide() {
    let aligned = "param a    = 1    in 0 .. 2\nparam long = 1000 in 0 .. 2000\n\nparam b = 1\n";
    assert_eq!(items("param a=1 in 0..2\nparam long=1000 in 0..2000\n\nparam b=1"), aligned);
    let plain = "let a = 1\nlet f(x: number) = x\n";
    assert_eq!(items(plain), plain);
    let wide = format!("let a = 1\nlet {} = 2\n", "b".repeat(90));
    assert_eq!(items(&wide), wide.replace("a =", &format!("a{} =", " ".repeat(89))));
    let too_wide = format!("let a = 1 + 1\nlet {} = 2\n", "b".repeat(90));
    assert_eq!(items(&too_wide), too_wide);
}

#[test]
fn comments_keep_their_lines_and_those_behind_consecutive_lines_are_aligned() {
    let text = "param a=1 # one\nparam b=1000# two\n\nparam c=1 # three\n# four\nparam d=1";
    let expected = "param a = 1     # one\nparam b = 1000  # two\n\nparam c = 1  # three\n# four\nparam d = 1\n";
    assert_eq!(items(text), expected);
}

/// Blanks and comments that may stand wherever a blank may.
const BLANKS: [&str; 9] =
    ["", " ", "    ", "\t", "\n", "\n\n\n", " \r\n\t", "# why \u{e9}\t \r\n", "\n  # a remark\n\n  #\n"];

/// The same text with other blanks and more comments.
fn disturbed(text: &str, choices: &[usize]) -> String {
    let separates =
        |stretch: Option<&Stretch<'_>>| matches!(stretch, Some(Stretch::Rest('(' | ')' | '{' | '}' | ',' | '|')));
    let stretches = stretches(text);
    let mut choices = choices.iter().cycle();
    let mut disturbed = String::new();
    for (index, stretch) in stretches.iter().enumerate() {
        let before = index.checked_sub(1).and_then(|before| stretches.get(before));
        let blank = BLANKS[choices.next().copied().unwrap_or_default()];
        match *stretch {
            Stretch::Blank(blanks) => {
                let after = stretches.get(index + 1);
                let in_quantity = matches!((before, after),
                    (Some(Stretch::Rest(digit)), Some(Stretch::Rest(letter))) if digit.is_ascii_digit() && letter.is_alphabetic());
                if matches!(before, Some(Stretch::Comment(_))) {
                    disturbed.push('\n');
                    disturbed.push_str(blank);
                } else if in_quantity || (blank.is_empty() && !separates(before) && !separates(after)) {
                    disturbed.push_str(blanks);
                } else {
                    disturbed.push_str(blank);
                }
            }
            Stretch::Comment(part) | Stretch::Text(part) => disturbed.push_str(part),
            Stretch::Rest(letter) => {
                if separates(before) || separates(Some(stretch)) {
                    disturbed.push_str(blank);
                }
                disturbed.push(letter);
            }
        }
    }
    disturbed
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(300))]

    #[test]
    fn any_layout_of_a_policy_is_laid_out_faithfully(
        policy in any::<prop::sample::Index>(),
        choices in prop::collection::vec(prop_oneof![3 => Just(0_usize), 3 => Just(1), 2 => 0..BLANKS.len()], 1..400),
    ) {
        is_laid_out_faithfully(&disturbed(policy.get::<String>(&POLICIES), &choices));
    }

    #[test]
    fn all_on_one_line_is_laid_out_faithfully(policy in any::<prop::sample::Index>()) {
        let parts = stretches(policy.get::<String>(&POLICIES)).into_iter().map(|stretch| match stretch {
            Stretch::Blank(_) => " ".to_owned(),
            Stretch::Comment(_) => String::new(),
            Stretch::Text(text) => text.to_owned(),
            Stretch::Rest(letter) => letter.to_string(),
        });
        is_laid_out_faithfully(&parts.collect::<String>());
    }

    #[test]
    fn any_text_is_formatted_or_refused(text in "(\\PC|\n|\t| |[-a-z0-9:{}()|\"#*/.,<>=]){0,80}") {
        for text in [&text, &format!("machine m {text}"), &format!("machine m state S {{ {text} }}")] {
            if format(&Source::new("policy.fsm", text)).is_ok() {
                is_laid_out_faithfully(text);
            }
        }
    }
}
