//! `vibrissa tune`

use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};

use clap::Args;
use sha2::Digest;
use vibrissa_runtime::machine::Program;

use super::exit::Exit;
use super::failure::Failure;
use super::options::{ArrayOptions, Format, Jobs, Settings, WorldOptions};
use super::output;
use super::trials::make_directory;
use super::tune_runs::{TuningRuns, TuningWork};
use super::values::{parse_runs, parse_seed};
use vibrissa_lab::family::Family;
use vibrissa_lab::load;
use vibrissa_lab::report::tuning_tables;
use vibrissa_lab::sweep::Header;
use vibrissa_lab::trial::{engine_version, short_hash};
use vibrissa_lab::tune::{
    Axis, Candidate, Evolution, Objective, Term, TunedFigures, TunedParameter, TunedRun, TunedValues, Tuning,
    TuningScene,
};
use vibrissa_language::with_defaults;
use vibrissa_text::file::CommandFiles;

const EXAMPLE: &str = "Example:\n  vibrissa tune policies/thesis.fsm --param target --param light --scene polygon --simulator quasistatic\n  vibrissa tune mine.fsm --scene scenarios/box.yaml --held-out scenarios/octagon.yaml --write tuned.fsm\n\nExit status: 0 done; 1 a held-out run under the tuned values did not pass; 2 unusable input; 3 internal error; 130 interrupted.";

/// The arguments of `vibrissa tune`.
#[derive(Debug, Args)]
#[command(after_help = EXAMPLE)]
pub(super) struct TuneArguments {
    /// Policy, compiled machine or name of a built-in policy such as `thesis`
    #[arg(value_name = "POLICY")]
    policy: PathBuf,
    /// Parameter to tune, within the range that the policy declares. The default is all parameters with a range
    #[arg(long = "param", value_name = "NAME")]
    parameters: Vec<String>,
    /// Scenario file, name of a built-in scenario or family of the training scenes. May be given several times
    #[arg(long = "scene", value_name = "FILE|FAMILY", required = true)]
    scenes: Vec<PathBuf>,
    /// Scenario file, name of a built-in scenario or family of the held-out scenes. The default is further scenes of the training families
    #[arg(long = "held-out", value_name = "FILE|FAMILY")]
    held_out: Vec<PathBuf>,
    /// Number of scenes of each family, for training and again as held-out scenes
    #[arg(long, value_name = "N", default_value_t = 5, allow_negative_numbers = true, value_parser = parse_runs)]
    count: u64,
    /// Weight of a figure in the cost. The default is 10 for each millimetre of mean error and 0.01 for each second
    #[arg(long = "weight", value_name = "FIGURE=WEIGHT", value_parser = Term::parse)]
    weights: Vec<Term>,
    /// Largest number of training runs
    #[arg(long, value_name = "N", default_value_t = 500, allow_negative_numbers = true, value_parser = parse_runs)]
    runs: u64,
    /// Seed of the search and of the scenes of families
    #[arg(long, value_name = "S", default_value_t = 1, allow_negative_numbers = true, value_parser = parse_seed)]
    seed: u64,
    #[command(flatten)]
    settings: Settings,
    #[command(flatten)]
    world: WorldOptions,
    #[command(flatten)]
    array: ArrayOptions,
    #[command(flatten)]
    jobs: Jobs,
    /// Directory of the results. The default is out/tune-NAME. Runs whose results are already in it are skipped
    #[arg(short, long, value_name = "DIR")]
    out: Option<PathBuf>,
    /// Write the policy with the tuned values as defaults into this file
    #[arg(long, value_name = "FILE")]
    write: Option<PathBuf>,
    #[command(flatten)]
    format: Format,
}

