//! Texts that are nearly policies: those of this project, broken in small ways.

use std::fs;
use std::path::{Path, PathBuf};

use crate::TOKENS;
use crate::generate;
use crate::random::Random;
use crate::shared;

/// Texts longer than this (bytes) are cut, so that a random walk stays among small ones.
const LONGEST: usize = 8 << 10;

/// All policies of the project, in the order of their paths. Another wrong one makes the right ones no rarer among the texts to try.
pub(crate) struct Corpus {
    pub(crate) right: Vec<String>,
    /// Those of the tests of errors.
    pub(crate) wrong: Vec<String>,
}

impl Corpus {
    fn pick(&self, random: &mut Random) -> &String {
        match random.below(2) {
            0 => random.pick(&self.right),
            _ => random.pick(&self.wrong),
        }
    }
}

pub(crate) fn corpus() -> Corpus {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let mut folders = ["policies", "tests/fixtures"].map(|folder| root.join(folder)).to_vec();
    let mut files = Vec::new();
    while let Some(folder) = folders.pop() {
        for entry in fs::read_dir(folder).unwrap() {
            let path = entry.unwrap().path();
            if path.is_dir() {
                folders.push(path);
            } else if path.extension().is_some_and(|extension| extension == "fsm") {
                files.push(path);
            }
        }
    }
    files.sort();
    let text = |file: &PathBuf| String::from_utf8_lossy(&fs::read(file).unwrap()).into_owned();
    let (wrong, right): (Vec<_>, Vec<_>) = files.into_iter().partition(|file| file.iter().any(|name| name == "bad"));
    Corpus { right: right.iter().map(text).collect(), wrong: wrong.iter().map(text).collect() }
}

/// A text to try.
pub(crate) fn input(corpus: &Corpus, random: &mut Random) -> String {
    let mut text = match random.below(2) {
        0 => generate::policy(random),
        _ => corpus.pick(random).clone(),
    };
    let changes = [0, 0, 1, 1, 2, 5][random.below(6)];
    text = changed(text, corpus, changes, random);
    let mut end = text.len().min(LONGEST);
    while !text.is_char_boundary(end) {
        end -= 1;
    }
    text.truncate(end);
    text
}

/// A text to try whose parts share others, as it is or changed in small ways.
pub(crate) fn shared_input(corpus: &Corpus, is_changed: bool, random: &mut Random) -> String {
    let text = shared::policy(random);
    let changes = if is_changed { 1 + random.below(4) } else { 0 };
    changed(text, corpus, changes, random)
}

/// The text after so many small changes.
fn changed(mut text: String, corpus: &Corpus, changes: usize, random: &mut Random) -> String {
    let other = corpus.pick(random);
    for _ in 0..changes {
        text = match random.below(3) {
            0 => with_other_bytes(&text, other, random),
            _ => with_other_words(&text, other, random),
        };
    }
    text
}

/// The text with a stretch of bytes left out, doubled, made random, or replaced by one of another text.
fn with_other_bytes(text: &str, other: &str, random: &mut Random) -> String {
    let bytes = text.as_bytes();
    let start = random.below(bytes.len() + 1);
    let end = (start + random.below(24)).min(bytes.len());
    let from = random.below(other.len() + 1);
    let piece = match random.below(4) {
        0 => Vec::new(),
        1 => [&bytes[start..end], &bytes[start..end]].concat(),
        2 => (0..random.below(4)).map(|_| *random.pick(b"azS019.:=-+*/<>(){}|\"#% \n\xb5\x00\xff")).collect(),
        _ => other.as_bytes()[from..(from + random.below(24)).min(other.len())].to_vec(),
    };
    String::from_utf8_lossy(&[&bytes[..start], &piece, &bytes[end..]].concat()).into_owned()
}

/// The text with some of its words left out, said again elsewhere, or replaced by those of another text or of the language.
fn with_other_words(text: &str, other: &str, random: &mut Random) -> String {
    let words = words(text);
    let others = self::words(other);
    let stretch = |words: &[&str], most, random: &mut Random| {
        let start = random.below(words.len() + 1);
        start..(start + random.below(most)).min(words.len())
    };
    let replaced = stretch(&words, 3, random);
    let piece = match random.below(5) {
        0 => String::new(),
        1 => words[stretch(&words, 12, random)].concat(),
        2 => others[stretch(&others, 40, random)].concat(),
        3 => words[stretch(&words, 3, random)].concat().repeat(2 + random.below(20)),
        _ => format!(" {} ", random.pick(&TOKENS)),
    };
    [&words[..replaced.start].concat(), &piece, &words[replaced.end..].concat()].map(String::as_str).concat()
}

/// The words, signs and blanks of a text.
fn words(text: &str) -> Vec<&str> {
    let mut words = Vec::new();
    let mut rest = text;
    while let Some(first) = rest.chars().next() {
        let is_word = |c: char| c.is_alphanumeric() || c == '_' || c == '.';
        let end = if is_word(first) { rest.find(|c| !is_word(c)).unwrap_or(rest.len()) } else { first.len_utf8() };
        let (word, behind) = rest.split_at(end);
        words.push(word);
        rest = behind;
    }
    words
}
