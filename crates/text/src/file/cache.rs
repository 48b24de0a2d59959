//! Files that can be made again.

use std::env;
use std::fs;
use std::path::PathBuf;

use sha2::{Digest, Sha256};

use super::regular::read;
use super::replace::replace;

/// A folder of files that can be made again, each with a key. Anybody may delete it at any time.
///
/// A file is written as a whole or not at all, and has a hash of its content. So several processes may write the same file, and a
/// damaged one counts as none. What cannot be read or written is made again, without an error.
#[derive(Debug, Clone)]
pub struct Cache {
    folder: PathBuf,
}

/// The folder of the cache. Empty for none.
const VARIABLE: &str = "VIBRISSA_CACHE";
/// Largest size of a file in bytes.
const LIMIT: usize = 1 << 22;
/// Number of hexadecimal digits of a hash.
const DIGITS: usize = 64;

impl Cache {
    /// The part `name` of the cache of the user: in the folder that the environment variable `VIBRISSA_CACHE` names, or else in
    /// `vibrissa` in the folder of the system for caches. `None` if the variable is empty, or if there is no such folder.
    #[must_use]
    pub fn of_user(name: &str) -> Option<Self> {
        let folder = match env::var_os(VARIABLE) {
            Some(given) => PathBuf::from(given),
            None => system_folder()?.join("vibrissa"),
        };
        (!folder.as_os_str().is_empty()).then(|| Self::at(folder.join(name)))
    }

    /// The files of a folder, which need not exist.
    #[must_use]
    pub fn at(folder: PathBuf) -> Self {
        Self { folder }
    }

    /// The content of the file with this key, if there is one and it is whole.
    #[must_use]
    pub fn read(&self, key: &str) -> Option<Vec<u8>> {
        let file = read(&self.folder.join(key), LIMIT).ok()?;
        let (hash, content) = file.split_at_checked(DIGITS)?;
        (hash == hex(&Sha256::digest(content)).as_bytes()).then(|| content.to_vec())
    }

    /// Writes the file with this key if that is possible.
    pub fn write(&self, key: &str, content: &[u8]) {
        let hashed = [hex(&Sha256::digest(content)).as_bytes(), content].concat();
        // The folder is not an output of the command, which goes on without it.
        let _ = fs::create_dir_all(&self.folder).and_then(|()| replace(&self.folder.join(key), &hashed));
    }
}

/// The folder of the system for caches.
fn system_folder() -> Option<PathBuf> {
    // A relative path would depend on the working directory.
    let absolute = |path: PathBuf| path.is_absolute().then_some(path);
    let variable = |name| env::var_os(name).map(PathBuf::from).and_then(absolute);
    if cfg!(windows) {
        return variable("LOCALAPPDATA");
    }
    variable("XDG_CACHE_HOME").or_else(|| {
        let folder = if cfg!(target_os = "macos") { "Library/Caches" } else { ".cache" };
        Some(env::home_dir().and_then(absolute)?.join(folder))
    })
}

/// A hash in hexadecimal digits.
#[must_use]
pub fn hex(hash: &[u8]) -> String {
    use std::fmt::Write;
    // Writing to a string cannot fail.
    hash.iter().fold(String::with_capacity(2 * hash.len()), |mut text, byte| {
        let _ = write!(text, "{byte:02x}");
        text
    })
}
