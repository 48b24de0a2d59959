//! The files of a policy, as files of one folder.

use std::collections::BTreeMap;
use std::path::Path;
use std::{fs, io};

/// The folder of the standard library.
const LIBRARY: &str = "policies/std";

/// The texts of a policy and of all libraries that it uses, by the names of their files.
#[derive(Debug, Clone)]
pub(super) struct Files(pub(super) BTreeMap<String, String>);

impl Files {
    /// Reads `policies/NAME` and the libraries behind it.
    pub(super) fn read(root: &Path, name: &str) -> io::Result<Self> {
        let mut files = BTreeMap::new();
        let mut pending = vec![(name.to_owned(), root.join("policies").join(name))];
        while let Some((name, path)) = pending.pop() {
            let text = fs::read_to_string(&path)
                .map_err(|error| io::Error::new(error.kind(), format!("{}: {error}", path.display())))?;
            let used = text.lines().filter_map(module);
            pending.extend(used.map(|used| (format!("{used}.fsm"), root.join(LIBRARY).join(format!("{used}.fsm")))));
            files.insert(name, text);
            pending.retain(|(name, _)| !files.contains_key(name));
        }
        Ok(Self(files))
    }

    /// Writes all files into a folder. They use one another instead of the standard library in the program.
    pub(super) fn write(&self, folder: &Path) -> io::Result<()> {
        fs::create_dir_all(folder)?;
        for (name, text) in &self.0 {
            let line = |line: &str| match module(line) {
                Some(module) => line.replacen(&format!("std.{module}"), &format!("\"{module}.fsm\""), 1),
                None => line.to_owned(),
            };
            let text: String = text.lines().map(line).flat_map(|line| [line, "\n".to_owned()]).collect();
            fs::write(folder.join(name), text)?;
        }
        Ok(())
    }
}

/// The module of the standard library that a line uses.
fn module(line: &str) -> Option<&str> {
    let module = line.strip_prefix("use std.")?;
    Some(module.split(|letter: char| !letter.is_alphanumeric() && letter != '_').next().unwrap_or_default())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_line_that_uses_a_module_names_it() {
        assert_eq!(module("use std.first_contact (meet, turn_along)"), Some("first_contact"));
        assert_eq!(module("use std.shaft"), Some("shaft"));
        assert_eq!(module("# use std.shaft"), None);
    }
}
