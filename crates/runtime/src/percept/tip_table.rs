//! The tip position as a function of the base angle and the direction of the contact force.

use std::array;
use std::convert::Infallible;
use std::f64::consts::PI;
use std::sync::Arc;

use nalgebra::Vector2;

use crate::math;
use crate::mechanics::{Equilibrium, EquilibriumProblem, ShaftChain};
use crate::rig::{Hinge, Shaft, Whisker};

use super::newest::Newest;

/// The tip position as a function of the base angle and the direction of the force at the tip. It is a table of
/// equilibria of the whisker's chain of links, with cubic interpolation through four of them in each direction.
///
/// Angles are in the frame of the base, for a counter-clockwise bend. The other bend is the mirror image. A force
/// beyond head-on (180°) still bends an already bent whisker in the same direction. For small base angles there is no such
/// equilibrium.
#[derive(Debug, Clone)]
pub struct TipTable {
    /// Step of the base angle between rows (rad). The first row is the straight whisker.
    angle_step: f64,
    /// Positions of the tip's centre (m, frame of the base), one direction after the other. NaN without an equilibrium.
    tips_base: Vec<Vector2<f64>>,
}

/// A tip position and its derivatives.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct TipPosition {
    /// Position of the tip's centre (m, frame of the base).
    pub tip_base: Vector2<f64>,
    /// Derivative by the base angle (m/rad).
    pub by_angle: Vector2<f64>,
    /// Derivative by the direction of the force (m/rad).
    pub by_direction: Vector2<f64>,
}

/// Largest base moment, in units of `EI / L`.
const MOMENT_RANGE: f64 = 6.0;
/// Number of steps of the base angle.
const ANGLE_STEPS: usize = 72;
/// First direction of the force (rad), at which a force still pulls at the tip, and the step between directions.
const FIRST_DIRECTION: f64 = 50.0 * PI / 180.0;
const DIRECTION_STEP: f64 = 2.0 * PI / 180.0;
/// Number of directions, up to 230°.
const DIRECTIONS: usize = 91;
/// Number of equilibria that are solved in parallel.
const SIDE_BY_SIDE: usize = 4;
/// Number of directions, up to 174°, in which a force bends a straight whisker.
const FROM_STRAIGHT: usize = 63;

impl TipTable {
    /// Computes the table of `whisker`.
    #[must_use]
    pub fn new(whisker: &Whisker) -> Self {
        let (chain, shaft) = (ShaftChain::new(whisker), &whisker.shaft);
        let angle_step =
            MOMENT_RANGE * shaft.tip_stiffness() / shaft.length / whisker.hinge.stiffness / ANGLE_STEPS as f64;
        let mut columns: Vec<Vec<Option<Equilibrium>>> = Vec::with_capacity(DIRECTIONS);
        for first in (0..FROM_STRAIGHT).step_by(SIDE_BY_SIDE) {
            let directions = array::from_fn(|lane| direction(first + lane));
            columns.extend(from_straight(&chain, whisker, angle_step, directions));
        }
        columns.truncate(FROM_STRAIGHT);
        for index in FROM_STRAIGHT..DIRECTIONS {
            columns.push(continued(&chain, direction(index), [&columns[index - 1], &columns[index - 2]]));
        }
        let none = Vector2::repeat(f64::NAN);
        let tips_base =
            columns.iter().flatten().map(|solution| solution.map_or(none, |found| found.tip_base)).collect();
        Self { angle_step, tips_base }
    }

    /// Returns the table of `whisker` from a cache of the newest tables. Whiskers that differ only in their mounting
    /// position share a table, as do most runs of a process.
    #[must_use]
    pub fn shared(whisker: &Whisker) -> Arc<Self> {
        // 100 kB each.
        static NEWEST: Newest<(Shaft, Hinge), TipTable> = Newest::new();
        let key = (whisker.shaft.clone(), whisker.hinge.clone());
        let Ok(table) = NEWEST.get_or::<Infallible>(key, || Ok(Self::new(whisker)));
        table
    }

    /// The tip position at a base angle (rad, 0 or more) under a force in a direction (rad). `None` beyond the table or
    /// without an equilibrium.
    #[must_use]
    pub fn at(&self, base_angle: f64, force_direction: f64) -> Option<TipPosition> {
        let row = Stencil::new(base_angle / self.angle_step, ANGLE_STEPS)?;
        let column = Stencil::new((force_direction - FIRST_DIRECTION) / DIRECTION_STEP, DIRECTIONS - 1)?;
        let mut position =
            TipPosition { tip_base: Vector2::zeros(), by_angle: Vector2::zeros(), by_direction: Vector2::zeros() };
        for (across, (weight, slope)) in column.weights.iter().zip(column.slopes).enumerate() {
            let first = (column.first + across) * (ANGLE_STEPS + 1) + row.first;
            for (tip, (row_weight, row_slope)) in
                self.tips_base[first..first + 4].iter().zip(row.weights.iter().zip(row.slopes))
            {
                position.tip_base += weight * row_weight * tip;
                position.by_angle += weight * row_slope * tip;
                position.by_direction += slope * row_weight * tip;
            }
        }
        position.by_angle /= self.angle_step;
        position.by_direction /= DIRECTION_STEP;
        // One NaN among the positions makes the result NaN.
        position.tip_base.x.is_finite().then_some(position)
    }

