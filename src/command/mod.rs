//! The command line: one file for each command, with its arguments. Only this module prints.

mod bench;
mod calibrate;
mod calibrate_array;
mod calibrate_plan;
mod calibrate_pluck;
mod check;
mod compare;
mod compile;
mod completions;
mod diff;
mod drive;
mod estimators;
mod exit;
mod experiment;
mod explain;
mod failure;
mod families;
mod fmt;
mod graph;
mod groups;
mod inspect;
mod keep;
#[cfg(feature = "live")]
mod live;
mod lsp;
mod man;
mod merge;
mod mjcf;
mod near_misses;
mod options;
mod output;
mod pareto;
#[cfg(feature = "live")]
mod playground;
mod progress;
mod provenance;
mod push;
mod replay;
mod report_folder;
mod reports;
mod run;
mod run_outputs;
mod run_recording;
mod scale;
#[cfg(test)]
mod schema;
mod services;
#[cfg(unix)]
mod stage_options;
mod stress;
mod sweep;
mod test;
mod test_property;
mod timing;
mod trial_runs;
mod trials;
mod tune;
mod tune_runs;
mod values;
mod watch;
mod worker;
mod worlds;

use std::ffi::OsString;
use std::panic::catch_unwind;
use std::process::ExitCode;

use clap::{FromArgMatches, Parser, Subcommand};

use vibrissa_text::diagnostic::printable;

use exit::Exit;
use groups::{Inspect, Setup, Study};
use options::OLD_SIMULATOR;

/// Scenarios, benchmarks and a policy language for whisker-based active touch.
#[derive(Debug, Parser)]
#[command(name = "vibrissa", version, about, max_term_width = 100, after_help = EXIT_STATUS)]
struct Arguments {
    #[command(subcommand)]
    command: Command,
}

const EXIT_STATUS: &str = "Exit status: 0 done and all expectations held; 1 an expectation failed; 2 unusable input; \
                           3 internal error; 130 interrupted.";

#[derive(Debug, Subcommand)]
enum Command {
    /// Check policies and describe their machines
    Check(check::CheckArguments),
    /// Format policies in place
    Fmt(fmt::FmtArguments),
    /// Run the tests of policies
    Test(test::TestArguments),
    /// Compile a policy into a file that runs without its text
    Compile(compile::CompileArguments),
    /// Draw the statechart of a policy
    Graph(graph::GraphArguments),
    /// Run scenarios and score the estimated contours
    Run(run::RunArguments),
    /// Run the ten scenes of the bench and compare the figures with those of the baseline
    Bench(bench::BenchArguments),
    /// Run random scenes of families
    Families(families::FamiliesArguments),
    /// Compare policies over the same runs
    Compare(compare::CompareArguments),
    /// Run a parameter sweep in worker processes. An interrupted sweep can be resumed
    Sweep(sweep::SweepArguments),
    /// Tune parameters of a policy over scenes. An interrupted tuning can be resumed
    Tune(tune::TuneArguments),
    /// Study the simulators and the contact estimators, or merge the parts of a sweep
    #[command(subcommand)]
    Study(Study),
    /// Look inside runs, scenarios and recordings
    #[command(subcommand)]
    Inspect(Inspect),
    /// Calibrate the contact estimators of a whisker
    Calibrate(calibrate::CalibrateArguments),
    /// Drive an array by a compiled machine: a simulated one through emulated sensors, or that of the robot
    Drive(drive::DriveArguments),
    /// Send a signed machine to a robot, which verifies it and drives it at its next start
    Push(push::PushArguments),
    /// Repeat a recorded run through driver, perception and machine, and compare every result bit for bit
    Replay(replay::ReplayArguments),
    /// Serve the playground that `cargo x playground` has built to this machine
    // It needs a checkout, so the help of the program leaves it out.
    #[cfg(feature = "live")]
    #[command(hide = true)]
    Playground(playground::PlaygroundArguments),
    /// Write files for a shell, a manual or the services of a robot
    #[command(subcommand)]
    Setup(Setup),
    /// Serve an editor over standard input and output (language server protocol)
    // An editor starts it, so people need not see it.
    #[command(hide = true)]
    Lsp,
    /// Run the runs of a sweep, or stress tests, that standard input asks for
    #[command(hide = true)]
    Worker(worker::WorkerArguments),
}

/// Runs the program with the arguments of the process.
#[must_use]
pub fn main() -> ExitCode {
    match arguments() {
        // A panic is a fault of the program. Its message has been printed, and scripts recognise it by the exit status.
        Ok(arguments) => catch_unwind(|| carried_out(&arguments)).unwrap_or(Exit::Internal).into(),
        Err(status) => status,
    }
}

fn carried_out(arguments: &Arguments) -> Exit {
    let done = match &arguments.command {
        Command::Run(arguments) => run::run(arguments),
        Command::Bench(arguments) => bench::bench(arguments),
        Command::Families(arguments) => families::families(arguments),
        Command::Compare(arguments) => compare::compare(arguments),
        Command::Sweep(arguments) => sweep::sweep(arguments),
        Command::Tune(arguments) => tune::tune(arguments),
        Command::Check(arguments) => check::check(arguments),
        Command::Fmt(arguments) => fmt::fmt(arguments),
        Command::Test(arguments) => test::test(arguments),
        Command::Compile(arguments) => compile::compile(arguments),
        Command::Drive(arguments) => drive::drive(arguments),
        Command::Push(arguments) => push::push(arguments),
        Command::Replay(arguments) => replay::replay(arguments),
        #[cfg(feature = "live")]
        Command::Playground(arguments) => playground::playground(arguments),
        Command::Graph(arguments) => graph::graph(arguments),
        Command::Study(study) => study.run(),
        Command::Inspect(inspect) => inspect.run(),
        Command::Setup(setup) => setup.run(),
        Command::Calibrate(arguments) => calibrate::calibrate(arguments),
        Command::Lsp => lsp::lsp(),
        Command::Worker(arguments) => worker::worker(arguments),
    };
    done.unwrap_or_else(|failure| {
        failure.report();
        failure.exit()
    })
}

/// Reads the command line. Requests for help and mistakes are answered here. Then the result is the exit status.
fn arguments() -> Result<Arguments, ExitCode> {
    if let Some(new) = std::env::args_os().nth(1).and_then(|name| groups::new_name(&name)) {
        output::error(format_args!("this command is now `vibrissa {new}`"));
        return Err(Exit::Unusable.into());
    }
    let is_old = |word: OsString| {
        word.to_str().and_then(|word| word.strip_prefix("--")?.split('=').next()) == Some(OLD_SIMULATOR)
    };
    if std::env::args_os().any(is_old) {
        output::message("note: `--world` is now `--simulator`");
    }
    let words = std::env::args_os();
    #[cfg(feature = "live")]
    let words = live::joined(words);
    let parsed = |words: &mut dyn Iterator<Item = OsString>| {
        let matches = groups::program().try_get_matches_from(words)?;
        Arguments::from_arg_matches(&matches)
    };
    parsed(&mut words.into_iter()).map_err(|answer| {
        // The answer quotes the command line and has its own colours, so control characters are removed before.
        let shown = std::env::args_os().map(|argument| printable(&argument.to_string_lossy()).into_owned().into());
        let shown = parsed(&mut shown.into_iter()).err();
        let _ = shown.as_ref().unwrap_or(&answer).print();
        ExitCode::from(u8::try_from(answer.exit_code()).unwrap_or_default())
    })
}
