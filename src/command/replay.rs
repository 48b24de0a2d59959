//! `vibrissa replay`

#[cfg(feature = "recording")]
use std::io::{BufReader, Seek};
use std::path::{Path, PathBuf};

use clap::Args;
use vibrissa_robot::recording;

use super::exit::Exit;
use super::failure::Failure;
#[cfg(feature = "live")]
use super::live::{LivePage, Speed, begin, serve_on};
use super::options::Format;
use super::output;
use super::provenance::provenance;
#[cfg(feature = "recording")]
use super::{diff::explained, inspect::breakpoints};
#[cfg(feature = "live")]
use crate::live::{Live, replay_setup};
use vibrissa_lab::load::{self, LoadError};
#[cfg(feature = "recording")]
use vibrissa_lab::recording::{RunRecording, compare_policies};
#[cfg(feature = "recording")]
use vibrissa_lab::report::difference_tables;
use vibrissa_lab::report::replay_tables;
use vibrissa_lab::results::ReplayResult;
use vibrissa_text::file::CommandFiles;
#[cfg(feature = "live")]
use {
    sha2::Digest,
    std::sync::Arc,
    vibrissa_lab::built_in::SCENARIOS,
    vibrissa_lab::load::Loaded,
    vibrissa_lab::recording::SampledRun,
    vibrissa_lab::trial::{Trial, short_hash},
    vibrissa_runtime::machine::Program,
    vibrissa_text::diagnostic::Source,
    vibrissa_world::scene::{Scene, WorldKind, WorldSetup},
};

const EXAMPLE: &str = "Examples:\n  vibrissa replay caught.mcap\n  vibrissa replay run.mcap --policy mine.fsm\n\nExit status: 0 every result is bit-identical; 1 a result differs; 2 unusable input; 3 internal error.";

/// The arguments of `vibrissa replay`.
#[derive(Debug, Args)]
#[command(after_help = EXAMPLE)]
pub(super) struct ReplayArguments {
    /// Recording. Or all parts of a recorded run
    #[arg(value_name = "FILE", required = true)]
    recording: Vec<PathBuf>,
    /// Give the samples of a recorded run to this policy as well, and report the first tick in which its command differs from that of
    /// the recorded policy. With `--live`: the text of the machine that the robot ran, so that the page shows its guards
    #[cfg(feature = "recording")]
    #[arg(long, value_name = "FILE")]
    policy: Option<PathBuf>,
    /// Scenario of the recorded run, so that the page knows the objects and can simulate the run again. Those of the bench are known.
    /// For a real robot: a scenario with the objects that it touched
    #[cfg(feature = "live")]
    #[arg(long, value_name = "FILE", requires = "live")]
    scenario: Option<PathBuf>,
    #[cfg(feature = "live")]
    #[command(flatten)]
    live: LivePage,
    #[command(flatten)]
    format: Format,
}

pub(super) fn replay(arguments: &ReplayArguments) -> Result<Exit, Failure> {
    let paths = &arguments.recording;
    let named = paths.first().map_or(Path::new(""), PathBuf::as_path);
    let mut files = CommandFiles::new();
    #[cfg(feature = "recording")]
    {
        if let Some(run) = run_recording(named, &mut files)? {
            #[cfg(feature = "live")]
            if let Some(live) = arguments.live.start(Speed::Max, &[])? {
                if arguments.policy.is_some() && run.policy().is_some() {
                    let reason =
                        "the page shows the recorded policy; leave out --policy, or compare policies without --live";
                    return Err(Failure::at(named)(reason));
                }
                show(named, SampledRun::from(&run), arguments, &mut files, &live)?;
                replay_run(named, &run, None, arguments, &mut files)?;
                serve_on(&live)
            }
            return replay_run(named, &run, arguments.policy.as_deref(), arguments, &mut files);
        }
        #[cfg(feature = "live")]
        if let Some(live) = arguments.live.start(Speed::Max, &[])? {
            let (recorded, replayed) =
                SampledRun::of_robot(load::recording(paths, &mut files)?).map_err(LoadError::recording(named))?;
            let result = ReplayResult::new(recorded.identity.clone(), &replayed);
            show(named, recorded, arguments, &mut files, &live)?;
            print_replay(named, &result, arguments.format)?;
            serve_on(&live)
        }
        if arguments.policy.is_some() {
            let reason = "it is the recording of a robot, whose steps another policy cannot repeat; leave out --policy, or add --live \
                          to see the guards of the policy that ran";
            return Err(Failure::at(named)(reason));
        }
    }
    let recording = load::recording(paths, &mut files)?;
    let identity = recording.identity().clone();
    let replayed = recording::replay(recording).map_err(LoadError::recording(named))?;
    print_replay(named, &ReplayResult::new(identity, &replayed), arguments.format)
}

/// Prints how the replay of a robot's loop has ended.
fn print_replay(named: &Path, result: &ReplayResult, format: Format) -> Result<Exit, Failure> {
    if result.is_cut {
        let (path, end) = (named.display(), result.end_s);
        output::message(format_args!("warning: {path}: its end is missing; it was replayed until {end:.3} s"));
    }
    output::document(format, &provenance(), result, || replay_tables(result))?;
    Ok(if result.difference.is_none() { Exit::Done } else { Exit::Unexpected })
}

