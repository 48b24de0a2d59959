//! The runs of a sweep in short, for its page.

use std::collections::BTreeMap;
use std::path::Path;

use serde::Deserialize;
use serde_json::Value;

use super::Sweep;
use super::header::Header;
use super::lines::Lines;
use super::results::{Indices, ResultsError};
use crate::results::{Ending, LargestError, figure_in};
use vibrissa_declare::figures::Metric;
use vibrissa_text::file;

/// The result of a run in short.
#[derive(Debug, Clone, PartialEq, Deserialize)]
pub struct RunRow {
    /// Hash of its key, in hexadecimal digits. It is the name of its picture.
    pub run: String,
    key: String,
    /// Number of its trial.
    pub trial: u64,
    /// True if all expectations of its scenario hold.
    pub passed: bool,
    /// The outcome.
    pub outcome: Ending,
    /// Reason of the outcome.
    pub reason: Option<String>,
    /// Description of the scene.
    pub about: Option<String>,
    /// The tip estimate with the largest error.
    pub largest_error: Option<LargestError>,
    /// Descriptions of what did not hold. A file of an older program has none.
    #[serde(default)]
    pub violations: Vec<String>,
    #[serde(flatten)]
    figures: Value,
}

impl RunRow {
    /// A figure in the unit of its key. `None` if the run does not have it.
    pub(crate) fn figure(&self, metric: Metric) -> Option<f64> {
        figure_in(&self.figures, metric)
    }
}

/// The first `most` runs of each group in the file of results at `path`, in the order of the groups and of their trials. Only groups with
/// runs are counted.
///
/// # Errors
/// [`ResultsError`] if the file cannot be read as results of the `sweep`.
pub fn run_rows(sweep: &Sweep, path: &Path, most: usize) -> Result<Vec<Vec<RunRow>>, ResultsError> {
    let file = file::open(path).map_err(ResultsError::file(path))?;
    let mut lines = Lines::new(path, &file);
    lines.header::<Header>()?;
    let indices = Indices::new(sweep);
    let mut groups: BTreeMap<_, BTreeMap<u64, RunRow>> = BTreeMap::new();
    while let Some((line, text)) = lines.next()? {
        let wrong = |cause: String| ResultsError::Line { path: path.to_owned(), line, cause };
        let row: RunRow = serde_json::from_str(&text).map_err(|cause| wrong(cause.to_string()))?;
        let run = indices.get(&row.key).ok_or_else(|| wrong(format!("there is no run `{}` in the sweep", row.key)))?;
        let rows = groups.entry(run.group()).or_default();
        rows.insert(row.trial, row);
        if rows.len() > most {
            rows.pop_last();
        }
    }
    Ok(groups.into_values().map(|rows| rows.into_values().collect()).collect())
}
