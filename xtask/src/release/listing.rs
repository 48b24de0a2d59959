//! The list of the released files.

use std::fmt::Write;
use std::fs;
use std::path::Path;

use super::ReleaseError;
use crate::hash::sha256;
use crate::pack::disk;

/// The file with the hashes, in the form of `sha256sum --check`.
const NAME: &str = "SHA256SUMS";

/// Writes the hashes of all files, and gives a table of sizes (bytes), hashes and names.
pub(super) fn write(folder: &Path) -> Result<String, ReleaseError> {
    let entries = fs::read_dir(folder).map_err(disk("read", folder))?;
    let mut files: Vec<_> = entries.flatten().map(|entry| entry.path()).filter(|file| !file.ends_with(NAME)).collect();
    files.sort();
    let (mut sums, mut table) = (String::new(), String::new());
    for file in files {
        let hash = sha256(&file).map_err(disk("read", &file))?;
        let size = fs::metadata(&file).map_err(disk("read", &file))?.len();
        let name = file.file_name().unwrap_or_default().to_string_lossy().into_owned();
        // Writing to a string cannot fail.
        let _ = writeln!(sums, "{hash}  {name}");
        let _ = writeln!(table, "{size:>10}  {hash}  {name}");
    }
    let list = folder.join(NAME);
    fs::write(&list, sums).map_err(disk("write", &list))?;
    Ok(table)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::pack::clear;

    #[test]
    fn every_file_is_listed_with_its_size_and_the_list_does_not_list_itself() -> Result<(), ReleaseError> {
        let folder = std::env::temp_dir().join(format!("xtask-listing-{}", std::process::id()));
        clear(&folder)?;
        for (name, text) in [("b", ""), ("a", "abc")] {
            fs::write(folder.join(name), text).map_err(disk("write", &folder))?;
        }
        let first = write(&folder)?;
        assert_eq!(first, write(&folder)?);
        let hash = "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad";
        assert!(first.starts_with(&format!("         3  {hash}  a\n         0  ")), "{first}");
        let sums = fs::read_to_string(folder.join(NAME)).map_err(disk("read", &folder))?;
        assert!(sums.starts_with(&format!("{hash}  a\n")) && sums.lines().count() == 2, "{sums}");
        fs::remove_dir_all(&folder).map_err(disk("clear", &folder))?;
        Ok(())
    }
}
