//! The arguments of every command; those of the language's own tools are [beside](super::language_arguments).

use std::num::NonZeroUsize;
use std::path::PathBuf;

use clap::{Args, Parser, Subcommand};

use crate::scene::{Scene, WorldSetup};
use crate::sweep::Shard;

use super::language_arguments::{CheckArguments, CompileArguments, FmtArguments, GraphArguments, TestArguments};
use super::settings::Settings;
pub(super) use super::values::{TierName, World};
use super::values::{
    parse_friction, parse_jitter, parse_jitter_heading, parse_jobs, parse_repeats, parse_runs, parse_seed,
};

/// Scenarios, benchmarks and a policy language for whisker-based active touch.
#[derive(Debug, Parser)]
#[command(name = "vibrissa", version, about, max_term_width = 100, after_help = EXIT_STATUS)]
pub struct Arguments {
    #[command(subcommand)]
    pub(super) command: Command,
}

pub(super) const EXIT_STATUS: &str = "Exit status: 0 done and all expectations held; 1 an expectation failed; 2 unusable input; \
                           3 internal error.";

#[derive(Debug, Subcommand)]
pub(super) enum Command {
    /// Run scenarios under a policy, and score what was felt against the exact contour
    Run(RunArguments),
    /// Run the scenes of the thesis, and put the figures beside the thesis's
    Bench(BenchArguments),
    /// Fit the tip models of a whisker to touches in known places
    Calibrate(CalibrateArguments),
    /// Do the same runs under several policies, and say where they differ
    Compare(CompareArguments),
    /// Measure run time against error over the settings of a scene's world
    Pareto(ParetoArguments),
    /// Run scenes that are drawn by chance from families, and say how many complete
    Families(FamiliesArguments),
    /// Do the runs of a sweep, each in a process that it may end, and go on with them after a kill
    Sweep(SweepArguments),
    /// Run what is hard on worlds, and find the largest steps that are stable
    Stress(StressArguments),
    /// Join the results of a sweep's shards
    Merge(MergeArguments),
    /// Do runs of a sweep, or hard cases, that standard input asks for
    #[command(hide = true)]
    Worker(WorkerArguments),
    /// Check policies, and say what they consist of
    Check(CheckArguments),
    /// Compile a policy into a file that runs without its text
    Compile(CompileArguments),
    /// Draw the statechart of a policy
    Graph(GraphArguments),
    /// Run the tests that policies carry
    Test(TestArguments),
    /// Lay out policies, in place
    Fmt(FmtArguments),
    /// Serve an editor in which policies are written, over standard input and output
    // It says how to get one where there is none, and is not offered there.
    #[cfg_attr(not(feature = "lsp"), command(hide = true))]
    Lsp,
    /// Print the MuJoCo model of a scenario
    Mjcf(MjcfArguments),
    /// Tell what of a scenario is left out of its run, what that saves, and why it is safe
    Explain(ExplainArguments),
}

#[derive(Debug, Args)]
#[command(after_help = EXIT_STATUS)]
pub(super) struct RunArguments {
    /// Scenario files, one run each
    #[arg(value_name = "SCENARIO", required = true)]
    pub(super) scenarios: Vec<PathBuf>,
    /// Policy, or compiled machine, to run instead of the policy that a scenario names, or of the one that is built in where that
    /// names none
    #[arg(long, value_name = "FILE")]
    pub(super) policy: Option<PathBuf>,
    #[command(flatten)]
    pub(super) settings: Settings,
    /// World to run in, instead of the scenario's; `mujoco` where that names none
    #[arg(long, value_enum)]
    pub(super) world: Option<World>,
    #[command(flatten)]
    pub(super) pruning: Pruning,
    /// Seed of the sensors' noise instead of the scenario's; it matters only to a rig with noise
    #[arg(long, value_name = "N", allow_negative_numbers = true, value_parser = parse_seed)]
    pub(super) seed: Option<u64>,
    /// Write a picture and the result of every run into this directory
    #[arg(short, long, value_name = "DIR")]
    pub(super) out: Option<PathBuf>,
    /// Write what every tick perceived and commanded into this file, one line of JSON a tick
    #[arg(long, value_name = "FILE", conflicts_with = "watch")]
    pub(super) ticks: Option<PathBuf>,
    /// Print only JSON: an array of results
    #[arg(long)]
    pub(super) json: bool,
    #[command(flatten)]
    pub(super) columns: Columns,
    /// Run again whenever a scenario or policy is saved; print a line for every simulated second
    #[arg(long, conflicts_with = "json")]
    pub(super) watch: bool,
}

const BENCH_STATUS: &str = "Exit status: 0 all runs completed and no figure is worse than the thesis's; 1 otherwise; \
                            2 unusable input; 3 internal error; 130 interrupted.";

