//! The directory of recordings.
#![expect(clippy::disallowed_methods, reason = "the names are made here, and nothing is read")]

use std::fmt;
use std::fs::{self, File};
use std::io::{ErrorKind, Result};
use std::path::{Path, PathBuf};

/// A directory whose recordings have a limited total size. Other files stay untouched, and do not count.
#[derive(Debug)]
pub(super) struct Directory {
    path: PathBuf,
    limit_bytes: u64,
}

/// The name of a file: the number of the run in the directory, and that of the part in the run. Later files have higher
/// numbers, whatever the clock of the robot says.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub(super) struct PartName {
    pub(super) run: u32,
    pub(super) part: u32,
}

impl Directory {
    pub(super) fn new(path: PathBuf, limit_bytes: u64) -> Self {
        Self { path, limit_bytes }
    }

    pub(super) fn path(&self) -> &Path {
        &self.path
    }

    pub(super) fn limit_bytes(&self) -> u64 {
        self.limit_bytes
    }

    /// The number of the next run.
    pub(super) fn next_run(&self) -> Result<u32> {
        fs::create_dir_all(&self.path)?;
        Ok(self.parts()?.last().map_or(1, |(name, _)| name.run.saturating_add(1)))
    }

    /// Deletes the oldest recordings until `bytes` more fit into the limit.
    pub(super) fn make_room(&self, bytes: u64) -> Result<()> {
        let parts = self.parts()?;
        let mut total: u64 = parts.iter().map(|(_, size)| size).sum();
        for (name, size) in parts {
            if total.saturating_add(bytes) <= self.limit_bytes {
                break;
            }
            self.remove(name)?;
            total -= size;
        }
        Ok(())
    }

    /// Creates a file. Its name survives a loss of power.
    pub(super) fn create(&self, name: PartName) -> Result<File> {
        fs::create_dir_all(&self.path)?;
        let file = File::create_new(self.file(name))?;
        match File::open(&self.path).and_then(|folder| folder.sync_all()) {
            // Some file systems cannot synchronise a folder.
            Err(error) if matches!(error.kind(), ErrorKind::InvalidInput | ErrorKind::Unsupported) => {}
            done => done?,
        }
        Ok(file)
    }

    pub(super) fn remove(&self, name: PartName) -> Result<()> {
        fs::remove_file(self.file(name))
    }

    /// All recordings with their sizes (bytes), oldest first.
    fn parts(&self) -> Result<Vec<(PartName, u64)>> {
        let mut parts = Vec::new();
        for entry in fs::read_dir(&self.path)? {
            let entry = entry?;
            if let Some(name) = entry.file_name().to_str().and_then(PartName::parse) {
                parts.push((name, entry.metadata()?.len()));
            }
        }
        parts.sort_unstable();
        Ok(parts)
    }

    fn file(&self, name: PartName) -> PathBuf {
        self.path.join(name.to_string())
    }
}

impl fmt::Display for PartName {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "run-{:05}-{:05}.mcap", self.run, self.part)
    }
}

impl PartName {
    /// The name in a text. `None` if it is the name of another file.
    fn parse(text: &str) -> Option<Self> {
        let (run, part) = text.strip_prefix("run-")?.strip_suffix(".mcap")?.split_once('-')?;
        let name = Self { run: run.parse().ok()?, part: part.parse().ok()? };
        (name.to_string() == text).then_some(name)
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "a test may panic")]

    use super::*;

    #[test]
    fn names_are_read_as_they_were_written_and_other_files_are_not_recordings() {
        for name in [PartName { run: 1, part: 0 }, PartName { run: 123_456, part: 99_999 }] {
            assert_eq!(PartName::parse(&name.to_string()), Some(name));
        }
        for other in ["run-1-0.mcap", "run-00001-00000.mcap.tmp", "run-+0001-00000.mcap", "kept.mcap"] {
            assert_eq!(PartName::parse(other), None, "{other}");
        }
    }

    #[test]
    fn room_is_made_by_the_oldest_recordings_alone() {
        let folder = tempfile::tempdir().unwrap();
        let directory = Directory::new(folder.path().to_owned(), 250);
        let write = |name: &str| std::fs::write(folder.path().join(name), [0; 100]).unwrap();
        for name in ["run-00001-00000.mcap", "run-00001-00001.mcap", "run-00002-00000.mcap", "mine.mcap"] {
            write(name);
        }
        directory.make_room(60).unwrap();
        let mut left: Vec<_> = folder.path().read_dir().unwrap().map(|entry| entry.unwrap().file_name()).collect();
        left.sort();
        assert_eq!(left, ["mine.mcap", "run-00002-00000.mcap"]);
        assert_eq!(directory.next_run().unwrap(), 3);
    }
}
