//! A file's content, replaced as a whole.

use std::fs::{self, File, OpenOptions};
use std::io::{ErrorKind, Result, Write};
use std::path::Path;

use super::identity::{folder, place};

/// Temporary files are called `.vibrissa-`, letters and digits drawn at random, `.tmp`. One is left only where the program was killed.
const PREFIX: &str = ".vibrissa-";
const SUFFIX: &str = ".tmp";
const RANDOM: usize = 12;

/// Replaces the content of the file at `path`, or makes the file. Whoever reads it, also after a kill, a full disk or a loss of power, finds the
/// old content or the new one. A link stays, and what it leads to is replaced. The file keeps its mode, and its owner where that is
/// allowed; a new one has the mode that the umask leaves. Another hard link of the old file keeps the old content.
///
/// # Errors
/// The file may not be written, its folder may not, or there is no room. Then the old content is there. Only if the folder cannot be synced, the
/// new one may be.
pub fn replace(path: &Path, content: &[u8]) -> Result<()> {
    let path = place(path)?;
    let folder = folder(&path);
    // A new name is given without asking whether the file may be written. Opening asks; nothing is changed by it.
    let old = match OpenOptions::new().write(true).open(&path) {
        Ok(old) => Some(old),
        Err(cause) if cause.kind() == ErrorKind::NotFound => None,
        Err(cause) => return Err(cause),
    };
    // In the same folder, because only within a file system a new name takes the place of the old one at once.
    let mut new = builder().tempfile_in(folder)?;
    if let Some(old) = old {
        keep_mode(&old, new.as_file())?;
    }
    new.write_all(content)?;
    new.as_file().sync_all()?;
    let temporary = new.into_temp_path();
    fs::rename(&temporary, &path)?;
    temporary.keep()?;
    sync_name(&path)
}

fn builder() -> tempfile::Builder<'static, 'static> {
    let mut builder = tempfile::Builder::new();
    builder.prefix(PREFIX).suffix(SUFFIX).rand_bytes(RANDOM);
    #[cfg(unix)]
    {
        use std::os::unix::fs::PermissionsExt;
        // Of which the umask takes its part, as of that of any new file.
        builder.permissions(fs::Permissions::from_mode(0o666));
    }
    builder
}

/// Gives a new file the owner and the mode of the old one, before it has content that not everybody may read.
fn keep_mode(old: &File, new: &File) -> Result<()> {
    let old = old.metadata()?;
    #[cfg(unix)]
    {
        use std::os::unix::fs::{MetadataExt, fchown};
        let about = new.metadata()?;
        // Only root may give files away, others may to groups that they belong to. Whoever else replaces a file of another user owns it.
        if about.gid() != old.gid() {
            let _ = fchown(new, None, Some(old.gid()));
        }
        if about.uid() != old.uid() {
            let _ = fchown(new, Some(old.uid()), None);
        }
    }
    new.set_permissions(old.permissions())
}

/// Makes the name of a new file outlast a loss of power.
///
/// # Errors
/// The file's folder cannot be synced.
#[cfg(unix)]
pub fn sync_name(path: &Path) -> Result<()> {
    match File::open(folder(path)).and_then(|folder| folder.sync_all()) {
        // Some file systems cannot sync a folder, and a folder that may be written need not be one that may be opened.
        Err(cause)
            if matches!(
                cause.kind(),
                ErrorKind::InvalidInput | ErrorKind::Unsupported | ErrorKind::PermissionDenied
            ) =>
        {
            Ok(())
        }
        done => done,
    }
}

#[cfg(not(unix))]
#[expect(clippy::unnecessary_wraps, missing_docs, reason = "elsewhere it can fail")]
pub fn sync_name(_: &Path) -> Result<()> {
    Ok(())
}
