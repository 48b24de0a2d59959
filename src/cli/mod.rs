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

use arguments::Command;

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
