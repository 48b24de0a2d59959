//! Senses that a test writes down, and machines that run on them.
#![allow(dead_code, unreachable_pub, reason = "every test file uses a part of it")]
#![allow(clippy::unwrap_used, reason = "a test may panic")]

use std::sync::Arc;

use vibrissa_language::compile;
use vibrissa_runtime::geometry::Vector2;
use vibrissa_runtime::machine::{
    Action, BodyScalar, ContourVector, Machine, MapQuestion, MapScalar, MapVector, Mark, Program, Senses,
    WhiskerScalar, WhiskerVector,
};
use vibrissa_text::diagnostic::{Colour, Source, terminal};

/// What one whisker is like; numbers and truths as the machine sees them.
#[derive(Debug, Clone, Copy)]
pub struct Feel {
    pub touching: bool,
    pub ready: bool,
    pub base_angle: f64,
    pub side: f64,
    pub sense: f64,
    pub tangent: Vector2,
}

impl Default for Feel {
    fn default() -> Self {
        Self { touching: false, ready: true, base_angle: 0.0, side: 1.0, sense: 0.0, tangent: Vector2::new(1.0, 0.0) }
    }
}

/// A scripted perception: what every whisker is like at every tick.
#[derive(Debug, Clone)]
pub struct Script {
    pub period: f64,
    pub now: usize,
    /// By how much (s) each tick comes late; those that are not listed do not.
    pub late: Vec<f64>,
    /// By tick, then by whisker; the last tick lasts.
    pub ticks: Vec<Vec<Feel>>,
    pub recorded: Vec<usize>,
    pub marked: Vec<(usize, Mark)>,
    /// Positions with their contours, as bits. All numbers that are none are alike.
    pub positions: Vec<(usize, [u64; 2])>,
    /// What the map was told, as bits: an event and its numbers.
    pub told: Vec<(&'static str, Vec<u64>)>,
}

impl Script {
    pub fn new(ticks: Vec<Vec<Feel>>) -> Self {
        Self {
            period: 1.0 / 30.0,
            now: 0,
            late: Vec::new(),
            ticks,
            recorded: Vec::new(),
            marked: Vec::new(),
            positions: Vec::new(),
            told: Vec::new(),
        }
    }

    /// One whisker that touches at the ticks marked `x`.
    pub fn touches(marks: &str) -> Self {
        Self::new(marks.chars().map(|mark| vec![Feel { touching: mark == 'x', ..Feel::default() }]).collect())
    }

    fn feel(&self, whisker: usize) -> Feel {
        let tick = self.ticks.get(self.now).or(self.ticks.last()).unwrap();
        tick.get(whisker).copied().unwrap_or_default()
    }
}

/// The bits of a number. All that are none are alike.
fn bits(number: f64) -> u64 {
    if number.is_nan() { u64::MAX } else { number.to_bits() }
}

impl Senses for Script {
    fn time(&self) -> f64 {
        self.now as f64 * self.period + self.late.get(self.now).unwrap_or(&0.0)
    }

    fn body(&self, quantity: BodyScalar) -> f64 {
        match quantity {
            BodyScalar::Yaw => 0.5,
            BodyScalar::Blocked => f64::from(u8::from(self.now % 2 == 1)),
            BodyScalar::Shortfall => 0.01,
            BodyScalar::Length => 0.18,
            BodyScalar::Width => 0.12,
            BodyScalar::NoseWidth => 0.03,
            BodyScalar::TailWidth => 0.11,
            BodyScalar::NoseReach => 0.1,
            BodyScalar::Flexibility => 1.25,
            BodyScalar::Decay => 0.25,
            BodyScalar::Sway => 0.75,
        }
    }

    fn body_position(&self) -> Vector2 {
        Vector2::new(1.0, 2.0)
    }

    fn whisker(&self, whisker: usize, quantity: WhiskerScalar) -> f64 {
        let feel = self.feel(whisker);
        match quantity {
            WhiskerScalar::BaseAngle => feel.base_angle,
            WhiskerScalar::Touching => f64::from(u8::from(feel.touching)),
            WhiskerScalar::Side => feel.side,
            WhiskerScalar::Sense => feel.sense,
            WhiskerScalar::ContourReady => f64::from(u8::from(feel.ready)),
            WhiskerScalar::Yaw => 0.25,
            WhiskerScalar::Length => 0.1,
            WhiskerScalar::ContourCurvature => 3.0,
            WhiskerScalar::TipDeviation => 0.002,
            WhiskerScalar::BaseAngleDeviation => 4e-7,
            WhiskerScalar::RecordedDeviation => 3e-5,
            WhiskerScalar::Fitted => 1.0,
        }
    }

