//! One setting of the world or of perception.

use std::fmt;

use vibrissa_runtime::machine::ContactEstimatorKind;
use vibrissa_runtime::rig::Rig;
use vibrissa_world::physics::{Integrator, Physics, Solver};
use vibrissa_world::scene::{Scene, WorldKind};

/// One change of a setting to a scenario.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Change {
    /// The world.
    World(WorldKind),
    /// Links of every whisker.
    Links(usize),
    /// The longest step (s), for all steps. It is rounded down to an integer fraction of a sample. A step longer than a
    /// sample lengthens the samples.
    Step(f64),
    /// Contacts with a time constant of one step, the shortest that MuJoCo accepts. With integrators other than
    /// `discrete`, the shortest is two steps.
    HardContacts,
    /// No calm steps: no step is longer than those for fast whiskers.
    NoCalmSteps,
    /// Whiskers bend in the air too.
    BendInAir,
    /// Numerical integrator of MuJoCo.
    Integrator(Integrator),
    /// Contact solver of MuJoCo.
    Solver(Solver),
    /// Contact estimator of every whisker.
    ContactEstimator(ContactEstimatorKind),
}

/// A setting: a scenario with changes that are applied in order. The default has none.
#[derive(Debug, Clone, PartialEq)]
pub struct Setting(pub Vec<Change>);

/// Links of the fine run. Perception assumes as many in all settings.
pub(super) const FINE_LINKS: usize = 40;
/// The longest step (s) of the fine run.
const FINE_STEP: f64 = 0.5e-3;

const LINKS: [usize; 6] = [6, 8, 12, 16, 24, 40];
const SLOW: f64 = 1.0 / 150.0;
const USUAL: f64 = 1.0 / 300.0;
const SHORT: f64 = 1.0 / 900.0;
const SHORTER: f64 = 1.0 / 1800.0;
const STEPS: [f64; 6] = [1.0 / 90.0, SLOW, USUAL, 1.0 / 600.0, SHORT, SHORTER];
/// A step (s) at which explicit integrators are stable.
const EXPLICIT_STEP: f64 = 1.0 / 3600.0;

impl Setting {
    /// The scenario as it is.
    #[must_use]
    pub const fn unchanged() -> Self {
        Self(Vec::new())
    }

    /// The fine setting that others are compared with: 40 links and steps of at most 0.5 ms, in MuJoCo if the program
    /// has it. Contacts are as hard as the step allows, because penetration is absent in a world of rigid surfaces.
    #[must_use]
    pub fn fine() -> Self {
        use Change::{BendInAir, HardContacts, Links, Step, World};
        Self(vec![World(WorldKind::default()), Links(FINE_LINKS), Step(FINE_STEP), HardContacts, BendInAir])
    }

    /// The settings that are compared for a scene in its `world`: the default, the fine one, every axis by itself, and
    /// some combinations. Duplicates are omitted, and so are settings of worlds that the program does not have.
    #[must_use]
    pub fn all(scene: &Scene, world: WorldKind) -> Vec<Self> {
        use Change::{
            BendInAir, ContactEstimator, HardContacts, Integrator as By, Links, NoCalmSteps, Solver as With, Step,
            World,
        };
        let steps_with = Integrator::ALL.map(|integrator| vec![Step(EXPLICIT_STEP), By(integrator), HardContacts]);
        let together = [
            vec![Links(8), Step(SLOW)],
            vec![Links(8), With(Solver::ProjectedGaussSeidel)],
            vec![HardContacts],
            vec![Step(USUAL), HardContacts],
            vec![Step(1.0 / 600.0), HardContacts],
            vec![Step(SHORT), HardContacts],
            vec![Step(SHORTER), HardContacts],
            vec![Links(8), HardContacts],
            vec![Links(8), With(Solver::ProjectedGaussSeidel), HardContacts],
            vec![Links(8), Step(SHORT), HardContacts],
            vec![Links(24), Step(SHORTER), HardContacts],
            vec![World(WorldKind::QuasiStatic), Links(8)],
            vec![World(WorldKind::QuasiStatic), Links(FINE_LINKS)],
        ];
        let singles = LINKS.map(Links).into_iter().chain(STEPS.map(Step)).chain(Solver::ALL.map(With));
        let singles =
            singles.chain(WorldKind::ALL.map(World)).chain([NoCalmSteps, BendInAir]).map(|change| vec![change]);
        let all = [Self::unchanged(), Self::fine()].into_iter();
        let all = all.chain(singles.chain(steps_with).chain(together).map(Self));
        let mut seen: Vec<(Rig, Physics, WorldKind)> = Vec::new();
        let is_new = |setting: &Self| {
            let (scene, world) = setting.apply(scene, world);
            let about = (scene.rig, scene.physics, world);
            let is_new = (cfg!(feature = "sim") || world != WorldKind::Mujoco) && !seen.contains(&about);
            seen.push(about);
            is_new
        };
        // An ideal sensor is no setting of a robot.
        let estimators = ContactEstimatorKind::ALL.into_iter().filter(|kind| !kind.is_ideal());
        all.filter(is_new).chain(estimators.map(|kind| Self(vec![ContactEstimator(kind)]))).collect()
    }

