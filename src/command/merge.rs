//! `vibrissa study merge`

use std::path::{Path, PathBuf};

use clap::Args;

use super::exit::Exit;
use super::failure::Failure;
use super::options::Format;
use super::output;
use super::provenance::provenance;
use super::sweep::{PAGE, print_summary, write_page};
use vibrissa_lab::load::LoadError;
use vibrissa_lab::results::Provenance;
use vibrissa_lab::sweep::{Missing, SweepSummary, merge as merge_files};
use vibrissa_text::file::CommandFiles;

const EXAMPLE: &str = "Example:\n  vibrissa study merge out/corners\n\nExit status: 0 all runs are there; 1 some are missing; 2 unusable input; 3 internal error; 130 interrupted.";

/// The arguments of `vibrissa study merge`.
#[derive(Debug, Args)]
#[command(after_help = EXAMPLE)]
pub(super) struct MergeArguments {
    /// Files with results of shards, or a directory with them
    #[arg(value_name = "DIR|FILE", required = true)]
    paths: Vec<PathBuf>,
    /// File of the merged results. The default is results.jsonl in the directory of the first file
    #[arg(short, long, value_name = "FILE")]
    out: Option<PathBuf>,
    #[command(flatten)]
    format: Format,
}

/// Largest number of missing runs whose keys are reported.
const MAX_REPORTED: usize = 10;

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
        report_missing(&missing);
        return Ok(Exit::Unexpected);
    }
    let path = arguments.out.clone().unwrap_or_else(|| first.with_file_name("results.jsonl"));
    let file = read.output("--out", &path)?;
    let page = read.output("--out", &path.with_file_name(PAGE))?;
    let provenance = of_parts(&merged.origins);
    let _lock = merged.check_path(&path)?;
    file.write_with(|out| merged.write(&provenance, out))?;
    let summary = SweepSummary::new(&merged.sweep, &merged.figures, 0);
    print_summary(&provenance, &summary, &path, arguments.format)?;
    write_page(page, &provenance, &merged.sweep, &summary, &path, arguments.format)?;
    Ok(Exit::Done)
}

/// The origin of merged results: the runs of all parts, and the commands that made the parts before this one.
fn of_parts(parts: &[Provenance]) -> Provenance {
    let own = provenance();
    let Some(first) = parts.first() else { return own };
    let mut commands: Vec<&str> = Vec::new();
    for command in parts.iter().map(|part| part.command.as_str()).chain([own.command.as_str()]) {
        if !commands.contains(&command) {
            commands.push(command);
        }
    }
    Provenance { command: commands.join(" && "), date: own.date, ..first.clone() }
}

/// The results of shards in a directory, in the order of their names, or else those of a whole sweep.
fn results_in(directory: &Path) -> Result<Vec<PathBuf>, Failure> {
    let entries = directory.read_dir().map_err(LoadError::read(directory))?;
    let entries = entries.collect::<Result<Vec<_>, _>>().map_err(LoadError::read(directory))?;
    let names = entries.iter().filter_map(|entry| entry.file_name().into_string().ok());
    let is_shard =
        |name: &String| name.starts_with("shard-") && Path::new(name).extension().is_some_and(|end| end == "jsonl");
    let mut shards: Vec<PathBuf> = names.filter(is_shard).map(|name| directory.join(name)).collect();
    shards.sort();
    if shards.is_empty() {
        let whole = directory.join("results.jsonl");
        // Any kind of file. The error of an unsuitable one follows when it is read.
        shards.extend(whole.symlink_metadata().is_ok().then_some(whole));
    }
    Ok(shards)
}

/// Reports the missing runs, and the commands that produce them.
fn report_missing(missing: &[Missing]) {
    for Missing { key, shard } in missing.iter().take(MAX_REPORTED) {
        output::message(format_args!("missing: {key} (shard {shard})"));
    }
    if missing.len() > MAX_REPORTED {
        output::message(format_args!("and {} more", missing.len() - MAX_REPORTED));
    }
    let mut shards: Vec<_> = missing.iter().map(|missing| missing.shard).collect();
    shards.sort();
    shards.dedup();
    let shards: Vec<_> = shards.iter().map(|shard| format!("--shard {shard}")).collect();
    let runs = if missing.len() == 1 { "1 run is".to_owned() } else { format!("{} runs are", missing.len()) };
    output::error(format_args!(
        "{runs} missing, so nothing was written; run the sweep again with {}, then merge",
        shards.join(", ")
    ));
}
