//! The samples of a tick as JSON, exact to the last bit.

use serde::{Deserialize, Serialize};
use vibrissa_runtime::geometry::{Point2, Pose};
use vibrissa_runtime::signal::{MAX_WHISKERS, Reading, Sample, TrueTip};

/// The samples of a tick.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct SamplesMessage {
    /// The samples, oldest first.
    samples: Vec<SampleMessage>,
}

/// One sample. `null` is a number that is not finite.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct SampleMessage {
    time_s: Option<f64>,
    /// Position of the platform's centre of mass (m) and its heading (rad).
    body: [Option<f64>; 3],
    /// Base angles in the order of the rig.
    base_angles_rad: Vec<Option<f64>>,
    /// Shear and axial force of each whisker, if the rig measures them.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    forces_n: Vec<[Option<f64>; 2]>,
    /// Position of the true tip (m) and 1 if it touches, for a policy that uses true tips.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    true_tips: Vec<[Option<f64>; 3]>,
}

impl SamplesMessage {
    /// The message of the samples of a rig with this number of whiskers.
    pub(super) fn new(samples: &[Sample], whiskers: usize) -> Self {
        Self { samples: samples.iter().map(|sample| SampleMessage::new(sample, whiskers)).collect() }
    }

    /// The samples. `None` if a list has another length than the rig has whiskers.
    pub(super) fn samples(&self, whiskers: usize) -> Option<Vec<Sample>> {
        self.samples.iter().map(|sample| sample.sample(whiskers)).collect()
    }
}

impl SampleMessage {
    fn new(sample: &Sample, whiskers: usize) -> Self {
        let readings = sample.whiskers.get(..whiskers).unwrap_or(&sample.whiskers);
        let forces = readings.iter().map(|reading| Some([finite(reading.shear?), finite(reading.axial?)]));
        let tips = readings.iter().map(|reading| {
            let tip = reading.true_tip?;
            Some([finite(tip.point_world.x), finite(tip.point_world.y), Some(f64::from(u8::from(tip.touches)))])
        });
        Self {
            time_s: finite(sample.time),
            body: [sample.body.position.x, sample.body.position.y, sample.body.heading].map(finite),
            base_angles_rad: readings.iter().map(|reading| finite(reading.base_angle)).collect(),
            forces_n: forces.collect::<Option<_>>().unwrap_or_default(),
            true_tips: tips.collect::<Option<_>>().unwrap_or_default(),
        }
    }

    fn sample(&self, whiskers: usize) -> Option<Sample> {
        let is_short = |length: usize| length != 0 && length != whiskers;
        if self.base_angles_rad.len() != whiskers || is_short(self.forces_n.len()) || is_short(self.true_tips.len()) {
            return None;
        }
        let [x, y, heading] = self.body.map(number);
        let mut readings = [Reading::default(); MAX_WHISKERS];
        for (whisker, reading) in readings.iter_mut().take(whiskers).enumerate() {
            let forces = self.forces_n.get(whisker).map(|forces| forces.map(number));
            *reading = Reading {
                base_angle: number(*self.base_angles_rad.get(whisker)?),
                shear: forces.map(|[shear, _]| shear),
                axial: forces.map(|[_, axial]| axial),
                true_tip: self.true_tips.get(whisker).map(|tip| {
                    let [x, y, touches] = tip.map(number);
                    TrueTip { point_world: Point2::new(x, y), touches: touches > 0.0 }
                }),
            };
        }
        let body = Pose { position: Point2::new(x, y), heading };
        Some(Sample { time: number(self.time_s), body, whiskers: readings })
    }
}

fn finite(number: f64) -> Option<f64> {
    number.is_finite().then_some(number)
}

fn number(finite: Option<f64>) -> f64 {
    finite.unwrap_or(f64::NAN)
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "a test may panic")]
    use super::*;
    use proptest::prelude::*;

    fn samples(forces: bool, true_tips: bool) -> impl Strategy<Value = Vec<Sample>> {
        let number = || prop::num::f64::NORMAL | prop::num::f64::SUBNORMAL | prop::num::f64::ZERO;
        let sample = prop::collection::vec(number(), 24).prop_map(move |numbers| {
            let mut numbers = numbers.into_iter();
            let mut next = || numbers.next().unwrap();
            let mut whiskers = [Reading::default(); MAX_WHISKERS];
            for reading in &mut whiskers[..3] {
                reading.base_angle = next();
                reading.shear = forces.then(&mut next);
                reading.axial = forces.then(&mut next);
                reading.true_tip =
                    true_tips.then(|| TrueTip { point_world: Point2::new(next(), next()), touches: next() > 0.0 });
            }
            Sample { time: next(), body: Pose { position: Point2::new(next(), next()), heading: next() }, whiskers }
        });
        prop::collection::vec(sample, 0..4)
    }

    proptest! {
        #[test]
        fn samples_are_read_as_they_were_written(
            samples in (any::<bool>(), any::<bool>()).prop_flat_map(|(forces, tips)| samples(forces, tips)),
        ) {
            let text = serde_json::to_string(&SamplesMessage::new(&samples, 3)).unwrap();
            let read: SamplesMessage = serde_json::from_str(&text).unwrap();
            prop_assert_eq!(read.samples(3).unwrap(), samples);
            prop_assert!(read.samples.is_empty() || read.samples(2).is_none());
        }
    }

    #[test]
    fn a_number_that_is_not_finite_is_null_and_read_as_no_number() {
        let sample = Sample { time: 1.0, body: Pose::UNKNOWN, whiskers: [Reading::default(); MAX_WHISKERS] };
        let text = serde_json::to_string(&SamplesMessage::new(&[sample], 1)).unwrap();
        assert_eq!(text, r#"{"samples":[{"time_s":1.0,"body":[null,null,null],"base_angles_rad":[0.0]}]}"#);
        let read: SamplesMessage = serde_json::from_str(&text).unwrap();
        assert!(read.samples(1).unwrap()[0].body.heading.is_nan());
    }
}
