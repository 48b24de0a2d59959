//! The codes of diagnostics: each is shown to its reviewer, and means one thing.

use std::collections::{BTreeMap, BTreeSet};
use std::path::Path;

/// Codes that no snapshot can show, and why.
const UNSEEN: [(&str, &str); 1] =
    [("P0199", "grammar and reader disagree: no text shows it unless the compiler is at fault")];

/// The texts of all files below a folder that end so.
fn texts(folder: &str, end: &str) -> Vec<String> {
    let mut folders = vec![Path::new(concat!(env!("CARGO_MANIFEST_DIR"), "/../..")).join(folder)];
    let mut texts = Vec::new();
    while let Some(folder) = folders.pop() {
        for entry in std::fs::read_dir(folder).unwrap() {
            let path = entry.unwrap().path();
            if path.is_dir() {
                folders.push(path);
            } else if path.to_string_lossy().ends_with(end) {
                texts.push(std::fs::read_to_string(path).unwrap());
            }
        }
    }
    texts
}

/// Whether a text is a code, such as `P0101`.
fn is_code(text: &str) -> bool {
    text.len() == 5 && text.starts_with(['P', 'S']) && text[1..].chars().all(|letter| letter.is_ascii_digit())
}

/// The codes that stand between two texts.
fn codes_between<'t>(text: &'t str, before: &'t str, behind: &'t str) -> impl Iterator<Item = &'t str> {
    let rests = text.match_indices(before).filter_map(move |(at, _)| text.get(at + before.len()..));
    rests.filter_map(move |rest| rest.get(..5).filter(|code| is_code(code) && rest[5..].starts_with(behind)))
}

/// The sources without the tests in them.
fn sources() -> Vec<String> {
    let product = |text: String| text.split("#[cfg(test)]").next().unwrap().to_owned();
    let folders = ["crates/language/src", "crates/yaml/src", "crates/world/src", "crates/lab/src", "src"];
    folders.iter().flat_map(|folder| texts(folder, ".rs")).map(product).collect()
}

/// What the snapshots show: codes with their severities.
fn shown() -> BTreeMap<String, BTreeSet<&'static str>> {
    let mut shown: BTreeMap<String, BTreeSet<&'static str>> = BTreeMap::new();
    for text in texts("snapshots", ".snap") {
        for severity in ["error", "warning"] {
            for code in codes_between(&text, &format!("{severity}["), "]: ") {
                shown.entry(code.to_owned()).or_default().insert(severity);
            }
        }
    }
    shown
}

#[test]
fn every_code_is_shown_by_a_snapshot_and_every_code_shown_is_given() {
    let sources = sources();
    let given: BTreeSet<&str> = sources.iter().flat_map(|text| codes_between(text, "\"", "\"")).collect();
    assert!(given.len() > 50, "the codes are written otherwise now: {given:?}");
    let shown = shown();
    let shown: BTreeSet<&str> = shown.keys().map(String::as_str).collect();
    let unseen: BTreeSet<&str> = UNSEEN.iter().map(|&(code, _)| code).collect();
    let missing: Vec<&&str> = given.difference(&shown).filter(|code| !unseen.contains(*code)).collect();
    assert!(missing.is_empty(), "add a fixture with a snapshot that shows {missing:?}");
    assert_eq!(shown.difference(&given).collect::<Vec<_>>(), [&""; 0], "snapshots of what is no more");
    assert!(unseen.is_subset(&given) && unseen.is_disjoint(&shown), "{unseen:?}");
}

#[test]
fn no_code_is_an_error_here_and_a_warning_there() {
    for (code, severities) in shown() {
        assert_eq!(severities.len(), 1, "{code}");
        assert_eq!(severities.contains("warning"), code.starts_with("P05"), "{code}");
    }
}

#[test]
fn no_two_names_of_codes_share_one() {
    let mut names: BTreeMap<String, String> = BTreeMap::new();
    for text in sources() {
        for line in text.lines().filter(|line| line.contains("const ") && line.contains(": &str = \"")) {
            if let Some(code) = codes_between(line, "\"", "\";").next()
                && let Some(other) = names.insert(code.to_owned(), line.to_owned())
            {
                panic!("{code} is both `{other}` and `{line}`");
            }
        }
    }
    assert!(names.len() > 10, "the codes of scenarios are written otherwise now: {names:?}");
}

#[test]
fn the_page_explains_every_warning_once() {
    let page = include_str!("../../docs/language-semantics.md");
    let rows = page.lines().filter(|line| line.starts_with("| P05"));
    let explained: Vec<&str> = rows.flat_map(|row| row.split('|').nth(1).unwrap().trim().split(", ")).collect();
    let shown = shown();
    let warnings: Vec<&str> = shown.keys().map(String::as_str).filter(|code| code.starts_with("P05")).collect();
    assert_eq!(explained, warnings);
}
