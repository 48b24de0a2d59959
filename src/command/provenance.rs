//! The origin of the results of this process.

use std::env;
use std::ffi::{OsStr, OsString};
use std::path::Path;
use std::time::{Duration, SystemTime, UNIX_EPOCH};

use vibrissa_lab::results::{MismatchRecord, Provenance, RunOrigin, RunResult, Simulator};
use vibrissa_lab::trial::{Trial, simulator_version};
use vibrissa_world::mismatch::Mismatch;

/// The commit of the sources of this program. The build script sets it.
const COMMIT: Option<&str> = option_env!("VIBRISSA_COMMIT");
/// Seconds since 1970, which replace the time of the clock, so that files can be reproduced bit by bit.
const EPOCH: &str = "SOURCE_DATE_EPOCH";
/// Options whose values are secrets.
const SECRET: [&str; 1] = ["--live-token"];

/// The origin of results without runs.
pub(super) fn provenance() -> Provenance {
    Provenance {
        command: command(env::args_os().skip(1)),
        version: env!("CARGO_PKG_VERSION").to_owned(),
        commit: COMMIT.map(str::to_owned),
        date: humantime::format_rfc3339_seconds(date(env::var(EPOCH).ok().as_deref())).to_string(),
        ..Provenance::default()
    }
}

/// The origin of the results of some runs.
pub(super) fn of_runs<'r>(runs: impl IntoIterator<Item = &'r RunResult>) -> Provenance {
    let mut provenance = provenance();
    for run in runs {
        provenance.add(RunOrigin {
            scenario: &run.scenario,
            policy: &run.policy,
            simulator: simulator(&run.world),
            seed: run.seed,
            mismatch: run
                .mismatch
                .as_ref()
                .map(|mismatch| (record(mismatch.file.as_deref()), mismatch.is_drawn.then_some(mismatch.seed))),
            calibration: run.calibration.as_ref().map(|calibration| calibration.kind),
            scenario_hash: &run.hash.scenario,
            policy_hash: &run.hash.policy,
        });
    }
    provenance
}

/// The origin of the results of some trials.
pub(super) fn of_trials<'t>(trials: impl IntoIterator<Item = &'t Trial>) -> Provenance {
    let mut provenance = provenance();
    for trial in trials {
        let Trial { scene, program, world, seed, inputs, .. } = trial;
        let drawn = |mismatch: &Mismatch| mismatch.is_drawn().then_some(mismatch.seed.unwrap_or(0));
        provenance.add(RunOrigin {
            scenario: &scene.name,
            policy: &program.name,
            simulator: simulator(world.kind.name()),
            seed: *seed,
            mismatch: scene.mismatch.as_ref().map(|mismatch| (record(mismatch.file.as_deref()), drawn(mismatch))),
            calibration: trial.calibration().map(|calibration| calibration.kind),
            scenario_hash: &inputs.scenario_hash,
            policy_hash: &inputs.policy_hash,
        });
    }
    provenance
}

/// A simulator with its version.
pub(super) fn simulator(name: &str) -> Simulator {
    Simulator { name: name.to_owned(), version: simulator_version(name).to_owned() }
}

fn record(file: Option<&str>) -> MismatchRecord {
    MismatchRecord { file: file.map(str::to_owned), seeds: Vec::new() }
}

/// Where a repeated command writes. The outputs of the first one stay.
const REPEATED: &str = "repeated";
/// Options whose values are folders of outputs.
const FOLDERS: [&str; 2] = ["--out", "-o"];
/// Options whose values are files of outputs.
const FILES: [&str; 5] = ["--ticks", "--record", "--video", "--transitions", "--write"];

