//! `vibrissa merge`

use std::path::{Path, PathBuf};

use crate::file::CommandFiles;
use crate::sweep::{Missing, SweepSummary, merge as merge_files};

use super::arguments::MergeArguments;
use super::exit::{Exit, Failure};
use super::output;
use super::sweep::tell;

/// How many missing runs are told by their keys.
const TOLD: usize = 10;

pub(super) fn merge(arguments: &MergeArguments) -> Result<Exit, Failure> {
    let mut files = Vec::new();
    for path in &arguments.paths {
        if path.is_dir() {
            files.extend(results_in(path)?);
        } else {
            files.push(path.clone());
        }
    }
    let mut read = CommandFiles::new();
    let (Some(merged), Some(first)) = (merge_files(&files, &mut read)?, files.first()) else {
        return Err(Failure::NoResults { directory: arguments.paths.first().cloned().unwrap_or_default() });
    };
    let missing: Vec<_> = merged.missing().collect();
    if !missing.is_empty() {
        tell_missing(&missing);
        return Ok(Exit::Unexpected);
    }
    let path = arguments.out.clone().unwrap_or_else(|| first.with_file_name("results.jsonl"));
    let file = read.output("--out", &path)?;
    let _lock = merged.check_place(&path)?;
    file.write(merged.text()?)?;
    tell(&SweepSummary::new(&merged.sweep, &merged.figures, 0), &path, arguments.json, arguments.columns)?;
    Ok(Exit::Done)
}

/// The results of shards in a directory, in the order of their names, or else those of a whole sweep.
fn results_in(directory: &Path) -> Result<Vec<PathBuf>, Failure> {
    let entries = directory.read_dir().map_err(Failure::read(directory))?;
    let entries = entries.collect::<Result<Vec<_>, _>>().map_err(Failure::read(directory))?;
    let names = entries.iter().filter_map(|entry| entry.file_name().into_string().ok());
    let is_shard =
        |name: &String| name.starts_with("shard-") && Path::new(name).extension().is_some_and(|end| end == "jsonl");
    let mut shards: Vec<PathBuf> = names.filter(is_shard).map(|name| directory.join(name)).collect();
    shards.sort();
    if shards.is_empty() {
        let whole = directory.join("results.jsonl");
        // Whatever it is: reading it says why it will not do.
        shards.extend(whole.symlink_metadata().is_ok().then_some(whole));
    }
    Ok(shards)
}

/// Tells which runs are missing, and how to get them.
fn tell_missing(missing: &[Missing]) {
    for Missing { key, shard } in missing.iter().take(TOLD) {
        output::message(format_args!("missing: {key} (shard {shard})"));
    }
    if missing.len() > TOLD {
        output::message(format_args!("and {} more", missing.len() - TOLD));
    }
    let mut shards: Vec<_> = missing.iter().map(|missing| missing.shard).collect();
    shards.sort();
    shards.dedup();
    let shards: Vec<_> = shards.iter().map(|shard| format!("--shard {shard}")).collect();
    let runs = if missing.len() == 1 { "1 run is".to_owned() } else { format!("{} runs are", missing.len()) };
    output::error(format_args!(
        "{runs} missing, and nothing was written; do the same sweep again with {}, and merge then",
        shards.join(", ")
    ));
}