#[derive(Debug, Args)]
#[command(after_help = BENCH_STATUS)]
pub(super) struct BenchArguments {
    /// Policy, or compiled machine, to run instead of those that are built in; may be given several times
    #[arg(long = "policy", value_name = "FILE")]
    pub(super) policies: Vec<PathBuf>,
    #[command(flatten)]
    pub(super) settings: Settings,
    /// Coefficients of friction of what is touched, with a run for each: --friction 0,0.1,0.3
    #[arg(long, value_name = "MU", value_delimiter = ',', default_value = "0", allow_negative_numbers = true, value_parser = parse_friction)]
    pub(super) friction: Vec<f64>,
    /// Give the sensors the noise and the resolution that the real one is estimated to have
    #[arg(long)]
    pub(super) noise: bool,
    /// World to run in, instead of the scenario's; `mujoco` where that names none
    #[arg(long, value_enum)]
    pub(super) world: Option<World>,
    #[command(flatten)]
    pub(super) pruning: Pruning,
    /// Compare tip models instead, by what `vibrissa.fsm` feels in every scene: without noise, with that of the real sensor, and with
    /// ten times that
    #[arg(long, conflicts_with_all = ["policies", "settings", "friction", "noise", "out"])]
    pub(super) estimators: bool,
    /// Compare worlds instead, by the same policies in every scene: how far tips, moments and contours are from those of MuJoCo's chains
    #[arg(long, value_enum, value_name = "TIER", value_delimiter = ',',
          conflicts_with_all = ["friction", "noise", "world", "no_prune", "estimators", "timing", "out"])]
    pub(super) worlds: Vec<TierName>,
    /// Measure times instead: run every scene N times, from 1 to 1000, one run at a time, and print medians
    #[arg(long, value_name = "N", conflicts_with_all = ["estimators", "out", "jobs"], allow_negative_numbers = true, value_parser = parse_repeats)]
    pub(super) timing: Option<usize>,
    /// Write all results, a picture of every run and a page that shows them into this directory
    #[arg(short, long, value_name = "DIR")]
    pub(super) out: Option<PathBuf>,
    /// Print only JSON: an array of results, each with what the thesis reports
    #[arg(long)]
    pub(super) json: bool,
    #[command(flatten)]
    pub(super) columns: Columns,
    /// How many runs to do at a time, from 1 to 32 for each processor; as many as there are processors unless given
    #[arg(short, long, value_name = "J", allow_negative_numbers = true, value_parser = parse_jobs)]
    pub(super) jobs: Option<NonZeroUsize>,
}

const CALIBRATE_STATUS: &str = "Exit status: 0 done; 2 unusable input; 3 internal error.";

#[derive(Debug, Args)]
#[command(after_help = CALIBRATE_STATUS)]
pub(super) struct CalibrateArguments {
    /// Touches that were measured, as comma-separated values with the columns `x_mm`, `y_mm` and `base_angle_urad`,
    /// and `normal_deg` and `contact` if they are known; without a file they are taken in the simulated world
    #[arg(value_name = "SETS")]
    pub(super) sets: Option<PathBuf>,
    /// Scenario whose rig has the whisker, instead of the reference rig
    #[arg(long, value_name = "SCENARIO")]
    pub(super) rig: Option<PathBuf>,
    /// Whisker to calibrate; the rig's first unless given
    #[arg(long, value_name = "NAME")]
    pub(super) whisker: Option<String>,
    /// Give the simulated sensors the noise and the resolution that the real one is estimated to have
    #[arg(long, conflicts_with = "sets")]
    pub(super) noise: bool,
    /// Seed of that noise
    #[arg(long, value_name = "N", default_value_t = 0, allow_negative_numbers = true, value_parser = parse_seed)]
    pub(super) seed: u64,
    /// Write the calibration, the sets and a picture of the deflection profile into this directory
    #[arg(short, long, value_name = "DIR")]
    pub(super) out: Option<PathBuf>,
    /// Print only JSON
    #[arg(long)]
    pub(super) json: bool,
    #[command(flatten)]
    pub(super) columns: Columns,
}

const COMPARE_STATUS: &str =
    "Exit status: 0 done, whichever is better; 2 unusable input; 3 internal error; 130 interrupted.";