    fn whisker_vector(&self, whisker: usize, quantity: WhiskerVector) -> Vector2 {
        match quantity {
            WhiskerVector::ContourTangent => self.feel(whisker).tangent,
            WhiskerVector::Tip => Vector2::new(0.3, 0.4),
            WhiskerVector::TipBase => Vector2::new(0.09, 0.01),
            WhiskerVector::Base => Vector2::new(0.2, 0.3),
            WhiskerVector::ContourEnd => Vector2::new(0.31, 0.39),
            WhiskerVector::ContourNormal => Vector2::new(0.6, -0.8),
        }
    }

    fn tip_at(&self, whisker: usize, base_angle: f64) -> Vector2 {
        Vector2::new(whisker as f64, base_angle)
    }

    fn contour_at(&self, whisker: usize, back: f64, quantity: ContourVector) -> Vector2 {
        match quantity {
            ContourVector::Point => Vector2::new(whisker as f64, -back),
            ContourVector::Tangent => Vector2::new(back, 1.0),
            ContourVector::Normal => Vector2::new(-1.0, back),
        }
    }

    fn loop_closed(&self, whisker: usize, within: f64, after: f64) -> bool {
        self.feel(whisker).sense > within - after
    }

    fn record(&mut self, whisker: usize) {
        self.recorded.push(whisker);
    }

    fn record_position(&mut self, contour: usize, position: Vector2) {
        self.positions.push((contour, [bits(position.x), bits(position.y)]));
    }

    /// It depends on what the map was told in this run, so that a program must not read too early or too late.
    fn map(&self, quantity: MapScalar) -> f64 {
        let told = self.told.len();
        match quantity {
            MapScalar::Unknown => 0.02,
            MapScalar::IsComplete => f64::from(u8::from(told % 5 == 4)),
            MapScalar::HasNext => f64::from(u8::from(told.is_multiple_of(2))),
            MapScalar::NextIsSurface => f64::from(u8::from(told.is_multiple_of(3))),
            MapScalar::NextSide => 1.0,
            MapScalar::NextHeading => 0.1 * told as f64,
            MapScalar::RouteSpeed => 0.06,
            MapScalar::RouteYawRate => -0.3,
            MapScalar::RouteIsDone => f64::from(u8::from(self.now % 3 == 2)),
            MapScalar::RouteIsLost => f64::from(u8::from(self.now % 4 == 3)),
        }
    }

    fn map_vector(&self, quantity: MapVector) -> Vector2 {
        match quantity {
            MapVector::NextPlace => Vector2::new(0.5, 0.25 * self.told.len() as f64),
            MapVector::NextNormal => Vector2::new(-0.6, 0.8),
            MapVector::NextPosition => Vector2::new(0.4, 0.1),
            MapVector::RouteDirection => Vector2::new(0.8, 0.6),
        }
    }

    fn map_holds(&self, question: MapQuestion, position: Vector2, heading: f64) -> bool {
        match question {
            MapQuestion::IsFree => position.x > 0.0,
            MapQuestion::IsClear => position.y > heading,
            MapQuestion::IsTraced => position.x > position.y,
        }
    }

    fn go_to(&mut self, position: Vector2, heading: f64) {
        self.told.push(("go_to", [position.x, position.y, heading].map(bits).to_vec()));
    }

    fn give_up(&mut self) {
        self.told.push(("give_up", Vec::new()));
    }

    fn felt(&mut self, position: Vector2, normal: Vector2) {
        self.told.push(("felt", [position.x, position.y, normal.x, normal.y].map(bits).to_vec()));
    }

    fn mark(&mut self, whisker: usize, mark: Mark) {
        self.marked.push((whisker, mark));
    }
}

/// The program of a policy that must compile.
pub fn program(text: &str) -> Program {
    let source = Source::new("test.fsm", text);
    compile(&source).unwrap_or_else(|faults| panic!("{}", terminal(&source, &faults, Colour::Plain)))
}

/// Runs a policy over a script, and gives the machine and, for every tick, the state it ended in and its action.
pub fn run(text: &str, script: &mut Script) -> (Machine, Vec<(String, Action)>) {
    run_program(program(text), script)
}

/// The same for a compiled policy.
pub fn run_program(program: Program, script: &mut Script) -> (Machine, Vec<(String, Action)>) {
    let mut machine = Machine::new(Arc::new(program));
    let mut ticks = Vec::new();
    for now in 0..script.ticks.len() {
        script.now = now;
        let tick = machine.tick(script);
        ticks.push((machine.state_name().to_owned(), tick.action));
    }
    (machine, ticks)
}

/// The states that a policy is in, tick by tick.
pub fn states(text: &str, script: &mut Script) -> Vec<String> {
    run(text, script).1.into_iter().map(|(state, _)| state).collect()
}