/// The command with its arguments, quoted for a shell. It has no secret, and it does not write to the outputs of the first command.
fn command(arguments: impl Iterator<Item = OsString>) -> String {
    let arguments: Vec<String> = arguments.map(|argument| argument.to_string_lossy().into_owned()).collect();
    // The parts of a sweep are merged from where they are.
    let is_part = arguments.iter().take(2).eq(["study", "merge"])
        || arguments.iter().any(|argument| argument.starts_with("--shard"));
    let mut words = vec!["vibrissa".to_owned()];
    let mut before: Option<&str> = None;
    for argument in &arguments {
        let (name, value) = match (before.take(), argument.split_once('=')) {
            (Some(name), _) => (name, Some(argument.as_str())),
            (None, Some((name, value))) if name.starts_with("--") => (name, Some(value)),
            (None, _) => (argument.as_str(), None),
        };
        let replaced = value.and_then(|value| replacement(name, value, is_part));
        let word = match replaced {
            Some(replaced) if argument.starts_with(&format!("{name}=")) => format!("{name}={replaced}"),
            Some(replaced) => replaced,
            None => argument.clone(),
        };
        let takes_value = SECRET.contains(&name) || FOLDERS.contains(&name) || FILES.contains(&name);
        before = (value.is_none() && takes_value).then_some(name);
        // No argument of a process has a null character.
        words.push(shlex::try_quote(&word).map_or_else(|_| word.clone(), std::borrow::Cow::into_owned));
    }
    words.join(" ")
}

/// What stands for the value of an option. `None` if that is shown.
fn replacement(name: &str, value: &str, is_part: bool) -> Option<String> {
    if SECRET.contains(&name) {
        return Some("...".to_owned());
    }
    if is_part {
        return None;
    }
    if FOLDERS.contains(&name) {
        return Some(REPEATED.to_owned());
    }
    // The ending of a file determines its format.
    let file = Path::new(value).file_name().map_or(value.into(), OsStr::to_string_lossy);
    FILES.contains(&name).then(|| format!("{REPEATED}-{}", file.trim_start_matches(&format!("{REPEATED}-"))))
}

/// The time of the clock, or the given one in seconds since 1970.
fn date(epoch: Option<&str>) -> SystemTime {
    let given = epoch.and_then(|seconds| UNIX_EPOCH.checked_add(Duration::from_secs(seconds.parse().ok()?)));
    given.unwrap_or_else(SystemTime::now)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn shown(arguments: &[&str]) -> String {
        command(arguments.iter().map(OsString::from))
    }

    #[test]
    fn a_command_is_quoted_for_a_shell_and_has_no_secret() {
        assert_eq!(
            shown(&["run", "a b.yaml", "--set", "speed=80 mm/s"]),
            "vibrissa run 'a b.yaml' --set 'speed=80 mm/s'"
        );
        assert_eq!(shown(&["run", "it's.yaml"]), "vibrissa run \"it's.yaml\"");
        for arguments in [&["run", "--live-token", "abc", "x"][..], &["run", "--live-token=abc", "x"]] {
            let shown = shown(arguments);
            assert!(!shown.contains("abc") && shown.contains("--live-token") && shown.ends_with(" x"), "{shown}");
        }
    }

    #[test]
    fn a_repeated_command_writes_beside_the_outputs_of_the_first_one() {
        for given in [&["--out", "a/first"][..], &["-o", "a/first"], &["--out=a/first"]] {
            let shown = shown(&[&["bench"], given].concat());
            assert!(!shown.contains("first") && shown.contains(REPEATED), "{shown}");
        }
        assert_eq!(shown(&["run", "x", "--record", "a/b.mcap"]), "vibrissa run x --record repeated-b.mcap");
        assert_eq!(shown(&["run", "x", "--record=repeated-b.mcap"]), "vibrissa run x '--record=repeated-b.mcap'");
        // A merge reads what its parts wrote.
        let part = ["sweep", "a.yaml", "--shard", "1/2", "--out", "first"];
        assert_eq!(shown(&part), "vibrissa sweep a.yaml --shard 1/2 --out first");
    }

    #[test]
    fn a_given_date_replaces_that_of_the_clock_and_a_date_that_cannot_be_is_none() {
        assert_eq!(date(Some("0")), UNIX_EPOCH);
        for wrong in [None, Some("tomorrow"), Some("99999999999999999999")] {
            assert!(date(wrong) > UNIX_EPOCH + Duration::from_secs(1_700_000_000), "{wrong:?}");
        }
    }
}
