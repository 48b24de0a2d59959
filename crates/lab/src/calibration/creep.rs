//! The damping of a whisker from its readings while it is pressed to and fro.

use nalgebra::{DMatrix, DVector};
use vibrissa_runtime::math;

/// One sample of a whisker that is pressed against an object.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Pressed {
    /// Duration since the last one (s).
    pub period: f64,
    /// Displacement of the base along its line (m).
    pub displacement: f64,
    /// Displacement to the left of that line (m). A compliant platform yields to the whisker.
    pub aside: f64,
    /// Rotation (rad).
    pub turn: f64,
    /// Mean reading (rad).
    pub reading: f64,
}

/// Damping (s) of the grid: the first, the last, and the ratio of neighbours.
const GRID: (f64, f64, f64) = (2e-3, 4.0, 1.1);
/// Degree of the polynomial by which the base angle at rest depends on the displacement.
const DEGREE: usize = 3;
/// Least number of samples, and the least share of what is not explained without damping that the damping explains.
const LEAST: usize = 20;
/// Number of samples before and after one that show its speed, in spite of noise.
const AROUND: usize = 10;
const LEAST_EXPLAINED: f64 = 0.5;

/// The damping (s) of the material relative to its stiffness, from ticks that begin at rest.
///
/// The reading of a shaft with the damping `T` is `a + T a'`, with the base angle `a` that the same shape has at rest, and `a` is a function
/// of the displacement. Friction has one sign while the whisker is pressed and the other one while it is released. `None` if no damping
/// explains the readings better.
#[must_use]
pub fn damping(pressed: &[Pressed]) -> Option<f64> {
    if pressed.len() < LEAST {
        return None;
    }
    let (first, last, ratio) = GRID;
    let without = misfit(pressed, 0.0)?;
    let grid =
        std::iter::successors(Some(first), |damping| Some(damping * ratio)).take_while(|damping| *damping < last);
    let rated = grid.filter_map(|damping| Some((misfit(pressed, damping)?, damping)));
    let (least, best) = rated.min_by(|a, b| a.0.total_cmp(&b.0))?;
    (least < (1.0 - LEAST_EXPLAINED) * without).then_some(best)
}

/// Share of the variance of the readings that this damping (s) and a function of the displacement do not explain.
fn misfit(pressed: &[Pressed], damping: f64) -> Option<f64> {
    let first = pressed.first()?;
    let furthest = pressed.iter().map(|tick| (tick.displacement - first.displacement).abs()).fold(0.0, f64::max);
    if furthest == 0.0 {
        return None;
    }
    let readings = DVector::from_iterator(pressed.len(), pressed.iter().map(|tick| tick.reading));
    let columns = DMatrix::from_fn(pressed.len(), DEGREE + 4, |row, column| {
        let (tick, speed) = (&pressed[row], speed(pressed, row));
        let along = (tick.displacement - first.displacement) / furthest;
        let power = |exponent: usize| math::powi(along, i32::try_from(exponent).unwrap_or(0));
        match column.checked_sub(DEGREE + 1) {
            None if column == 0 => 1.0,
            // A term of the base angle at rest, and `T` times its growth.
            None => power(column) + damping * column as f64 * power(column - 1) * speed / furthest,
            Some(0) => speed.signum(),
            Some(1) => tick.aside / furthest,
            Some(_) => tick.turn,
        }
    });
    let solved = columns.clone().svd(true, true).solve(&readings, 1e-12).ok()?;
    let variation = readings.add_scalar(-readings.mean()).norm_squared();
    let share = (readings - columns * solved).norm_squared() / variation;
    share.is_finite().then_some(share)
}

/// Speed (m/s) along the line, by samples on both sides, because a single difference is mostly noise.
fn speed(pressed: &[Pressed], index: usize) -> f64 {
    let (before, after) = (index.saturating_sub(AROUND), (index + AROUND).min(pressed.len() - 1));
    let time: f64 = pressed[before + 1..=after].iter().map(|tick| tick.period).sum();
    (pressed[after].displacement - pressed[before].displacement) / time
}

#[cfg(test)]
mod tests {
    use std::f64::consts::TAU;

    use proptest::prelude::*;

    use super::*;

    /// Duration (s) of a sample. A shorter difference of the damping is not seen.
    const SAMPLE: f64 = 1.0 / 300.0;

    /// Readings of a whisker that is pressed to and fro for two seconds. It is stiffer the more it is bent, and friction holds
    /// it.
    fn swing(damping: f64, friction: f64, noise: f64) -> Vec<Pressed> {
        let base_angle = |displacement: f64| 1.2e-4 - 0.02 * displacement + 0.4 * displacement * displacement;
        let period = SAMPLE;
        (0..600_u32)
            .map(|index| {
                let time = f64::from(index) * period;
                let displacement = |time: f64| 2e-3 * (1.0 - math::cos(TAU * time));
                let step = 1e-5;
                let growth =
                    (base_angle(displacement(time + step)) - base_angle(displacement(time - step))) / (2.0 * step);
                let held = friction * (displacement(time + step) - displacement(time - step)).signum();
                let scatter = noise * math::sin(f64::from(index) * 2.4);
                let reading = base_angle(displacement(time)) + damping * growth + held + scatter;
                Pressed { period, displacement: displacement(time), aside: 0.0, turn: 0.0, reading }
            })
            .collect()
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(40))]

        #[test]
        fn the_damping_is_found_beside_friction(damping in 0.02..0.8_f64, friction in 0.0..4e-6_f64) {
            let found = super::damping(&swing(damping, friction, 1e-7));
            prop_assert!(found.is_some_and(|found| (found - damping).abs() < 0.15 * damping + SAMPLE), "{found:?} and {damping}");
        }

        #[test]
        fn friction_alone_is_no_damping(friction in 0.0..4e-6_f64) {
            prop_assert_eq!(super::damping(&swing(0.0, friction, 3e-7)), None);
        }
    }
}
