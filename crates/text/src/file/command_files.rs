//! The files of one command.

use std::collections::HashMap;
use std::fs::File;
use std::io::{Error, ErrorKind, Result, stderr, stdin, stdout};
use std::path::{Path, PathBuf};

use super::identity::{Identity, resolve_links};
use super::output::{Method, Output, OutputError, Stream};
use super::regular::{self, read_at_most};
use super::special;

/// The inputs and outputs of one command. No file is both, and no file is written twice, under any name or link.
#[derive(Debug)]
pub struct CommandFiles {
    /// All requested inputs in the order of the requests, including those that do not exist.
    inputs: Vec<PathBuf>,
    uses: HashMap<Identity, Use>,
    /// Standard output and standard error.
    streams: [Option<Identity>; 2],
}

/// The use of a file.
#[derive(Debug, Clone)]
enum Use {
    Input(PathBuf),
    Output { argument: &'static str, path: PathBuf },
}

/// The kind of an output file.
enum OutputKind {
    /// A regular file, or no file yet.
    Regular,
    /// Any other file, such as a pipe.
    Special,
    /// A stream of the program.
    Stream(Stream),
}

/// The error for an input that is already an output.
#[derive(Debug, thiserror::Error)]
#[error("this command writes to the same file: {0}; give one of them another path")]
struct IsOutput(String);

impl Default for CommandFiles {
    fn default() -> Self {
        Self::new()
    }
}

impl CommandFiles {
    /// The files of a command that has not begun.
    #[must_use]
    pub fn new() -> Self {
        Self {
            inputs: Vec::new(),
            uses: HashMap::new(),
            streams: [stream_identity(&stdout()), stream_identity(&stderr())].map(|stream| Some(stream?.0)),
        }
    }

    /// Reads a regular file, at most `limit` bytes and one more. A longer result shows that the file exceeds the limit.
    ///
    /// # Errors
    /// The file is not regular, cannot be read, or is an output of the command.
    pub fn read(&mut self, path: &Path, limit: usize) -> Result<Vec<u8>> {
        self.open(path).and_then(|file| read_at_most(file, limit))
    }

    /// Reads standard input, of any kind, with the same limit.
    ///
    /// # Errors
    /// It cannot be read, or the messages or results of the command go to the same file.
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
    /// Those of [`Self::read`].
    pub fn open(&mut self, path: &Path) -> Result<File> {
        self.inputs.push(path.to_owned());
        let file = regular::open(path)?;
        for identity in Identity::of(path) {
            self.read_once(identity, path)?;
        }
        Ok(file)
    }

    /// Records that a file is read.
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

    /// The paths of all inputs until now, including those that do not exist.
    pub fn inputs(&self) -> impl Iterator<Item = &Path> {
        self.inputs.iter().map(PathBuf::as_path)
    }

    /// An output, named by `argument`. Request all outputs before the work begins, so that a refusal loses no results.
    ///
    /// # Errors
    /// [`OutputError`] if the file cannot be written, is an input, or is already an output.
    pub fn output(&mut self, argument: &'static str, path: &Path) -> std::result::Result<Output, OutputError> {
        let unwritable = |cause| OutputError::Unwritable { argument, path: path.to_owned(), cause };
        let method = match self.output_kind(path).map_err(unwritable)? {
            OutputKind::Regular => {
                self.write_once(argument, path)?;
                Method::Replace
            }
            OutputKind::Special => Method::Open(special::open(path).map_err(unwritable)?),
            OutputKind::Stream(stream) => Method::Stream(stream),
        };
        Ok(Output::new(argument, path, method))
    }

    /// An output to which lines are appended. The caller opens the file.
    ///
    /// # Errors
    /// [`OutputError`] as of [`Self::output`], and if the file is not regular or receives a stream of the program.
    pub fn growing(&mut self, argument: &'static str, path: &Path) -> std::result::Result<(), OutputError> {
        let unwritable = |cause| OutputError::Unwritable { argument, path: path.to_owned(), cause };
        match self.output_kind(path).map_err(unwritable)? {
            OutputKind::Regular => self.write_once(argument, path),
            OutputKind::Special | OutputKind::Stream(_) => {
                let cause = "lines are added only to a regular file of their own";
                Err(unwritable(Error::new(ErrorKind::InvalidInput, cause)))
            }
        }
    }

    /// The kind of the file at an output's path.
    fn output_kind(&self, path: &Path) -> Result<OutputKind> {
        let Ok(about) = path.metadata() else { return Ok(OutputKind::Regular) };
        if about.is_dir() {
            return Err(ErrorKind::IsADirectory.into());
        }
        let stream = Identity::inode(&about).and_then(|inode| self.stream(&inode));
        Ok(match stream {
            Some(stream) => OutputKind::Stream(stream),
            None if about.is_file() => OutputKind::Regular,
            None => OutputKind::Special,
        })
    }

    /// Records that a regular file is written.
    fn write_once(&mut self, argument: &'static str, path: &Path) -> std::result::Result<(), OutputError> {
        resolve_links(path).map_err(|cause| OutputError::Unwritable { argument, path: path.to_owned(), cause })?;
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

    /// The program's own stream that a file is, if it is one.
    fn stream(&self, identity: &Identity) -> Option<Stream> {
        let [out, error] = self.streams.each_ref().map(|stream| stream.as_ref() == Some(identity));
        if out { Some(Stream::Output) } else { error.then_some(Stream::Error) }
    }
}

/// The identity of a stream, and true if the stream is a regular file.
#[cfg(unix)]
fn stream_identity(stream: &impl std::os::fd::AsFd) -> Option<(Identity, bool)> {
    let about = File::from(stream.as_fd().try_clone_to_owned().ok()?).metadata().ok()?;
    Some((Identity::inode(&about)?, about.is_file()))
}

#[cfg(not(unix))]
fn stream_identity<S>(_: &S) -> Option<(Identity, bool)> {
    None
}
