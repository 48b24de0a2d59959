//! What the figures of a page are made of: the files behind its commands, and their texts without what changes no figure.

use std::collections::BTreeSet;
use std::fs;
use std::path::{Component, Path, PathBuf};

use super::stamp::StampError;

/// The scenes that the bench and its relatives run, in `scenarios`.
pub(crate) const BENCH: [&str; 10] = [
    "disk",
    "rounded-rectangle",
    "complex",
    "octagon",
    "box",
    "prism",
    "wall",
    "smooth-tunnel",
    "zigzag-tunnel",
    "round-tunnel",
];
/// The policies that commands run unless they are given others.
pub(super) const POLICIES: [&str; 2] = ["policies/thesis.fsm", "policies/vibrissa.fsm"];
/// The mismatch that the program contains.
pub(super) const PLAUSIBLE: &str = "scenarios/mismatch/plausible.yaml";
/// The folder of the standard library.
pub(super) const LIBRARY: &str = "policies/std";
/// The endings of files that a command or a file names.
const ENDINGS: [&str; 6] = ["fsm", "yaml", "svg", "dxf", "csv", "stl"];

/// The files that the commands read, and all that these name in turn, by their paths from the root.
pub(super) fn files(root: &Path, commands: &[&str]) -> Result<BTreeSet<String>, StampError> {
    let mut found = BTreeSet::new();
    for command in commands {
        let has_policy = command.split(' ').any(|word| word == "--policy");
        // A scenario names the policy that it runs under. Only `run` asks for it, and only if it is given none.
        let runs_own_policy = command.starts_with("run ") && !has_policy;
        let mut seen = BTreeSet::new();
        let mut pending = named(command, has_policy);
        while let Some(path) = pending.pop() {
            if seen.contains(&path) {
                continue;
            }
            let text = read(root, &path)?;
            pending.extend(match ending(&path) {
                "fsm" => libraries(&path, &text),
                "yaml" => mentions(root, &path, &text, runs_own_policy)?,
                _ => Vec::new(),
            });
            seen.insert(path);
        }
        found.extend(seen);
    }
    Ok(found)
}

/// The files that a command names, and those that it takes by default.
fn named(command: &str, has_policy: bool) -> Vec<String> {
    let words = command.split(' ').filter(|word| ENDINGS.contains(&ending(word)));
    let mut files: Vec<String> = words.map(str::to_owned).collect();
    let verb = verb(command);
    let has_scene = files.iter().any(|file| ending(file) == "yaml");
    if matches!(verb, "bench" | "estimators" | "timing" | "worlds") || verb == "compare" && !has_scene {
        files.extend(BENCH.map(|scene| format!("scenarios/{scene}.yaml")));
    }
    if matches!(verb, "bench" | "estimators" | "timing" | "worlds" | "pareto") && !has_policy {
        files.extend(POLICIES.map(str::to_owned));
    }
    if verb == "families" && !has_policy {
        files.push(POLICIES[1].to_owned());
    }
    if verb == "scale" {
        files.extend([POLICIES[0], "policies/bang.fsm"].map(str::to_owned));
    }
    if verb == "pareto" {
        files.extend(["scenarios/disk.yaml", PLAUSIBLE].map(str::to_owned));
    }
    files
}

/// The word that says what a command does. Those of studies stand behind another one.
pub(super) fn verb(command: &str) -> &str {
    command.strip_prefix("study ").unwrap_or(command).split(' ').next().unwrap_or_default()
}

/// The libraries that the text of a policy uses.
fn libraries(path: &str, text: &str) -> Vec<String> {
    let code = policy(text);
    let words: Vec<&str> = code.split(' ').collect();
    let uses = words.windows(2).filter(|pair| pair[0] == "use").filter_map(|pair| {
        let name = pair[1].split('(').next().unwrap_or_default();
        match name.strip_prefix("std.") {
            Some(module) => Some(format!("{LIBRARY}/{module}.fsm")),
            None => Some(beside(path, name.strip_prefix('"')?.strip_suffix('"')?)),
        }
    });
    uses.collect()
}

