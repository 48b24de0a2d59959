//! The arguments of the language's own tools.

use std::path::PathBuf;

use clap::{Args, ValueEnum};

use super::arguments::EXIT_STATUS;
use super::settings::Settings;
use super::values::{World, parse_depth};

#[derive(Debug, Args)]
#[command(after_help = EXIT_STATUS)]
pub(super) struct CheckArguments {
    /// Policy files or compiled machines
    #[arg(value_name = "POLICY", required = true)]
    pub(super) policies: Vec<PathBuf>,
    /// Take warnings for errors: exit status 2
    #[arg(long)]
    pub(super) deny_warnings: bool,
    /// Print only JSON: an array of policies with their diagnostics
    #[arg(long)]
    pub(super) json: bool,
}

#[derive(Debug, Args)]
#[command(after_help = EXIT_STATUS)]
pub(super) struct CompileArguments {
    /// Policy file, or a compiled machine to set parameters of
    #[arg(value_name = "POLICY")]
    pub(super) policy: PathBuf,
    /// File to write, usually NAME.machine
    #[arg(short, long, value_name = "FILE")]
    pub(super) out: PathBuf,
    #[command(flatten)]
    pub(super) settings: Settings,
}

#[derive(Debug, Args)]
#[command(after_help = EXIT_STATUS)]
pub(super) struct GraphArguments {
    /// Policy file
    #[arg(value_name = "POLICY")]
    pub(super) policy: PathBuf,
    /// Format of the statechart
    #[arg(long, value_enum, default_value_t = ChartFormat::Svg)]
    pub(super) format: ChartFormat,
    /// Show states of N levels only, from 1 to 8: with 1 those that lie in no other. What leads to or from the others leads to or from the
    /// state around them
    #[arg(long, value_name = "N", allow_negative_numbers = true, value_parser = parse_depth)]
    pub(super) depth: Option<usize>,
    /// Show only what lies in this state, and where that leads; with --depth, N levels of it
    #[arg(long, value_name = "NAME")]
    pub(super) state: Option<String>,
    /// Write it into this file instead of printing it
    #[arg(short, long, value_name = "FILE")]
    pub(super) out: Option<PathBuf>,
}

/// The formats of a statechart.
#[derive(Debug, Clone, Copy, ValueEnum)]
pub(super) enum ChartFormat {
    /// A picture
    Svg,
    /// Text for Mermaid, which many pages that show Markdown draw
    Mermaid,
    /// Text for Graphviz
    Dot,
}

#[derive(Debug, Args)]
#[command(after_help = EXIT_STATUS)]
pub(super) struct TestArguments {
    /// Policy files
    #[arg(value_name = "POLICY", required = true)]
    pub(super) policies: Vec<PathBuf>,
    /// Run only tests whose title has this text in it
    #[arg(long, value_name = "TEXT")]
    pub(super) filter: Option<String>,
    /// World to run in, instead of the scenario's; `mujoco` where that names none
    #[arg(long, value_enum)]
    pub(super) world: Option<World>,
    /// Write a picture and the result of every test's run into this directory
    #[arg(short, long, value_name = "DIR")]
    pub(super) out: Option<PathBuf>,
    /// Print only JSON: an array of tests with their results
    #[arg(long)]
    pub(super) json: bool,
}

#[derive(Debug, Args)]
#[command(after_help = EXIT_STATUS)]
pub(super) struct FmtArguments {
    /// Policy files; `-` lays out standard input and prints it
    #[arg(value_name = "POLICY", required = true)]
    pub(super) policies: Vec<PathBuf>,
    /// Change nothing: print what would change, and end with status 1 if anything would
    #[arg(long)]
    pub(super) check: bool,
}
