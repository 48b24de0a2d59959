//! The command line: arguments, printing, exit codes. The only room that prints.

mod arguments;
mod batch;
mod bench;
mod calibrate;
mod check;
mod compare;
mod compile;
mod estimators;
mod exit;
mod explain;
mod families;
mod fmt;
mod graph;
mod input;
mod job;
mod language_arguments;
mod lsp;
mod merge;
mod mjcf;
mod output;
mod pareto;
mod plan;
mod progress;
mod run;
#[cfg(test)]
mod schema;
mod settings;
mod stress;
mod sweep;
mod test;
mod tiers;
mod timing;
mod values;
mod watch;
mod worker;

pub use arguments::Arguments;
pub use exit::Exit;

use std::process::ExitCode;

use clap::Parser;

use crate::diagnostic::printable;

use arguments::Command;

/// Reads the command line. Where that asks for help, or is at fault, it is answered: the status to end with.
///
/// # Errors
/// [`Exit`] when there is nothing to carry out.
pub fn arguments() -> Result<Arguments, ExitCode> {
    Arguments::try_parse().map_err(|answer| {
        // The answer quotes the command line, and has colours of its own, so that what a terminal would obey is taken out before.
        let shown = std::env::args_os().map(|argument| printable(&argument.to_string_lossy()).into_owned());
        let shown = Arguments::try_parse_from(shown).err();
        let _ = shown.as_ref().unwrap_or(&answer).print();
        ExitCode::from(u8::try_from(answer.exit_code()).unwrap_or_default())
    })
}

/// Carries out a command line.
#[must_use]
pub fn main(arguments: &Arguments) -> Exit {
    let done = match &arguments.command {
        Command::Run(arguments) if arguments.watch => watch::watch(arguments),
        Command::Run(arguments) => run::run(arguments),
        Command::Bench(arguments) => bench::bench(arguments),
        Command::Calibrate(arguments) => calibrate::calibrate(arguments),
        Command::Compare(arguments) => compare::compare(arguments),
        Command::Pareto(arguments) => pareto::pareto(arguments),
        Command::Families(arguments) => families::families(arguments),
        Command::Sweep(arguments) => sweep::sweep(arguments),
        Command::Stress(arguments) => stress::stress(arguments),
        Command::Merge(arguments) => merge::merge(arguments),
        Command::Worker(arguments) => worker::worker(arguments),
        Command::Check(arguments) => check::check(arguments),
        Command::Compile(arguments) => compile::compile(arguments),
        Command::Graph(arguments) => graph::graph(arguments),
        Command::Test(arguments) => test::test(arguments),
        Command::Fmt(arguments) => fmt::fmt(arguments),
        Command::Lsp => lsp::lsp(),
        Command::Explain(arguments) => explain::explain(arguments),
        Command::Mjcf(arguments) => mjcf::mjcf(arguments),
    };
    done.unwrap_or_else(|failure| {
        failure.report();
        failure.exit()
    })
}