pub(super) fn tune(arguments: &TuneArguments) -> Result<Exit, Failure> {
    let mut files = CommandFiles::new();
    let text = arguments.write.as_ref().map(|_| load::policy_text(&arguments.policy, &mut files)).transpose()?;
    let policy = load::policy(&arguments.policy, &mut files)?;
    output::warnings(&policy.value);
    let own = policy.value.artifact.program.clone();
    let policy = arguments.settings.of(policy)?;
    let program = policy.value.artifact.program;
    let axes = Axis::of(&program, &arguments.parameters)?;
    let training = scenes(&arguments.scenes, 0, arguments, &mut files)?;
    let held_out = held_out(arguments, &mut files)?;
    if let Some(twice) = held_out.iter().find(|scene| training.iter().any(|one| one.name == scene.name)) {
        return Err(Failure::NotHeldOut { scene: twice.name.clone() });
    }
    let array = arguments.array.load(&mut files)?;
    array
        .check_effect(training.iter().chain(&held_out).filter_map(TuningScene::of_scenario))
        .map_err(load::LoadError::from)?;
    let objective = Objective::new(&arguments.weights);
    let (name, hash) = (format!("tune-{}", program.name), short_hash(&policy.hash.finalize()));
    let mut header = header(&name, hash, &axes, [&training, &held_out], &objective, arguments);
    header.inputs.extend(array.inputs());
    let directory = arguments.out.clone().unwrap_or_else(|| Path::new("out").join(name));
    make_directory(Some(&directory))?;
    let path = directory.join("results.jsonl");
    files.growing("--out", &path)?;
    let written = arguments.write.as_ref().map(|path| files.output("--write", path)).transpose()?;

    let default = Candidate::new(&axes, |name| value(&own, name));
    let given = Candidate::new(&axes, |name| value(&program, name));
    let plan = Plan::new(&axes, training.len(), usize::from(given != default) + 1, arguments.runs)?;
    let work = TuningWork {
        axes: &axes,
        program: &program,
        objective: &objective,
        speed: arguments.settings.has("speed").then(|| value(&program, "speed")).flatten(),
        world: &arguments.world,
        array: &array,
        jobs: arguments.jobs,
    };
    let provenance = work.provenance(&given, training.iter().chain(&held_out), arguments.seed)?;
    let references: Vec<&Candidate> = if given == default { vec![&given] } else { vec![&default, &given] };
    let expected = plan.runs(training.len()) + (references.len() + 1) * held_out.len();
    let mut runs = TuningRuns::open(&path, expected, &header, &provenance, work)?;
    runs.run(&references, &training)?;
    let mut best = (mean_cost(&runs.of(&given, &training)), given.clone());
    let mut evolution = Evolution::new(&given.point(&axes), arguments.seed);
    for _ in 0..plan.generations {
        let generation: Vec<Candidate> = evolution.ask().iter().map(|point| Candidate::at(&axes, point)).collect();
        runs.run(&generation.iter().collect::<Vec<_>>(), &training)?;
        let costs: Vec<f64> = generation.iter().map(|one| mean_cost(&runs.of(one, &training))).collect();
        for (candidate, &cost) in generation.iter().zip(&costs) {
            if cost < best.0 {
                best = (cost, candidate.clone());
            }
        }
        evolution.tell(&costs);
    }
    let tuned = best.1;
    let last: Vec<&Candidate> = references.iter().copied().chain([&tuned]).collect();
    runs.run(&last, &held_out)?;

    let figures = |of: &'static str, candidate: &Candidate| TunedValues {
        of,
        settings: candidate.settings(),
        training: TunedFigures::new(&runs.of(candidate, &training)),
        held_out: TunedFigures::new(&runs.of(candidate, &held_out)),
    };
    let mut values = vec![figures("given", &given), figures("tuned", &tuned)];
    if given != default {
        values.insert(0, figures("policy", &default));
    }
    let [own_values, given_values, tuned_values] = [&default, &given, &tuned].map(Candidate::settings);
    let parameter = |axis: &Axis| {
        let text = |values: &BTreeMap<String, String>| values.get(&axis.name).cloned().unwrap_or_default();
        let [default, given, tuned] = [&own_values, &given_values, &tuned_values].map(text);
        TunedParameter { name: axis.name.clone(), range: axis.range(), default, given, tuned }
    };
    let tuning = Tuning {
        policy: program.name.clone(),
        objective: objective.to_string(),
        runs: plan.runs(training.len()),
        resumed: runs.resumed(),
        parameters: axes.iter().map(parameter).collect(),
        values,
    };
    if let (Some(file), Some(text)) = (written, text) {
        let changed = with_defaults(&text, &tuned_values);
        let faults = |faults| load::LoadError::Faults { source_text: Box::new(text.clone()), faults };
        file.write(changed.map_err(faults)?)?;
    }
    runs.finish();
    output::document(arguments.format, &provenance, &tuning, || tuning_tables(&tuning))?;
    if !arguments.format.json {
        let set = tuned_values.iter().map(|(name, value)| format!("--set \"{name}={value}\""));
        output::result(set.collect::<Vec<_>>().join(" "))?;
        output::result(format_args!("results: {}", path.display()))?;
    }
    let passed = tuning.values.last().is_some_and(|tuned| tuned.held_out.passed == tuned.held_out.runs);
    Ok(if passed { Exit::Done } else { Exit::Unexpected })
}

