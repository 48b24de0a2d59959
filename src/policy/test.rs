//! The tests that a policy carries: runs of it, and what must be true of them.

use crate::diagnostic::{Diagnostic, Span};
use crate::geometry::Vector2;
use vibrissa_runtime::machine::{
    BodyScalar, ContourVector, Op, Program, Register, Senses, WhiskerScalar, WhiskerVector, compute,
};
use vibrissa_runtime::units::{Dimension, format_si};

/// A run of a policy in a scenario, and what must be true of it.
#[derive(Debug, Clone, PartialEq)]
pub struct PolicyTest {
    /// What it is about.
    pub title: String,
    /// The scenario's file, relative to the policy's.
    pub scenario: String,
    /// Where the scenario is named.
    pub scenario_span: Span,
    /// The parameters that it sets, by index, and their values (SI).
    pub settings: Vec<(usize, f64)>,
    /// What must be true of the run.
    pub expectations: Vec<Expectation>,
}

impl PolicyTest {
    /// Sets the parameters of its own policy's `program` as the test does.
    pub fn set(&self, program: &mut Program) {
        for &(parameter, value) in &self.settings {
            program.image[parameter] = value;
        }
    }
}

/// Something that must be true of a run.
#[derive(Debug, Clone, PartialEq)]
pub struct Expectation {
    /// Where it is written.
    pub span: Span,
    pub(super) code: Vec<Op>,
    /// What registers hold before the figures are known.
    pub(super) image: Vec<f64>,
    pub(super) truth: Register,
    pub(super) figures: Vec<FigurePlace>,
}

/// Where an expectation reads a figure of the run.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct FigurePlace {
    pub(super) register: Register,
    pub(super) figure: RunFigure,
    pub(super) span: Span,
}

/// A figure of a run that expectations can read.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum RunFigure {
    /// Whether it ended as it should.
    Completed,
    /// Whether the policy gave up.
    Failed,
    /// Whether the time was up before the loop closed.
    TimedOut,
    /// Whether the simulation can no longer be trusted.
    Diverged,
    /// Simulated time (s).
    Time,
    /// Mean distance of the tip estimates to the object (m).
    ErrorMean,
    /// Its 95th percentile (m).
    ErrorP95,
    /// Its maximum (m).
    ErrorMax,
    /// Share of the tip estimates whose error is more than their own standard deviation explains (0 to 1).
    Outliers,
    /// Hausdorff distance between the object and the estimated contour (m).
    Hausdorff,
    /// Share of the object's outline that was traced (0 to 1).
    Coverage,
    /// The greatest distance of an estimated corner from the exact one (m).
    CornerPlaceMax,
    /// The longest time that a corner cost (s).
    CornerTimeMax,
    /// The longest path of the platform that a corner cost (m).
    CornerPathMax,
    /// How often the platform's body touched something.
    Collisions,
    /// How often the state with this index was entered.
    Visits(usize),
    /// For how long the state with this index was active (s).
    TimeIn(usize),
}

impl RunFigure {
    fn show(self, value: f64) -> String {
        match self {
            Self::Completed | Self::Failed | Self::TimedOut | Self::Diverged => (value > 0.5).to_string(),
            _ if value.is_nan() => "not known".to_owned(),
            Self::Time | Self::TimeIn(_) | Self::CornerTimeMax => format_si(value, Dimension::TIME),
            Self::ErrorMean
            | Self::ErrorP95
            | Self::ErrorMax
            | Self::Hausdorff
            | Self::CornerPlaceMax
            | Self::CornerPathMax => format_si(value, Dimension::LENGTH),
            Self::Outliers | Self::Coverage | Self::Collisions | Self::Visits(_) => format_si(value, Dimension::NUMBER),
        }
    }
}

impl Expectation {
    /// What is wrong with a run of `program` that has these figures (SI, truths as 1 and 0, not a number for what the run
    /// does not have); `None` if the expectation holds.
    pub fn violation(&self, program: &Program, figure: impl Fn(RunFigure) -> f64) -> Option<Diagnostic> {
        let mut registers = self.image.clone();
        let parameters = program.parameters.len();
        registers[..parameters].copy_from_slice(&program.image[..parameters]);
        for place in &self.figures {
            registers[usize::from(place.register)] = figure(place.figure);
        }
        // A test's code has far fewer operations than this.
        let everything = 0..u32::try_from(self.code.len()).unwrap_or(u32::MAX);
        compute(&self.code, &everything, &mut registers, &mut Numb);
        if registers[usize::from(self.truth)] > 0.5 {
            return None;
        }
        let diagnostic = Diagnostic::error("P0701", "the run is not as expected", self.span, "does not hold");
        Some(self.figures.iter().fold(diagnostic, |diagnostic, place| {
            let value = place.figure.show(figure(place.figure));
            diagnostic.note(place.span, format!("is {value}"))
        }))
    }
}

/// Feels nothing: the code of expectations reads registers only.
struct Numb;

impl Senses for Numb {
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

    fn contour_at(&self, _: usize, _: f64, _: ContourVector) -> Vector2 {
        Vector2::repeat(f64::NAN)
    }

    fn record(&mut self, _: usize) {}
}
