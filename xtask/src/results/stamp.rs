//! The stamp of a page: hashes of what its figures were made from.

use std::collections::{BTreeMap, BTreeSet};
use std::fmt::Write as _;
use std::io;
use std::path::{Path, PathBuf};

use sha2::{Digest, Sha256};
use thiserror::Error;

use super::inputs;
use super::pages::Page;
use crate::platform::MUJOCO_VERSION;

/// The line above the lines of a stamp, and the one below them. Both are comments in Markdown and in SVG.
const BEGIN: &str = "<!-- made from";
const END: &str = "-->";
/// The folder of the figures of the bench, which stand for the program: a change of code without one of figures keeps a page.
const FIGURES: &str = "snapshots/metrics";

/// A stamp that cannot be computed.
#[derive(Debug, Error)]
pub(crate) enum StampError {
    #[error("cannot read {}, which published figures are made from: {source}", path.display())]
    Read { path: PathBuf, source: io::Error },
    #[error("{by} names {file}, which is not there; published figures are made from it")]
    Missing { by: String, file: String },
}

/// What figures were made from, each with its hash or version.
#[derive(Debug, Default, Clone, PartialEq, Eq)]
pub(super) struct Stamp(BTreeMap<String, String>);

impl Stamp {
    /// The stamp of a page of the checkout.
    pub(super) fn of(root: &Path, page: &Page) -> Result<Self, StampError> {
        Self::of_commands(root, page.commands, page.code)
    }

    /// The stamp of commands, and of files and folders of code whose figures are not among those of the bench.
    pub(super) fn of_commands(root: &Path, commands: &[&str], code: &[&str]) -> Result<Self, StampError> {
        let files = inputs::files(root, commands)?;
        let mut parts = BTreeMap::new();
        for path in files.iter().cloned().chain(figures(commands, &files)) {
            let hash = hash(&inputs::essence(root, &path)?);
            parts.insert(path, hash);
        }
        for path in code {
            let is_file = root.join(path).is_file();
            let code = if is_file { inputs::essence(root, path) } else { inputs::code(root, path) };
            parts.insert((*path).to_owned(), hash(&code?));
        }
        parts.insert("commands".to_owned(), hash(&commands.join("\n")));
        parts.insert("MuJoCo".to_owned(), MUJOCO_VERSION.to_owned());
        // All packages of the workspace have one version.
        parts.insert("vibrissa".to_owned(), env!("CARGO_PKG_VERSION").to_owned());
        Ok(Self(parts))
    }

    /// The stamp in the text of a page. `None` without one.
    pub(super) fn read(text: &str) -> Option<Self> {
        let (_, stamp) = text.split_once(&format!("{BEGIN}\n"))?;
        let (lines, _) = stamp.split_once(&format!("{END}\n"))?;
        let parts =
            lines.lines().map(|line| line.rsplit_once(' ').map(|(name, hash)| (name.to_owned(), hash.to_owned())));
        parts.collect::<Option<_>>().map(Self)
    }

    /// The lines of a page that [`Self::read`] reads.
    pub(super) fn text(&self) -> String {
        let lines = self.0.iter().fold(String::new(), |mut lines, (name, hash)| {
            let _ = writeln!(lines, "{name} {hash}");
            lines
        });
        format!("{BEGIN}\n{lines}{END}\n")
    }

    /// One hash for all of it.
    pub(super) fn hash(&self) -> String {
        hash(&self.text())
    }

    /// The names of what differs from what a page was made from.
    pub(super) fn changes(&self, published: &Self) -> Vec<String> {
        let (now, before) = (&self.0, &published.0);
        let changed = now.iter().filter(|(name, hash)| before.get(*name) != Some(hash)).map(|(name, _)| name);
        let gone = before.keys().filter(|name| !now.contains_key(*name));
        changed.chain(gone).cloned().collect()
    }
}

/// The stored figures that stand for the program: those of the simulators that the commands run, under the policies that they run.
/// Those of the policy that hardly changes, `thesis.fsm`, stand for the program under all other policies.
fn figures(commands: &[&str], files: &BTreeSet<String>) -> Vec<String> {
    const BOTH: [&str; 4] = ["worlds", "pareto", "stress", "scale"];
    let mut found = Vec::new();
    for (world, is_default) in [("mujoco", true), ("quasistatic", false)] {
        let runs = |command: &&&str| {
            let verb = inputs::verb(command);
            let chosen = command.split_once("--world ").map(|(_, rest)| rest.split(' ').next().unwrap_or_default());
            BOTH.contains(&verb) && chosen.is_none() || chosen.map_or(is_default, |chosen| chosen == world)
        };
        if !commands.iter().any(|command| runs(&command)) {
            continue;
        }
        found.push(format!("{FIGURES}/thesis-{world}.txt"));
        if files.contains(inputs::POLICIES[1]) {
            found.push(format!("{FIGURES}/vibrissa-{world}.txt"));
        }
    }
    found
}

/// The first 12 digits of the SHA-256 of a text. That is enough against chance.
pub(super) fn hash(text: &str) -> String {
    hexadecimal(&Sha256::digest(text)[..6])
}

pub(super) fn hexadecimal(bytes: &[u8]) -> String {
    bytes.iter().fold(String::new(), |mut text, byte| {
        // Writing to a string cannot fail.
        let _ = write!(text, "{byte:02x}");
        text
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn stamp(parts: &[(&str, &str)]) -> Stamp {
        Stamp(parts.iter().map(|&(name, hash)| (name.to_owned(), hash.to_owned())).collect())
    }

    #[test]
    fn a_stamp_is_read_back_from_the_end_of_a_page_and_tells_what_changed() {
        let before = stamp(&[("a b.fsm", "1"), ("gone.yaml", "2"), ("same", "3")]);
        let page = format!("# Page\n\ntext\n\n{}", before.text());
        assert_eq!(Stamp::read(&page), Some(before.clone()));
        let now = stamp(&[("a b.fsm", "4"), ("new", "5"), ("same", "3")]);
        assert_eq!(now.changes(&before), ["a b.fsm", "new", "gone.yaml"]);
        assert_eq!(before.changes(&before), [""; 0]);
        assert_eq!(Stamp::read("# Page\n"), None);
        assert_eq!(Stamp::read("<!-- made from\na 1\n"), None, "cut short");
    }

    #[test]
    fn figures_of_a_simulator_that_a_page_does_not_use_do_not_matter() {
        let names = |command: &str, file: &str| figures(&[command], &[file.to_owned()].into());
        let [thesis, vibrissa] = inputs::POLICIES;
        assert_eq!(names("bench --ideal --json", thesis), ["snapshots/metrics/thesis-mujoco.txt"]);
        assert_eq!(names("bench --ideal --world quasistatic --json", vibrissa).len(), 2);
        assert_eq!(names("study worlds --against quasistatic --json", vibrissa).len(), 4);
    }
}