    /// The contact estimator that replaces the policy's own.
    pub(super) fn contact_estimator(&self) -> Option<ContactEstimatorKind> {
        self.0.iter().find_map(|change| if let Change::ContactEstimator(kind) = change { Some(*kind) } else { None })
    }

    /// The scene and the world after the changes.
    pub(super) fn apply(&self, scene: &Scene, world: WorldKind) -> (Scene, WorldKind) {
        let (mut scene, mut world) = (scene.clone(), world);
        let Scene { rig, physics, .. } = &mut scene;
        for change in &self.0 {
            match *change {
                Change::World(kind) => world = kind,
                Change::Links(links) => set_links(rig, links),
                Change::Step(step) => set_step(rig, physics, step),
                Change::HardContacts => physics.contact_time = physics.step,
                Change::NoCalmSteps => physics.calm_step = physics.step,
                Change::BendInAir => physics.rigid_in_air = false,
                Change::Integrator(integrator) => physics.integrator = integrator,
                Change::Solver(solver) => physics.solver = solver,
                Change::ContactEstimator(kind) => rig.sensing.forces |= kind == ContactEstimatorKind::MomentAndShear,
            }
        }
        (scene, world)
    }

    /// Name of the single kind of change, `several` for a combination.
    pub(super) fn axis(&self) -> &'static str {
        match self.0.as_slice() {
            [] => "default",
            _ if *self == Self::fine() => "fine",
            [Change::Links(_)] => "links",
            [Change::Step(_) | Change::NoCalmSteps] => "step",
            [Change::BendInAir] => "whiskers in the air",
            // An integrator is combined with the step that it needs.
            [Change::Integrator(_)] | [Change::Step(_), Change::Integrator(_), Change::HardContacts] => "integrator",
            [Change::HardContacts] => "contacts",
            [Change::Solver(_)] => "solver",
            [Change::World(_)] => "world",
            [Change::ContactEstimator(_)] => "tip model",
            _ => "several",
        }
    }
}

/// Sets the number of links of every whisker.
pub(super) fn set_links(rig: &mut Rig, links: usize) {
    for whisker in &mut rig.whiskers {
        whisker.shaft.links = links;
    }
}

fn set_step(rig: &mut Rig, physics: &mut Physics, step: f64) {
    // An integer in spite of rounding errors.
    let parts = |period: f64| (period / step - 1e-9).ceil().max(1.0);
    let sensing = &mut rig.sensing;
    sensing.sample_rate = sensing.sample_rate.min(sensing.control_rate * parts(sensing.control_rate.recip()));
    let sample = sensing.sample_rate.recip();
    physics.step = sample / parts(sample);
    physics.calm_step = physics.step;
}

impl fmt::Display for Setting {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if let "default" | "fine" = self.axis() {
            return f.write_str(self.axis());
        }
        for (index, change) in self.0.iter().enumerate() {
            f.write_str(if index > 0 { ", " } else { "" })?;
            match change {
                Change::World(world) => write!(f, "{world}")?,
                Change::Links(links) => write!(f, "{links} links")?,
                Change::Step(step) => write!(f, "{:.2} ms", 1e3 * step)?,
                Change::HardContacts => f.write_str("hard")?,
                Change::NoCalmSteps => f.write_str("no longer steps in calm")?,
                Change::BendInAir => f.write_str("bending in the air")?,
                Change::Integrator(integrator) => f.write_str(integrator.name())?,
                Change::Solver(solver) => f.write_str(solver.name())?,
                Change::ContactEstimator(kind) => f.write_str(kind.name())?,
            }
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "a test may panic")]
    use super::*;
    use crate::built_in::SCENARIOS;
    use vibrissa_text::diagnostic::Source;
    use vibrissa_world::scenario;

    #[test]
    fn every_setting_is_another_and_its_steps_make_up_samples_and_ticks() {
        let whole = |parts: f64| (parts - parts.round()).abs() < 1e-9 && parts > 0.5;
        for file in [SCENARIOS[0], SCENARIOS[4]] {
            let scene = scenario::read(&Source::new(file.path, file.text)).unwrap();
            let settings = Setting::all(&scene, WorldKind::default());
            assert_eq!(settings[..2], [Setting::unchanged(), Setting::fine()]);
            let mut names: Vec<_> = settings.iter().map(ToString::to_string).collect();
            for setting in &settings {
                let Scene { rig, physics, .. } = setting.apply(&scene, WorldKind::default()).0;
                assert!(whole(1.0 / (physics.step * rig.sensing.sample_rate)), "{setting}");
                assert!(whole(rig.sensing.sample_rate / rig.sensing.control_rate), "{setting}");
            }
            names.sort();
            names.dedup();
            assert_eq!(names.len(), settings.len());
        }
    }
}
