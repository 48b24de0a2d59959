//! A file of results that grows line by line, and that is gone on with after a kill.

use crate::results::Document;
use std::collections::{BTreeMap, HashMap};
use std::fs::{File, TryLockError};
use std::io::{self, Write};
use std::path::{Path, PathBuf};

use super::header::Header;
use super::line::read_line;
use super::lines::{LINE_LIMIT, Lines};
use super::shard::Shard;
use crate::file;
use crate::results::Figures;
use crate::sweep::Sweep;

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
    /// A line is too long to be a result.
    #[error("{}, line {line}: it has more than {} MiB, and no line of results has; is this the right file?", path.display(), LINE_LIMIT >> 20)]
    LongLine {
        /// The file.
        path: PathBuf,
        /// The number of the line, from 1.
        line: usize,
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
        let file = locked(path)?;
        let indices = indices(sweep);
        let mut there = BTreeMap::new();
        let mut lines = Lines::new(path, &file);
        let found = lines.header()?;
        if let Some(found) = &found {
            check(path, found, header)?;
        }
        while let Some((number, line)) = lines.next()? {
            let wrong = |cause: String| ResultsError::Line { path: path.to_owned(), line: number, cause };
            let (key, figures) = read_line(&line).map_err(|cause| wrong(cause.to_string()))?;
            let index = indices.get(&key).filter(|_| header.shard.has(&key));
            let index = *index.ok_or_else(|| wrong(format!("there is no run `{key}` here")))?;
            if there.insert(index, figures).is_some() {
                return Err(wrong(format!("the run `{key}` is there a second time")));
            }
        }
        let whole = lines.whole();
        file.set_len(whole).map_err(&failed)?;
        let mut results = Self { path: path.to_owned(), file };
        if found.is_none() {
            let header = serde_json::to_string(&header.versioned()).map_err(io::Error::from).map_err(&failed)?;
            results.add(&header)?;
            file::sync_name(path).map_err(&failed)?;
        }
        Ok((results, there))
    }

    /// Adds the line of a run. It is on the disk when this returns.
    ///
    /// # Errors
    /// [`ResultsError::File`] when it cannot be written.
    pub fn add(&mut self, line: &str) -> Result<(), ResultsError> {
        // In one go, so that a line is there as a whole or as the torn end of the file.
        let line = format!("{}\n", line.trim_end());
        let written = if line.len() > LINE_LIMIT {
            // It could not be read again.
            Err(io::Error::new(io::ErrorKind::InvalidData, "a line of results would be too long"))
        } else {
            self.file.write_all(line.as_bytes()).and_then(|()| self.file.sync_data())
        };
        written.map_err(ResultsError::file(&self.path))
    }
}

/// Checks that results of what `header` tells may take the place of what is at `path`: that there is nothing, or what are results of the same.
/// As long as what it gives is kept, no sweep writes to them.
pub(super) fn check_place(path: &Path, header: &Header) -> Result<Option<File>, ResultsError> {
    // What is no regular file holds nothing that could be lost.
    if !path.is_file() {
        return Ok(None);
    }
    let file = file::open(path).map_err(ResultsError::file(path))?;
    lock(path, &file)?;
    if let Some(found) = Lines::new(path, &file).header()? {
        check(path, &found, header)?;
    }
    Ok(Some(file))
}

/// Opens a file of results, which nobody else writes to as long as it is open.
fn locked(path: &Path) -> Result<File, ResultsError> {
    loop {
        let file = file::append(path).map_err(ResultsError::file(path))?;
        lock(path, &file)?;
        // Before it was locked, merged results may have taken its place; what is added to it would be lost.
        if file::is_at(&file, path) {
            return Ok(file);
        }
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
