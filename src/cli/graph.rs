//! `vibrissa graph`

use crate::file::CommandFiles;
use crate::policy::chart::View;
use crate::report::{chart_dot, chart_mermaid, chart_svg};

use super::exit::{Exit, Failure};
use super::language_arguments::{ChartFormat, GraphArguments};
use super::{input, output};

/// So many states, some of them in others, make a picture that is wider than a screen.
const MANY_STATES: usize = 20;

pub(super) fn graph(arguments: &GraphArguments) -> Result<Exit, Failure> {
    let view = View { state: arguments.state.as_deref(), depth: arguments.depth };
    let mut files = CommandFiles::new();
    let whole = input::chart(&arguments.policy, &mut files)?;
    let file = arguments.out.as_ref().map(|path| files.output("--out", path)).transpose()?;
    let chart = whole.view(view).map_err(|cause| Failure::View { policy: arguments.policy.clone(), cause })?;
    let text = match arguments.format {
        ChartFormat::Svg => {
            chart_svg(&chart).map_err(|cause| Failure::Chart { policy: arguments.policy.clone(), cause })?
        }
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