    /// Largest base angle of the table (rad).
    #[must_use]
    pub fn range(&self) -> f64 {
        self.angle_step * ANGLE_STEPS as f64
    }
}

/// The force direction (rad) with this index.
fn direction(index: usize) -> f64 {
    FIRST_DIRECTION + DIRECTION_STEP * index as f64
}

/// Equilibria under forces in some directions, by continuation from the straight whisker.
fn from_straight(
    chain: &ShaftChain,
    whisker: &Whisker,
    angle_step: f64,
    directions: [f64; SIDE_BY_SIDE],
) -> [Vec<Option<Equilibrium>>; SIDE_BY_SIDE] {
    let shaft = &whisker.shaft;
    let straight = chain.at_rest();
    let mut columns = directions.map(|_| {
        let mut column = Vec::with_capacity(ANGLE_STEPS + 1);
        column.push(Some(straight));
        column
    });
    let mut before = [None; SIDE_BY_SIDE];
    let mut last = [Some(straight); SIDE_BY_SIDE];
    for index in 1..=ANGLE_STEPS {
        let base_angle = angle_step * index as f64;
        let problems = array::from_fn(|lane| {
            let force_direction = directions[lane];
            let guess = match (last[lane], before[lane]) {
                (Some(last), Some(before)) => extrapolated(&last, &before),
                // The first step is that of a cantilever under a small force.
                (Some(straight), None) => {
                    let force = base_angle * whisker.hinge.stiffness / (shaft.length * math::sin(force_direction));
                    let tip_angle =
                        force * math::sin(force_direction) * math::square(shaft.length) / (2.0 * shaft.tip_stiffness());
                    Equilibrium { tip_angle, force, ..straight }
                }
                (None, _) => return None,
            };
            Some(EquilibriumProblem { base_angle, force_direction, guess })
        });
        before = last;
        last = chain.solve_each(problems);
        for (column, &solution) in columns.iter_mut().zip(&last) {
            column.push(solution);
        }
    }
    columns
}

/// Equilibria for the next force direction, by continuation from the previous two at the same base angles. `None` where
/// the solution belongs to another branch.
fn continued(
    chain: &ShaftChain,
    force_direction: f64,
    [last, before]: [&[Option<Equilibrium>]; 2],
) -> Vec<Option<Equilibrium>> {
    let mut column = Vec::with_capacity(last.len());
    for (last, before) in last.chunks(SIDE_BY_SIDE).zip(before.chunks(SIDE_BY_SIDE)) {
        let problems = array::from_fn(|lane| {
            let last = last.get(lane).copied().flatten()?;
            let guess = before[lane].map_or(last, |before| extrapolated(&last, &before));
            Some(EquilibriumProblem { base_angle: last.base_angle, force_direction, guess })
        });
        let found = chain.solve_each::<SIDE_BY_SIDE>(problems);
        column.extend(last.iter().zip(found).map(|(last, found)| found.filter(|found| is_next(last.as_ref(), found))));
    }
    column
}

/// True if an equilibrium can be the continuation of the last one after a small rotation of the force.
fn is_next(last: Option<&Equilibrium>, found: &Equilibrium) -> bool {
    last.is_some_and(|last| {
        let is_near =
            (found.tip_angle - last.tip_angle).abs() < 0.2 && found.force > 0.0 && found.force < 1.5 * last.force;
        is_near && last.base_angle > 0.0
    })
}

/// Linear extrapolation from two solutions.
fn extrapolated(last: &Equilibrium, before: &Equilibrium) -> Equilibrium {
    Equilibrium { tip_angle: 2.0 * last.tip_angle - before.tip_angle, force: 2.0 * last.force - before.force, ..*last }
}

/// Cubic interpolation on one axis: the first of four knots, their weights, and the weights of the slope per step.
struct Stencil {
    first: usize,
    weights: [f64; 4],
    slopes: [f64; 4],
}

impl Stencil {
    /// Creates the interpolation at the position `along` between the knots 0 to `last`. `None` outside.
    fn new(along: f64, last: usize) -> Option<Self> {
        if !(along >= 0.0 && along <= last as f64) {
            return None;
        }
        #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "between 0 and the last knot")]
        let first = (along as usize).saturating_sub(1).min(last - 3);
        let u = along - first as f64;
        let [a, b, c] = [u - 1.0, u - 2.0, u - 3.0];
        Some(Self {
            first,
            weights: [-a * b * c / 6.0, u * b * c / 2.0, -u * a * c / 2.0, u * a * b / 6.0],
            slopes: [
                -(a * b + a * c + b * c) / 6.0,
                (u * b + u * c + b * c) / 2.0,
                -(u * a + u * c + a * c) / 2.0,
                (u * a + u * b + a * b) / 6.0,
            ],
        })
    }
}
