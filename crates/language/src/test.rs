//! The tests of a policy: runs with expectations.

use std::sync::Arc;

use vibrissa_declare::catalogue::{Entry, Parameter};
use vibrissa_declare::figures::Metric;
use vibrissa_runtime::geometry::Vector2;
use vibrissa_runtime::machine::{
    BodyScalar, ContourVector, Op, Program, Register, Senses, WhiskerScalar, WhiskerVector, compute,
};
use vibrissa_runtime::units::{Dimension, format_si};
use vibrissa_text::diagnostic::{Diagnostic, Span};

/// Runs of a policy, with their expectations: a test or a property.
#[derive(Debug, Clone, PartialEq)]
pub struct PolicyTest {
    /// The title.
    pub title: String,
    /// Span of the title.
    pub title_span: Span,
    /// The scenes.
    pub scenes: TestScenes,
    /// The changed parameters, by index, with their values (SI).
    pub settings: Vec<(usize, f64)>,
    /// The expectations of each run.
    pub expectations: Vec<Expectation>,
}

impl PolicyTest {
    /// The diagnostic for a run that violates a contract of the policy. `details` name the contract and its time.
    #[must_use]
    pub fn contract_violation(&self, details: &str) -> Diagnostic {
        Diagnostic::error("P0705", "the run violates a contract of the policy", self.title_span, "in this test")
            .hint(details.to_owned())
    }

    /// Sets the parameters of the policy's own `program` to the values of the test.
    pub fn set(&self, program: &mut Program) {
        for &(parameter, value) in &self.settings {
            program.initial_registers[parameter] = value;
        }
    }
}

/// The scenes of a test or a property.
#[derive(Debug, Clone, PartialEq)]
pub enum TestScenes {
    /// One scenario.
    Scenario {
        /// Its file, relative to the policy's.
        file: String,
        /// Span of its name.
        span: Span,
    },
    /// All scenes of a family with parameters in these ranges.
    Family {
        /// The family.
        entry: &'static Entry,
        /// The ranges of all parameters of the family. Those that the property names come last, in its order.
        ranges: Vec<ParameterRange>,
    },
}

/// The values of a family's parameter in a property.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ParameterRange {
    /// The parameter.
    pub parameter: &'static Parameter,
    /// The least value (SI).
    pub low: f64,
    /// The greatest value (SI).
    pub high: f64,
}

/// A condition that a run must fulfil.
#[derive(Debug, Clone, PartialEq)]
pub struct Expectation {
    /// Span of the condition.
    pub span: Span,
    pub(super) code: Vec<Op>,
    /// Initial values of the registers: those of the program, which the expectations share, and the own ones behind them.
    pub(super) initial: [Arc<[f64]>; 2],
    pub(super) result: Register,
    pub(super) figures: Vec<FigureRegister>,
}

/// A register for a figure of the run.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct FigureRegister {
    pub(super) register: Register,
    pub(super) figure: RunFigure,
    pub(super) span: Span,
}

/// A figure of a run that expectations can read.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum RunFigure {
    /// True if the run fulfils the expectations of its scenario.
    Passed,
    /// True if the run completed.
    Completed,
    /// True if the policy failed.
    Failed,
    /// True if the run reached its time limit before its end.
    TimedOut,
    /// True if the simulation diverged.
    Diverged,
    /// A figure that tests can read (SI).
    Metric(Metric),
    /// Number of entries of the state with this index.
    Visits(usize),
    /// Total time in the state with this index (s).
    TimeIn(usize),
    /// A figure of the values of the plot with this index (SI).
    Plot(PlotFigure, usize),
}

/// A figure of the values of a plot.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum PlotFigure {
    /// The least value.
    Least,
    /// The greatest value.
    Greatest,
    /// The last value.
    Last,
}

impl RunFigure {
    fn show(self, value: f64, program: &Program) -> String {
        match self {
            Self::Passed | Self::Completed | Self::Failed | Self::TimedOut | Self::Diverged => {
                (value > 0.5).to_string()
            }
            _ if value.is_nan() => "not known".to_owned(),
            Self::Plot(_, plot) => {
                let kind = program.outputs.plots.get(plot).map(|plot| &plot.kind);
                let shown = kind.and_then(|kind| kind.read(&[value], &program.whiskers));
                shown.map_or_else(String::new, |shown| shown.to_string())
            }
            Self::Metric(metric) => format_si(value, metric.figure().dimension()),
            Self::TimeIn(_) => format_si(value, Dimension::TIME),
            Self::Visits(_) => format_si(value, Dimension::NUMBER),
        }
    }
}

impl Expectation {
    /// The diagnostic for a run of `program` that violates the expectation. `None` if the expectation holds.
    ///
    /// `figure` returns figures in SI units, bools as 1 and 0, and NaN for a figure that the run does not have.
    pub fn violation(&self, program: &Program, figure: impl Fn(RunFigure) -> f64) -> Option<Diagnostic> {
        let mut registers = self.initial.concat();
        let parameters = program.parameters.len();
        registers[..parameters].copy_from_slice(&program.initial_registers[..parameters]);
        for place in &self.figures {
            registers[usize::from(place.register)] = figure(place.figure);
        }
        // The code of a test has far fewer operations than this.
        let everything = 0..u32::try_from(self.code.len()).unwrap_or(u32::MAX);
        compute(&self.code, &everything, &mut registers, &mut NoSenses);
        if registers[usize::from(self.result)] > 0.5 {
            return None;
        }
        let diagnostic = Diagnostic::error("P0701", "the run is not as expected", self.span, "does not hold");
        Some(self.figures.iter().fold(diagnostic, |diagnostic, read| {
            let value = read.figure.show(figure(read.figure), program);
            diagnostic.note(read.span, format!("is {value}"))
        }))
    }
}

/// Senses without values. The code of expectations reads only registers.
struct NoSenses;

impl Senses for NoSenses {
    fn time(&self) -> f64 {
        f64::NAN
    }

    fn body(&self, _: BodyScalar) -> f64 {
        f64::NAN
    }

    fn body_position(&self) -> Vector2 {
        Vector2::repeat(f64::NAN)
    }

    fn whisker(&self, _: usize, _: WhiskerScalar) -> f64 {
        f64::NAN
    }

    fn whisker_vector(&self, _: usize, _: WhiskerVector) -> Vector2 {
        Vector2::repeat(f64::NAN)
    }

    fn tip_at(&self, _: usize, _: f64) -> Vector2 {
        Vector2::repeat(f64::NAN)
    }

    fn loop_closed(&self, _: usize, _: f64, _: f64) -> bool {
        false
    }

    fn contour_at(&self, _: usize, _: f64, _: ContourVector) -> Vector2 {
        Vector2::repeat(f64::NAN)
    }

    fn record(&mut self, _: usize) {}

    fn record_position(&mut self, _: usize, _: Vector2) {}
}
