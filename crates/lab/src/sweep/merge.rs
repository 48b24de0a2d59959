//! Merged results of the shards of a sweep.

use crate::results::Document;
use std::collections::{BTreeMap, HashMap};
use std::fs::File;
use std::path::{Path, PathBuf};

use super::header::Header;
use super::line::read_line;
use super::lines::Lines;
use super::results::{self, ResultsError, check_path};
use super::shard::Shard;
use crate::results::{Figures, Provenance};
use crate::sweep::Sweep;
use vibrissa_text::diagnostic::Source;
use vibrissa_text::file::CommandFiles;

/// The results of all parts of a sweep.
#[derive(Debug)]
pub struct Merged {
    /// The header, with the part of the first file.
    pub header: Header,
    /// The origins of the files, as far as they state them.
    pub origins: Vec<Provenance>,
    /// The sweep.
    pub sweep: Sweep,
    /// The lines of the runs by index.
    pub lines: BTreeMap<u64, String>,
    /// The figures of the runs by index.
    pub figures: BTreeMap<u64, Figures>,
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
    let (mut merged, mut indices): (Option<Merged>, _) = (None, HashMap::new());
    let mut owners = BTreeMap::new();
    for path in paths {
        let file = files.open(path).map_err(ResultsError::file(path))?;
        let mut lines = Lines::new(path, &file);
        let no_header =
            || ResultsError::NoResults { path: path.clone(), of: Header::FORMAT, cause: "it is empty".to_owned() };
        let header: Header = lines.header()?.ok_or_else(no_header)?;
        let merged = match &mut merged {
            Some(merged) => {
                if let Some(difference) = header.difference(&merged.header) {
                    return Err(ResultsError::Other { path: path.clone(), difference });
                }
                merged
            }
            none => {
                let merged = none.insert(Merged::new(path, header)?);
                indices = results::indices(&merged.sweep);
                merged
            }
        };
        merged.origins.extend(lines.provenance.take());
        while let Some((number, line)) = lines.next()? {
            let wrong = |cause| ResultsError::Line { path: path.clone(), line: number, cause };
            let (key, figures) = read_line(&line).map_err(|cause| wrong(cause.to_string()))?;
            let index = indices.get(&key).ok_or_else(|| wrong(format!("there is no run `{key}` in the sweep")))?;
            let before = merged.figures.get(index);
            if let Some(first) = owners.insert(*index, path)
                && (first != path || results::is_settled(before))
            {
                return Err(ResultsError::Twice { first: first.clone(), second: path.clone(), key });
            }
            merged.lines.insert(*index, line.trim_end().to_owned());
            merged.figures.insert(*index, figures);
        }
    }
    Ok(merged)
}

impl Merged {
    fn new(path: &Path, header: Header) -> Result<Self, ResultsError> {
        let source = Source::new(path.display().to_string(), &*header.text);
        let sweep = Sweep::from_yaml(&source).map_err(|_| ResultsError::NoResults {
            path: path.to_owned(),
            of: Header::FORMAT,
            cause: "this version of the program cannot read the sweep that it holds".to_owned(),
        })?;
        Ok(Self { header, origins: Vec::new(), sweep, lines: BTreeMap::new(), figures: BTreeMap::new() })
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
        let missing = self.sweep.runs().filter(|run| !self.lines.contains_key(&run.index));
        missing.map(|run| {
            let key = run.key();
            Missing { shard: self.header.shard.of_run(&key), key }
        })
    }

    /// The results as text, in the order of the runs, with their origin.
    ///
    /// # Errors
    /// If the header cannot be written as JSON, which would be a fault of the program.
    pub fn text(&self, provenance: &Provenance) -> serde_json::Result<String> {
        let mut text = serde_json::to_string(&self.header.of_shard(Shard::WHOLE).versioned(Some(provenance)))?;
        for line in self.lines.values() {
            text.push('\n');
            text += line;
        }
        text.push('\n');
        Ok(text)
    }
}
