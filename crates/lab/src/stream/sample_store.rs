//! All samples of a run, in little memory.

use vibrissa_runtime::geometry::{Point2, Pose};
use vibrissa_runtime::signal::{MAX_WHISKERS, Reading, Sample, TrueTip};

/// Bits of a reading that say which optional values it has.
const SHEAR: u8 = 1;
const AXIAL: u8 = 2;
const TRUE_TIP: u8 = 4;
const TOUCHES: u8 = 8;

/// The samples of a run, tick by tick. A [`Sample`] has the size of the largest rig, and this has only what the rig measures.
#[derive(Debug, Default)]
pub struct SampleStore {
    /// Number of whiskers of the rig.
    whiskers: usize,
    /// Time, position and heading of each sample, then the values of its readings.
    values: Vec<f64>,
    /// For each reading, the values that it has.
    contents: Vec<u8>,
    /// For each tick, the end of its part of `values` and of `contents`.
    ends: Vec<(usize, usize)>,
}

impl SampleStore {
    /// An empty store for a rig with this number of whiskers.
    #[must_use]
    pub fn new(whiskers: usize) -> Self {
        Self { whiskers: whiskers.min(MAX_WHISKERS), ..Self::default() }
    }

    /// Adds the samples of the next tick.
    pub fn push(&mut self, samples: &[Sample]) {
        for sample in samples {
            self.values.extend([sample.time, sample.body.position.x, sample.body.position.y, sample.body.heading]);
            for reading in sample.whiskers.iter().take(self.whiskers) {
                let Reading { base_angle, shear, axial, true_tip } = *reading;
                let mut content = 0;
                self.values.push(base_angle);
                for (value, bit) in [(shear, SHEAR), (axial, AXIAL)] {
                    self.values.extend(value);
                    content |= if value.is_some() { bit } else { 0 };
                }
                if let Some(TrueTip { point_world, touches }) = true_tip {
                    self.values.extend([point_world.x, point_world.y]);
                    content |= TRUE_TIP | if touches { TOUCHES } else { 0 };
                }
                self.contents.push(content);
            }
        }
        self.ends.push((self.values.len(), self.contents.len()));
    }

    /// The number of ticks.
    #[must_use]
    pub fn ticks(&self) -> usize {
        self.ends.len()
    }

    /// The samples of a tick, with the bits that they had. None for a tick that the store does not have.
    #[must_use]
    pub fn get(&self, tick: usize) -> Vec<Sample> {
        let Some(&end) = self.ends.get(tick) else { return Vec::new() };
        let start = tick.checked_sub(1).and_then(|before| self.ends.get(before)).copied().unwrap_or_default();
        let mut values = self.values.get(start.0..end.0).unwrap_or_default().iter().copied();
        let mut contents = self.contents.get(start.1..end.1).unwrap_or_default().iter().copied();
        let mut samples = Vec::new();
        while let Some(time) = values.next() {
            let mut next = || values.next().unwrap_or(f64::NAN);
            let body = Pose { position: Point2::new(next(), next()), heading: next() };
            let mut whiskers = [Reading::default(); MAX_WHISKERS];
            for reading in whiskers.iter_mut().take(self.whiskers) {
                let content = contents.next().unwrap_or(0);
                reading.base_angle = next();
                reading.shear = (content & SHEAR != 0).then(&mut next);
                reading.axial = (content & AXIAL != 0).then(&mut next);
                reading.true_tip = (content & TRUE_TIP != 0)
                    .then(|| TrueTip { point_world: Point2::new(next(), next()), touches: content & TOUCHES != 0 });
            }
            samples.push(Sample { time, body, whiskers });
        }
        samples
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn reading() -> impl Strategy<Value = Reading> {
        let number = || -1e3..1e3_f64;
        let tip = (number(), number(), any::<bool>());
        (number(), prop::option::of(number()), prop::option::of(number()), prop::option::of(tip)).prop_map(
            |(base_angle, shear, axial, tip)| Reading {
                base_angle,
                shear,
                axial,
                true_tip: tip.map(|(x, y, touches)| TrueTip { point_world: Point2::new(x, y), touches }),
            },
        )
    }

    proptest! {
        #[test]
        fn samples_are_kept_as_they_are(
            ticks in prop::collection::vec(prop::collection::vec((0.0..9.0, [reading(), reading(), reading()]), 0..4), 0..5),
        ) {
            let mut store = SampleStore::new(3);
            let ticks: Vec<Vec<Sample>> = ticks.into_iter().map(|samples| samples.into_iter().map(|(time, readings)| {
                let mut whiskers = [Reading::default(); MAX_WHISKERS];
                whiskers[..3].copy_from_slice(&readings);
                let body = Pose { position: Point2::new(time, -time), heading: 2.0 * time };
                Sample { time, body, whiskers }
            }).collect()).collect();
            for samples in &ticks {
                store.push(samples);
            }
            prop_assert_eq!(store.ticks(), ticks.len());
            for (tick, samples) in ticks.iter().enumerate() {
                prop_assert_eq!(&store.get(tick), samples);
            }
            prop_assert!(store.get(ticks.len()).is_empty());
        }
    }
}
