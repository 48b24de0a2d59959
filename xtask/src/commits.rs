//! The subjects of commits: each is imperative, and none names a path of a machine.

use std::path::Path;
use std::process::{Command, Stdio};

use thiserror::Error;

/// This file. Commits before the one that added it are not checked, because they cannot be changed.
const FILE: &str = "xtask/src/commits.rs";
/// First words that begin no imperative sentence, though their endings do not show it.
const NO_VERBS: [&str; 20] = [
    "a", "an", "all", "and", "each", "every", "for", "how", "in", "it", "more", "new", "no", "now", "of", "one", "the",
    "this", "what", "when",
];
/// Verbs that end as other forms do.
const VERBS: [&str; 12] =
    ["bring", "discuss", "embed", "express", "feed", "focus", "need", "pass", "process", "press", "speed", "string"];
/// Most letters of a subject, so that a list of commits shows it whole.
const MOST_LETTERS: usize = 100;

/// Subjects that say something other than what the commit does.
#[derive(Debug, Error)]
#[error("subjects of commits; begin with a verb, such as `Add`, and change them with `git rebase --interactive`:\n  {}", .0.join("\n  "))]
pub(crate) struct CommitsError(Vec<String>);

/// Checks the commits since this check. A checkout without history has none.
pub(crate) fn check(root: &Path) -> Result<(), CommitsError> {
    let since = git(root, &["log", "--diff-filter=A", "--format=%H", "--", FILE]);
    let Some(first) = since.lines().last() else { return Ok(()) };
    let subjects = git(root, &["log", "--no-merges", "--format=%s", &format!("{first}..HEAD")]);
    let faults: Vec<_> = subjects.lines().filter_map(fault).collect();
    if faults.is_empty() { Ok(()) } else { Err(CommitsError(faults)) }
}

/// What is wrong with a subject.
fn fault(subject: &str) -> Option<String> {
    let first = subject.split(' ').next().unwrap_or_default().to_lowercase();
    let is_other_form = ["ed", "ing", "s"].iter().any(|ending| first.ends_with(ending)) && !VERBS.contains(&&*first);
    let is_no_verb = is_other_form || NO_VERBS.contains(&&*first) || !first.chars().all(char::is_alphabetic);
    let why = if is_no_verb {
        "its first word is no verb in the imperative"
    } else if subject.split_whitespace().any(is_absolute_path) {
        "it names a path of a machine"
    } else if subject.chars().count() > MOST_LETTERS {
        "it is longer than 100 letters"
    } else {
        return None;
    };
    Some(format!("`{subject}`: {why}"))
}

/// True if a word begins at the root of a machine, also behind a quotation mark or a bracket.
fn is_absolute_path(word: &str) -> bool {
    let path = word.trim_start_matches(|letter: char| "`'\"(".contains(letter));
    path.strip_prefix('/').is_some_and(|rest| rest.starts_with(char::is_alphanumeric))
}

/// The output of git. Empty without git or history.
fn git(root: &Path, arguments: &[&str]) -> String {
    let output = Command::new("git").current_dir(root).args(arguments).stderr(Stdio::null()).output();
    output.map(|output| String::from_utf8_lossy(&output.stdout).into_owned()).unwrap_or_default()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn imperative_subjects_pass_and_others_do_not() {
        for subject in ["Add a table of keys", "Speed up the search", "Pass the seed on", "Follow the new headings"] {
            assert_eq!(fault(subject), None, "{subject}");
        }
        for subject in ["The commands have another number", "Adds a key", "Added a key", "Adding a key", "49: a key"] {
            assert!(fault(subject).is_some_and(|fault| fault.contains("no verb")), "{subject}");
        }
        for subject in ["Read /a/x again", "Read `/a` again", "Read (/b/c) again"] {
            assert!(fault(subject).is_some_and(|fault| fault.contains("path")), "{subject}");
        }
        assert_eq!(fault("Divide a / b and src/lib.rs"), None);
        assert!(fault(&format!("Add {}", "x".repeat(100))).is_some_and(|fault| fault.contains("letters")));
    }
}
