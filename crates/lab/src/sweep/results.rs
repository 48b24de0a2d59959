//! A file of results that grows line by line. An interrupted sweep is resumed from it.

use crate::results::Document;
use std::collections::BTreeMap;
use std::fs::{File, TryLockError};
use std::io::{self, Write};
use std::path::{Path, PathBuf};
use vibrissa_text::system::in_words;

use super::header::Header;
use super::line::{ReadLine, read_line};
use super::lines::{LINE_LIMIT, Lines};
use super::shard::run_hash;
use crate::results::{Ending, Figures, Provenance};
use crate::sweep::{Sweep, SweepRun};
use vibrissa_text::file;

/// The error of a file of results.
#[derive(Debug, thiserror::Error)]
pub enum ResultsError {
    /// The file cannot be read or written.
    #[error("cannot use {}: {words}", path.display(), words = in_words(cause))]
    File {
        /// The file.
        path: PathBuf,
        /// The cause.
        cause: io::Error,
    },
    /// Another process writes to the file.
    #[error("another process is writing to {}; wait for it, or choose another path with --out", path.display())]
    Busy {
        /// The file.
        path: PathBuf,
    },
    /// The file has other content.
    #[error("{} does not contain results of runs ({cause}); choose another path with --out", path.display())]
    NoResults {
        /// The file.
        path: PathBuf,
        /// The error of its first line.
        cause: String,
    },
    /// The file has results of other inputs.
    #[error("{} holds results of {difference}; choose another path with --out, or remove that file", path.display())]
    Other {
        /// The file.
        path: PathBuf,
        /// The difference.
        difference: String,
    },
    /// A line is not a result.
    #[error("{}, line {line}: {cause}; remove that line, and give the same command again", path.display())]
    Line {
        /// The file.
        path: PathBuf,
        /// The number of the line, from 1.
        line: usize,
        /// The error of the line.
        cause: String,
    },
    /// A line is too long to be a result.
    #[error("{}, line {line} is longer than {} MiB, the limit of a result; check that this is the right file", path.display(), LINE_LIMIT >> 20)]
    LongLine {
        /// The file.
        path: PathBuf,
        /// The number of the line, from 1.
        line: usize,
    },
    /// A run has two results.
    #[error("{} and {} both have the run `{key}`; merge each part once, and only parts of the same division", first.display(), second.display())]
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

/// The indices of a sweep's runs by the hashes of their keys, ascending. The keys of a million runs would need ten times as much memory.
#[derive(Debug)]
pub(super) struct Indices<'s> {
    sweep: &'s Sweep,
    by_hash: Vec<(u64, u64)>,
}

impl<'s> Indices<'s> {
    pub(super) fn new(sweep: &'s Sweep) -> Self {
        let mut by_hash: Vec<_> = sweep.runs().map(|run| (run_hash(&run.key()), run.index)).collect();
        by_hash.sort_unstable();
        Self { sweep, by_hash }
    }

    /// The run of a line of results.
    ///
    /// # Errors
    /// If the sweep has no run with its key, or if the line contradicts that.
    pub(super) fn run_of(&self, line: &ReadLine) -> Result<SweepRun<'s>, String> {
        let hash = run_hash(&line.key);
        let from = self.by_hash.partition_point(|&(before, _)| before < hash);
        let same = self.by_hash.iter().skip(from).take_while(|&&(found, _)| found == hash);
        let mut same = same.filter_map(|&(_, index)| self.sweep.run(index));
        let run = same.find(|run| run.key() == line.key);
        let run = run.ok_or_else(|| format!("there is no run `{}` in the sweep", line.key))?;
        line.check(&run).map(|()| run)
    }
}

/// A file of results that is open for writing.
#[derive(Debug)]
pub struct Results {
    path: PathBuf,
    file: File,
}

impl Results {
    /// Opens or creates the file of results of a `sweep` at `path`, and returns the figures of its runs by index, without those that
    /// have no result. An incomplete last line is removed. No other process can write to the file until this is dropped.
    ///
    /// # Errors
    /// [`ResultsError`] if the file cannot be used, or has other content than results of the part of `sweep` in
    /// `header`.
    pub fn of_sweep(
        path: &Path,
        header: &Header,
        provenance: &Provenance,
        sweep: &Sweep,
    ) -> Result<(Self, BTreeMap<u64, Figures>), ResultsError> {
        let indices = Indices::new(sweep);
        let mut there = BTreeMap::new();
        let results = Self::open(path, header, provenance, |line| {
            let line = read_line(line).map_err(|cause| cause.to_string())?;
            let run = indices.run_of(&line)?;
            let (figures, key) = (line.figures(), line.key);
            if !header.shard.has(&key) {
                return Err(format!("this part of the sweep has no run `{key}`"));
            }
            let before = there.insert(run.index, figures);
            if is_settled(before.as_ref()) { Err(format!("the run `{key}` occurs a second time")) } else { Ok(()) }
        })?;
        there.retain(|_, figures| is_settled(Some(figures)));
        Ok((results, there))
    }

