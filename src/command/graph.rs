//! `vibrissa graph`

use std::path::{Path, PathBuf};

use clap::{Args, ValueEnum};

use super::exit::Exit;
use super::failure::Failure;
use super::output;
use super::values::parse_depth;
use vibrissa_lab::load;
use vibrissa_lab::report::{chart_dot, chart_mermaid, chart_svg};
use vibrissa_language::chart::View;
use vibrissa_text::file::CommandFiles;

const EXAMPLE: &str = "Example:\n  vibrissa graph policies/thesis.fsm --out thesis.svg\n  vibrissa graph policies/vibrissa.fsm --depth 1 --format mermaid\n\nExit status: 0 done and all expectations held; 1 an expectation failed; 2 unusable input; 3 internal error; 130 interrupted.";

/// The arguments of `vibrissa graph`.
#[derive(Debug, Args)]
#[command(after_help = EXAMPLE)]
pub(super) struct GraphArguments {
    /// Policy file or name of a built-in policy such as `thesis`
    #[arg(value_name = "POLICY")]
    policy: PathBuf,
    /// Format of the statechart. By default, it follows from the ending of --out: .svg, .mmd or .dot
    #[arg(long, value_enum)]
    format: Option<ChartFormat>,
    /// Show N levels of states, from 1 to 8. Transitions of hidden states are drawn at the outer state that is shown
    #[arg(long, value_name = "N", allow_negative_numbers = true, value_parser = parse_depth)]
    depth: Option<usize>,
    /// Show only this state, its inner states and the targets of its transitions. --depth counts from this state
    #[arg(long, value_name = "NAME")]
    state: Option<String>,
    /// File of the chart. The default is standard output
    #[arg(short, long, value_name = "FILE")]
    out: Option<PathBuf>,
}

/// The formats of a statechart.
#[derive(Debug, Clone, Copy, ValueEnum)]
enum ChartFormat {
    /// A picture
    Svg,
    /// Text for Mermaid, which many Markdown viewers draw
    Mermaid,
    /// Text for Graphviz
    Dot,
}

impl ChartFormat {
    /// The format that the ending of a file names. A file without an ending, or standard output, gets a picture.
    fn of(path: Option<&Path>) -> Result<Self, Failure> {
        let Some(path) = path else { return Ok(Self::Svg) };
        match path.extension().and_then(|ending| ending.to_str()) {
            None | Some("svg") => Ok(Self::Svg),
            Some("mmd" | "md") => Ok(Self::Mermaid),
            Some("dot" | "gv") => Ok(Self::Dot),
            Some(_) => Err(Failure::ChartFile(path.to_owned())),
        }
    }
}

/// A picture of as many states, some of them nested, is wider than a screen.
const MANY_STATES: usize = 20;

pub(super) fn graph(arguments: &GraphArguments) -> Result<Exit, Failure> {
    let view = View { state: arguments.state.as_deref(), depth: arguments.depth };
    let mut files = CommandFiles::new();
    let whole = load::chart(&arguments.policy, &mut files)?;
    let file = arguments.out.as_ref().map(|path| files.output("--out", path)).transpose()?;
    let format = arguments.format.map_or_else(|| ChartFormat::of(arguments.out.as_deref()), Ok)?;
    let chart = whole.view(view).map_err(Failure::at(&arguments.policy))?;
    let text = match format {
        ChartFormat::Svg => chart_svg(&chart).map_err(Failure::at(&arguments.policy))?,
        ChartFormat::Mermaid => chart_mermaid(&chart),
        ChartFormat::Dot => chart_dot(&chart),
    };
    if chart.states.len() > MANY_STATES && chart.states.iter().any(|state| state.parent.is_some()) {
        output::message(format_args!(
            "The chart has {} states. `--depth 1` shows the outermost ones, and `--state NAME` the inside of one.",
            chart.states.len()
        ));
    }
    let text = text.trim_end();
    match file {
        Some(file) => file.write(format!("{text}\n"))?,
        None => output::result(text)?,
    }
    Ok(Exit::Done)
}