/// The default or set value (SI) of a parameter.
fn value(program: &Program, name: &str) -> Option<f64> {
    let index = program.parameters.iter().position(|parameter| parameter.name == name)?;
    program.initial_registers.get(index).copied()
}

fn mean_cost(runs: &[TunedRun]) -> f64 {
    TunedFigures::new(runs).cost.unwrap_or(f64::INFINITY)
}

/// The family with this name, or that of a file. `None` for anything else.
fn family(path: &Path, files: &mut CommandFiles) -> Result<Option<Family>, load::LoadError> {
    match path.to_str().and_then(Family::named) {
        None if load::is_scenario(path) => load::drawn_scenes(&load::scenario_text(path, files)?),
        named => Ok(named),
    }
}

/// The scenes with these files and families. Numbers of families begin at `first`.
fn scenes(
    names: &[PathBuf],
    first: u64,
    arguments: &TuneArguments,
    files: &mut CommandFiles,
) -> Result<Vec<TuningScene>, Failure> {
    let mut scenes = Vec::new();
    for path in names {
        match family(path, files)? {
            Some(family) => {
                for number in first..first + arguments.count {
                    scenes.push(TuningScene::family(family.clone(), arguments.seed, number)?);
                }
            }
            None if load::is_scenario(path) => scenes.push(TuningScene::scenario(load::scenario(path, files)?)),
            None => return Err(Failure::NoSuchFamily { name: path.display().to_string() }),
        }
    }
    let mut names = BTreeSet::new();
    if let Some(twice) = scenes.iter().find(|scene| !names.insert(scene.name.clone())) {
        return Err(Failure::SceneTwice { scene: twice.name.clone() });
    }
    Ok(scenes)
}

/// The held-out scenes: those that were requested, or else further ones of the training families.
fn held_out(arguments: &TuneArguments, files: &mut CommandFiles) -> Result<Vec<TuningScene>, Failure> {
    let names = if arguments.held_out.is_empty() {
        let mut families = Vec::new();
        for path in &arguments.scenes {
            families.extend(family(path, files)?.map(|_| path.clone()));
        }
        families
    } else {
        arguments.held_out.clone()
    };
    if names.is_empty() {
        return Err(Failure::NoHeldOut);
    }
    scenes(&names, arguments.count, arguments, files)
}

fn header(
    name: &str,
    policy: String,
    axes: &[Axis],
    scenes: [&[TuningScene]; 2],
    objective: &Objective,
    arguments: &TuneArguments,
) -> Header {
    let parameters: Vec<String> = axes.iter().map(|axis| format!("{} in {}", axis.name, axis.range())).collect();
    let all = scenes.into_iter().flatten();
    let inputs = [
        ("the program", engine_version()),
        ("the policy", policy),
        ("the parameters", parameters.join(", ")),
        ("the objective", objective.to_string()),
        ("the seed", arguments.seed.to_string()),
        ("the world", arguments.world.text()),
    ];
    let inputs = inputs.into_iter().map(|(name, value)| (name.to_owned(), value));
    Header::new(name, inputs.chain(all.map(|scene| (format!("scene {}", scene.name), scene.hash.clone()))))
}

/// The size of a search.
struct Plan {
    references: usize,
    samples: usize,
    generations: usize,
}

impl Plan {
    /// The generations that a number of training runs is sufficient for, after those of the reference values.
    fn new(axes: &[Axis], scenes: usize, references: usize, runs: u64) -> Result<Self, Failure> {
        let samples = Evolution::samples_of(axes.len());
        let runs = usize::try_from(runs).unwrap_or(usize::MAX);
        let generations = runs.saturating_sub(references * scenes) / (samples * scenes);
        if generations == 0 {
            return Err(Failure::FewRuns { needed: (references + samples) * scenes });
        }
        Ok(Self { references, samples, generations })
    }

    /// Number of training runs.
    fn runs(&self, scenes: usize) -> usize {
        (self.references + self.samples * self.generations) * scenes
    }
}
