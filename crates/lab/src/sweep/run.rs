//! One run of a sweep.

use std::fmt::Write;

use super::axis::{Axis, AxisValues};
use super::shard::run_name;
use super::{Sweep, SweepScenes};
use super::{family_axis, read};
use vibrissa_runtime::machine::ParameterValue;
use vibrissa_text::diagnostic::{Diagnostic, Source, Span};
use vibrissa_world::scenario;
use vibrissa_world::scenario::Files;
use vibrissa_world::scene::{FileReference, Scene};

/// One run of a sweep: a trial, under one policy, with one value of every axis.
#[derive(Debug, Clone, Copy)]
pub struct SweepRun<'s> {
    sweep: &'s Sweep,
    /// Its index in the list of all runs, from 0.
    pub index: u64,
    /// The index of its scenes among the sweep's.
    pub scenes: usize,
    /// The number of its trial among those of its scenes.
    pub trial: u64,
    /// Index of the combination of axis values. The last axis varies fastest.
    variant: u64,
    /// The index of its policy among the sweep's.
    pub policy: usize,
}

impl<'s> SweepRun<'s> {
    /// The run with this index.
    pub(super) fn new(sweep: &'s Sweep, index: u64) -> Option<Self> {
        let (policies, variants) = (sweep.policies.len() as u64, sweep.variant_count());
        let policy = usize::try_from(index.checked_rem(policies)?).ok()?;
        let variant = (index / policies).checked_rem(variants)?;
        let mut trial = index / policies / variants;
        for (scenes, SweepScenes { trials, .. }) in sweep.scenes.iter().enumerate() {
            if trial < *trials {
                return Some(Self { sweep, index, scenes, trial, variant, policy });
            }
            trial -= trials;
        }
        None
    }

    /// Its scenes.
    #[must_use]
    pub fn scenes(&self) -> &'s SweepScenes {
        &self.sweep.scenes[self.scenes]
    }

    /// Its policy.
    #[must_use]
    pub fn policy(&self) -> &'s FileReference {
        &self.sweep.policies[self.policy]
    }

    /// The group of the run. It is equal for trials with the same scenes, settings and policy. Groups are in the order
    /// of the sweep.
    #[must_use]
    pub fn group(&self) -> (usize, u64, usize) {
        (self.scenes, self.variant, self.policy)
    }

    /// The text that identifies the run within the sweep.
    #[must_use]
    pub fn key(&self) -> String {
        let scenes = self.scenes();
        let mut key = format!("{}={}", scenes.kind_word(), scenario::quoted(scenes.name()));
        // Writing to a string cannot fail.
        if let Some(seed) = scenes.seed {
            let _ = write!(key, ", seed={seed}");
        }
        let _ = write!(key, ", trial={}", self.trial);
        for (name, value) in self.settings() {
            let _ = write!(key, ", {name}={value}");
        }
        key + ", policy=" + &scenario::quoted(&self.policy().name)
    }

    /// The hash of its key, in hexadecimal digits.
    #[must_use]
    pub fn hash(&self) -> String {
        run_name(&self.key())
    }

    /// The axes with the values of this run as written in the sweep.
    pub fn settings(&self) -> impl Iterator<Item = (&'s str, String)> {
        self.choices().map(|(axis, value)| (axis.name.as_str(), axis.values.text(value)))
    }

    /// The parameters of its policy that are set, with their spans in the sweep.
    pub fn parameters(&self) -> impl Iterator<Item = (&'s str, &'s ParameterValue, Span)> {
        self.choices().filter_map(|(axis, value)| match &axis.values {
            AxisValues::Parameter(values) => Some((axis.name.as_str(), &values[value].value, values[value].span)),
            AxisValues::Scenario(_) | AxisValues::Family(..) => None,
        })
    }

    /// The parameters of its family that are set (SI), with their spans in the sweep.
    pub(super) fn family_values(&self) -> impl Iterator<Item = (&'static str, f64, Span)> {
        self.choices().filter_map(|(axis, value)| match &axis.values {
            AxisValues::Family(name, values) => Some((*name, values[value].value.value_si, values[value].span)),
            AxisValues::Scenario(_) | AxisValues::Parameter(_) => None,
        })
    }

    /// The error of a family that has no scene with the run's values, at a span in the sweep.
    pub(super) fn no_scene(&self, span: Span, reason: &str) -> Diagnostic {
        family_axis::no_scene(self.scenes().name(), span, reason)
    }

    /// The error of a policy that cannot be run as the run requires. Its span is that of the parameter, or else of the
    /// policy.
    #[must_use]
    pub fn unfit(&self, parameter: Option<Span>, reason: &str) -> Diagnostic {
        read::unfit(parameter.unwrap_or(self.policy().span), reason)
    }

    /// Reads its scene: the `scenario` with the changes of the run.
    ///
    /// # Errors
    /// As [`scenario::read`], with the text that the spans refer to: the scenario, or the `sweep`.
    pub fn scene(
        &self,
        scenario: &Source,
        sweep: &Source,
        files: &mut Files<'_>,
    ) -> Result<Scene, (Box<Source>, Vec<Diagnostic>)> {
        let changes = self.choices().filter_map(|(axis, value)| match &axis.values {
            AxisValues::Scenario(changes) => Some(&changes[value]),
            AxisValues::Parameter(_) | AxisValues::Family(..) => None,
        });
        scenario::read_changed(scenario, sweep, &changes.collect::<Vec<_>>(), files)
    }

    /// The axes with the index of the value of each.
    fn choices(&self) -> impl Iterator<Item = (&'s Axis, usize)> {
        let mut left = self.variant;
        let choice = |axis: &'s Axis| {
            let length = axis.len() as u64;
            let value = usize::try_from(left % length).unwrap_or(0);
            left /= length;
            (axis, value)
        };
        let mut choices: Vec<_> = self.sweep.axes.iter().rev().map(choice).collect();
        choices.reverse();
        choices.into_iter()
    }
}