/// Replays a simulated run, or compares its policy with another one.
#[cfg(feature = "recording")]
fn replay_run(
    path: &Path,
    run: &RunRecording,
    policy: Option<&Path>,
    arguments: &ReplayArguments,
    files: &mut CommandFiles,
) -> Result<Exit, Failure> {
    let Some(policy) = policy else {
        let result = vibrissa_lab::recording::replay(run).map_err(Failure::at(path))?;
        output::document(arguments.format, &provenance(), &result, || replay_tables(&result))?;
        return Ok(if result.difference.is_none() { Exit::Done } else { Exit::Unexpected });
    };
    let no_text =
        "it has no text of its policy, because a compiled machine was recorded; record a run of the policy itself";
    let own = run.policy().ok_or_else(|| Failure::at(path)(no_text))?;
    let (own, other) = (breakpoints(own, &[])?, explained(policy, files)?);
    let difference = compare_policies(run, [&own, &other]).map_err(Failure::at(path))?;
    output::document(arguments.format, &provenance(), &difference, || difference_tables(&difference))?;
    Ok(if difference.first.is_none() { Exit::Done } else { Exit::Unexpected })
}

/// Replays a recorded run on a page.
#[cfg(feature = "live")]
fn show(
    path: &Path,
    mut recorded: SampledRun,
    arguments: &ReplayArguments,
    files: &mut CommandFiles,
    live: &Live,
) -> Result<(), Failure> {
    if let Some(policy) = &arguments.policy {
        recorded.policy = Some(recorded_policy(&recorded, policy, files)?);
    }
    let scene = recorded_scene(&recorded, arguments.scenario.as_deref(), files)?;
    let trial = scene.as_ref().and_then(|scene| recorded_trial(&recorded, scene));
    let mut watcher = begin(live, replay_setup(&recorded, scene, trial), || false)?;
    let replayed = recorded.drive(&mut watcher).map_err(Failure::at(path))?;
    if let Some(replayed) = replayed {
        watcher.finish_unjudged(&replayed);
    }
    Ok(())
}

/// The text of the recorded machine, whose parameters may have other values.
#[cfg(feature = "live")]
fn recorded_policy(recorded: &SampledRun, path: &Path, files: &mut CommandFiles) -> Result<Source, Failure> {
    let policy = load::policy(path, files)?.value;
    let program = policy.artifact.program;
    let own = Program { initial_registers: program.initial_registers.clone(), ..(*recorded.program).clone() };
    let text = policy.text.filter(|_| own == program).map(|text| text.source);
    let reason = "it does not compile to the recorded machine; give the text of the policy that ran";
    text.ok_or_else(|| Failure::at(path)(reason))
}

/// The scene of a recording, if its scenario is given or one of the bench. `None` if it is not known.
#[cfg(feature = "live")]
fn recorded_scene(
    recorded: &SampledRun,
    given: Option<&Path>,
    files: &mut CommandFiles,
) -> Result<Option<Scene>, Failure> {
    // Nobody has recorded which objects a real robot touched.
    let Some(recorded) = recorded.identity.get("scenario_hash") else {
        let scene = given.map(|path| load::scenario(path, files)).transpose()?;
        return Ok(scene.map(|loaded| loaded.value));
    };
    let is_recorded = |loaded: &Loaded<Scene>| {
        let hashes = [loaded.hash.clone(), loaded.hash.clone().chain_update(load::UNCALIBRATED)];
        hashes.iter().any(|hash| short_hash(&hash.clone().finalize()) == *recorded)
    };
    let loaded = match given {
        Some(path) => {
            let loaded = load::scenario(path, files)?;
            if !is_recorded(&loaded) {
                return Err(Failure::at(path)("the recorded run had another scenario; give the file that it ran"));
            }
            Some(loaded)
        }
        None => SCENARIOS.iter().find_map(|file| load::built_in_scenario(file).ok().filter(is_recorded)),
    };
    Ok(loaded.map(|loaded| loaded.value))
}

/// The trial of a recorded run of this scene. `None` if the simulator or its version is another one.
#[cfg(feature = "live")]
fn recorded_trial(recorded: &SampledRun, scene: &Scene) -> Option<Trial> {
    let identity = |key: &str| recorded.identity.get(key).map_or("", String::as_str);
    let kind = WorldKind::named(identity("world"))?;
    let trial = Trial {
        assumed_rig: recorded.rig.clone(),
        seed: identity("seed").parse().unwrap_or(scene.seed),
        ..Trial::new(scene.clone(), Arc::clone(&recorded.program))
    };
    let worlds = [true, false].map(|prune| Trial { world: WorldSetup { kind, prune }, ..trial.clone() });
    worlds.into_iter().find(|trial| trial.identity().hash.engine == identity("engine_hash"))
}

/// Reads the recording of a simulated run. `None` if the file is no such recording.
#[cfg(feature = "recording")]
pub(super) fn run_recording(path: &Path, files: &mut CommandFiles) -> Result<Option<RunRecording>, Failure> {
    let mut file = files.open(path).map_err(LoadError::read(path))?;
    if !RunRecording::is_in(BufReader::new(&file)) {
        return Ok(None);
    }
    file.rewind().map_err(LoadError::read(path))?;
    RunRecording::read(BufReader::new(file)).map(Some).map_err(Failure::at(path))
}
