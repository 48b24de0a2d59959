//! Atomic replacement of a file's content.

use std::fs::{self, File, OpenOptions};
use std::io::{BufWriter, ErrorKind, Result, Write};
use std::path::Path;

use super::identity::{folder, resolve_links};

/// Prefix of temporary files. Random letters and digits follow, and then `.tmp`. Such a file remains only if the
/// program was killed.
pub(super) const PREFIX: &str = ".vibrissa-";
const SUFFIX: &str = ".tmp";
const RANDOM: usize = 12;

/// Replaces the content of the file at `path`, or creates the file.
///
/// A reader finds either the old or the new content, even after a kill, a full disk or a loss of power. A symbolic link
/// stays, and its target is replaced. The file keeps its mode, and its owner if the system allows it. A new file has
/// the mode that the umask leaves. Other hard links of the old file keep the old content.
///
/// # Errors
/// The file or its folder may not be written, or the disk is full. Then the old content is there. If only the
/// synchronisation of the folder failed, the new content may be there.
pub fn replace(path: &Path, content: &[u8]) -> Result<()> {
    replace_with(path, |file| file.write_all(content))
}

/// The same with a content that `write` writes piece by piece.
pub(super) fn replace_with(path: &Path, write: impl FnOnce(&mut dyn Write) -> Result<()>) -> Result<()> {
    let path = resolve_links(path)?;
    let folder = folder(&path);
    // Renaming does not ask for permission to write the file. Opening does, and changes nothing.
    let old = match OpenOptions::new().write(true).open(&path) {
        Ok(old) => Some(old),
        Err(cause) if cause.kind() == ErrorKind::NotFound => None,
        Err(cause) => return Err(cause),
    };
    // In the same folder, because a rename is atomic only within one file system.
    let mut new = builder().tempfile_in(folder)?;
    if let Some(old) = old {
        keep_mode(&old, new.as_file())?;
    }
    let mut buffered = BufWriter::new(&mut new);
    write(&mut buffered)?;
    buffered.flush()?;
    drop(buffered);
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
        // The umask applies to this mode, as to that of any new file.
        builder.permissions(fs::Permissions::from_mode(0o666));
    }
    builder
}

/// Gives a new file the owner and the mode of the old one, before it has content that must not be readable by everyone.
fn keep_mode(old: &File, new: &File) -> Result<()> {
    let old = old.metadata()?;
    #[cfg(unix)]
    {
        use std::os::unix::fs::{MetadataExt, fchown};
        let about = new.metadata()?;
        // Only root may change owners. Other users may change the group to one of their own. Otherwise the new file
        // belongs to the current user.
        if about.gid() != old.gid() {
            let _ = fchown(new, None, Some(old.gid()));
        }
        if about.uid() != old.uid() {
            let _ = fchown(new, Some(old.uid()), None);
        }
    }
    new.set_permissions(old.permissions())
}

/// Synchronises the folder, so that the name of a new file survives a loss of power.
///
/// # Errors
/// The folder of the file cannot be synchronised.
#[cfg(unix)]
pub fn sync_name(path: &Path) -> Result<()> {
    match File::open(folder(path)).and_then(|folder| folder.sync_all()) {
        // Some file systems cannot synchronise a folder, and a folder that may be written need not be one that may be
        // opened.
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
