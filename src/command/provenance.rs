//! The origin of the results of this process.

use std::env;
use std::ffi::OsString;
use std::time::{Duration, SystemTime, UNIX_EPOCH};

use vibrissa_lab::results::{MismatchRecord, Provenance, RunOrigin, RunResult, Simulator};
use vibrissa_lab::trial::{Trial, simulator_version};

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
            mismatch: run.mismatch.as_ref().map(|mismatch| (record(mismatch.file.as_deref()), mismatch.seed)),
            calibration: run.calibration.as_ref().map(|calibration| calibration.kind),
        });
    }
    provenance
}

/// The origin of the results of some trials.
pub(super) fn of_trials<'t>(trials: impl IntoIterator<Item = &'t Trial>) -> Provenance {
    let mut provenance = provenance();
    for trial in trials {
        let Trial { scene, program, world, seed, .. } = trial;
        let mismatch = scene.mismatch.as_ref();
        provenance.add(RunOrigin {
            scenario: &scene.name,
            policy: &program.name,
            simulator: simulator(world.kind.name()),
            seed: *seed,
            mismatch: mismatch.map(|mismatch| (record(mismatch.file.as_deref()), mismatch.seed.unwrap_or(0))),
            calibration: trial.calibration().map(|calibration| calibration.kind),
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

/// The command with its arguments, quoted for a shell. It has no secret.
fn command(arguments: impl Iterator<Item = OsString>) -> String {
    let mut words = vec!["vibrissa".to_owned()];
    let mut is_secret = false;
    for argument in arguments {
        let argument = argument.to_string_lossy();
        let name = argument.split_once('=').map_or(&*argument, |(name, _)| name);
        let hidden = SECRET.contains(&name).then_some(name);
        let word = match hidden {
            _ if is_secret => "...".to_owned(),
            Some(name) if name.len() < argument.len() => format!("{name}=..."),
            _ => argument.to_string(),
        };
        is_secret = hidden.is_some_and(|name| name.len() == argument.len());
        // No argument of a process has a null character.
        words.push(shlex::try_quote(&word).map_or_else(|_| word.clone(), std::borrow::Cow::into_owned));
    }
    words.join(" ")
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
    fn a_given_date_replaces_that_of_the_clock_and_a_date_that_cannot_be_is_none() {
        assert_eq!(date(Some("0")), UNIX_EPOCH);
        for wrong in [None, Some("tomorrow"), Some("99999999999999999999")] {
            assert!(date(wrong) > UNIX_EPOCH + Duration::from_secs(1_700_000_000), "{wrong:?}");
        }
    }
}
