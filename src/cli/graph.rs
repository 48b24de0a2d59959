//! `vibrissa graph`

use crate::report::{chart_dot, chart_mermaid, chart_svg};

use super::exit::{Exit, Failure};
use super::language_arguments::{ChartFormat, GraphArguments};
use super::{file, input, output};

pub(super) fn graph(arguments: &GraphArguments) -> Result<Exit, Failure> {
    let chart = input::chart(&arguments.policy)?;
    let text = match arguments.format {
        ChartFormat::Svg => {
            chart_svg(&chart).map_err(|cause| Failure::Chart { policy: arguments.policy.clone(), cause })?
        }
        ChartFormat::Mermaid => chart_mermaid(&chart),
        ChartFormat::Dot => chart_dot(&chart),
    };
    let text = text.trim_end();
    match &arguments.out {
        Some(path) => file::write(path, format!("{text}\n"))?,
        None => output::result(text)?,
    }
    Ok(Exit::Done)
}
