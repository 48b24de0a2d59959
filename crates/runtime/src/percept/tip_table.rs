//! Where a whisker's tip is, by its base angle and the direction of the contact force.

use std::array;
use std::collections::VecDeque;
use std::f64::consts::PI;
use std::sync::{Arc, Mutex, PoisonError};

use nalgebra::Vector2;

use crate::mechanics::{Equilibrium, EquilibriumProblem, ShaftChain};
use crate::rig::{Hinge, Shaft, Whisker};

/// Where a whisker's tip is, by its base angle and the direction of the force at the tip: a table of equilibria of the whisker's own
/// chain, with cubics through four of them each way in between.
///
/// Angles are in the frame of the base, for a bend that is counter-clockwise; one the other way is the mirror image. A force beyond
/// head-on (180°) still bends a whisker the same way once it is bent; for small base angles there is none such.
#[derive(Debug, Clone)]
pub struct TipTable {
    /// Step of the base angle from row to row (rad); the first row is the straight whisker.
    angle_step: f64,
    /// Places of the tip's centre (m, frame of the base), direction after direction; not a number where there is no equilibrium.
    tips_base: Vec<Vector2<f64>>,
}

/// A tip's place, and how it changes.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct TipPosition {
    /// Place of the tip's centre (m, frame of the base).
    pub tip_base: Vector2<f64>,
    /// Its change with the base angle (m/rad).
    pub by_angle: Vector2<f64>,
    /// Its change with the direction of the force (m/rad).
    pub by_direction: Vector2<f64>,
}

/// Greatest base moment, in units of `EI / L`.
const MOMENT_RANGE: f64 = 6.0;
/// Steps of the base angle.
const ANGLE_STEPS: usize = 72;
/// The first direction (rad), from where a force still drags at the tip, and the step to the next.
const FIRST_DIRECTION: f64 = 50.0 * PI / 180.0;
const DIRECTION_STEP: f64 = 2.0 * PI / 180.0;
/// Directions in the table, up to 230°.
const DIRECTIONS: usize = 91;
/// Tables that are kept, of 100 kB each.
const MOST_KEPT: usize = 16;
/// Equilibria that are solved for side by side.
const SIDE_BY_SIDE: usize = 4;
/// Directions that a straight whisker bends under from the beginning, up to 174°.
const FROM_STRAIGHT: usize = 63;

impl TipTable {
    /// The table of `whisker`.
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

    /// The table of `whisker`. Those made last are kept: whiskers that differ by their place alone have the same, and so have most
    /// runs of a process.
    #[must_use]
    pub fn shared(whisker: &Whisker) -> Arc<Self> {
        static KEPT: Mutex<VecDeque<(Shaft, Hinge, Arc<TipTable>)>> = Mutex::new(VecDeque::new());
        // A table is complete before it is kept, so that no panic leaves one that is not.
        let kept = || KEPT.lock().unwrap_or_else(PoisonError::into_inner);
        let is_same = |(shaft, hinge, _): &&(Shaft, Hinge, _)| (shaft, hinge) == (&whisker.shaft, &whisker.hinge);
        if let Some((.., table)) = kept().iter().find(is_same) {
            return Arc::clone(table);
        }
        let table = Arc::new(Self::new(whisker));
        let mut kept = kept();
        kept.truncate(MOST_KEPT - 1);
        kept.push_front((whisker.shaft.clone(), whisker.hinge.clone(), Arc::clone(&table)));
        table
    }

    /// The tip at a base angle (rad, 0 or more) under a force in a direction (rad). `None` beyond the table, and where there is no
    /// such equilibrium.
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
        // One place that is not a number makes all of them so.
        position.tip_base.x.is_finite().then_some(position)
    }

    /// The greatest base angle of the table (rad).
    #[must_use]
    pub fn range(&self) -> f64 {
        self.angle_step * ANGLE_STEPS as f64
    }
}

fn direction(index: usize) -> f64 {
    FIRST_DIRECTION + DIRECTION_STEP * index as f64
}

/// Equilibria under forces of some directions, from the straight whisker on.
fn from_straight(
    chain: &ShaftChain,
    whisker: &Whisker,
    angle_step: f64,
    directions: [f64; SIDE_BY_SIDE],
) -> [Vec<Option<Equilibrium>>; SIDE_BY_SIDE] {
    let shaft = &whisker.shaft;
    let straight = chain.straight();
    let mut columns = directions.map(|_| {
        let mut column = Vec::with_capacity(ANGLE_STEPS + 1);
        column.push(Some(straight));
        column
    });
    let mut before = [None; SIDE_BY_SIDE];
    let mut last = [Some(straight); SIDE_BY_SIDE];
    for index in 1..=ANGLE_STEPS {
        let base_angle = angle_step * index as f64;
        let sought = array::from_fn(|lane| {
            let force_direction = directions[lane];
            let guess = match (last[lane], before[lane]) {
                (Some(last), Some(before)) => extrapolated(&last, &before),
                // The first step is that of a cantilever under a small force.
                (Some(straight), None) => {
                    let force = base_angle * whisker.hinge.stiffness / (shaft.length * force_direction.sin());
                    let tip_angle =
                        force * force_direction.sin() * shaft.length.powi(2) / (2.0 * shaft.tip_stiffness());
                    Equilibrium { tip_angle, force, ..straight }
                }
                (None, _) => return None,
            };
            Some(EquilibriumProblem { base_angle, force_direction, guess })
        });
        before = last;
        last = chain.solve_each(sought);
        for (column, &solution) in columns.iter_mut().zip(&last) {
            column.push(solution);
        }
    }
    columns
}

/// Equilibria under a force that is turned by one step more, from those before it at the same base angles; none where what is found
/// belongs to another shape.
fn continued(
    chain: &ShaftChain,
    force_direction: f64,
    [last, before]: [&[Option<Equilibrium>]; 2],
) -> Vec<Option<Equilibrium>> {
    let mut column = Vec::with_capacity(last.len());
    for (last, before) in last.chunks(SIDE_BY_SIDE).zip(before.chunks(SIDE_BY_SIDE)) {
        let sought = array::from_fn(|lane| {
            let last = last.get(lane).copied().flatten()?;
            let guess = before[lane].map_or(last, |before| extrapolated(&last, &before));
            Some(EquilibriumProblem { base_angle: last.base_angle, force_direction, guess })
        });
        let found = chain.solve_each::<SIDE_BY_SIDE>(sought);
        column.extend(last.iter().zip(found).map(|(last, found)| found.filter(|found| is_next(last.as_ref(), found))));
    }
    column
}

/// Whether an equilibrium may be the one that the last becomes when the force is turned a little.
fn is_next(last: Option<&Equilibrium>, found: &Equilibrium) -> bool {
    last.is_some_and(|last| {
        let is_near =
            (found.tip_angle - last.tip_angle).abs() < 0.2 && found.force > 0.0 && found.force < 1.5 * last.force;
        is_near && last.base_angle > 0.0
    })
}

/// Straight on from two solutions.
fn extrapolated(last: &Equilibrium, before: &Equilibrium) -> Equilibrium {
    Equilibrium { tip_angle: 2.0 * last.tip_angle - before.tip_angle, force: 2.0 * last.force - before.force, ..*last }
}

/// A place between the knots of an axis: the first of four, their weights, and the weights of the slope for one step.
struct Stencil {
    first: usize,
    weights: [f64; 4],
    slopes: [f64; 4],
}

impl Stencil {
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
