//! Policies to look at.

use std::path::Path;

use vibrissa_language::check;
use vibrissa_language::index::{Index, gather};
use vibrissa_text::diagnostic::Source;

use crate::page::PAGES;

pub(crate) const ROOT: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../..");
pub(crate) const THESIS: &str = include_str!("../../fixtures/editor/thesis.fsm");
pub(crate) const SWIPE: &str = include_str!("../../fixtures/editor/swipe.fsm");

pub(crate) fn index(text: &str) -> Index {
    Index::new(&Source::new("test.fsm", text), None)
}

/// A source with the files of the fixtures that it uses.
pub(crate) fn gathered(text: &str) -> Source {
    let file = |path: &str| {
        let path = Path::new(ROOT).join("tests/fixtures/policies/use").join(path);
        std::fs::read_to_string(path).map_err(|_| "there is none".to_owned())
    };
    gather(&Source::new("test.fsm", text), &mut { file })
}

/// Every policy and library of the project that has no fault, with its name.
pub(crate) fn policies() -> Vec<(String, String)> {
    let folders = [
        "policies",
        "policies/std",
        "tests/fixtures/policies/warn",
        "tests/fixtures/policies/format",
        "tests/fixtures/charts",
    ];
    let files = folders.iter().flat_map(|folder| std::fs::read_dir(Path::new(ROOT).join(folder)).unwrap());
    let texts = files.map(|file| file.unwrap().path()).filter(|path| path.extension().is_some_and(|is| is == "fsm"));
    let mut texts: Vec<(String, String)> =
        texts.map(|path| (path.display().to_string(), std::fs::read_to_string(path).unwrap())).collect();
    for (number, example) in PAGES.split("```fsm\n").skip(1).enumerate() {
        let example = example.split("```").next().unwrap();
        let text = if example.starts_with("machine") {
            example.to_owned()
        } else {
            format!("machine example {example}\ninitial Still\nstate Still {{ stop }}\n")
        };
        texts.push((format!("example {number} of the pages"), text));
    }
    texts.push(("with another file".to_owned(), USING.to_owned()));
    texts.push(("marks".to_owned(), MARKING.to_owned()));
    texts.retain(|(_, text)| check(&gathered(text)).is_ok());
    texts.sort();
    texts
}

pub(crate) const USING: &str = r#"machine m

use "laws/corner.fsm" (wait, sharp)
use std.guards

whisker r0

let blunt = 2 * sharp

initial Waiting

state Waiting {
  do wait(r0)
  when lost(r0) and angle(r0.base) > blunt -> Failure("it is lost")
}
"#;

pub(crate) const MARKING: &str = r#"machine m

whisker r0

param lost = 100 ms in 0 .. 1 s

initial Waiting

state Waiting {
  mark lost r0
  mark found r0
  when not r0.touching for lost -> Failure("it is lost")
}

test "lost" in "lost.yaml" {
  set lost = 200 ms
  expect run.failed and run.visits(Waiting) == 1
}
"#;
