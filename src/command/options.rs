//! Groups of options that several commands share.

use std::collections::BTreeSet;
use std::ffi::OsString;
use std::num::NonZeroUsize;
use std::path::PathBuf;
use std::sync::Once;

use clap::Args;
use clap::builder::{PossibleValue, PossibleValuesParser, TypedValueParser};
use vibrissa_runtime::machine::{ParameterValue, SetError};
use vibrissa_runtime::units::{Quantity, parse_quantity};

use super::failure::Failure;
use super::output;
use super::values::{parse_friction, parse_jobs, parse_seed};
use vibrissa_lab::built_in::{POLICIES, REAL_MISMATCH, TextFile};
use vibrissa_lab::family::{Family, Values};
use vibrissa_lab::load::{self, GivenMismatch, LoadError, Loaded, Policy};
use vibrissa_lab::study::bench::Conditions;
use vibrissa_lab::trial::{Threads, processors};
use vibrissa_text::file::CommandFiles;
use vibrissa_world::scene::{Scene, WorldKind, WorldSetup};

/// The format of results on standard output.
#[derive(Debug, Clone, Copy, Args)]
pub(super) struct Format {
    /// Print JSON instead of tables
    #[arg(long)]
    pub(super) json: bool,
    /// Print all columns of tables. Without this option, tables are at most 100 characters wide
    #[arg(long, conflicts_with = "json")]
    pub(super) wide: bool,
}

/// The number of runs at a time.
#[derive(Debug, Clone, Copy, Args)]
pub(super) struct Jobs {
    /// Number of runs at a time, from 1 to 32 for each processor. The default is one for each processor
    #[arg(short, long, value_name = "J", allow_negative_numbers = true, value_parser = parse_jobs)]
    jobs: Option<NonZeroUsize>,
}

impl Jobs {
    /// The requested number of threads, or one for each processor.
    pub(super) fn threads(self) -> Threads {
        self.threads_or(processors())
    }

    /// The requested number of threads, or `count`.
    pub(super) fn threads_or(self, count: NonZeroUsize) -> Threads {
        static WARNED: Once = Once::new();
        let fewer = |started| {
            WARNED.call_once(|| {
                output::message(format_args!("warning: the system starts no more than {started} at a time"));
            });
        };
        Threads { count: self.jobs.unwrap_or(count), fewer }
    }
}

/// Reads the name of a simulator.
fn simulator_names() -> impl TypedValueParser<Value = WorldKind> {
    let help = |kind: WorldKind| PossibleValue::new(kind.name()).help(kind.about());
    PossibleValuesParser::new(WorldKind::ALL.map(help)).try_map(|name| WorldKind::named(&name).ok_or("no simulator"))
}

/// The old name of `--simulator`, without its dashes. It is still accepted.
pub(super) const OLD_SIMULATOR: &str = "world";

/// The simulator of a run.
#[derive(Debug, Args)]
pub(super) struct WorldOption {
    /// Simulator of the run. Overrides the simulator of the scenario. Without either, `mujoco` is used if the program contains it
    #[arg(long = "simulator", alias = OLD_SIMULATOR, value_parser = simulator_names())]
    world: Option<WorldKind>,
}

impl WorldOption {
    /// The simulator, if one is given.
    pub(super) fn kind(&self) -> Option<WorldKind> {
        self.world
    }

    /// The world of a run of `scene`.
    pub(super) fn of(&self, scene: &Scene) -> WorldKind {
        self.kind().or(scene.world).unwrap_or_default()
    }
}

/// The pruning of a run.
#[derive(Debug, Args)]
pub(super) struct PruneOption {
    /// Simulate every part of the scene. By default, parts without effect are omitted (`vibrissa inspect explain` lists them)
    #[arg(long)]
    pub(super) no_prune: bool,
}

/// The world of a run and its pruning.
#[derive(Debug, Args)]
pub(super) struct WorldOptions {
    #[command(flatten)]
    pub(super) world: WorldOption,
    #[command(flatten)]
    pub(super) prune: PruneOption,
}

impl WorldOptions {
    /// The options as text, for the header of results.
    pub(super) fn text(&self) -> String {
        let world = self.world.world.map(WorldKind::name);
        let pruned = if self.prune.no_prune { ", not pruned" } else { "" };
        format!("{}{pruned}", world.unwrap_or("of the scene"))
    }

    /// The world of a run of `scene`.
    pub(super) fn of(&self, scene: &Scene) -> WorldSetup {
        WorldSetup { kind: self.world.of(scene), prune: !self.prune.no_prune }
    }
}