/// The files that a scenario or a sweep names. Paths are relative to the file; those of mismatches in a sweep to the scenarios.
fn mentions(root: &Path, path: &str, text: &str, with_policy: bool) -> Result<Vec<String>, StampError> {
    let mut files = Vec::new();
    let lines = text.lines().map(|line| line.split(" #").next().unwrap_or_default());
    for line in lines.filter(|line| !line.starts_with('#')) {
        if line.trim_start().starts_with("policy:") && !with_policy {
            continue;
        }
        let between = |letter: char| letter.is_whitespace() || "[]{}(),\"'".contains(letter);
        for name in line.split(between).filter(|word| ENDINGS.contains(&ending(word))) {
            let candidates = [beside(path, name), beside("scenarios/", name)];
            let file = candidates.into_iter().find(|file| root.join(file).is_file());
            let missing = || StampError::Missing { by: path.to_owned(), file: name.to_owned() };
            files.push(file.ok_or_else(missing)?);
        }
    }
    Ok(files)
}

/// A path that is relative to the folder of a file, from the root.
fn beside(file: &str, path: &str) -> String {
    let mut parts: Vec<String> = Vec::new();
    let folder = file.rsplit_once('/').map_or("", |(folder, _)| folder);
    for part in Path::new(folder).join(path).components() {
        match part {
            Component::ParentDir => drop(parts.pop()),
            Component::Normal(name) => parts.push(name.to_string_lossy().into_owned()),
            _ => {}
        }
    }
    parts.join("/")
}

fn ending(path: &str) -> &str {
    path.rsplit_once('.').map_or("", |(_, end)| end)
}

/// All Rust files below a folder, as one text without what changes no figure.
pub(super) fn code(root: &Path, folder: &str) -> Result<String, StampError> {
    let files = crate::sources::rust_files(&root.join(folder));
    let files = files.map_err(|(path, source)| StampError::Read { path, source })?;
    Ok(files.iter().map(|(_, text)| rust(text) + "\n").collect())
}

/// The text of a file without what changes no figure.
pub(super) fn essence(root: &Path, path: &str) -> Result<String, StampError> {
    let text = read(root, path)?;
    Ok(match ending(path) {
        "fsm" => policy(&text),
        "rs" => rust(&text),
        // The values of the stored figures, without tolerances.
        "txt" => plain(text.lines().map(|line| line.split(" ± ").next().unwrap_or_default())),
        "yaml" => plain(text.lines()),
        _ => text,
    })
}

fn read(root: &Path, path: &str) -> Result<String, StampError> {
    let path: PathBuf = root.join(path);
    fs::read_to_string(&path).map_err(|source| StampError::Read { path, source })
}

/// Lines without those that are blank or only a comment.
fn plain<'a>(lines: impl Iterator<Item = &'a str>) -> String {
    let lines = lines.map(str::trim_end).filter(|line| !line.is_empty() && !line.trim_start().starts_with('#'));
    lines.flat_map(|line| [line, "\n"]).collect()
}

/// The code of a Rust file: no comments and attributes of whole lines, no layout, no unit tests, which end the file. Nor has it what a
/// move of code changes: imports, the crate and the module before a name, and who may see an item.
fn rust(text: &str) -> String {
    let code = text.split("\n#[cfg(test)]\nmod tests {").next().unwrap_or_default();
    let lines = code.lines().map(str::trim).filter(|line| !line.starts_with("//") && !line.starts_with("#["));
    let mut is_import = false;
    let mut kept = String::new();
    for line in lines {
        is_import |= ["use ", "pub use ", "pub(crate) use "].iter().any(|start| line.starts_with(start));
        if !is_import {
            kept += line;
            kept.push(' ');
        }
        is_import &= !line.ends_with(';');
    }
    // A line that is broken has a comma after its last part, and no blanks there.
    let joined: String = kept.replace("pub(crate)", "pub").split_whitespace().collect();
    let joined = [(",)", ")"), (",]", "]"), (",}", "}")].iter().fold(joined, |text, (from, to)| text.replace(from, to));
    without_paths(&joined)
}

