//! The first mode of a whisker from its readings on a platform that shakes it in the air.

use std::f64::consts::TAU;

use nalgebra::{DMatrix, DVector};
use vibrissa_runtime::math;
use vibrissa_runtime::percept::sway_by_acceleration;
use vibrissa_runtime::rig::{Vibration, Whisker};

/// One sample of a whisker in the air.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Shaken {
    /// Time (s).
    pub(super) time: f64,
    /// Displacement of the platform to the left of the straight shaft (m).
    pub(super) displacement: f64,
    /// Reading (rad).
    pub(super) reading: f64,
}

/// Least number of standard deviations by which the readings follow the displacement.
const CERTAIN: f64 = 10.0;

/// The frequency of the first mode (Hz) without damping. The platform moves as a sine with a frequency (Hz) that is far below it.
///
/// The shaft then follows its base, and the moment that accelerates it bends the hinge. For a shape, this moment is proportional to the
/// mass, and the mass to the inverse square of the first mode. Damping hardly changes the moment, so the whisker may creep. `None` if the
/// readings do not follow the platform.
pub(super) fn first_mode(whisker: &Whisker, frequency: f64, shaken: &[Shaken]) -> Option<f64> {
    let count = shaken.len();
    let first = shaken.first()?;
    // An offset and a whisker that still creeps back change the readings too.
    let columns = DMatrix::from_fn(count, 3, |row, column| match column {
        0 => 1.0,
        1 => shaken[row].time - first.time,
        _ => shaken[row].displacement - first.displacement,
    });
    let readings = DVector::from_iterator(count, shaken.iter().map(|sample| sample.reading));
    let inverse = (columns.transpose() * &columns).try_inverse()?;
    let solved = &inverse * columns.transpose() * &readings;
    let free = count.checked_sub(4)?;
    let variance = (readings - columns * &solved).norm_squared() / free as f64;
    let (slope, deviation) = (solved[2], (variance * inverse[(2, 2)]).sqrt());
    let sway = slope / math::square(TAU * frequency);
    (slope > CERTAIN * deviation)
        .then(|| Vibration::of(whisker).frequency / TAU * (sway_by_acceleration(whisker) / sway).sqrt())
        .filter(|first_mode| first_mode.is_finite())
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;
    use vibrissa_runtime::rig::Rig;

    use super::*;

    /// Readings of a whisker with this first mode (Hz) and damping (s) during two periods of 1 Hz. A mass on a damped spring moves in
    /// steps of a tenth of a millisecond, and the reading is its moment.
    fn shaken(whisker: &Whisker, first_mode: f64, damping: f64, noise: f64) -> Vec<Shaken> {
        let mut slower = whisker.clone();
        slower.first_mode = Some(first_mode);
        let (sway, stiffness) = (sway_by_acceleration(&slower), math::square(TAU * first_mode));
        let (step, mut bent, mut speed) = (1e-4, 0.0, 0.0);
        let mut samples = Vec::new();
        for index in 0..20_000_u32 {
            let time = f64::from(index) * step;
            let acceleration = 0.1 * TAU * math::cos(TAU * time);
            let force = stiffness * (bent + damping * speed);
            speed += (-acceleration - force) * step;
            bent += speed * step;
            if index % 33 == 0 {
                let scatter = noise * math::sin(f64::from(index) * 2.4);
                let displacement = 0.1 / TAU * (1.0 - math::cos(TAU * time));
                samples.push(Shaken { time, displacement, reading: sway * force + scatter + 1e-6 });
            }
        }
        samples
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(40))]

        #[test]
        fn the_first_mode_of_a_whisker_that_creeps_is_found(first_mode in 4.0..12.0_f64, damping in 0.1..0.6_f64) {
            let rig = Rig::default();
            let found = super::first_mode(&rig.whiskers[0], 1.0, &shaken(&rig.whiskers[0], first_mode, damping, 3e-7));
            prop_assert!(found.is_some_and(|found| (found / first_mode - 1.0).abs() < 0.1), "{found:?} and {first_mode}");
        }

        #[test]
        fn noise_is_no_first_mode(noise in 1e-8..1e-6_f64) {
            let rig = Rig::default();
            let mut still = shaken(&rig.whiskers[0], 10.0, 0.1, 0.0);
            for (index, sample) in still.iter_mut().enumerate() {
                sample.reading = noise * math::sin(index as f64 * 2.4);
            }
            prop_assert_eq!(super::first_mode(&rig.whiskers[0], 1.0, &still), None);
        }
    }
}
