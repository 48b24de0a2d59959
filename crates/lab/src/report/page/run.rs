//! A run as a section of a page.

use maud::{Markup, html};
use serde::{Deserialize, Serialize};

use super::figure::{figure, namespaced};
use crate::report::number::millimetres;
use crate::report::picture::{PlottedRun, colour_of, growth_picture, histogram, plotted, state_band};
use crate::report::style;
use crate::report::tables::results::text;
use crate::results::{Ending, LargestError, RunResult};
use crate::run::{Run, Trace};
use crate::score::Score;
use vibrissa_declare::figures::{Cell, Metric};
use vibrissa_world::scene::Scene;

/// The figures of a run for a page. They are small, while the trace of a run is large.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct RunFigures {
    /// The [picture](crate::report::picture) of the run (SVG).
    pub picture: String,
    /// The positions of its data, as JSON.
    positions: String,
    /// Its states over time (SVG).
    band: String,
    /// How the map grew (SVG). `None` without one.
    growth: Option<String>,
    /// Histograms of the errors and of the times of control ticks (SVG).
    histograms: [Option<String>; 2],
    /// Position of the largest error on the picture (px). `None` if the map does not show it.
    ring: Option<(f64, f64)>,
    /// Its duration (s).
    duration: f64,
}

/// Positions on a picture, for the script.
#[derive(Debug, Serialize)]
struct Positions<'t> {
    sides: (f64, f64),
    strips: (f64, f64),
    end_s: f64,
    states: &'t [String],
    whiskers: &'t [String],
    /// Position (px), error (µm), time (s), state, whisker.
    tips: Vec<(f64, f64, f64, f64, Option<usize>, usize)>,
}

impl RunFigures {
    /// The figures of `run`, the run of `scene` under the policy named `policy`, with its `score`.
    #[must_use]
    pub fn new(scene: &Scene, policy: &str, run: &Run, score: &Score) -> Self {
        let plotted = plotted(scene, policy, run, score);
        let errors: Vec<f64> = plotted.tips.iter().map(|tip| 1e3 * tip.error).collect();
        let ticks: Vec<f64> = run.tick_times.iter().map(|time| 1e6 * time.as_secs_f64()).collect();
        let histograms = [
            histogram("Error of tip estimates (mm)", &errors, |error| colour_of(1e-3 * error)),
            histogram("Time of a control tick (µs)", &ticks, |_| style::PLATFORM),
        ];
        Self {
            positions: positions(&plotted, &run.trace),
            band: state_band(&run.trace),
            growth: run.map.as_ref().map(|map| growth_picture(scene, policy, &run.trace, map)),
            histograms,
            ring: plotted.tips.iter().max_by(|a, b| a.error.total_cmp(&b.error)).and_then(|tip| tip.position),
            duration: plotted.end,
            picture: plotted.svg,
        }
    }

    /// The figures of a run that could not begin: empty ones.
    #[must_use]
    pub fn none() -> Self {
        Self {
            picture: "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"0\" height=\"0\"></svg>".to_owned(),
            positions: Positions {
                sides: (0.0, 0.0),
                strips: (0.0, 0.0),
                end_s: 0.0,
                states: &[],
                whiskers: &[],
                tips: Vec::new(),
            }
            .json(),
            band: String::new(),
            growth: None,
            histograms: [None, None],
            ring: None,
            duration: 0.0,
        }
    }
}

impl Positions<'_> {
    fn json(&self) -> String {
        // Without maps that have other keys than texts, this cannot fail.
        serde_json::to_string(self).unwrap_or_default()
    }
}

/// The positions with as many digits as a pointer can distinguish.
fn positions(plotted: &PlottedRun, trace: &Trace) -> String {
    let tenth = |value: f64| (10.0 * value).round() / 10.0;
    let tips = plotted.tips.iter().filter_map(|tip| {
        let (x, y) = tip.position?;
        Some((tenth(x), tenth(y), tenth(1e6 * tip.error), (100.0 * tip.time).round() / 100.0, tip.state, tip.whisker))
    });
    let positions = Positions {
        sides: plotted.sides,
        strips: plotted.strips,
        end_s: plotted.end,
        states: &trace.states,
        whiskers: &trace.whiskers,
        tips: tips.collect(),
    };
    positions.json()
}

/// A run of a page.
pub(super) struct PageRun<'r> {
    /// Name of the scene with its conditions.
    pub(super) scene: String,
    pub(super) result: &'r RunResult,
    pub(super) figures: &'r RunFigures,
    /// True if the run is as expected.
    pub(super) passed: bool,
}

/// The address of the section of a run.
pub(super) fn address(index: usize) -> String {
    format!("#run{index}")
}

