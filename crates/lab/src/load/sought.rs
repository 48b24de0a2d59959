//! What a path is given for, with the texts of the program that have a name.

use std::fmt;
use std::io::{Error, ErrorKind};
use std::path::{Path, PathBuf};

use vibrissa_runtime::units::suggest;
use vibrissa_text::file::CommandFiles;

use super::LoadError;
use super::scenario::beside;
use super::text::siblings;
use crate::built_in::{MISMATCHES, NAMED_SCENARIOS, POLICIES, TextFile};

/// What a path is given for. Each kind has built-in texts, which are given by their names.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Sought {
    /// A scenario.
    Scenario,
    /// A policy or a compiled machine.
    Policy,
    /// A mismatch.
    Mismatch,
}

impl Sought {
    /// The built-in texts.
    fn built_in(self) -> &'static [TextFile] {
        match self {
            Self::Scenario => NAMED_SCENARIOS,
            Self::Policy => POLICIES,
            Self::Mismatch => MISMATCHES,
        }
    }

    /// True if the path stands for a built-in text: it is the name of one, and there is no file at it.
    #[must_use]
    pub fn is_built_in(self, path: &Path) -> bool {
        TextFile::named(self.built_in(), path).is_some() && !path.exists()
    }

    /// The path of what the text at `path` names: relative to its folder, or a built-in text if there is no such file.
    pub(crate) fn beside(self, path: &Path, name: &Path) -> PathBuf {
        let beside = beside(path, name);
        if TextFile::named(self.built_in(), name).is_some() && !beside.exists() { name.to_owned() } else { beside }
    }

    /// Reads the file at a path. If there is none, the built-in text with this name. Any other path is
    /// only that of a file.
    pub(super) fn bytes(self, path: &Path, limit: usize, files: &mut CommandFiles) -> Result<Vec<u8>, LoadError> {
        let cause = match files.read(path, limit) {
            Ok(bytes) => return Ok(bytes),
            Err(cause) if cause.kind() != ErrorKind::NotFound => return Err(LoadError::read(path)(cause)),
            Err(cause) => cause,
        };
        match TextFile::named(self.built_in(), path) {
            Some(file) => Ok(file.text.as_bytes().to_owned()),
            None => Err(self.missing(path, cause)),
        }
    }

    fn missing(self, path: &Path, cause: Error) -> LoadError {
        let meant = self.meant(path);
        LoadError::Missing { sought: self, path: path.to_owned(), meant, cause }
    }

    /// The most probable meaning of a path without a file.
    fn meant(self, path: &Path) -> Option<String> {
        let (file, stem) = (path.file_name()?.to_str()?, path.file_stem()?.to_str()?);
        let mut names: Vec<String> = self.built_in().iter().map(|file| file.name().to_owned()).collect();
        // A path with the name of a built-in text means that, wherever the command runs.
        if let Some(file) = self.built_in().iter().find(|file| file.stem() == stem) {
            return Some(file.name().to_owned());
        }
        let nearest = |name: &str, names: &[String]| suggest(name, names.iter().map(String::as_str)).map(str::to_owned);
        let of_stem = nearest(stem, &names);
        names.extend(siblings(path).into_iter().filter(|sibling| sibling != file));
        nearest(file, &names).or(of_stem)
    }

    /// The names of the built-in texts.
    pub(super) fn names(self) -> String {
        self.built_in().iter().map(TextFile::name).collect::<Vec<_>>().join(", ")
    }
}

impl fmt::Display for Sought {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Scenario => "scenario",
            Self::Policy => "policy",
            Self::Mismatch => "mismatch",
        })
    }
}

/// True if a path is given for a scenario: by the ending of its file, or by the name of a built-in one.
#[must_use]
pub fn is_scenario(path: &Path) -> bool {
    path.extension().is_some_and(|ending| ending == "yaml" || ending == "yml") || Sought::Scenario.is_built_in(path)
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "a test may panic")]

    use super::*;

    const ALL: [Sought; 3] = [Sought::Scenario, Sought::Policy, Sought::Mismatch];

    #[test]
    fn every_built_in_text_is_read_by_its_name_and_by_no_other_path() {
        for sought in ALL {
            for file in sought.built_in() {
                let read = |path: &Path| sought.bytes(path, 1 << 20, &mut CommandFiles::new());
                assert_eq!(read(Path::new(file.name())).unwrap(), file.text.as_bytes());
                let elsewhere = Path::new("nowhere").join(file.path);
                let told = read(&elsewhere).unwrap_err().to_string();
                assert!(told.contains(&format!("did you mean `{}`?", file.name())), "{told}");
            }
        }
    }

    #[test]
    fn a_name_that_cannot_be_read_has_an_error_with_its_kind_its_nearest_name_and_all_names() {
        for (sought, wrong, meant) in [
            (Sought::Scenario, "dsik", "disk"),
            (Sought::Policy, "thesi", "thesis"),
            (Sought::Mismatch, "plausble", "plausible"),
        ] {
            let told = sought.bytes(Path::new(wrong), 9, &mut CommandFiles::new()).unwrap_err().to_string();
            assert!(told.contains(&format!("did you mean `{meant}`?")) && told.contains(&sought.to_string()), "{told}");
            assert!(sought.built_in().iter().all(|file| told.contains(file.name())), "{told}");
        }
    }

    #[test]
    fn no_name_is_that_of_two_kinds() {
        let names: Vec<_> = ALL.iter().flat_map(|sought| sought.built_in()).map(TextFile::name).collect();
        let different: std::collections::BTreeSet<_> = names.iter().collect();
        assert_eq!(different.len(), names.len());
    }
}