#[derive(Debug, Args)]
#[command(after_help = COMPARE_STATUS)]
pub(super) struct CompareArguments {
    /// Two policies or more, the first of which the others are compared with; and scenarios (.yaml), those of the bench
    /// unless there are any
    #[arg(value_name = "FILE", required = true)]
    pub(super) files: Vec<PathBuf>,
    /// How many runs to do of each scenario, from 1 to 100000: the first as it is, the others with seeds of their own, which fix the
    /// noise and the start
    #[arg(long, value_name = "N", default_value_t = 1, allow_negative_numbers = true, value_parser = parse_runs)]
    pub(super) seeds: u64,
    /// How far starts may be from the scenario's along x and y, from 0 to 10 m: --jitter "20 mm"
    #[arg(long, value_name = "LENGTH", default_value = "0 mm", allow_hyphen_values = true, value_parser = parse_jitter)]
    pub(super) jitter: f64,
    /// How far headings may be from the scenario's, from 0 to 180 deg: --jitter-heading "10 deg"
    #[arg(long, value_name = "ANGLE", default_value = "0 deg", allow_hyphen_values = true, value_parser = parse_jitter_heading)]
    pub(super) jitter_heading: f64,
    /// World to run in, instead of the scenario's; `mujoco` where that names none
    #[arg(long, value_enum)]
    pub(super) world: Option<World>,
    #[command(flatten)]
    pub(super) pruning: Pruning,
    /// Print only JSON: the runs that did not complete, and the figures with their intervals
    #[arg(long)]
    pub(super) json: bool,
    #[command(flatten)]
    pub(super) columns: Columns,
    /// How many runs to do at a time, from 1 to 32 for each processor; as many as there are processors unless given
    #[arg(short, long, value_name = "J", allow_negative_numbers = true, value_parser = parse_jobs)]
    pub(super) jobs: Option<NonZeroUsize>,
}

const PARETO_STATUS: &str =
    "Exit status: 0 done, whichever settings are better; 2 unusable input; 3 internal error; 130 interrupted.";

#[derive(Debug, Args)]
#[command(after_help = PARETO_STATUS)]
pub(super) struct ParetoArguments {
    /// Scenario; the disk of the bench unless given
    #[arg(value_name = "SCENARIO")]
    pub(super) scenario: Option<PathBuf>,
    /// Policy, or compiled machine, to run instead of the one that is built in
    #[arg(long, value_name = "FILE")]
    pub(super) policy: Option<PathBuf>,
    /// How often to run every setting, from 1 to 1000; run times are medians
    #[arg(long, value_name = "N", default_value = "3", allow_negative_numbers = true, value_parser = parse_repeats)]
    pub(super) repeats: usize,
    /// Write the results and a picture of time against error into this directory
    #[arg(short, long, value_name = "DIR")]
    pub(super) out: Option<PathBuf>,
    /// Print only JSON
    #[arg(long)]
    pub(super) json: bool,
    #[command(flatten)]
    pub(super) columns: Columns,
}

const FAMILIES_STATUS: &str =
    "Exit status: 0 all runs passed; 1 otherwise; 2 unusable input; 3 internal error; 130 interrupted.";

#[derive(Debug, Args)]
#[command(after_help = FAMILIES_STATUS)]
pub(super) struct FamiliesArguments {
    /// Families, all unless there are any
    #[arg(value_name = "NAME")]
    pub(super) names: Vec<String>,
    /// Policy, or compiled machine, to run instead of the one that is built in; it has a parameter `speed`
    #[arg(long, value_name = "FILE")]
    pub(super) policy: Option<PathBuf>,
    #[command(flatten)]
    pub(super) settings: Settings,
    /// How many scenes to draw of each family, from 1 to 100000
    #[arg(long, value_name = "N", default_value_t = 20, allow_negative_numbers = true, value_parser = parse_runs)]
    pub(super) count: u64,
    /// Draw other scenes
    #[arg(long, value_name = "S", default_value_t = 1, allow_negative_numbers = true, value_parser = parse_seed)]
    pub(super) seed: u64,
    /// Draw only the scene with this number
    #[arg(long, value_name = "K", conflicts_with = "count", allow_negative_numbers = true, value_parser = parse_seed)]
    pub(super) trial: Option<u64>,
    /// World to run in, instead of the scenario's; `mujoco` where that names none
    #[arg(long, value_enum)]
    pub(super) world: Option<World>,
    #[command(flatten)]
    pub(super) pruning: Pruning,
    /// Print the scenarios instead of running them
    #[arg(long, conflicts_with_all = ["json", "out", "policy", "settings"])]
    pub(super) print: bool,
    /// Write all results, and a picture of every run that did not pass, into this directory
    #[arg(short, long, value_name = "DIR")]
    pub(super) out: Option<PathBuf>,
    /// Print only JSON: an array of results
    #[arg(long)]
    pub(super) json: bool,
    #[command(flatten)]
    pub(super) columns: Columns,
    /// How many runs to do at a time, from 1 to 32 for each processor; as many as there are processors unless given
    #[arg(short, long, value_name = "J", allow_negative_numbers = true, value_parser = parse_jobs)]
    pub(super) jobs: Option<NonZeroUsize>,
}

const SWEEP_STATUS: &str = "Exit status: 0 every run has a result, whatever it is; 1 a run crashed or could not begin; \
                            2 unusable input; 3 internal error; 130 interrupted.";

