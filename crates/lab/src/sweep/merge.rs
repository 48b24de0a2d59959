//! Merged results of the shards of a sweep.

use crate::results::Document;
use std::collections::BTreeMap;
use std::fs::File;
use std::io::{self, Read, Seek, SeekFrom, Write};
use std::path::{Path, PathBuf};

use super::header::Header;
use super::line::read_line;
use super::lines::Lines;
use super::results::{self, Indices, ResultsError, check_path};
use super::shard::Shard;
use crate::results::{Figures, Provenance};
use crate::sweep::Sweep;
use vibrissa_text::diagnostic::Source;
use vibrissa_text::file::CommandFiles;

/// The results of all parts of a sweep. Their lines stay in the files.
#[derive(Debug)]
pub struct Merged {
    /// The header, with the part of the first file.
    pub header: Header,
    /// The origins of the files, as far as they state them.
    pub origins: Vec<Provenance>,
    /// The sweep.
    pub sweep: Sweep,
    /// The figures of the runs by index.
    pub figures: BTreeMap<u64, Figures>,
    files: Vec<File>,
    /// The positions of the lines of the runs by index.
    places: BTreeMap<u64, Place>,
}

/// The place of a line in the files.
#[derive(Debug, Clone, Copy)]
struct Place {
    /// Index of the file.
    file: usize,
    /// Where the line begins, and its length (bytes).
    start: u64,
    length: usize,
}

/// A run without a result.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Missing {
    /// Its key.
    pub key: String,
    /// Its part of the sweep.
    pub shard: Shard,
}

/// Merges files of results. `None` without a file.
///
/// # Errors
/// [`ResultsError`] if they are not results of the same sweep, or if a run has two results.
pub fn merge(paths: &[PathBuf], files: &mut CommandFiles) -> Result<Option<Merged>, ResultsError> {
    let Some(first) = paths.first() else { return Ok(None) };
    let mut merged = Merged::new(first, header_of(first)?)?;
    let sweep = merged.sweep.clone();
    let indices = Indices::new(&sweep);
    for (number_of_file, path) in paths.iter().enumerate() {
        let file = files.open(path).map_err(ResultsError::file(path))?;
        let mut lines = Lines::new(path, &file);
        let header = lines.header()?.ok_or_else(|| no_header(path))?;
        if let Some(difference) = header.difference(&merged.header) {
            return Err(ResultsError::Other { path: path.clone(), difference });
        }
        merged.origins.extend(lines.provenance.take());
        let mut start = lines.whole();
        while let Some((number, line)) = lines.next()? {
            let wrong = |cause| ResultsError::Line { path: path.clone(), line: number, cause };
            let line = read_line(&line).map_err(|cause| wrong(cause.to_string()))?;
            let index = indices.run_of(&line).map_err(wrong)?.index;
            let (figures, key) = (line.figures(), line.key);
            let end = lines.whole();
            let place = Place { file: number_of_file, start, length: usize::try_from(end - start).unwrap_or_default() };
            start = end;
            if let Some(before) = merged.places.insert(index, place)
                && (before.file != number_of_file || results::is_settled(merged.figures.get(&index)))
            {
                let first = paths.get(before.file).unwrap_or(path).clone();
                return Err(ResultsError::Twice { first, second: path.clone(), key });
            }
            merged.figures.insert(index, figures);
        }
        drop(lines);
        merged.files.push(file);
    }
    Ok(Some(merged))
}

/// The header of a file of results.
fn header_of(path: &Path) -> Result<Header, ResultsError> {
    let file = vibrissa_text::file::open(path).map_err(ResultsError::file(path))?;
    Lines::new(path, &file).header()?.ok_or_else(|| no_header(path))
}

fn no_header(path: &Path) -> ResultsError {
    ResultsError::NoResults { path: path.to_owned(), cause: "it is empty".to_owned() }
}

impl Merged {
    fn new(path: &Path, header: Header) -> Result<Self, ResultsError> {
        let source = Source::new(path.display().to_string(), &*header.text);
        let sweep = Sweep::from_yaml(&source).map_err(|_| ResultsError::NoResults {
            path: path.to_owned(),
            cause: "this version of the program cannot read the sweep that it holds".to_owned(),
        })?;
        let (figures, places) = (BTreeMap::new(), BTreeMap::new());
        Ok(Self { header, origins: Vec::new(), sweep, figures, files: Vec::new(), places })
    }

    /// Checks that the results may be written to `path`. While the returned file is open, no sweep writes to it.
    ///
    /// # Errors
    /// [`ResultsError`] if the file has other content, or if a sweep is writing to it.
    pub fn check_path(&self, path: &Path) -> Result<Option<File>, ResultsError> {
        check_path(path, &self.header.of_shard(Shard::WHOLE))
    }

    /// The runs without a result.
    pub fn missing(&self) -> impl Iterator<Item = Missing> {
        let missing = self.sweep.runs().filter(|run| !self.places.contains_key(&run.index));
        missing.map(|run| {
            let key = run.key();
            Missing { shard: self.header.shard.of_run(&key), key }
        })
    }

    /// Writes the results in the order of the runs, with their origin. Each line is read from its file when it is written.
    ///
    /// # Errors
    /// If a file cannot be read any more, or the results cannot be written.
    pub fn write(&self, provenance: &Provenance, out: &mut dyn Write) -> io::Result<()> {
        let header = self.header.of_shard(Shard::WHOLE);
        serde_json::to_writer(&mut *out, &header.versioned(Some(provenance)))?;
        let mut text = Vec::new();
        for place in self.places.values() {
            let Some(mut file) = self.files.get(place.file) else { continue };
            file.seek(SeekFrom::Start(place.start))?;
            text.clear();
            file.take(place.length as u64).read_to_end(&mut text)?;
            write!(out, "\n{}", String::from_utf8_lossy(&text).trim_end())?;
        }
        writeln!(out)
    }
}
