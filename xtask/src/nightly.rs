//! The published pass rates of the families of random scenes, compared with those of the program, and the calibrations of drawn
//! arrays.

mod binomial;
mod ellipsoids;

use std::fmt::Write as _;
use std::path::{Path, PathBuf};
use std::{fs, io};

use thiserror::Error;

use crate::results::{self, FAMILIES, FOLDER, NoKey, PageError, ResultsError, SIMULATORS, Verdicts, joined};
use crate::wilson::wilson;
use binomial::sign_test;
use ellipsoids::{CALIBRATIONS, Ellipsoids};

/// The page of the pass rates, in [`FOLDER`].
const PAGE: &str = "families.md";
/// Below this probability, a change is called significant.
const SIGNIFICANT: f64 = 0.05;

/// The scenes to run, and the program to run them with.
#[derive(Debug, Default, Clone, PartialEq, Eq)]
pub(crate) struct Options {
    /// Only so many scenes of each family, and arrays.
    pub(crate) count: Option<u64>,
    /// A program that is there already, instead of one that is built.
    pub(crate) program: Option<PathBuf>,
}

/// The pass rates differ, or they are not known.
#[derive(Debug, Error)]
pub(crate) enum NightlyError {
    #[error(
        "the verdicts of {0} families differ from those in {FOLDER}/{PAGE}. If the change is intended, run `cargo x results families` \
         and commit the page"
    )]
    Changed(usize),
    #[error(
        "the 95 % ellipsoids of the calibration have the true parameters of {within} of {accepted} whiskers, and should have those of \
         90 to 99 %. Look at the noise that the fit assumes"
    )]
    Ellipsoids { within: u64, accepted: u64 },
    #[error("cannot read {}: {source}. `cargo x results families` writes it", path.display())]
    Read { path: PathBuf, source: io::Error },
    #[error("{FOLDER}/{PAGE}: {0}. `cargo x results families` writes it anew")]
    Page(#[from] PageError),
    #[error("{FOLDER}/{PAGE} has no scenes of `{family}`, {simulator}. `cargo x results families` adds them")]
    Unpublished { family: String, simulator: String },
    #[error(
        "{0} in the output of `vibrissa`. Was it renamed? Correct xtask/src/results/verdicts.rs or xtask/src/nightly/ellipsoids.rs"
    )]
    Key(#[from] NoKey),
    #[error(transparent)]
    Results(#[from] ResultsError),
}

/// Runs the scenes of the page again, and prints the verdicts that changed. Then calibrates drawn arrays.
pub(crate) fn nightly(root: &Path, options: &Options) -> Result<(), NightlyError> {
    let path = root.join(FOLDER).join(PAGE);
    let page = fs::read_to_string(&path).map_err(|source| NightlyError::Read { path, source })?;
    // Before anything runs, so that a page without verdicts costs no time.
    let published = Verdicts::published(&page)?;
    let stale = results::changes_of(root, "families")?;
    if !stale.is_empty() {
        println!("{FOLDER}/{PAGE} is stale, so verdicts may differ. These inputs changed: {}", stale.join(", "));
    }
    if options.program.is_none() {
        results::build(root)?;
    }
    let mut changed = 0;
    for (simulator, command) in SIMULATORS.into_iter().zip(FAMILIES) {
        let command = limited(command, options.count);
        let output = results::output(root, options.program.as_deref(), &command)?;
        println!("\n{simulator}: vibrissa {command}");
        for found in Verdicts::of(simulator, output.items())? {
            let before = before(&published, &found)?;
            println!("{}", comparison(&before, &found));
            changed += usize::from(before != found);
        }
    }
    let ellipsoids = calibrate(root, options)?;
    if changed > 0 {
        return Err(NightlyError::Changed(changed));
    }
    let Ellipsoids { within, accepted, .. } = ellipsoids;
    // A share of a few arrays says nothing.
    if options.count.is_none() && !ellipsoids.are_right() {
        return Err(NightlyError::Ellipsoids { within, accepted });
    }
    Ok(())
}

/// Calibrates drawn arrays, and prints how many ellipsoids have the true parameters.
fn calibrate(root: &Path, options: &Options) -> Result<Ellipsoids, NightlyError> {
    let command = limited(CALIBRATIONS, options.count);
    let output = results::output(root, options.program.as_deref(), &command)?;
    let found = Ellipsoids::of(output.items())?;
    let Ellipsoids { whiskers, accepted, within, touches } = found;
    println!(
        "\nCalibrations: vibrissa {command}\n  {accepted} of {whiskers} whiskers are accepted, with at most {touches} touches\n  \
         true parameters of {within} of {accepted} within the 95 % ellipsoid"
    );
    Ok(found)
}

/// The command with at most `count` scenes of each family, or arrays. The first ones are the same for every count.
fn limited(command: &str, count: Option<u64>) -> String {
    let mut words: Vec<_> = command.split(' ').map(str::to_owned).collect();
    if let (Some(count), Some(at)) =
        (count, words.iter().position(|word| ["--count", "--arrays"].contains(&word.as_str())))
    {
        let all = words[at + 1].parse().unwrap_or(count);
        words[at + 1] = count.min(all).to_string();
    }
    words.join(" ")
}

/// The published verdicts of the scenes that were run.
fn before(published: &[Verdicts], found: &Verdicts) -> Result<Verdicts, NightlyError> {
    let is_it = |of: &&Verdicts| of.simulator == found.simulator && of.family == found.family && of.runs >= found.runs;
    let Verdicts { family, simulator, runs, .. } = found.clone();
    let before = published.iter().find(is_it).ok_or(NightlyError::Unpublished { family, simulator })?;
    Ok(before.first(runs))
}

/// The verdicts of a family beside the published ones of the same scenes, and whether the difference may be chance.
fn comparison(before: &Verdicts, now: &Verdicts) -> String {
    let Verdicts { family, runs, .. } = now;
    let share = |of: &Verdicts| {
        let percent = |share: f64| 100.0 * share;
        let [low, high] = wilson(of.passed(), of.runs).unwrap_or([0.0, 1.0]).map(percent);
        let rate = percent(of.passed() as f64 / of.runs as f64);
        format!("{rate:.1} % (95 % interval {low:.1} to {high:.1} %)")
    };
    if before == now {
        return format!("  {family}: {} of {runs} passed as published, {}", now.passed(), share(now));
    }
    let lost: Vec<_> = now.failed.difference(&before.failed).copied().collect();
    let gained: Vec<_> = before.failed.difference(&now.failed).copied().collect();
    let chance = sign_test(lost.len() as u64, gained.len() as u64);
    let probability = if chance < 0.001 { "p < 0.001".to_owned() } else { format!("p = {chance:.3}") };
    let verdict = if chance < SIGNIFICANT { "a significant change" } else { "it may be chance" };
    let mut text = format!(
        "  {family}: {} of {runs} passed, {}\n    published: {} of {runs}, {}\n    changed verdicts: {}, sign test: {probability}, {verdict}",
        now.passed(),
        share(now),
        before.passed(),
        share(before),
        lost.len() + gained.len()
    );
    for (title, trials) in [("no longer pass", &lost), ("pass now", &gained)] {
        if !trials.is_empty() {
            let _ = write!(text, "\n    {title}, by trial: {}", joined(trials));
        }
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;

    fn verdicts(runs: u64, failed: &[u64]) -> Verdicts {
        let (simulator, family) = ("MuJoCo".to_owned(), "wall".to_owned());
        Verdicts { simulator, family, runs, failed: failed.iter().copied().collect() }
    }

    #[test]
    fn fewer_scenes_are_the_first_ones_of_the_same_command() {
        for command in FAMILIES {
            assert_eq!(limited(command, None), command);
            assert_eq!(limited(command, Some(1_000_000)), command);
            let few = limited(command, Some(3));
            assert!(few.starts_with("families --count 3 --seed 11 --world ") && few.ends_with(" --json"), "{few}");
        }
        assert!(limited(CALIBRATIONS, Some(3)).contains(" --arrays 3 --json"));
    }

    #[test]
    fn verdicts_are_compared_with_those_of_the_same_scenes() {
        let published = [verdicts(200, &[1, 30, 150])];
        let before_ten = before(&published, &verdicts(10, &[])).ok();
        assert_eq!(before_ten, Some(verdicts(10, &[1])));
        let more = before(&published, &verdicts(201, &[])).map_err(|error| error.to_string());
        assert!(more.is_err_and(|text| text.contains("`wall`, MuJoCo") && text.contains("cargo x results families")));
    }

    #[test]
    fn a_change_is_told_with_its_trials_its_intervals_and_whether_it_may_be_chance() {
        let before = verdicts(200, &[1, 30, 150]);
        let same = comparison(&before, &before);
        assert_eq!(same, "  wall: 197 of 200 passed as published, 98.5 % (95 % interval 95.7 to 99.5 %)");
        let one = comparison(&before, &verdicts(200, &[1, 30]));
        assert!(one.contains("wall: 198 of 200 passed, 99.0 %") && one.contains("published: 197 of 200"), "{one}");
        assert!(one.contains("changed verdicts: 1, sign test: p = 1.000, it may be chance"), "{one}");
        assert!(one.ends_with("pass now, by trial: 150"), "{one}");
        let many = comparison(&before, &verdicts(200, &[1, 2, 3, 4, 5, 6, 7, 30, 150]));
        assert!(many.contains("p = 0.031, a significant change"), "{many}");
        assert!(many.ends_with("no longer pass, by trial: 2, 3, 4, 5, 6, 7"), "{many}");
    }
}