#[derive(Debug, Args)]
#[command(after_help = SWEEP_STATUS)]
pub(super) struct SweepArguments {
    /// Sweep: scenes, policies, and what varies
    #[arg(value_name = "FILE")]
    pub(super) file: PathBuf,
    #[command(flatten)]
    pub(super) pruning: Pruning,
    /// Do only the K-th of N parts; which part a run belongs to depends on its key alone
    #[arg(long, value_name = "K/N", default_value_t = Shard::WHOLE)]
    pub(super) shard: Shard,
    /// How many runs to do at a time, from 1 to 32 for each processor; as many as there are processors unless given
    #[arg(short, long, value_name = "J", allow_negative_numbers = true, value_parser = parse_jobs)]
    pub(super) jobs: Option<NonZeroUsize>,
    /// Write results into this directory, or go on with those that are there; out/NAME unless given
    #[arg(short, long, value_name = "DIR")]
    pub(super) out: Option<PathBuf>,
    /// Print only JSON: how many runs ended how, by scenes, settings and policy
    #[arg(long)]
    pub(super) json: bool,
    #[command(flatten)]
    pub(super) columns: Columns,
}

const MERGE_STATUS: &str = "Exit status: 0 all runs are there; 1 some are missing; 2 unusable input; 3 internal error.";

#[derive(Debug, Args)]
#[command(after_help = MERGE_STATUS)]
pub(super) struct MergeArguments {
    /// Files with results of shards, or a directory with them
    #[arg(value_name = "DIR|FILE", required = true)]
    pub(super) paths: Vec<PathBuf>,
    /// Write the results into this file; results.jsonl beside the first unless given
    #[arg(short, long, value_name = "FILE")]
    pub(super) out: Option<PathBuf>,
    /// Print only JSON: how many runs ended how, by scenes, settings and policy
    #[arg(long)]
    pub(super) json: bool,
    #[command(flatten)]
    pub(super) columns: Columns,
}

#[derive(Debug, Args)]
pub(super) struct WorkerArguments {
    /// Sweep; hard cases without one
    #[arg(value_name = "FILE")]
    pub(super) file: Option<PathBuf>,
    #[command(flatten)]
    pub(super) pruning: Pruning,
}

const STRESS_STATUS: &str = "Exit status: 0 every case ended in a way that runs end, with finite numbers; 1 otherwise; 2 unusable input; \
                             3 internal error; 130 interrupted.";

#[derive(Debug, Args)]
#[command(after_help = STRESS_STATUS)]
pub(super) struct StressArguments {
    /// Print only JSON: an array of cases and settings
    #[arg(long)]
    pub(super) json: bool,
    #[command(flatten)]
    pub(super) columns: Columns,
    /// How many cases to run at a time, from 1 to 32 for each processor; as many as there are processors unless given
    #[arg(short, long, value_name = "J", allow_negative_numbers = true, value_parser = parse_jobs)]
    pub(super) jobs: Option<NonZeroUsize>,
}

#[derive(Debug, Args)]
#[command(after_help = EXIT_STATUS)]
pub(super) struct ExplainArguments {
    /// Scenario file
    #[arg(value_name = "SCENARIO")]
    pub(super) scenario: PathBuf,
    /// Policy, or compiled machine, instead of the policy that the scenario names, or of the one that is built in where that names
    /// none
    #[arg(long, value_name = "FILE")]
    pub(super) policy: Option<PathBuf>,
    /// World to run in, instead of the scenario's; `mujoco` where that names none
    #[arg(long, value_enum)]
    pub(super) world: Option<World>,
    /// Print only JSON: the decisions
    #[arg(long)]
    pub(super) json: bool,
}

#[derive(Debug, Args)]
#[command(after_help = EXIT_STATUS)]
pub(super) struct MjcfArguments {
    /// Scenario file
    #[arg(value_name = "SCENARIO")]
    pub(super) scenario: PathBuf,
}

/// How tables are printed.
#[derive(Debug, Clone, Copy, Args)]
pub(super) struct Columns {
    /// Print every column of tables; without this, tables are at most 100 characters wide
    #[arg(long, conflicts_with = "json")]
    pub(super) wide: bool,
}

/// How much is simulated.
#[derive(Debug, Args)]
pub(super) struct Pruning {
    /// Simulate everything, also what cannot matter; `vibrissa explain` tells what that is
    #[arg(long)]
    pub(super) no_prune: bool,
}

impl Pruning {
    /// How to run a scene when this world is asked for, if any is.
    pub(super) fn of(&self, asked: Option<World>, scene: &Scene) -> WorldSetup {
        WorldSetup { kind: World::of(asked, scene), prune: !self.no_prune }
    }
}