/// A text of code without the crates of this project and the words for modules before names.
fn without_paths(code: &str) -> String {
    let is_of_word = |letter: char| letter.is_alphanumeric() || letter == '_';
    let mut parts = code.split("::").peekable();
    let mut text = String::with_capacity(code.len());
    while let Some(part) = parts.next() {
        let head = part.trim_end_matches(is_of_word);
        let word = &part[head.len()..];
        if parts.peek().is_none() {
            text += part;
        } else if matches!(word, "crate" | "super") || word.starts_with("vibrissa_") {
            text += head;
        } else {
            text += part;
            text += "::";
        }
    }
    text
}

/// The code of a policy: no comments, no layout, which has no meaning in the grammar, no tests and no properties.
fn policy(text: &str) -> String {
    let words = words(text);
    let mut code = String::with_capacity(text.len());
    let mut depth = 0_usize;
    let mut is_test = false;
    for (index, word) in words.iter().enumerate() {
        let next_is_text = words.get(index + 1).is_some_and(|next| next.starts_with('"'));
        is_test |= depth == 0 && next_is_text && matches!(word.as_str(), "test" | "property");
        let quoted = word.starts_with('"');
        let braces = |brace: char| if quoted { 0 } else { word.matches(brace).count() };
        let (opened, closed) = (braces('{'), braces('}'));
        if !is_test {
            code += word;
            code.push(' ');
        }
        depth = (depth + opened).saturating_sub(closed);
        is_test &= closed == 0 || depth > 0;
    }
    code
}

/// The words of a policy that blanks, line ends and comments separate. A text in quotation marks is one word.
fn words(text: &str) -> Vec<String> {
    let mut words = Vec::new();
    let mut word = String::new();
    let mut letters = text.chars();
    let mut flush = |word: &mut String| {
        if !word.is_empty() {
            words.push(std::mem::take(word));
        }
    };
    while let Some(letter) = letters.next() {
        match letter {
            '#' => {
                flush(&mut word);
                let _ = letters.by_ref().find(|&letter| letter == '\n');
            }
            '"' => {
                flush(&mut word);
                word.push('"');
                word.extend(letters.by_ref().take_while(|&letter| letter != '"'));
                word.push('"');
                flush(&mut word);
            }
            '{' | '}' => {
                flush(&mut word);
                word.push(letter);
                flush(&mut word);
            }
            letter if letter.is_whitespace() => flush(&mut word),
            letter => word.push(letter),
        }
    }
    flush(&mut word);
    words
}

#[cfg(test)]
mod tests {
    use super::*;

