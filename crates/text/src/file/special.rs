//! Pipes, terminals and devices, opened for writing.

use std::fs::{File, OpenOptions};
use std::io::Result;
use std::path::Path;

/// Opens the file for writing. Opening a pipe without a reader would wait for ever.
///
/// # Errors
/// The file cannot be opened, or the pipe has no reader.
#[cfg(unix)]
pub(super) fn open(path: &Path) -> Result<File> {
    use std::io::{Error, ErrorKind};
    use std::os::unix::fs::OpenOptionsExt;
    use std::time::{Duration, Instant};

    use rustix::fs::{OFlags, fcntl_getfl, fcntl_setfl};
    use rustix::io::Errno;

    /// The time that a reader of a pipe has to open it. A shell starts both programs at once.
    const PATIENCE: Duration = Duration::from_secs(1);
    const PAUSE: Duration = Duration::from_millis(10);

    let mut options = OpenOptions::new();
    options.write(true).custom_flags(OFlags::NONBLOCK.bits().cast_signed());
    let until = Instant::now() + PATIENCE;
    loop {
        match options.open(path) {
            Ok(file) => {
                // Only opening must not wait. A slow reader gets everything.
                fcntl_setfl(&file, fcntl_getfl(&file)? - OFlags::NONBLOCK)?;
                return Ok(file);
            }
            Err(cause) if is_pipe(path) && cause.raw_os_error() == Some(Errno::NXIO.raw_os_error()) => {
                if Instant::now() >= until {
                    return Err(Error::new(ErrorKind::NotConnected, NoReader));
                }
                std::thread::sleep(PAUSE);
            }
            Err(cause) => return Err(cause),
        }
    }
}

/// The error for a pipe without a reader.
#[cfg(unix)]
#[derive(Debug, Clone, Copy, thiserror::Error)]
#[error("it is a pipe without a reader; start its reader, or remove it")]
struct NoReader;

#[cfg(unix)]
fn is_pipe(path: &Path) -> bool {
    use std::os::unix::fs::FileTypeExt;
    path.metadata().is_ok_and(|about| about.file_type().is_fifo())
}

#[cfg(not(unix))]
pub(super) fn open(path: &Path) -> Result<File> {
    OpenOptions::new().write(true).open(path)
}
