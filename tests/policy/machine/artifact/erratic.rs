//! Senses without sense, and what a machine must keep to whatever they say.

use std::cell::Cell;
use std::sync::Arc;

use vibrissa_runtime::geometry::{Point2, Pose, Vector2};
use vibrissa_runtime::machine::{
    BodyScalar, ContourVector, Machine, Mark, Program, Senses, WhiskerScalar, WhiskerVector,
};
use vibrissa_runtime::motion::Steering;
use vibrissa_runtime::rig::Rig;

/// Numbers that go wrong easily, among some that do not.
const NUMBERS: [f64; 14] =
    [0.0, 1.0, -1.0, 3e-4, -2e-3, 0.05, 1.5, -0.0, 1e-310, 1e18, -1e308, f64::MAX, f64::INFINITY, f64::NAN];

/// Senses that say now this, now that, but know how many whiskers there are.
struct Erratic {
    whiskers: usize,
    /// Contours that no whisker has.
    contours: usize,
    /// Whether every number is one that a rig may say.
    is_sound: bool,
    tick: usize,
    said: Cell<usize>,
}

impl Erratic {
    fn number(&self) -> f64 {
        self.said.set(self.said.get() + 1);
        // Half of the ticks are of sound mind.
        let choice = self.said.get().wrapping_mul(0x9E37_79B9) >> 7;
        NUMBERS[choice % if self.is_sound || self.tick.is_multiple_of(2) { 8 } else { NUMBERS.len() }]
    }

    fn vector(&self) -> Vector2 {
        Vector2::new(self.number(), self.number())
    }

    fn check(&self, whisker: usize) {
        assert!(whisker < self.whiskers, "whisker {whisker} of {}", self.whiskers);
    }

    fn check_index(&self, index: usize, is_of_contour: bool) {
        let count = self.whiskers + if is_of_contour { self.contours } else { 0 };
        assert!(index < count, "{index} of {count}");
    }
}

impl Senses for Erratic {
    fn time(&self) -> f64 {
        self.tick as f64 / 30.0
    }

    fn body(&self, _: BodyScalar) -> f64 {
        self.number()
    }

    fn body_position(&self) -> Vector2 {
        self.vector()
    }

    fn whisker(&self, index: usize, quantity: WhiskerScalar) -> f64 {
        self.check_index(index, quantity.is_of_contour());
        self.number()
    }

    fn whisker_vector(&self, index: usize, quantity: WhiskerVector) -> Vector2 {
        self.check_index(index, quantity.is_of_contour());
        self.vector()
    }

    fn tip_at(&self, whisker: usize, _: f64) -> Vector2 {
        self.check(whisker);
        self.vector()
    }

    fn contour_at(&self, contour: usize, _: f64, _: ContourVector) -> Vector2 {
        self.check_index(contour, true);
        self.vector()
    }

    fn loop_closed(&self, whisker: usize, _: f64, _: f64) -> bool {
        self.check(whisker);
        self.number() > 0.0
    }

    fn record(&mut self, whisker: usize) {
        self.check(whisker);
    }

    fn record_position(&mut self, contour: usize, _: Vector2) {
        assert!(contour < self.contours, "contour {contour} of {}", self.contours);
    }

    fn mark(&mut self, whisker: usize, _: Mark) {
        self.check(whisker);
    }
}

/// Runs a program for a hundred ticks: it must not panic, ask for a whisker that it has not, or give a command that is not
/// finite or is beyond the rig's limits. Where all numbers are finite, a machine comes to more of its states before it fails.
pub(crate) fn run(program: Program) {
    let program = Arc::new(program);
    for is_sound in [true, false] {
        run_on(&program, is_sound);
    }
}

fn run_on(program: &Arc<Program>, is_sound: bool) {
    let rig = Rig::default();
    let whiskers: Vec<_> = (0..program.whiskers.len()).map(|index| Some(index % rig.whiskers.len())).collect();
    let mut steering = Steering::new(&rig, &whiskers);
    let mut senses = Erratic {
        whiskers: program.whiskers.len(),
        contours: program.contours.len(),
        is_sound,
        tick: 0,
        said: Cell::new(0),
    };
    let mut machine = Machine::new(program.clone());
    for tick in 0..100 {
        senses.tick = tick;
        let action = machine.tick(&mut senses).action;
        let body = Pose { position: Point2::from(senses.vector()), heading: senses.number() };
        let command = steering.command(&action, body);
        assert!(command.is_finite(), "{action:?} at {body:?} gives {command:?}");
        assert!(command.velocity_world.norm() <= rig.platform.speed_limit * (1.0 + 1e-12), "{command:?}");
        assert!(command.yaw_rate.abs() <= rig.platform.yaw_rate_limit, "{command:?}");
        assert!(!machine.state_name().is_empty());
    }
}
