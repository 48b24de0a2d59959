//! The files of one command.

use std::collections::HashMap;
use std::fs::File;
use std::io::{Error, ErrorKind, Result, stderr, stdin, stdout};
use std::path::{Path, PathBuf};

use super::identity::{Identity, place};
use super::output::{Output, OutputError, Stream, Way};
use super::regular::{self, read_at_most};
use super::special;

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

/// What an output's path leads to.
enum Goal {
    /// A regular file, or nothing yet.
    Regular,
    /// What else there is, such as a pipe.
    Special,
    /// A stream of the program.
    Stream(Stream),
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
        let way = match self.goal(path).map_err(unwritable)? {
            Goal::Regular => {
                self.write_once(argument, path)?;
                Way::Replace
            }
            Goal::Special => Way::Open(special::open(path).map_err(unwritable)?),
            Goal::Stream(stream) => Way::Stream(stream),
        };
        Ok(Output::new(argument, path, way))
    }

    /// The same of a file to which lines are added. The caller opens it.
    ///
    /// # Errors
    /// [`OutputError`] as of [`Self::output`], and when it is no regular file, or a stream of the program goes there.
    pub fn growing(&mut self, argument: &'static str, path: &Path) -> std::result::Result<(), OutputError> {
        let unwritable = |cause| OutputError::Unwritable { argument, path: path.to_owned(), cause };
        match self.goal(path).map_err(unwritable)? {
            Goal::Regular => self.write_once(argument, path),
            Goal::Special | Goal::Stream(_) => {
                let cause = "lines are added only to a regular file of their own";
                Err(unwritable(Error::new(ErrorKind::InvalidInput, cause)))
            }
        }
    }

    /// What an output's path leads to.
    fn goal(&self, path: &Path) -> Result<Goal> {
        let Ok(about) = path.metadata() else { return Ok(Goal::Regular) };
        if about.is_dir() {
            return Err(ErrorKind::IsADirectory.into());
        }
        let stream = Identity::inode(&about).and_then(|inode| self.stream(&inode));
        Ok(match stream {
            Some(stream) => Goal::Stream(stream),
            None if about.is_file() => Goal::Regular,
            None => Goal::Special,
        })
    }

    /// Notes that a regular file is written.
    fn write_once(&mut self, argument: &'static str, path: &Path) -> std::result::Result<(), OutputError> {
        place(path).map_err(|cause| OutputError::Unwritable { argument, path: path.to_owned(), cause })?;
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
        Ok(())
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
