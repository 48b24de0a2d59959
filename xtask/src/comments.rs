//! The doc comments of the code: the share that begins with a question word, and terms that are not the field's.

use std::io;
use std::path::{Path, PathBuf};

use thiserror::Error;

use crate::prose::{TERMS, has_words};
use crate::sources::rust_files;

/// The folders with code.
const FOLDERS: [&str; 3] = ["src", "crates", "xtask/src"];
/// The first words that say nothing about the item.
const QUESTIONS: [&str; 5] = ["What", "How", "Where", "Whether", "Why"];
/// The largest share of doc comments that begin with one of them.
const MAX_SHARE: f64 = 0.08;

/// A fault of the doc comments.
#[derive(Debug, Error)]
pub(crate) enum CommentsError {
    #[error("cannot read {}: {cause}", path.display())]
    Read { path: PathBuf, cause: io::Error },
    #[error(
        "{asking} of {all} doc comments begin with What, How, Where, Whether or Why; name the thing instead, such as \
         `True if ...` or `The number of ...`. The first of them:\n  {places}"
    )]
    Questions { asking: usize, all: usize, places: String },
    #[error("use the terms of the field in these doc comments:\n  {0}")]
    Terms(String),
}

/// A doc comment: the number of its first line, and its text.
type Comment = (usize, String);

/// Checks all doc comments of the checkout at `root`.
pub(crate) fn check(root: &Path) -> Result<(), CommentsError> {
    let (mut all, mut asking, mut terms) = (0, Vec::new(), Vec::new());
    for folder in FOLDERS {
        let sources = rust_files(&root.join(folder)).map_err(|(path, cause)| CommentsError::Read { path, cause })?;
        for (path, text) in sources {
            let name = path.strip_prefix(root).unwrap_or(&path).display().to_string();
            for (line, comment) in comments(&text) {
                all += 1;
                if is_question(&comment) {
                    asking.push(format!("{name}:{line}: {}", comment.chars().take(60).collect::<String>()));
                }
                let comment = comment.to_lowercase();
                let found = TERMS.iter().filter(|(term, _)| has_words(&comment, term));
                terms.extend(
                    found.map(|(term, better)| format!("{name}:{line}: `{term}`: the field's term is `{better}`")),
                );
            }
        }
    }
    if asking.len() as f64 >= MAX_SHARE * f64::from(u32::try_from(all).unwrap_or(u32::MAX)) {
        let places = asking.iter().take(10).cloned().collect::<Vec<_>>().join("\n  ");
        return Err(CommentsError::Questions { asking: asking.len(), all, places });
    }
    if terms.is_empty() { Ok(()) } else { Err(CommentsError::Terms(terms.join("\n  "))) }
}

/// The doc comments of a text. Code in backquotes is replaced by a letter.
fn comments(text: &str) -> Vec<Comment> {
    let mut found: Vec<Comment> = Vec::new();
    let mut last = 0;
    for (number, line) in (1..).zip(text.lines().map(str::trim)) {
        let Some(comment) = line.strip_prefix("///").or_else(|| line.strip_prefix("//!")) else { continue };
        match found.last_mut() {
            Some((_, block)) if last + 1 == number => *block = format!("{block} {}", comment.trim()),
            _ => found.push((number, comment.trim().to_owned())),
        }
        last = number;
    }
    for (_, comment) in &mut found {
        let parts = comment.split('`').enumerate();
        *comment = parts.map(|(index, part)| if index % 2 == 0 { part } else { "x" }).collect();
    }
    found
}

fn is_question(comment: &str) -> bool {
    let first: String = comment.chars().take_while(|letter| letter.is_alphabetic()).collect();
    QUESTIONS.contains(&first.as_str())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_comment_is_one_block_without_its_code() {
        let text = "//! A module.\n\n/// Whether it\n/// is `tip model` so.\nfn f() {}\n// no doc comment\n";
        let expected = [(1, "A module.".to_owned()), (3, "Whether it is x so.".to_owned())];
        assert_eq!(comments(text), expected);
    }

    #[test]
    fn only_the_first_word_makes_a_question() {
        assert!(is_question("Whether it is so.") && is_question("What follows."));
        assert!(!is_question("True if it is so, whatever follows.") && !is_question("Whatever follows."));
    }
}
