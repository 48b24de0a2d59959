//! `vibrissa graph`

use crate::file::CommandFiles;
use crate::policy::chart::View;
use crate::report::{chart_dot, chart_mermaid, chart_svg};

use super::exit::{Exit, Failure};
use super::language_arguments::{ChartFormat, GraphArguments};
use super::{input, output};

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
    let text = text.trim_end();
    match file {
        Some(file) => file.write(format!("{text}\n"))?,
        None => output::result(text)?,
    }
    Ok(Exit::Done)
}
