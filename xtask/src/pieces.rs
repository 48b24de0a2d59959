//! What each part of `vibrissa.fsm` is worth: the runs that change without it.

mod files;
mod piece;

use std::fmt::Write;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};
use std::{fs, io};

use sha2::{Digest, Sha256};
use thiserror::Error;

use crate::cargo::target_directory;
use crate::json::Json;
use crate::results::{self, NoKey, ResultsError, number, value};
use files::Files;
use piece::Piece;

/// The policy that is measured.
const POLICY: &str = "vibrissa.fsm";
/// The page with the result, in the target directory. It is not published, because it takes an hour after each change of the policy.
const PAGE: &str = "pieces/pieces.md";
/// The runs that decide about a part that changes none of the scenes of the families.
const FURTHER: [&str; 2] = [
    "families --world quasistatic --count 15 --seed 3002 --json",
    "bench --world quasistatic --friction 0.1 --noise --json",
];

/// How much is run, and with what program.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) struct Options {
    /// Scenes of each family.
    pub(crate) count: u64,
    /// A program that is there already, instead of one that is built.
    pub(crate) program: Option<PathBuf>,
}

impl Default for Options {
    fn default() -> Self {
        Self { count: 5, program: None }
    }
}

/// A fault that leaves the page unmade.
#[derive(Debug, Error)]
pub(crate) enum PiecesError {
    #[error("cannot read or write the policy or its copies: {0}")]
    File(#[from] io::Error),
    #[error("`{POLICY}` itself does not run; `vibrissa check policies/{POLICY}` tells why")]
    Base,
    #[error("the program printed no results for a changed policy: {0}")]
    Key(#[from] NoKey),
    #[error(transparent)]
    Results(#[from] ResultsError),
}

/// The figures of a run that tell it from another one.
#[derive(Debug, Clone, PartialEq)]
struct Verdict {
    passed: bool,
    figures: String,
}

/// A part with the runs that differ without it.
struct Worth {
    file: String,
    piece: Piece,
    /// Passed runs with it and without it, and runs with other figures. `None` if the policy does not compile without it.
    counts: Option<Counts>,
}

#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
struct Counts {
    with: usize,
    without: usize,
    changed: usize,
}

impl Counts {
    fn of(base: &[Verdict], changed: &[Verdict]) -> Self {
        let passed = |verdicts: &[Verdict]| verdicts.iter().filter(|verdict| verdict.passed).count();
        let differ = base.iter().zip(changed).filter(|(one, other)| one != other).count();
        Self { with: passed(base), without: passed(changed), changed: differ }
    }
}

/// Removes each part in turn, runs the scenes and writes the page.
pub(crate) fn write(root: &Path, options: &Options) -> Result<(), PiecesError> {
    let files = Files::read(root, POLICY)?;
    let commit = results::commit(root)?;
    if options.program.is_none() {
        results::build(root)?;
    }
    let scenes = format!("families --world quasistatic --count {} --seed 3001 --json", options.count);
    let run = |files: &Files, command: &str| run(root, options.program.as_deref(), files, command);
    let base = run(&files, &scenes)?.ok_or(PiecesError::Base)?;
    let further = FURTHER.iter().map(|command| run(&files, command)?.ok_or(PiecesError::Base));
    let further = further.collect::<Result<Vec<_>, _>>()?;
    let pieces: Vec<(String, Piece)> = (files.0.iter())
        .flat_map(|(name, text)| Piece::all(text).into_iter().map(move |piece| (name.clone(), piece)))
        .collect();
    let count = pieces.len();
    let mut worths = Vec::with_capacity(count);
    for (index, (file, piece)) in pieces.into_iter().enumerate() {
        let mut changed = files.clone();
        if let Some(text) = changed.0.get_mut(&file) {
            *text = piece.removed_from(text);
        }
        let mut counts = run(&changed, &scenes)?.map(|verdicts| Counts::of(&base, &verdicts));
        if counts.is_some_and(|counts| counts.changed == 0) {
            for (command, base) in FURTHER.iter().zip(&further) {
                let Some(verdicts) = run(&changed, command)? else { continue };
                let more = Counts::of(base, &verdicts);
                if let Some(counts) = counts.as_mut().filter(|_| more.changed > 0) {
                    *counts = more;
                    break;
                }
            }
        }
        eprintln!("      {} of {count}: {file}, line {}: {counts:?}", index + 1, piece.lines.start + 1);
        worths.push(Worth { file, piece, counts });
    }
    let path = target_directory(root).join(PAGE);
    fs::write(&path, page(&worths, base.len(), &commit))?;
    println!("      {}", path.display());
    Ok(())
}

/// The verdicts of the runs of a command under a policy. `None` if the policy does not compile. Results are kept for the
/// next call.
fn run(root: &Path, program: Option<&Path>, files: &Files, command: &str) -> Result<Option<Vec<Verdict>>, PiecesError> {
    let folder = target_directory(root).join("pieces");
    let program = program.map_or_else(|| target_directory(root).join("release/vibrissa"), Path::to_owned);
    let mut hash = Sha256::new();
    hash.update(command);
    hash.update(fs::read(&program)?);
    files.0.iter().for_each(|(name, text)| hash.update(format!("{name}\n{text}")));
    let key = hash.finalize().iter().take(16).fold(String::new(), |key, byte| format!("{key}{byte:02x}"));
    let kept = folder.join(key).with_extension("json");
    let text = if let Ok(text) = fs::read_to_string(&kept) {
        text
    } else {
        let policies = folder.join("policies");
        files.write(&policies)?;
        let mut call = Command::new(&program);
        call.args(command.split_whitespace()).arg("--policy").arg(policies.join(POLICY));
        let output = call.current_dir(root).stdin(Stdio::null()).output()?;
        // 1 says only that a run did not meet what was expected of it.
        let text = match output.status.code() {
            Some(0 | 1) => String::from_utf8_lossy(&output.stdout).into_owned(),
            _ => String::new(),
        };
        fs::write(&kept, &text)?;
        text
    };
    let Some(runs) = Json::read(&text) else { return Ok(None) };
    let verdict = |run: &Json| {
        let passed = match run.get("passed") {
            Some(passed) => *passed == Json::Bool(true),
            None => *value(run, "outcome")? == Json::Text("completed".to_owned()),
        };
        let figures =
            format!("{:?} {} {}", value(run, "error_mm.mean")?, number(run, "coverage")?, number(run, "sim_s")?);
        Ok(Verdict { passed, figures })
    };
    Ok(Some(runs.items().iter().map(verdict).collect::<Result<_, NoKey>>()?))
}

fn page(worths: &[Worth], runs: usize, commit: &str) -> String {
    let mut page = format!(
        "# What each part of `vibrissa.fsm` is worth\n\n\
         Written by `cargo x pieces`. Each transition, rule and statement of the policy and of the libraries that it uses was removed \
         in turn. The policy then ran in {runs} random scenes of the families (`docs/families.md`), quasi-static. If no run changed, it ran in 120 \
         further scenes, and then in the bench with friction and noise.\n\n\
         *Lost* is the number of runs that passed with the part and not without it, less those that passed only without it. *Changed* is the \
         number of runs with other figures.\n\n\
         The policy is that of commit {commit}.\n"
    );
    let needed = worths.iter().filter(|worth| worth.counts.is_none()).count();
    let _ = writeln!(
        page,
        "\nThe policy does not compile without {needed} of the {} parts. They are not listed.",
        worths.len()
    );
    let mut files: Vec<&str> = worths.iter().map(|worth| worth.file.as_str()).collect();
    files.dedup();
    for file in files {
        let _ = write!(page, "\n## {file}\n\n| line | part | lost | changed |\n|---|---|---|---|\n");
        let measured = worths.iter().filter(|worth| worth.file == file);
        for (Piece { lines, text }, counts) in measured.filter_map(|worth| Some((&worth.piece, worth.counts?))) {
            let text: String = text.chars().take(100).collect::<String>().replace('|', "\\|");
            let lost = i64::try_from(counts.with).unwrap_or(0) - i64::try_from(counts.without).unwrap_or(0);
            let _ = writeln!(page, "| {} | `{text}` | {lost} | {} |", lines.start + 1, counts.changed);
        }
    }
    page
}

#[cfg(test)]
mod tests {
    use super::*;

    fn verdict(passed: bool, figures: &str) -> Verdict {
        Verdict { passed, figures: figures.to_owned() }
    }

    #[test]
    fn a_run_counts_as_changed_by_its_figures_and_as_lost_by_its_verdict() {
        let base = [verdict(true, "a"), verdict(true, "b"), verdict(false, "c")];
        let without = [verdict(true, "a"), verdict(false, "d"), verdict(false, "e")];
        assert_eq!(Counts::of(&base, &without), Counts { with: 2, without: 1, changed: 2 });
    }

    #[test]
    fn the_page_lists_what_was_measured() {
        let piece = |line| Piece { lines: line..line + 1, text: "when |a| > b -> C".to_owned() };
        let worth = |line, counts| Worth { file: "a.fsm".to_owned(), piece: piece(line), counts };
        let worths = [worth(0, None), worth(1, Some(Counts { with: 3, without: 5, changed: 4 }))];
        let page = page(&worths, 6, "`1234567` of 2026-01-02");
        assert!(
            page.contains("without 1 of the 2 parts") && page.contains("| 2 | `when \\|a\\| > b -> C` | -2 | 4 |"),
            "{page}"
        );
    }
}