/// The array that is simulated.
#[derive(Debug, Args)]
pub(super) struct MismatchOptions {
    /// Simulate an array that differs from the one that control assumes, by this file or the built-in
    /// `plausible`. A key in `mismatch` of the scenario precedes the
    /// same key of the file
    #[arg(long = "mismatch", value_name = "FILE")]
    mismatch_file: Option<PathBuf>,
    /// Seed of the values that a mismatch draws from ranges. `families`, `compare`, `sweep` and `calibrate --arrays` add the number of the run
    #[arg(long, value_name = "N", allow_negative_numbers = true, value_parser = parse_seed)]
    mismatch_seed: Option<u64>,
}

impl MismatchOptions {
    /// Reads the mismatch.
    pub(super) fn load(&self, files: &mut CommandFiles) -> Result<GivenMismatch, LoadError> {
        GivenMismatch::read(self.mismatch_file.as_deref(), self.mismatch_seed, files)
    }

    /// The arguments that give another process the same mismatch.
    fn arguments(&self) -> impl Iterator<Item = OsString> {
        let file = self.mismatch_file.iter().flat_map(|file| ["--mismatch".into(), file.clone().into()]);
        let seed = self.mismatch_seed.iter().flat_map(|seed| ["--mismatch-seed".into(), seed.to_string().into()]);
        file.chain(seed)
    }
}

/// The array that is simulated, and whether it is calibrated before the runs.
#[derive(Debug, Args)]
pub(super) struct ArrayOptions {
    #[command(flatten)]
    mismatch: MismatchOptions,
    /// Let control assume the rig of the scene. By default, an array with a mismatch first calibrates itself by touches of a pin
    #[arg(long)]
    uncalibrated: bool,
}

impl ArrayOptions {
    /// Reads the mismatch.
    pub(super) fn load(&self, files: &mut CommandFiles) -> Result<GivenMismatch, LoadError> {
        Ok(self.mismatch.load(files)?.uncalibrated(self.uncalibrated))
    }

    /// The arguments that give another process the same arrays.
    pub(super) fn arguments(&self) -> impl Iterator<Item = OsString> {
        self.mismatch.arguments().chain(self.uncalibrated.then(|| "--uncalibrated".into()))
    }
}

/// Values of policy parameters.
#[derive(Debug, Args)]
pub(super) struct Settings {
    /// Set a parameter of the policy: --set "speed=80 mm/s", --set trust=false
    #[arg(long = "set", value_name = "NAME=VALUE", value_parser = parse_setting)]
    settings: Vec<(String, ParameterValue)>,
}

impl Settings {
    /// True if the parameter `name` is set.
    pub(super) fn has(&self, name: &str) -> bool {
        self.settings.iter().any(|(set, _)| set == name)
    }

    /// The names of the parameters and their values.
    pub(super) fn pairs(&self) -> &[(String, ParameterValue)] {
        &self.settings
    }

    /// A policy with its parameters set. Its hash depends on them.
    ///
    /// # Errors
    /// [`SetError`] if the policy does not have such a parameter, or if the value is out of its range.
    pub(super) fn of(&self, policy: Loaded<Policy>) -> Result<Loaded<Policy>, SetError> {
        load::set(policy, &self.settings)
    }
}

fn parse_setting(text: &str) -> Result<(String, ParameterValue), String> {
    let (name, value) = name_and_value(text)?;
    let value = ParameterValue::parse(value).map_err(|error| format!("{error}; {}", error.hint()))?;
    Ok((name.to_owned(), value))
}

fn parse_family_value(text: &str) -> Result<(String, Quantity), String> {
    let (name, value) = name_and_value(text)?;
    let value = parse_quantity(value).map_err(|error| format!("{error}; {}", error.hint()))?;
    Ok((name.to_owned(), value))
}

fn name_and_value(text: &str) -> Result<(&str, &str), String> {
    let (name, value) = text.split_once('=').ok_or("write NAME=VALUE, such as \"speed=80 mm/s\"")?;
    Ok((name.trim(), value.trim()))
}

/// Values of parameters of families.
#[derive(Debug, Args)]
pub(super) struct FamilyValues {
    /// Set a parameter of the families, with its unit: --with "angle=40 deg". The others are sampled
    #[arg(long = "with", value_name = "NAME=VALUE", value_parser = parse_family_value)]
    values: Vec<(String, Quantity)>,
}

