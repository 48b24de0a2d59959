//! The benches beside a stored baseline.
//!
//! Times depend on the machine, so that what is stored of each bench is how many times as long it takes as [`REFERENCE`] does in the
//! same run.

use std::collections::BTreeMap;
use std::fmt::Write as _;
use std::path::{Path, PathBuf};
use std::process::ExitStatus;
use std::time::SystemTime;
use std::{fs, io};

use thiserror::Error;

use crate::cargo::{NotStarted, cargo, target_directory};
use crate::setup::{self, Options, SetupError};

/// The bench that all others are measured by.
const REFERENCE: &str = "reference/sines";
/// Where the baseline is stored.
const BASELINE: &str = "benches/baseline.csv";
/// Its first line.
const HEADING: &str = "bench,times the reference";
/// A bench that takes longer than its baseline by more than this share is slower.
const SHARE: f64 = 0.25;

/// Why the benches say nothing, or nothing good.
#[derive(Debug, Error)]
pub(crate) enum BenchError {
    #[error("the benches ended ({0}); why is above")]
    Failed(ExitStatus),
    #[error("{}: {source}; look at its permissions", path.display())]
    File { path: PathBuf, source: io::Error },
    #[error("there is no baseline ({}): `cargo x bench --save` makes one of a run of all benches", .0.display())]
    NoBaseline(PathBuf),
    #[error(
        "{}, line {line}: this is not the name of a bench, a comma and a number above 0; correct it, or `cargo x bench --save`",
        path.display()
    )]
    Line { path: PathBuf, line: usize },
    #[error("no bench has written a result to {}: look above whether any ran", .0.display())]
    NoResults(PathBuf),
    #[error("there is no result of `{REFERENCE}`, which all others are measured by: look above whether it ran")]
    NoReference,
    #[error(
        "slower than the baseline by more than {} %: {}. Look again with nothing beside it; if it is meant, `cargo x bench --save`",
        SHARE * 100.0,
        .0.join(", ")
    )]
    Slower(Vec<String>),
    #[error(transparent)]
    Setup(#[from] SetupError),
    #[error(transparent)]
    Cargo(#[from] NotStarted),
}

/// Sets up, runs all benches and prints them beside the baseline, or makes them the baseline.
pub(crate) fn bench(root: &Path, save: bool) -> Result<(), BenchError> {
    setup::setup(root, &Options::default())?;
    let path = root.join(BASELINE);
    // Before the benches run: they take minutes.
    let baseline = if save { None } else { Some(stored(&path)?) };
    let start = SystemTime::now();
    let run = ["bench", "--package", "vibrissa", "--benches", "--", "--warm-up-time", "1", "--measurement-time", "2"];
    let status = cargo(root, &run).status().map_err(|source| NotStarted { program: "cargo", source })?;
    if !status.success() {
        return Err(BenchError::Failed(status));
    }
    let mut times = BTreeMap::new();
    let results = target_directory(root).join("criterion");
    if !results.is_dir() {
        return Err(BenchError::NoResults(results));
    }
    collect(&results, start, &mut times)?;
    if times.is_empty() {
        return Err(BenchError::NoResults(results));
    }
    let ratios = ratios(&times).ok_or(BenchError::NoReference)?;
    let Some(baseline) = baseline else {
        return fs::write(&path, written(&ratios)).map_err(|source| BenchError::File { path, source });
    };
    let (table, slower) = compare(&times, &ratios, &baseline);
    println!("\n{table}");
    if slower.is_empty() { Ok(()) } else { Err(BenchError::Slower(slower)) }
}

/// The baseline that is stored in a file.
fn stored(path: &Path) -> Result<BTreeMap<String, f64>, BenchError> {
    let text = fs::read_to_string(path).map_err(|source| match source.kind() {
        io::ErrorKind::NotFound => BenchError::NoBaseline(path.to_owned()),
        _ => BenchError::File { path: path.to_owned(), source },
    })?;
    read(&text).map_err(|line| BenchError::Line { path: path.to_owned(), line })
}

/// Medians (ns) of all results below a folder of criterion's that are no older than `since`, by the benches' names.
fn collect(folder: &Path, since: SystemTime, times: &mut BTreeMap<String, f64>) -> Result<(), BenchError> {
    let fault = |path: &Path| {
        let path = path.to_owned();
        move |source| BenchError::File { path, source }
    };
    for entry in fs::read_dir(folder).map_err(fault(folder))? {
        let path = entry.map_err(fault(folder))?.path();
        if !path.is_dir() {
            continue;
        }
        let (about, estimates) = (path.join("benchmark.json"), path.join("estimates.json"));
        if !path.ends_with("new") || !estimates.exists() {
            collect(&path, since, times)?;
            continue;
        }
        let changed = fs::metadata(&estimates).and_then(|about| about.modified()).map_err(fault(&estimates))?;
        let read = |path: &Path| fs::read_to_string(path).map_err(fault(path));
        if changed >= since
            && let Some(name) = name(&read(&about)?)
            && let Some(median) = median(&read(&estimates)?)
        {
            times.insert(name, median);
        }
    }
    Ok(())
}

/// The name of a bench, from what criterion writes about it.
fn name(about: &str) -> Option<String> {
    let (_, rest) = about.split_once("\"full_id\":\"")?;
    Some(rest.split_once('"')?.0.to_owned())
}

/// The median (ns) among criterion's estimates.
fn median(estimates: &str) -> Option<f64> {
    let (_, rest) = estimates.split_once("\"median\":")?;
    let (_, rest) = rest.split_once("\"point_estimate\":")?;
    rest.split([',', '}']).next()?.trim().parse().ok()
}

/// How many times as long as the reference each bench takes.
fn ratios(times: &BTreeMap<String, f64>) -> Option<BTreeMap<String, f64>> {
    let reference = times.get(REFERENCE)?;
    Some(times.iter().map(|(name, time)| (name.clone(), time / reference)).collect())
}

/// A baseline as it is stored.
fn written(ratios: &BTreeMap<String, f64>) -> String {
    ratios.iter().fold(format!("{HEADING}\n"), |text, (name, ratio)| format!("{text}{name},{ratio:.3e}\n"))
}

/// A stored baseline, or the number of the line that is none.
fn read(text: &str) -> Result<BTreeMap<String, f64>, usize> {
    let line = |(number, line): (usize, &str)| {
        let ratio = line.rsplit_once(',').and_then(|(name, ratio)| Some((name.to_owned(), ratio.parse().ok()?)));
        ratio.filter(|&(_, ratio): &(_, f64)| ratio.is_finite() && ratio > 0.0).ok_or(number)
    };
    (1..).zip(text.lines()).filter(|&(number, line)| number > 1 || line != HEADING).map(line).collect()
}

/// A table of the benches, the slowest change first, and the names of those that are slower than the baseline.
fn compare(
    times: &BTreeMap<String, f64>,
    ratios: &BTreeMap<String, f64>,
    baseline: &BTreeMap<String, f64>,
) -> (String, Vec<String>) {
    let mut rows: Vec<(&str, f64, Option<f64>)> = Vec::with_capacity(ratios.len());
    for (name, ratio) in ratios {
        rows.push((name, *ratio, baseline.get(name).map(|before| ratio / before - 1.0)));
    }
    rows.sort_by(|(.., a), (.., b)| b.unwrap_or(f64::INFINITY).total_cmp(&a.unwrap_or(f64::INFINITY)));
    let mut table = format!("{:<44} {:>12} {:>14} {:>14} {:>8}\n", "bench", "ns", "x reference", "baseline", "change");
    for (name, ratio, change) in &rows {
        let before = baseline.get(*name).map_or("none".to_owned(), |before| format!("{before:.4}"));
        let change = change.map_or("new".to_owned(), |change| format!("{:+.0} %", change * 100.0));
        let _ = writeln!(table, "{name:<44} {:>12.1} {ratio:>14.4} {before:>14} {change:>8}", times[*name]);
    }
    for name in baseline.keys().filter(|name| !ratios.contains_key(*name)) {
        let _ = writeln!(table, "{name:<44} {:>12} {:>14} {:>14.4} {:>8}", "", "", baseline[name], "gone");
    }
    let slower = rows.iter().filter(|(.., change)| change.is_some_and(|change| change > SHARE));
    (table, slower.map(|&(name, ..)| name.to_owned()).collect())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn map(pairs: &[(&str, f64)]) -> BTreeMap<String, f64> {
        pairs.iter().map(|&(name, value)| (name.to_owned(), value)).collect()
    }

    #[test]
    fn the_name_and_the_median_are_read_from_what_criterion_writes() {
        let about = r#"{"group_id":"a","function_id":"b c","full_id":"a/b c","directory_name":"a/b c"}"#;
        assert_eq!(name(about).as_deref(), Some("a/b c"));
        let estimates = r#"{"mean":{"point_estimate":9.0},
            "median":{"confidence_interval":{"lower_bound":1.0},"point_estimate":2.5,"standard_error":0.1},"slope":null}"#;
        assert_eq!(median(estimates), Some(2.5));
        assert_eq!(median("{}"), None);
    }

    #[test]
    fn a_baseline_is_read_as_it_was_written() {
        let ratios = map(&[("a/b c", 1.25), ("reference/sines", 1.0), ("tiny", 2.5e-4)]);
        assert_eq!(read(&written(&ratios)), Ok(ratios));
    }

    #[test]
    fn a_line_that_is_none_is_named() {
        assert_eq!(read("bench,times the reference\na,1\nb"), Err(3));
        assert_eq!(read("a,0"), Err(1));
        assert_eq!(read("a,nan"), Err(1));
    }

    #[test]
    fn a_baseline_that_is_not_there_is_told_with_what_to_do() {
        let error = stored(Path::new("/nowhere/baseline.csv")).map_err(|error| error.to_string());
        assert!(error.is_err_and(|text| text.contains("/nowhere/") && text.contains("cargo x bench --save")));
    }

    #[test]
    fn a_machine_that_is_twice_as_slow_makes_no_bench_slower() {
        let before = map(&[(REFERENCE, 100.0), ("a", 50.0)]);
        let after = map(&[(REFERENCE, 200.0), ("a", 100.0)]);
        let baseline = ratios(&before).unwrap_or_default();
        let (_, slower) = compare(&after, &ratios(&after).unwrap_or_default(), &baseline);
        assert!(slower.is_empty(), "{slower:?}");
    }

    #[test]
    fn what_is_slower_by_more_than_the_share_is_named_and_new_ones_are_not() {
        let times = map(&[(REFERENCE, 100.0), ("slow", 130.0), ("noisy", 120.0), ("new", 1.0)]);
        let baseline = map(&[(REFERENCE, 1.0), ("slow", 1.0), ("noisy", 1.0), ("past", 1.0)]);
        let (table, slower) = compare(&times, &ratios(&times).unwrap_or_default(), &baseline);
        assert_eq!(slower, ["slow"]);
        let ending = |name: &str| table.lines().find(|line| line.starts_with(name)).map(|line| line.ends_with("gone"));
        assert_eq!((ending("past"), ending("noisy")), (Some(true), Some(false)));
    }

    #[test]
    fn without_the_reference_there_are_no_ratios() {
        assert_eq!(ratios(&map(&[("a", 1.0)])), None);
    }
}