    fn root() -> &'static Path {
        Path::new(env!("CARGO_MANIFEST_DIR")).parent().unwrap_or(Path::new("."))
    }

    #[test]
    fn comments_layout_and_tests_of_a_policy_change_no_figure_and_a_number_does() {
        let text = "machine m\nparam speed = 5 mm/s  # slow\nstate A {\n  when a > 1 -> B\n}\n";
        let same = "# why\nmachine m param speed = 5 mm/s\nstate A { when a > 1\n -> B }\n\
                    test \"it {\" in \"x.yaml\" {\n  expect { a }\n}\nproperty \"p\" spanning wall {}\n";
        assert_eq!(policy(text), policy(same));
        assert_ne!(policy(text), policy(&text.replace("> 1", "> 2")));
        // A word of its own, and not a test.
        assert_ne!(policy(text), policy(&text.replace("state A", "state test")));
        assert!(policy("test \"a\" in \"b\" { } let x = 1 # end").contains("let x = 1"));
    }

    #[test]
    fn tolerances_and_comments_of_stored_figures_are_no_figures() {
        let figures = |text: &str| plain(text.lines().map(|line| line.split(" ± ").next().unwrap_or_default()));
        assert_eq!(figures("# a\n  mean 0.03 ± 0.1  deviation 1\n"), figures("\n  mean 0.03 ± 0.2  deviation 2\n"));
        assert_ne!(figures("  mean 0.03 ± 0.1\n"), figures("  mean 0.04 ± 0.1\n"));
    }

    #[test]
    fn comments_and_unit_tests_of_code_change_no_figure() {
        let code = "//! A.\nfn a() {\n    b(1);\n}\n";
        assert_eq!(rust(code), rust("fn a() { b(1); }\n\n#[cfg(test)]\nmod tests {\n    fn c() {}\n}\n"));
        assert_ne!(rust(code), rust("fn a() { b(2); }\n"));
    }

    #[test]
    fn a_move_of_code_to_another_crate_changes_no_figure() {
        let code = "use crate::low::{\n    One,\n};\n\n#[must_use]\npub(crate) fn a(b: crate::low::B) -> C { d(super::E::F, 1) }\n";
        let moved = "use vibrissa_low::One;\npub fn a(\n    b: vibrissa_low::low::B,\n) -> C {\n    d(E::F, 1)\n}\n";
        assert_eq!(rust(code), rust(moved));
        assert_ne!(rust(code), rust(&moved.replace("E::F", "E::G")));
    }

    #[test]
    fn a_command_depends_on_the_scenes_policies_and_libraries_that_it_runs() -> Result<(), StampError> {
        let of = |command: &str| files(root(), &[command]);
        let bench = of("bench --ideal --json")?;
        assert!(BENCH.iter().all(|scene| bench.contains(&format!("scenarios/{scene}.yaml"))));
        for file in ["policies/thesis.fsm", "policies/vibrissa.fsm", "policies/std/following.fsm"] {
            assert!(bench.contains(file), "{file}");
        }
        // The library of a library.
        assert!(bench.contains("policies/std/search.fsm"));
        let other = of("bench --ideal --policy policies/quick.fsm --json")?;
        assert!(other.contains("policies/lib/contact.fsm") && !other.contains("policies/vibrissa.fsm"));
        let own = of("run scenarios/more/peer-disk.yaml --json")?;
        assert!(own.contains("policies/thesis.fsm"), "the policy that the scenario names");
        let given = of("run scenarios/more/peer-disk.yaml --policy policies/vibrissa.fsm --json")?;
        assert!(!given.contains("policies/thesis.fsm"), "not the policy that it names");
        let sweep = of("sweep sweeps/mismatch.yaml --json")?;
        for file in ["policies/thesis.fsm", "scenarios/wall.yaml", "scenarios/mismatch/hard.yaml"] {
            assert!(sweep.contains(file), "{file}");
        }
        Ok(())
    }

    #[test]
    fn the_scenes_of_the_bench_are_those_that_the_program_contains() {
        let built_in = fs::read_to_string(root().join("crates/lab/src/built_in.rs")).unwrap_or_default();
        let is_scene = |word: &&str| word.starts_with("scenarios/") && ending(word) == "yaml";
        let named: Vec<&str> = built_in.split('"').filter(is_scene).collect();
        let scenes: Vec<String> = BENCH.map(|scene| format!("scenarios/{scene}.yaml")).into();
        assert_eq!(named[..BENCH.len()], scenes);
        assert!(named.contains(&PLAUSIBLE));
    }

    #[test]
    fn a_file_that_is_named_and_not_there_is_told() {
        let error = mentions(root(), "sweeps/x.yaml", "policies: [../policies/none.fsm]", true);
        let text = error.map_err(|error| error.to_string());
        assert!(text.is_err_and(|text| text.contains("sweeps/x.yaml") && text.contains("none.fsm")));
    }
}