impl FamilyValues {
    /// The values for a family.
    ///
    /// # Errors
    /// [`Failure`] if the family does not have such a parameter, or not such a value.
    pub(super) fn of(&self, family: &Family) -> Result<Values, Failure> {
        let value = |(name, value): &(String, Quantity)| {
            let fault = |cause| Failure::FamilyValue { family: family.name.to_string(), name: name.clone(), cause };
            let parameter = family.parameters.iter().find(|parameter| parameter.name == name);
            let Some(parameter) = parameter else {
                let names: Vec<_> = family.parameters.iter().map(|parameter| parameter.name).collect();
                return Err(fault(format!("there is no such parameter; there are {}", names.join(", "))));
            };
            if value.dimension != parameter.dimension {
                return Err(fault(format!(
                    "write {}, such as \"{}\"",
                    parameter.dimension.phrase(),
                    parameter.text(parameter.simplest)
                )));
            }
            match parameter.fault(value.value_si) {
                Some(cause) => Err(fault(cause)),
                None => Ok((parameter.name, value.value_si)),
            }
        };
        self.values.iter().map(value).collect()
    }
}

/// Several policies, by default those of the bench.
#[derive(Debug, Args)]
pub(super) struct Policies {
    /// Policy, compiled machine or name of a built-in policy such as `thesis`. Replaces the built-in policies, and may be given several times
    #[arg(long = "policy", value_name = "FILE")]
    policies: Vec<PathBuf>,
    #[command(flatten)]
    settings: Settings,
}

impl Policies {
    /// Reads the policies, sets their parameters and prints their warnings.
    pub(super) fn load(&self, files: &mut CommandFiles) -> Result<Vec<Loaded<Policy>>, Failure> {
        let paths: Vec<PathBuf> = match self.policies.as_slice() {
            [] => POLICIES.iter().map(|file| file.path.into()).collect(),
            given => given.to_vec(),
        };
        let policies = if self.policies.is_empty() {
            POLICIES.iter().map(|file: &TextFile| load::built_in_policy(file)).collect::<Result<Vec<_>, _>>()?
        } else {
            paths.iter().map(|path| load::policy(path, files)).collect::<Result<Vec<_>, _>>()?
        };
        // Pictures are named after policies.
        let mut names = BTreeSet::new();
        for (path, policy) in paths.iter().zip(&policies) {
            output::warnings(&policy.value);
            let name = &policy.value.artifact.program.name;
            if !names.insert(name) {
                let is_same = |policy: &Loaded<Policy>| policy.value.artifact.program.name == *name;
                let first = policies.iter().position(is_same).and_then(|index| paths.get(index));
                let first = first.unwrap_or(path).clone();
                return Err(Failure::SameName { first, second: path.clone(), name: name.clone() });
            }
        }
        let set = |(policy, path): (Loaded<Policy>, PathBuf)| {
            self.settings.of(policy).map_err(|cause| Failure::SetOf { policy: path, cause })
        };
        policies.into_iter().zip(paths).map(set).collect()
    }
}

/// Friction and sensor noise.
#[derive(Debug, Args)]
pub(super) struct ConditionOptions {
    /// Coefficients of friction of the objects, with a run for each: --friction 0,0.1,0.3
    #[arg(long, value_name = "MU", value_delimiter = ',', allow_negative_numbers = true, value_parser = parse_friction)]
    friction: Vec<f64>,
    /// Simulate the estimated noise and resolution of the real sensors
    #[arg(long)]
    noise: bool,
    /// Simulate the array that control assumes, without friction, noise and delays. Without this option and
    /// `--friction`, `--noise`, `--mismatch`, whiskers are round wires under gravity, and the array differs by the
    /// built-in mismatch `real`
    #[arg(long)]
    ideal: bool,
}

impl ConditionOptions {
    /// The conditions, each once, for an array whose mismatch is given or not, and this array.
    ///
    /// # Errors
    /// [`LoadError`] if the built-in mismatch cannot be read.
    pub(super) fn of(&self, array: GivenMismatch) -> Result<(Vec<Conditions>, GivenMismatch), LoadError> {
        if !self.ideal && !self.noise && self.friction.is_empty() && array.is_none() {
            return Ok((vec![Conditions::REAL], array.or_built_in(REAL_MISMATCH)?));
        }
        Ok((self.stated(), array))
    }

    /// The conditions that are stated, each once.
    fn stated(&self) -> Vec<Conditions> {
        if self.friction.is_empty() {
            return vec![Conditions { noise: self.noise, ..Conditions::default() }];
        }
        let mut all: Vec<Conditions> = Vec::new();
        for &friction in &self.friction {
            let conditions = Conditions { friction, noise: self.noise, ..Conditions::default() };
            if !all.contains(&conditions) {
                all.push(conditions);
            }
        }
        all
    }
}
