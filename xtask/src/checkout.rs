//! What a run of the tests may not leave behind.

use std::path::Path;
use std::process::Command;

/// The lines of Git's short status: what in a checkout differs from its last commit.
#[derive(Debug, Default, PartialEq, Eq)]
pub(crate) struct Checkout(Vec<String>);

impl Checkout {
    /// Looks at the checkout at `root`; `None` where Git or its repository is not at hand, as in an unpacked archive.
    pub(crate) fn look(root: &Path) -> Option<Self> {
        let output = Command::new("git").args(["status", "--porcelain"]).current_dir(root).output().ok()?;
        output.status.success().then(|| Self::from_status(&String::from_utf8_lossy(&output.stdout)))
    }

    fn from_status(text: &str) -> Self {
        Self(text.lines().map(str::to_owned).collect())
    }

    /// What differs now and did not `before`.
    pub(crate) fn since<'a>(&'a self, before: &Self) -> Vec<&'a str> {
        self.0.iter().filter(|line| !before.0.contains(line)).map(String::as_str).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn work_in_progress_is_not_held_against_the_tests() {
        let dirty = Checkout::from_status(" M src/lib.rs\n?? notes.txt\n");
        assert!(dirty.since(&dirty).is_empty());
    }

    #[test]
    fn a_file_left_behind_is_named() {
        let before = Checkout::from_status("?? notes.txt\n");
        let after = Checkout::from_status("?? MUJOCO_LOG.TXT\n?? notes.txt\n");
        assert_eq!(after.since(&before), ["?? MUJOCO_LOG.TXT"]);
    }
}
