//! The groups of commands: commands within others, and the headings of the help.

use std::ffi::OsStr;
use std::fmt::Write as _;

use clap::{Command, CommandFactory, Subcommand};

use super::exit::Exit;
use super::failure::Failure;
use super::{
    Arguments, completions, diff, estimators, explain, keep, man, merge, mjcf, near_misses, pareto, scale, services,
    stress, timing, worlds,
};

/// The commands that people see, under the headings of the help.
const GROUPS: [(&str, &[&str]); 5] = [
    ("Write policies", &["check", "fmt", "test", "compile", "graph"]),
    ("Run them", &["run", "bench", "families", "compare", "sweep", "tune", "study"]),
    ("Look inside", &["inspect"]),
    ("Sensors", &["calibrate"]),
    ("Robot", &["drive", "push", "replay", "setup"]),
];

/// Studies of simulators and estimators.
#[derive(Debug, Subcommand)]
pub(super) enum Study {
    /// Compare contact estimators on the samples of the same runs
    Estimators(estimators::EstimatorsArguments),
    /// Compare other simulations with MuJoCo along the same paths
    Worlds(worlds::WorldsArguments),
    /// Measure run times
    Timing(timing::TimingArguments),
    /// Measure how costs grow with sizes, and what a sweep of a million runs costs
    Scale(scale::ScaleArguments),
    /// Measure run time against error over the settings of a simulation
    Pareto(pareto::ParetoArguments),
    /// Run stress tests of the simulators, and find the largest stable steps
    Stress(stress::StressArguments),
    /// Merge the results of the parts of a sweep
    Merge(merge::MergeArguments),
}

impl Study {
    pub(super) fn run(&self) -> Result<Exit, Failure> {
        match self {
            Self::Estimators(arguments) => estimators::estimators(arguments),
            Self::Worlds(arguments) => worlds::worlds(arguments),
            Self::Timing(arguments) => timing::timing(arguments),
            Self::Scale(arguments) => scale::scale(arguments),
            Self::Pareto(arguments) => pareto::pareto(arguments),
            Self::Stress(arguments) => stress::stress(arguments),
            Self::Merge(arguments) => merge::merge(arguments),
        }
    }
}

/// What shows the inside of runs, scenarios and recordings.
#[derive(Debug, Subcommand)]
pub(super) enum Inspect {
    /// Find the first tick in which two policies differ, and why
    Diff(diff::DiffArguments),
    /// List how closely transitions that were not taken came to being taken
    NearMisses(near_misses::NearMissArguments),
    /// List the parts of a scenario that a run omits, with the reasons
    Explain(explain::ExplainArguments),
    /// Print the MuJoCo model of a scenario
    Mjcf(mjcf::MjcfArguments),
    /// Keep the part of a recording until a stop, as a test that `replay` repeats
    Keep(keep::KeepArguments),
}

impl Inspect {
    pub(super) fn run(&self) -> Result<Exit, Failure> {
        match self {
            Self::Diff(arguments) => diff::diff(arguments),
            Self::NearMisses(arguments) => near_misses::near_misses(arguments),
            Self::Explain(arguments) => explain::explain(arguments),
            Self::Mjcf(arguments) => mjcf::mjcf(arguments),
            Self::Keep(arguments) => keep::keep(arguments),
        }
    }
}

/// What is written once for a computer or a robot.
#[derive(Debug, Subcommand)]
pub(super) enum Setup {
    /// Print a completion script for a shell
    Completions(completions::CompletionsArguments),
    /// Write manual pages
    Man(man::ManArguments),
    /// Write the files of the services that store and show the telemetry of a robot
    Services(services::ServicesArguments),
}

impl Setup {
    pub(super) fn run(&self) -> Result<Exit, Failure> {
        match self {
            Self::Completions(arguments) => completions::completions(arguments),
            Self::Man(arguments) => man::man(arguments),
            Self::Services(arguments) => services::services(arguments),
        }
    }
}

/// The new name of a command that is in a group now.
pub(super) fn new_name(name: &OsStr) -> Option<String> {
    let program = Arguments::command();
    let moved =
        |group: &&str| program.find_subcommand(group).is_some_and(|group| group.find_subcommand(name).is_some());
    let group = ["study", "inspect", "setup"].into_iter().find(moved)?;
    Some(format!("{group} {}", name.to_string_lossy()))
}

/// The program with its commands under headings, which clap does not have.
pub(super) fn program() -> Command {
    let program = Arguments::command();
    let mut commands = String::new();
    for (heading, names) in GROUPS {
        let _ = writeln!(commands, "{heading}:");
        for command in names.iter().filter_map(|name| program.find_subcommand(name)) {
            let about = command.get_about().map(ToString::to_string).unwrap_or_default();
            let _ = writeln!(commands, "  {:<10}{about}", command.get_name());
        }
        commands.push('\n');
    }
    program.help_template(format!(
        "{{about-with-newline}}\n{{usage-heading}} {{usage}}\n\n{commands}Options:\n{{options}}{{after-help}}"
    ))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_visible_command_has_one_heading() {
        let program = Arguments::command();
        let mut visible: Vec<_> =
            program.get_subcommands().filter(|command| !command.is_hide_set()).map(Command::get_name).collect();
        let mut headed: Vec<_> = GROUPS.iter().flat_map(|(_, names)| names.iter().copied()).collect();
        assert_eq!(visible, headed, "the order of the help is that of the commands");
        assert!(visible.len() <= 18);
        visible.sort_unstable();
        headed.dedup();
        assert_eq!(headed.len(), visible.len());
    }
}
