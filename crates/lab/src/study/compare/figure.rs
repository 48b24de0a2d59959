//! The figures by which policies are compared.

use serde_json::Value;

use crate::results::{Ending, RunResult, figure_in};
use vibrissa_declare::figures::Metric;

/// A figure of a run by which policies are compared.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Figure {
    /// Its name, with its unit.
    pub name: &'static str,
    /// True if larger values are better.
    pub larger_is_better: bool,
    /// `None` for completion: 1 for a completed run and else 0, so that its mean is a share. Runs that did not meet their stop
    /// condition have only this figure, because the others would mislead.
    metric: Option<Metric>,
}

/// All figures: completion, and the declared ones in the order of their ranks.
#[must_use]
pub fn figures() -> Vec<Figure> {
    let compared = |metric: Metric| Some((metric.figure().compared?, metric));
    let mut declared: Vec<_> = Metric::ALL.into_iter().filter_map(compared).collect();
    declared.sort_by_key(|(compared, _)| compared.rank);
    let declared = declared.into_iter().map(|(compared, metric)| Figure {
        name: compared.name,
        larger_is_better: metric.figure().larger_is_better(),
        metric: Some(metric),
    });
    std::iter::once(Figure { name: "completed", larger_is_better: true, metric: None }).chain(declared).collect()
}

impl Figure {
    /// True if its mean is a share of runs, and its value is 0 or 1.
    pub(super) fn is_share(&self) -> bool {
        self.metric.is_none()
    }

    /// Its value in the unit of its name. `None` if the run does not have it, or if the run does not count for it.
    pub(super) fn of(&self, run: &RunResult) -> Option<f64> {
        let value = self.metric.map_or_else(|| Some(completed(run.outcome.name())), |metric| run.figure(metric));
        value.filter(|_| self.metric.is_none() || run.outcome.met_its_stop())
    }

    /// Its value for the JSON document of a run.
    pub(super) fn in_document(&self, run: &Value) -> Option<f64> {
        let outcome = run.get("outcome")?.as_str()?;
        let Some(metric) = self.metric else { return Some(completed(outcome)) };
        let met_its_stop = [Ending::Completed, Ending::Ended].iter().any(|ending| ending.name() == outcome);
        figure_in(run, metric).filter(|_| met_its_stop)
    }
}

fn completed(outcome: &str) -> f64 {
    f64::from(u8::from(outcome == Ending::Completed.name()))
}
