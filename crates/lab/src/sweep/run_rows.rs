//! The first runs of each group of a sweep, for its page.

use std::collections::BTreeMap;
use std::path::Path;

use super::Sweep;
use super::line::{ReadLine, read_line};
use super::lines::Lines;
use super::results::{Indices, ResultsError};
use vibrissa_text::file;

/// The first `most` runs of each group in the file of results at `path`, in the order of the groups and of their trials. Only groups with
/// runs are counted.
///
/// # Errors
/// [`ResultsError`] if the file cannot be read as results of the `sweep`.
pub fn run_rows(sweep: &Sweep, path: &Path, most: usize) -> Result<Vec<Vec<ReadLine>>, ResultsError> {
    let file = file::open(path).map_err(ResultsError::file(path))?;
    let mut lines = Lines::new(path, &file);
    lines.header()?;
    let indices = Indices::new(sweep);
    let mut groups: BTreeMap<_, BTreeMap<u64, ReadLine>> = BTreeMap::new();
    while let Some((line, text)) = lines.next()? {
        let wrong = |cause: String| ResultsError::Line { path: path.to_owned(), line, cause };
        let row = read_line(&text).map_err(|cause| wrong(cause.to_string()))?;
        let rows = groups.entry(indices.run_of(&row).map_err(wrong)?.group()).or_default();
        rows.insert(row.trial, row);
        if rows.len() > most {
            rows.pop_last();
        }
    }
    Ok(groups.into_values().map(|rows| rows.into_values().collect()).collect())
}
