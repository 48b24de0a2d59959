//! A mismatch.

use std::collections::BTreeMap;

use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::SeedableRng;

use super::array::{PoseErrors, SensorErrors, TrueArray};
use super::ranges::{Values, changes};
use super::whisker::true_whisker;
use super::{Loss, Property, Ranges};
use crate::physics::light_shaft;
use vibrissa_runtime::rig::{Rig, Whisker};
use vibrissa_runtime::signal::MAX_WHISKERS;
use vibrissa_runtime::units::format_si;

/// The differences between the true array and the assumed one, as ranges.
///
/// ```
/// use vibrissa_world::mismatch::{Mismatch, Property};
/// use vibrissa_runtime::rig::Rig;
/// let assumed = Rig::default();
/// let mut mismatch = Mismatch::default();
/// mismatch.common.set(Property::Length, 0.5e-3);
/// let array = mismatch.array(&assumed);
/// assert!((array.rig.whiskers[0].shaft.length - 100.5e-3).abs() < 1e-12);
/// ```
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Mismatch {
    /// The ranges of all whiskers, and those of sensors, poses, commands, platform and objects.
    pub common: Ranges,
    /// Ranges of single whiskers by name. They replace those of all whiskers.
    pub whiskers: BTreeMap<String, Ranges>,
    /// The consequence of a lost reading, if it is given.
    pub loss: Option<Loss>,
    /// The seed of the values, if it is given. Otherwise it is 0.
    pub seed: Option<u64>,
    /// Path of the file with the mismatch, for results.
    pub file: Option<String>,
}

/// A mismatch that does not fit to a rig.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum MismatchError {
    /// A whisker is not part of the rig.
    #[error("the rig has no whisker `{name}`; it has {known}")]
    UnknownWhisker {
        /// The name in the mismatch.
        name: String,
        /// The whiskers of the rig.
        known: String,
    },
    /// A value of a whisker could be out of the range of its key.
    #[error(
        "the true `{key}` of whisker `{name}` could be {value}, and must be {range}; narrow the range of `{key}` in the mismatch"
    )]
    Beyond {
        /// The whisker.
        name: String,
        /// The key of the rig.
        key: &'static str,
        /// The value with its unit.
        value: String,
        /// The range of the key.
        range: String,
    },
    /// A whisker could be too light for a simulation.
    #[error(
        "the links of the true whisker `{name}` could be too light to be simulated by MuJoCo; use fewer `links`, or a greater `radius`, \
         or write `world: quasistatic`, a simulator without inertia"
    )]
    Light {
        /// The whisker.
        name: String,
    },
}

impl Mismatch {
    /// The true array for an `assumed` rig. The same ranges and the same seed give the same array.
    #[must_use]
    pub fn array(&self, assumed: &Rig) -> TrueArray {
        let random = |stream: usize| {
            let mut random = ChaCha8Rng::seed_from_u64(self.seed.unwrap_or(0));
            random.set_stream(stream as u64);
            random
        };
        let whisker = |(index, whisker): (usize, &Whisker)| {
            let values = self.ranges(&whisker.name).draw(&mut random(index));
            (true_whisker(whisker, &values), SensorErrors::new(&values))
        };
        let (whiskers, sensors) = assumed.whiskers.iter().enumerate().map(whisker).unzip();
        // No whisker has this stream.
        let values = self.common.draw(&mut random(MAX_WHISKERS));
        let mut platform = assumed.platform.clone();
        if let Some(servo) = values.get(Property::Servo) {
            (platform.servo, platform.yaw_servo) = (servo, None);
        }
        values.apply(&mut platform);
        TrueArray {
            rig: Rig { platform, whiskers, sensing: assumed.sensing.clone() },
            sensors,
            lost: values.or_zero(Property::Lost),
            loss: self.loss.unwrap_or_default(),
            pose: PoseErrors::new(&values),
            command_latency: values.or_zero(Property::CommandLatency),
            friction: values.get(Property::Friction),
            values,
        }
    }

    /// True if the array depends on the seed.
    #[must_use]
    pub fn is_drawn(&self) -> bool {
        self.common.are_drawn() || self.whiskers.values().any(Ranges::are_drawn)
    }

    /// Adds the ranges and settings of `other` as far as they are not given here.
    pub fn complete(&mut self, other: &Self) {
        self.common.complete(&other.common);
        for (name, ranges) in &other.whiskers {
            self.whiskers.entry(name.clone()).or_default().complete(ranges);
        }
        self.loss = self.loss.or(other.loss);
        self.seed = self.seed.or(other.seed);
        self.file = self.file.take().or_else(|| other.file.clone());
    }

    /// Checks that every array that can be drawn for an `assumed` rig can be simulated by MuJoCo.
    ///
    /// # Errors
    /// [`MismatchError`] if it cannot.
    pub fn check(&self, assumed: &Rig) -> Result<(), MismatchError> {
        self.check_without_inertia(assumed)?;
        assumed.whiskers.iter().try_for_each(|whisker| self.check_inertia(whisker))
    }

    /// Checks that every array that can be drawn for an `assumed` rig can be simulated without inertia.
    ///
    /// # Errors
    /// [`MismatchError`] if it cannot.
    pub fn check_without_inertia(&self, assumed: &Rig) -> Result<(), MismatchError> {
        let is_known = |name: &String| assumed.whiskers.iter().any(|whisker| whisker.name == *name);
        if let Some(name) = self.whiskers.keys().find(|name| !is_known(name)) {
            let known: Vec<_> = assumed.whiskers.iter().map(|whisker| format!("`{}`", whisker.name)).collect();
            return Err(MismatchError::UnknownWhisker { name: name.clone(), known: known.join(", ") });
        }
        assumed.whiskers.iter().try_for_each(|whisker| self.check_keys(whisker))
    }

    /// Checks that every value that can be drawn is in the range of its key.
    fn check_keys(&self, assumed: &Whisker) -> Result<(), MismatchError> {
        for is_least in [true, false] {
            let mut whisker = assumed.clone();
            let values = self.ranges(&assumed.name).extreme(|_| is_least);
            values.apply(&mut whisker);
            for (key, _, property) in changes() {
                let Some(value) = values.get(property).and_then(|_| key.number(&mut whisker)) else { continue };
                if !key.key().contains(value) {
                    return Err(MismatchError::Beyond {
                        name: assumed.name.clone(),
                        key: key.name(),
                        value: format_si(value, key.dimension),
                        range: key.key().range_text(),
                    });
                }
            }
        }
        Ok(())
    }

    fn check_inertia(&self, assumed: &Whisker) -> Result<(), MismatchError> {
        let shaft = true_whisker(assumed, &self.smallest(assumed)).vibrating().shaft;
        match light_shaft(&shaft) {
            Some(_) => Err(MismatchError::Light { name: assumed.name.clone() }),
            None => Ok(()),
        }
    }

    /// The values with the lightest links: those of the shortest and thinnest shaft with the most links and the highest
    /// first mode.
    fn smallest(&self, assumed: &Whisker) -> Values {
        let greatest = [Property::Links, Property::Rig("whiskers.*.first_mode")];
        self.ranges(&assumed.name).extreme(|property| !greatest.contains(&property))
    }

    /// The ranges of a whisker.
    fn ranges(&self, name: &str) -> Ranges {
        let mut ranges = self.whiskers.get(name).cloned().unwrap_or_default();
        ranges.complete(&self.common);
        ranges
    }
}