    /// Opens or creates the file of results at `path`, and passes every complete line after the header to `each`. An
    /// incomplete last line is removed. No other process can write to the file until this is dropped.
    ///
    /// # Errors
    /// [`ResultsError`] if the file cannot be used, if it has another header, or if `each` refuses a line.
    pub fn open(
        path: &Path,
        header: &Header,
        provenance: &Provenance,
        mut each: impl FnMut(&str) -> Result<(), String>,
    ) -> Result<Self, ResultsError> {
        let failed = ResultsError::file(path);
        let file = locked(path)?;
        let mut lines = Lines::new(path, &file);
        let found = lines.header()?;
        if let Some(difference) = found.as_ref().and_then(|found| difference(found, header)) {
            return Err(ResultsError::Other { path: path.to_owned(), difference });
        }
        while let Some((line, text)) = lines.next()? {
            each(&text).map_err(|cause| ResultsError::Line { path: path.to_owned(), line, cause })?;
        }
        let whole = lines.whole();
        file.set_len(whole).map_err(&failed)?;
        let mut results = Self { path: path.to_owned(), file };
        if found.is_none() {
            let header =
                serde_json::to_string(&header.versioned(Some(provenance))).map_err(io::Error::from).map_err(&failed)?;
            results.add(&header)?;
            file::sync_name(path).map_err(&failed)?;
        }
        Ok(results)
    }

    /// Adds the line of a run. It is on the disk when this returns.
    ///
    /// # Errors
    /// [`ResultsError::File`] if it cannot be written.
    pub fn add(&mut self, line: &str) -> Result<(), ResultsError> {
        // One write, so that a line is complete or the incomplete end of the file.
        let line = format!("{}\n", line.trim_end());
        let written = if line.len() > LINE_LIMIT {
            // Such a line could not be read again.
            Err(io::Error::new(io::ErrorKind::InvalidData, "a line of results would be too long"))
        } else {
            self.file.write_all(line.as_bytes()).and_then(|()| self.file.sync_data())
        };
        written.map_err(ResultsError::file(&self.path))
    }
}

/// True if a run with these figures is not repeated. What made a process crash or prevented a run, such as a lack of memory, may be over.
/// So a run without a result is repeated when its sweep is resumed, and its later line replaces the earlier one.
pub(super) fn is_settled(figures: Option<&Figures>) -> bool {
    figures.is_some_and(|figures| !matches!(figures.ending, Ending::Crashed | Ending::Refused))
}

/// Checks that results with this `header` may replace the file at `path`: there is none, or it has results of the same
/// sweep. While the returned file is open, no sweep writes to it.
pub(super) fn check_path(path: &Path, header: &Header) -> Result<Option<File>, ResultsError> {
    // Anything but a regular file has no content that could be lost.
    if !path.is_file() {
        return Ok(None);
    }
    let file = file::open(path).map_err(ResultsError::file(path))?;
    lock(path, &file)?;
    if let Some(difference) = Lines::new(path, &file).header()?.and_then(|found| difference(&found, header)) {
        return Err(ResultsError::Other { path: path.to_owned(), difference });
    }
    Ok(Some(file))
}

/// Opens a file of results. No other process writes to it while it is open.
fn locked(path: &Path) -> Result<File, ResultsError> {
    loop {
        let file = file::append(path).map_err(ResultsError::file(path))?;
        lock(path, &file)?;
        // Merged results may have replaced the file before it was locked. Lines that are added to the old file would be
        // lost.
        if file::is_at(&file, path) {
            return Ok(file);
        }
    }
}

/// Locks a file of results against other writers while it is open.
fn lock(path: &Path, file: &File) -> Result<(), ResultsError> {
    file.try_lock().map_err(|error| match error {
        TryLockError::WouldBlock => ResultsError::Busy { path: path.to_owned() },
        TryLockError::Error(cause) => ResultsError::file(path)(cause),
    })
}

/// The difference of the results of `found` from those of `header`, if there is one.
fn difference(found: &Header, header: &Header) -> Option<String> {
    let other_shard = || format!("the shard {}, this one is {}", found.shard, header.shard);
    found.difference(header).or_else(|| (found.shard != header.shard).then(other_shard))
}