/// The runs in short: those that did not pass, the largest errors, and the states over time.
pub(super) fn overview(runs: &[PageRun<'_>]) -> Markup {
    let failed: Vec<_> = runs.iter().enumerate().filter(|(_, run)| !run.passed).collect();
    let longest = runs.iter().map(|run| run.figures.duration).fold(0.0, f64::max);
    html! {
        p { a href=(address(0)) { "To the pictures of the runs" } }
        @if !failed.is_empty() {
            section {
                h2 { "Not passed" }
                ul.worst { @for (index, run) in failed { li { (link(index, run)) ": " (reason(run)) } } }
            }
        }
        section {
            h2 { "Largest errors" }
            ul.worst { @for (index, run) in worst_runs(runs) { li { (worst_sentence(index, run)) } } }
        }
        section {
            h2 { "States over time" }
            p { "Each band is a run, and each colour is a state. The picture of a run names them. A ring marks the largest error." }
            div.bands {
                @for (index, run) in runs.iter().enumerate() {
                    div.label { (link(index, run)) }
                    div.lane { (band(run, &format!("band{index}-"), longest)) }
                }
                div.label {}
                div.axis { @for quarter in 0..=4_u8 { span { (seconds(0.25 * f64::from(quarter) * longest)) } } }
            }
        }
    }
}

fn seconds(time: f64) -> String {
    if time < 10.0 { format!("{time:.1} s") } else { format!("{time:.0} s") }
}

/// For each policy, its run with the largest error.
fn worst_runs<'r, 'a>(runs: &'r [PageRun<'a>]) -> Vec<(usize, &'r PageRun<'a>)> {
    let mut worst: Vec<(usize, &PageRun<'_>)> = Vec::new();
    let error = |run: &PageRun<'_>| run.result.largest_error.as_ref().map_or(f64::NEG_INFINITY, |worst| worst.error_mm);
    for (index, run) in runs.iter().enumerate().filter(|(_, run)| run.result.largest_error.is_some()) {
        let policy = run.result.policy_label();
        match worst.iter_mut().find(|(_, other)| other.result.policy_label() == policy) {
            Some(entry) if error(run) > error(entry.1) => *entry = (index, run),
            Some(_) => {}
            None => worst.push((index, run)),
        }
    }
    worst
}

fn worst_sentence(index: usize, run: &PageRun<'_>) -> Markup {
    let Some(worst) = &run.result.largest_error else { return html! {} };
    html! { b { (run.result.policy_label()) ": " } (link(index, run)) ", " (place(worst)) }
}

/// The error with its position, time and state.
pub(super) fn place(LargestError { error_mm, tip_m, time_s, state, whisker }: &LargestError) -> Markup {
    let [x, y] = tip_m.map(|part| 1e3 * part);
    html! {
        b { (millimetres(*error_mm)) " mm" } " at (" (format!("{x:.0}")) " mm, " (format!("{y:.0}")) " mm), after "
        (format!("{time_s:.1}")) " s, in the state " b { (state.as_deref().unwrap_or("Failure")) } ", by the whisker " (whisker) "."
    }
}

fn link(index: usize, run: &PageRun<'_>) -> Markup {
    html! { a href=(address(index)) { (run.scene) } " (" (run.result.policy_label()) ")" }
}

/// The reason why a run did not pass.
fn reason(run: &PageRun<'_>) -> String {
    match run.result.outcome {
        Ending::Completed => "completed, but a figure is worse than the baseline's".to_owned(),
        outcome => with_explanation(outcome, run.result),
    }
}

/// The outcome with its explanation.
fn with_explanation(outcome: Ending, result: &RunResult) -> String {
    result.explanation().map_or_else(|| outcome.to_string(), |explanation| format!("{outcome}: {explanation}"))
}

/// The band of a run on a lane of the length `longest` (s).
fn band(run: &PageRun<'_>, prefix: &str, longest: f64) -> Markup {
    let share = |time: f64| format!("{:.2}%", 100.0 * time / longest.max(f64::MIN_POSITIVE));
    html! {
        div.band style=(format!("width:{}", share(run.figures.duration))) { (maud::PreEscaped(namespaced(&run.figures.band, prefix))) }
        @if let Some(worst) = &run.result.largest_error {
            span.ring style=(format!("left:{}", share(worst.time_s))) {}
        }
    }
}

/// The section of a run: its reason, its picture and its histograms.
pub(super) fn section(index: usize, run: &PageRun<'_>) -> Markup {
    let PageRun { scene, result, figures, passed } = run;
    let known = |metric, digits| text(result, metric, Cell::Decimals(digits)).unwrap_or_default();
    let policy = result.policy_label();
    let name = format!("{scene}-{policy}").replace(", ", "-").replace(' ', "-");
    let caption = html! {
        @if let Some(worst) = &result.largest_error { "Largest error: " (place(worst)) @if figures.ring.is_some() { " The ring marks it." } @else { " It is outside of the map." } }
        @else { "The policy recorded no tip." }
    };
    html! {
        section.run id=(format!("run{index}")) {
            h2 { (scene) ", " (policy) }
            p class=(if *passed { "outcome" } else { "outcome worse" }) {
                (with_explanation(result.outcome, result))
                " · coverage " (known(Metric::Coverage, 1))
                " · collisions " (known(Metric::Collisions, 0))
                " · " (known(Metric::SimulatedTime, 1)) " s simulated by " (result.world)
            }
            (figure(&name, &format!("run{index}-"), &with_ring(figures), &caption, Some(&figures.positions)))
            @if let Some(growth) = &figures.growth {
                (figure(&format!("{name}-growth"), &format!("run{index}-growth-"), growth, &html! {}, None))
            }
            div.histograms {
                @for (histogram, kind) in figures.histograms.iter().zip(["errors", "ticks"]) {
                    @if let Some(svg) = histogram {
                        (figure(&format!("{name}-{kind}"), &format!("run{index}-{kind}-"), svg, &html! {}, None))
                    }
                }
            }
        }
    }
}

/// The picture with a ring around the largest error.
fn with_ring(figures: &RunFigures) -> String {
    let Some((x, y)) = figures.ring else { return figures.picture.clone() };
    let ring = format!(
        "<circle cx=\"{x:.1}\" cy=\"{y:.1}\" r=\"11\" fill=\"none\" stroke=\"{}\" stroke-width=\"2.5\"/></svg>",
        style::ALARM
    );
    figures.picture.strip_suffix("</svg>").map_or_else(|| figures.picture.clone(), |picture| format!("{picture}{ring}"))
}
