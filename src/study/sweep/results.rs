//! A file of results that grows line by line, and that is gone on with after a kill.

use std::collections::{BTreeMap, HashMap};
use std::fs::{File, OpenOptions, TryLockError};
use std::io::{self, BufRead, BufReader, Seek, Write};
use std::path::{Path, PathBuf};

use super::header::Header;
use super::line::read_line;
use super::shard::Shard;
use crate::scene::Sweep;
use crate::study::Figures;

/// Why results cannot be used.
#[derive(Debug, thiserror::Error)]
pub enum ResultsError {
    /// The file cannot be read or written.
    #[error("cannot use {}: {cause}", path.display())]
    File {
        /// The file.
        path: PathBuf,
        /// Why.
        cause: io::Error,
    },
    /// Another process writes to the file.
    #[error("another sweep is writing to {}; wait for it, or choose another place with --out", path.display())]
    Busy {
        /// The file.
        path: PathBuf,
    },
    /// The file holds something else.
    #[error("{} does not begin as results of a sweep do ({cause}); choose another place with --out", path.display())]
    NoResults {
        /// The file.
        path: PathBuf,
        /// What is wrong with its first line.
        cause: String,
    },
    /// The file holds results of another sweep, or of one that was another then.
    #[error("{} holds results of {difference}; keep the two apart, with another --out or without that file", path.display())]
    Other {
        /// The file.
        path: PathBuf,
        /// What is not as it was.
        difference: String,
    },
    /// A line is no result of the sweep.
    #[error("{}, line {line}: {cause}; remove that line, and go on with the sweep", path.display())]
    Line {
        /// The file.
        path: PathBuf,
        /// The number of the line, from 1.
        line: usize,
        /// What is wrong with it.
        cause: String,
    },
    /// A run has two results.
    #[error("{} and {} both have the run `{key}`; merge results of shards of the same number, each once", first.display(), second.display())]
    Twice {
        /// One of the files.
        first: PathBuf,
        /// The other one.
        second: PathBuf,
        /// The key of the run.
        key: String,
    },
}

impl ResultsError {
    pub(super) fn file(path: &Path) -> impl Fn(io::Error) -> Self {
        let path = path.to_owned();
        move |cause| Self::File { path: path.clone(), cause }
    }
}

/// The indices of a sweep's runs by their keys.
pub(super) fn indices(sweep: &Sweep) -> HashMap<String, u64> {
    sweep.runs().map(|run| (run.key(), run.index)).collect()
}

/// Results that are being written.
#[derive(Debug)]
pub struct Results {
    path: PathBuf,
    file: File,
}

impl Results {
    /// Opens the file of results at `path`, or begins it, and gives the figures of the runs that are there, by index. A last line
    /// that was not finished is cut off. Nobody else can write to the file as long as this lives.
    ///
    /// # Errors
    /// [`ResultsError`] when the file cannot be used, or holds something else than results of the part of `sweep` that `header`
    /// tells.
    pub fn open(path: &Path, header: &Header, sweep: &Sweep) -> Result<(Self, BTreeMap<u64, Figures>), ResultsError> {
        let failed = ResultsError::file(path);
        let file = OpenOptions::new().read(true).append(true).create(true).open(path).map_err(&failed)?;
        lock(path, &file)?;
        let mut results = Self { path: path.to_owned(), file };
        let indices = indices(sweep);
        let mut there = BTreeMap::new();
        let is_same = |found: &Header| check(path, found, header);
        let (found, whole) = read(path, &mut results.file, is_same, |number, line| {
            let wrong = |cause: String| ResultsError::Line { path: path.to_owned(), line: number, cause };
            let (key, figures) = read_line(line).map_err(|cause| wrong(cause.to_string()))?;
            let index = indices.get(&key).filter(|_| header.shard.has(&key));
            let index = *index.ok_or_else(|| wrong(format!("there is no run `{key}` here")))?;
            match there.insert(index, figures) {
                None => Ok(()),
                Some(_) => Err(wrong(format!("the run `{key}` is there a second time"))),
            }
        })?;
        results.file.set_len(whole).map_err(&failed)?;
        if found.is_none() {
            let header = serde_json::to_string(header).map_err(io::Error::from).map_err(&failed)?;
            results.add(&header)?;
        }
        Ok((results, there))
    }

    /// Adds the line of a run. It is in the file when this returns.
    ///
    /// # Errors
    /// [`ResultsError::File`] when it cannot be written.
    pub fn add(&mut self, line: &str) -> Result<(), ResultsError> {
        // In one go, so that a line is there as a whole or as the torn end of the file.
        let line = format!("{}\n", line.trim_end());
        self.file.write_all(line.as_bytes()).map_err(ResultsError::file(&self.path))
    }
}

/// Checks that results of what `header` tells may stand at `path`: that there is nothing, or what are results of the same, to which
/// nobody writes.
pub(super) fn check_place(path: &Path, header: &Header) -> Result<(), ResultsError> {
    match File::open(path) {
        Ok(mut file) => {
            lock(path, &file)?;
            read(path, &mut file, |found| check(path, found, header), |_, _| Ok(())).map(|_| ())
        }
        Err(cause) if cause.kind() == io::ErrorKind::NotFound => Ok(()),
        Err(cause) => Err(ResultsError::file(path)(cause)),
    }
}

/// Keeps others from writing to a file of results as long as it is open.
fn lock(path: &Path, file: &File) -> Result<(), ResultsError> {
    file.try_lock().map_err(|error| match error {
        TryLockError::WouldBlock => ResultsError::Busy { path: path.to_owned() },
        TryLockError::Error(cause) => ResultsError::file(path)(cause),
    })
}

fn check(path: &Path, found: &Header, header: &Header) -> Result<(), ResultsError> {
    let other_shard = |shard: Shard| format!("the shard {shard}, this one is {}", header.shard);
    let difference = found.difference(header);
    let difference = difference.or_else(|| (found.shard != header.shard).then(|| other_shard(found.shard)));
    difference.map_or(Ok(()), |difference| Err(ResultsError::Other { path: path.to_owned(), difference }))
}

/// Reads a file of results: has what the first line says checked, and gives every other line with its number. Returns what the first
/// says, `None` if it is not there as a whole, and how many bytes there are without a torn end.
pub(super) fn read(
    path: &Path,
    file: &mut File,
    check: impl Fn(&Header) -> Result<(), ResultsError>,
    mut each: impl FnMut(usize, &str) -> Result<(), ResultsError>,
) -> Result<(Option<Header>, u64), ResultsError> {
    let failed = ResultsError::file(path);
    file.rewind().map_err(&failed)?;
    let mut reader = BufReader::new(file);
    let (mut header, mut whole, mut text) = (None, 0, Vec::new());
    for number in 1.. {
        text.clear();
        reader.read_until(b'\n', &mut text).map_err(&failed)?;
        if text.last() != Some(&b'\n') {
            break;
        }
        whole += text.len() as u64;
        let line = String::from_utf8_lossy(&text);
        if header.is_none() {
            let no_results =
                |cause: serde_json::Error| ResultsError::NoResults { path: path.to_owned(), cause: cause.to_string() };
            let found = serde_json::from_str(&line).map_err(no_results)?;
            check(&found)?;
            header = Some(found);
        } else {
            each(number, &line)?;
        }
    }
    // Something else that just has no end of line is not to be taken for a torn header.
    if header.is_none() && !text.is_empty() && !text.starts_with(br#"{"sweep":""#) {
        return Err(ResultsError::NoResults { path: path.to_owned(), cause: "it has no first line".to_owned() });
    }
    Ok((header, whole))
}
