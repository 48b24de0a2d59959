//! The files of one command.

use std::collections::HashMap;
use std::fs::File;
use std::io::{Error, ErrorKind, Result, stderr, stdin, stdout};
use std::path::{Path, PathBuf};

use super::identity::{Identity, place};
use super::output::{Output, OutputError, Stream, Way};
use super::regular::{self, read_at_most};

/// What one command reads and writes. No file is both, and none is written twice, whatever names and links lead to it.
#[derive(Debug)]
pub struct CommandFiles {
    /// All that was asked for, be it there or not, in that order.
    inputs: Vec<PathBuf>,
    uses: HashMap<Identity, Use>,
    /// Standard output and standard error.
    streams: [Option<Identity>; 2],
}

/// What a file is used for.
#[derive(Debug, Clone)]
enum Use {
    Input(PathBuf),
    Output { argument: &'static str, path: PathBuf },
}

/// A file is an output already.
#[derive(Debug, thiserror::Error)]
#[error("this command writes to the same file: {0}; give one of them another place")]
struct IsOutput(String);

impl CommandFiles {
    /// Those of a command that has not begun.
    #[must_use]
    #[expect(clippy::new_without_default, reason = "it looks at the program's streams")]
    pub fn new() -> Self {
        Self {
            inputs: Vec::new(),
            uses: HashMap::new(),
            streams: [stream_identity(&stdout()), stream_identity(&stderr())].map(|stream| Some(stream?.0)),
        }
    }

    /// The bytes of a regular file, but no more than show that there are more than `limit`.
    ///
    /// # Errors
    /// It is none, it cannot be read, or the command writes to it.
    pub fn read(&mut self, path: &Path, limit: usize) -> Result<Vec<u8>> {
        self.open(path).and_then(|file| read_at_most(file, limit))
    }

    /// The same of standard input, whatever that is.
    ///
    /// # Errors
    /// It cannot be read, or the command's messages or results go to the same file.
    pub fn read_standard(&mut self, limit: usize) -> Result<Vec<u8>> {
        // A terminal is all three streams.
        if let Some((identity, true)) = stream_identity(&stdin()) {
            self.read_once(identity, Path::new("standard input"))?;
        }
        read_at_most(stdin().lock(), limit)
    }

    /// Opens a regular file for reading.
    ///
    /// # Errors
    /// As of [`Self::read`].
    pub fn open(&mut self, path: &Path) -> Result<File> {
        self.inputs.push(path.to_owned());
        let file = regular::open(path)?;
        for identity in Identity::of(path) {
            self.read_once(identity, path)?;
        }
        Ok(file)
    }

    /// Notes that a file is read.
    fn read_once(&mut self, identity: Identity, path: &Path) -> Result<()> {
        let output = match (self.stream(&identity), self.uses.get(&identity)) {
            (Some(stream), _) => stream.to_string(),
            (None, Some(Use::Output { argument, path })) => format!("{} ({argument})", path.display()),
            (None, _) => {
                self.uses.entry(identity).or_insert_with(|| Use::Input(path.to_owned()));
                return Ok(());
            }
        };
        Err(Error::new(ErrorKind::InvalidInput, IsOutput(output)))
    }

    /// The paths that were to be read until now, also those where there was nothing.
    pub fn inputs(&self) -> impl Iterator<Item = &Path> {
        self.inputs.iter().map(PathBuf::as_path)
    }

    /// A place to write to, which `argument` names. Where everything is asked for before the work begins, nothing is lost by a refusal.
    ///
    /// # Errors
    /// [`OutputError`] when it cannot be written, is an input, or is an output already.
    pub fn output(&mut self, argument: &'static str, path: &Path) -> std::result::Result<Output, OutputError> {
        let unwritable = |cause| OutputError::Unwritable { argument, path: path.to_owned(), cause };
        let about = path.metadata();
        if let Ok(about) = &about {
            if about.is_dir() {
                return Err(unwritable(ErrorKind::IsADirectory.into()));
            }
            if let Some(stream) = Identity::inode(about).and_then(|inode| self.stream(&inode)) {
                return Ok(Output::new(argument, path, Way::Stream(stream)));
            }
            if !about.is_file() {
                return Ok(Output::new(argument, path, Way::Open));
            }
        }
        place(path).map_err(unwritable)?;
        let identities: Vec<_> = Identity::of(path).collect();
        for identity in identities {
            let (argument, path) = (argument, path.to_owned());
            match self.uses.get(&identity).cloned() {
                Some(Use::Input(input)) => return Err(OutputError::Input { argument, path, input }),
                Some(Use::Output { argument: other_argument, path: other }) => {
                    return Err(OutputError::Twice { argument, path, other_argument, other });
                }
                None => self.uses.insert(identity, Use::Output { argument, path }),
            };
        }
        Ok(Output::new(argument, path, Way::Replace))
    }

    /// The program's own stream that a file is.
    fn stream(&self, identity: &Identity) -> Option<Stream> {
        let [out, error] = self.streams.each_ref().map(|stream| stream.as_ref() == Some(identity));
        if out { Some(Stream::Output) } else { error.then_some(Stream::Error) }
    }
}

/// What a stream is, and whether that is a regular file.
#[cfg(unix)]
fn stream_identity(stream: &impl std::os::fd::AsFd) -> Option<(Identity, bool)> {
    let about = File::from(stream.as_fd().try_clone_to_owned().ok()?).metadata().ok()?;
    Some((Identity::inode(&about)?, about.is_file()))
}

#[cfg(not(unix))]
fn stream_identity<S>(_: &S) -> Option<(Identity, bool)> {
    None
}
