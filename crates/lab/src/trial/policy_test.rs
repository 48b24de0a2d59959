//! The verdict of a policy's test on a run.

use super::trial::TrialResult;
use vibrissa_declare::figures::Kind;
use vibrissa_language::{PlotFigure, PolicyTest, RunFigure};
use vibrissa_runtime::machine::Program;
use vibrissa_text::diagnostic::Diagnostic;
use vibrissa_world::scene::Outcome;

/// The expectations of a `test` or a property that do not hold for the `result` of `program`, and the contracts that it
/// violated. Empty if the test passed.
#[must_use]
pub fn violations(test: &PolicyTest, program: &Program, result: &TrialResult) -> Vec<Diagnostic> {
    let figure = |wanted| figure(wanted, program, result);
    let faults = test.expectations.iter().filter_map(|expectation| expectation.violation(program, figure));
    let violated = result.run.contracts.iter().filter(|contract| contract.violations > 0);
    faults.chain(violated.map(|contract| test.contract_violation(&contract.to_string()))).collect()
}

/// A figure of a run (SI, bool as 1 and 0). Not a number if the run does not have it.
fn figure(figure: RunFigure, program: &Program, result: &TrialResult) -> f64 {
    let TrialResult { run, score, violations } = result;
    let ended = |outcome| f64::from(u8::from(run.outcome == outcome));
    match figure {
        RunFigure::Passed => f64::from(u8::from(violations.is_empty())),
        RunFigure::Completed => ended(Outcome::Completed),
        RunFigure::Failed => ended(Outcome::Failed),
        RunFigure::TimedOut => ended(Outcome::Timeout),
        RunFigure::Diverged => ended(Outcome::Diverged),
        RunFigure::Metric(metric) => score.figure(metric).unwrap_or(match metric.figure().kind {
            // A policy without marks has no retrieval.
            Kind::Count => 0.0,
            _ => f64::NAN,
        }),
        RunFigure::Visits(state) => {
            let mut was_active = false;
            let entered = run.trace.ticks.iter().filter(|tick| {
                let active = is_active(program, state, tick.state);
                let before = std::mem::replace(&mut was_active, active);
                active && !before
            });
            entered.count() as f64
        }
        RunFigure::Plot(figure, plot) => {
            let values = run.trace.plots.get(plot).map_or(&[][..], |plot| &plot.values);
            let mut values = values.iter().map(|&(_, value)| value);
            let found = match figure {
                PlotFigure::Least => values.reduce(f64::min),
                PlotFigure::Greatest => values.reduce(f64::max),
                PlotFigure::Last => values.next_back(),
            };
            found.unwrap_or(f64::NAN)
        }
        RunFigure::TimeIn(state) => {
            let ticks = run.trace.ticks.iter().filter(|tick| is_active(program, state, tick.state));
            ticks.count() as f64 * run.trace.period
        }
    }
}

/// True if a state is active while `innermost` is the innermost active state: the same state or one around it.
fn is_active(program: &Program, state: usize, innermost: Option<usize>) -> bool {
    innermost.is_some_and(|innermost| program.contains(state, innermost))
}
