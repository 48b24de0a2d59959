//! The runs of a sweep in short, for its page.

use std::collections::BTreeMap;
use std::path::Path;

use serde::Deserialize;

use super::header::Header;
use super::lines::Lines;
use super::results::{self, ResultsError};
use super::{Sweep, SweepRun};
use crate::results::{Ending, LargestError};
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
    /// Share of the reference that was traced, 0 to 1.
    pub coverage: Option<f64>,
    /// The tip estimate with the largest error.
    pub largest_error: Option<LargestError>,
    /// Descriptions of what did not hold. A file of an older program has none.
    #[serde(default)]
    pub violations: Vec<String>,
    error_mm: Option<Errors>,
    collisions: Option<Collisions>,
}

#[derive(Debug, Clone, PartialEq, Deserialize)]
struct Errors {
    mean: Option<f64>,
}

#[derive(Debug, Clone, PartialEq, Deserialize)]
struct Collisions {
    count: usize,
}

impl RunRow {
    /// Mean and largest error of its tips (mm).
    pub(crate) fn errors_mm(&self) -> [Option<f64>; 2] {
        [self.error_mm.as_ref().and_then(|errors| errors.mean), self.largest_error.as_ref().map(|worst| worst.error_mm)]
    }

    /// Number of collisions of the body.
    pub(crate) fn collision_count(&self) -> usize {
        self.collisions.as_ref().map_or(0, |collisions| collisions.count)
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
    let indices = results::indices(sweep);
    let mut groups: BTreeMap<_, BTreeMap<u64, RunRow>> = BTreeMap::new();
    while let Some((line, text)) = lines.next()? {
        let wrong = |cause: String| ResultsError::Line { path: path.to_owned(), line, cause };
        let row: RunRow = serde_json::from_str(&text).map_err(|cause| wrong(cause.to_string()))?;
        let run: Option<SweepRun<'_>> = indices.get(&row.key).and_then(|&index| sweep.run(index));
        let run = run.ok_or_else(|| wrong(format!("there is no run `{}` in the sweep", row.key)))?;
        let rows = groups.entry(run.group()).or_default();
        rows.insert(row.trial, row);
        if rows.len() > most {
            rows.pop_last();
        }
    }
    Ok(groups.into_values().map(|rows| rows.into_values().collect()).collect())
}
