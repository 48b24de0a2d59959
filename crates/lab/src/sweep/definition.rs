//! Definitions of sweeps in YAML.
//!
//! A sweep has scenes, policies, and axes that vary both. Its runs are all combinations. The list of runs and the key
//! of each run depend only on the text of the sweep.

use super::axis::Axis;
use super::read;
use super::run::SweepRun;
use super::scenes::SweepScenes;
use vibrissa_text::diagnostic::{Diagnostic, Source};
use vibrissa_world::scene::FileReference;

/// A sweep that has been read and checked. The files that it names have not been read.
#[derive(Debug, Clone)]
pub struct Sweep {
    /// Its name, a valid file name.
    pub name: String,
    /// The policies.
    pub policies: Vec<FileReference>,
    /// The sources of the scenes.
    pub scenes: Vec<SweepScenes>,
    pub(super) axes: Vec<Axis>,
}

impl Sweep {
    /// Reads a sweep.
    ///
    /// # Errors
    /// Everything that is wrong with it, as [`scenario::read`](vibrissa_world::scenario::read) tells it.
    ///
    /// ```
    /// use vibrissa_text::diagnostic::Source;
    /// use vibrissa_lab::sweep::Sweep;
    /// let text = "
    /// name: corners
    /// policies: [vibrissa.fsm, thesis.fsm]
    /// scenes: [{family: convex-corner, trials: 100}]
    /// vary: {policy: {speed: [2 cm/s, 5 cm/s]}}
    /// ";
    /// let sweep = Sweep::from_yaml(&Source::new("corners.yaml", text)).unwrap();
    /// assert_eq!(sweep.runs().count(), 400);
    /// assert_eq!(sweep.runs().last().unwrap().key(), "family=convex-corner, trial=99, speed=5 cm/s, policy=thesis");
    /// ```
    pub fn from_yaml(source: &Source) -> Result<Self, Vec<Diagnostic>> {
        read::read(source)
    }

    /// Number of runs. `None` on overflow.
    pub(super) fn count(&self) -> Option<u64> {
        let trials = self.scenes.iter().try_fold(0_u64, |sum, scenes| sum.checked_add(scenes.trials))?;
        let lengths = self.axes.iter().map(Axis::len).chain([self.policies.len()]);
        lengths.map(|length| length as u64).try_fold(trials, u64::checked_mul)
    }

    /// All runs in order: by scenes, trials, axes and policies.
    pub fn runs(&self) -> impl Iterator<Item = SweepRun<'_>> {
        (0..self.count().unwrap_or(0)).filter_map(|index| self.run(index))
    }

    /// The run with this index.
    #[must_use]
    pub fn run(&self, index: u64) -> Option<SweepRun<'_>> {
        SweepRun::new(self, index)
    }

    /// One run of every kind: the first trial of all scenes under every policy, with every value of an axis once.
    pub fn samples(&self) -> impl Iterator<Item = SweepRun<'_>> {
        let starts = self.scenes.iter().scan(0, |next, scenes| Some(std::mem::replace(next, *next + scenes.trials)));
        starts.flat_map(move |trial| self.variants().flat_map(move |variant| self.of(trial, variant)))
    }

    /// Number of combinations of the axes.
    pub(super) fn variant_count(&self) -> u64 {
        self.axes.iter().map(|axis| axis.len() as u64).product()
    }

    /// The combinations in which at most one axis has another value than its first.
    fn variants(&self) -> impl Iterator<Item = u64> {
        let stride = |axis: usize| self.axes[axis + 1..].iter().map(|axis| axis.len() as u64).product::<u64>();
        let others = self.axes.iter().enumerate();
        let others =
            others.flat_map(move |(index, axis)| (1..axis.len() as u64).map(move |value| value * stride(index)));
        std::iter::once(0).chain(others)
    }

    /// The runs of a trial with one combination of the axes. Trials are numbered through all scenes.
    fn of(&self, trial: u64, variant: u64) -> impl Iterator<Item = SweepRun<'_>> {
        let policies = self.policies.len() as u64;
        let first = (trial * self.variant_count() + variant) * policies;
        (first..first + policies).filter_map(|index| self.run(index))
    }
}
