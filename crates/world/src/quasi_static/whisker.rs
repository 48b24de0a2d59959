//! The quasi-static motion of one whisker.

use crate::geometry::{Point2, Pose, Vector2};
use vibrissa_runtime::rig::Whisker;

use super::base_path::BasePath;
use super::broad_phase::{Clearance, broad_phase};
use super::contact::{Contact, Pair, narrow_phase};
use super::equilibrium::{EquilibriumSolver, Step};
use super::first_order_lag::FirstOrderLag;
use super::friction::ConeForce;
use super::rod::{Rod, Shape};
use super::surface::Surfaces;

/// A whisker that moves through a sequence of equilibria.
#[derive(Debug)]
pub(super) struct QuasiStaticWhisker {
    rod: Rod,
    shape: Shape,
    base_path: BasePath,
    hinge: FirstOrderLag,
    solver: EquilibriumSolver,
    has_friction: bool,
    pairs: Vec<Pair>,
    contacts: Vec<Contact>,
    /// How far all feature pairs are that are not in `pairs`.
    clearance: Clearance,
    /// The change of every angle in the last sample (rad), if it can be extrapolated.
    prediction: Option<Vec<f64>>,
    previous_angles: Vec<f64>,
    /// The number of samples without an equilibrium since the last one.
    unsettled_samples: usize,
    force: Vector2,
    /// An upper bound (m) of the motion of the whisker relative to its base in the last sample.
    relative_motion: f64,
}

/// The reasons for which no equilibrium is available.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum EquilibriumError {
    /// The whisker penetrates a solid by this depth (m).
    Penetration(f64),
    /// The base passed through a solid. The distance (m) is that of its points of entry and exit.
    PassedThrough(f64),
    /// The iteration did not converge.
    NotConverged,
}

/// The convergence threshold (m) for the largest displacement in a step. Convergence is quadratic, so the next step
/// would be much smaller.
const CONVERGED: f64 = 2e-7;
/// The largest number of Newton steps in a sample. After a snap-off more steps are needed. The rest of the motion then
/// follows in the next sample.
const MAX_STEPS: usize = 80;
/// The largest displacement (m) of a descent step.
pub(super) const MAX_DESCENT: f64 = 3e-4;
/// The largest number of consecutive samples without an equilibrium.
const MAX_UNSETTLED_SAMPLES: usize = 300;
/// The largest number of substeps of a sample.
const MAX_SUBSTEPS: f64 = 200.0;
/// The largest ratio of tip motion to base motion that counts as smooth.
const MAX_SMOOTH_RATIO: f64 = 3.0;
/// The perturbation (rad) of a whisker that is pressed along its shaft. It lets the whisker buckle.
const PERTURBATION: f64 = 1e-4;

impl QuasiStaticWhisker {
    /// Creates a straight whisker among surfaces with a coefficient of friction.
    pub(super) fn new(whisker: &Whisker, friction: f64, base: Pose) -> Self {
        let rod = Rod::new(whisker);
        Self {
            shape: Shape::at_rest(&rod, base),
            base_path: BasePath::default(),
            hinge: FirstOrderLag::new(whisker.hinge.damping / whisker.hinge.stiffness),
            solver: EquilibriumSolver::new(friction),
            has_friction: friction > 0.0,
            pairs: Vec::new(),
            contacts: Vec::new(),
            clearance: Clearance::UNKNOWN,
            prediction: None,
            previous_angles: vec![0.0; rod.links()],
            unsettled_samples: 0,
            force: Vector2::zeros(),
            relative_motion: 0.0,
            rod,
        }
    }

    /// The reading of the base hinge (rad), delayed by its damper.
    pub(super) fn base_angle(&self) -> f64 {
        self.hinge.value()
    }

    /// An upper bound (m) of the motion of the whisker relative to its base in the last sample.
    pub(super) fn relative_motion(&self) -> f64 {
        self.relative_motion
    }

    /// The position of the tip (m, world frame).
    pub(super) fn tip(&self) -> Point2 {
        self.ends().last().unwrap_or(self.base())
    }

    /// The far ends of the links (m, world frame).
    pub(super) fn ends(&self) -> impl Iterator<Item = Point2> {
        // The link ends in the shape of a whisker at rest are not updated.
        self.rod.ends(&self.shape)
    }

    /// The force (N, world frame) of the whisker on its base. Between two equilibria it is the force of the previous
    /// equilibrium.
    pub(super) fn force(&self) -> Vector2 {
        self.force
    }

    /// The force (N) in the frame of the shaft at the base: axial, and perpendicular to the left.
    pub(super) fn force_base(&self) -> Vector2 {
        crate::geometry::rotate(self.force, -(self.shape.base.heading + self.base_angle()))
    }

    /// The position of the base (m, world frame).
    pub(super) fn base(&self) -> Point2 {
        self.shape.base.position
    }

    /// Moves the base to another pose within `period` (s) and finds the equilibrium there.
    pub(super) fn follow(
        &mut self,
        base: Pose,
        period: f64,
        surfaces: &Surfaces,
        limit: f64,
    ) -> Result<(), EquilibriumError> {
        let from = self.shape.base;
        if let Some(distance) = self.base_path.follow(from.position, base.position, surfaces) {
            return Err(EquilibriumError::PassedThrough(distance));
        }
        let base_motion =
            (base.position - from.position).norm() + self.rod.length() * (base.heading - from.heading).abs();
        let is_at_rest = self.unsettled_samples == 0 && self.shape.is_at_rest();
        if is_at_rest && self.pairs.is_empty() && self.clearance.clear > base_motion {
            self.clearance.clear -= base_motion;
            self.relative_motion = 0.0;
            self.shape.base = base;
            self.hinge.follow(0.0, period);
            return Ok(());
        }
        if is_at_rest {
            self.prediction = None;
        }
        self.previous_angles.copy_from_slice(&self.shape.angles);
        // An upper bound of the motion of any point before the iteration.
        let motion = base_motion + self.predicted_motion();
        let min_stride = (0.5 * self.rod.end_radius(self.rod.links() - 1)).max(motion / MAX_SUBSTEPS);
        let (mut done, mut settled, force) = (0.0, true, self.force);
        while done < 1.0 {
            let stride = (0.8 * self.nearest_idle(surfaces)).max(min_stride);
            let share = if motion > 0.0 { (stride / motion).min(1.0 - done) } else { 1.0 };
            done += share;
            if done > 1.0 - 1e-9 {
                done = 1.0;
            }
            if let Some(prediction) = &self.prediction {
                for (angle, prediction) in self.shape.angles.iter_mut().zip(prediction) {
                    *angle += share * prediction;
                }
            }
            let pose = Pose {
                position: from.position + done * (base.position - from.position),
                heading: from.heading + done * (base.heading - from.heading),
            };
            self.clearance.clear -= share * motion;
            settled = self.settle(if done < 1.0 { pose } else { base }, surfaces)?;
        }
        self.unsettled_samples = if settled { 0 } else { self.unsettled_samples + 1 };
        if !settled {
            // An incomplete step has the forces of its end, which is far from the current shape.
            self.force = force;
        }
        if self.unsettled_samples > MAX_UNSETTLED_SAMPLES {
            return Err(EquilibriumError::NotConverged);
        }
        let deepest = self.contacts.iter().map(|contact| contact.gap).fold(0.0, f64::min);
        // The base is fixed to the platform and cannot be deflected.
        let is_base_near = self.pairs.iter().any(Pair::is_at_base);
        let depth = if is_base_near { surfaces.depth(base.position).max(-deepest) } else { -deepest };
        if depth > limit {
            return Err(EquilibriumError::Penetration(depth));
        }
        self.update_predictor(settled, base_motion);
        self.hinge.follow(self.rod.base_angle(&self.shape), period);
        Ok(())
    }

    /// The distance (m) to the nearest inactive contact or sharp corner. Behind a sharp corner, an end could leave the
    /// solid by another side.
    fn nearest_idle(&self, surfaces: &Surfaces) -> f64 {
        let inactive = self.contacts.iter().filter(|contact| !contact.force.acts()).map(|contact| contact.gap);
        let corners = self.pairs.iter().filter_map(|pair| pair.sharp_corner(&self.shape, surfaces));
        inactive.chain(corners).fold(self.clearance.clear, f64::min)
    }

    /// Iterates towards the equilibrium for a pose of the base. Returns true if it converged.
    fn settle(&mut self, base: Pose, surfaces: &Surfaces) -> Result<bool, EquilibriumError> {
        self.release_anchors(surfaces);
        self.shape.place(&self.rod, base);
        for _ in 0..MAX_STEPS {
            if self.clearance.is_used_up() {
                self.clearance = broad_phase(&self.rod, &self.shape, surfaces, &mut self.pairs);
            }
            narrow_phase(&self.rod, &self.shape, surfaces, &mut self.pairs, &mut self.contacts, self.has_friction);
            let is_free = self.contacts.iter().all(|contact| contact.gap >= 0.0 && !contact.force.acts());
            if is_free && self.shape.is_at_rest() {
                self.force = Vector2::zeros();
                return Ok(true);
            }
            let Some(step) = self.solver.step(&self.rod, &self.shape, &self.contacts) else {
                self.perturb(base);
                continue;
            };
            if self.take(&step) {
                return Ok(true);
            }
            if !step.is_newton {
                self.release_anchors(surfaces);
            }
            if !step.is_newton && step.max_displacement < CONVERGED {
                // The iteration stopped at a maximum or a saddle point.
                self.perturb(base);
            }
        }
        if !self.shape.angles.iter().all(|angle| angle.is_finite()) {
            return Err(EquilibriumError::NotConverged);
        }
        Ok(false)
    }

    /// Measures the slip of contacts that do not stick from the current configuration on.
    fn release_anchors(&mut self, surfaces: &Surfaces) {
        if self.has_friction {
            for pair in &mut self.pairs {
                pair.release_anchor(&self.rod, &self.shape, surfaces);
            }
        }
    }

    /// Applies a step within the trust radius. Returns true if it converged.
    fn take(&mut self, step: &Step) -> bool {
        let trust_radius = if step.is_newton { self.clearance.clear } else { MAX_DESCENT };
        let share = (trust_radius / step.max_displacement).min(1.0);
        self.solver.take(&mut self.shape, share);
        self.clearance.clear -= share * step.max_displacement;
        for pair in &mut self.pairs {
            pair.force = ConeForce::default();
        }
        for contact in &mut self.contacts {
            contact.force = ConeForce::default();
        }
        self.force = Vector2::zeros();
        let active = self.solver.active();
        for edge in active {
            let contact = &mut self.contacts[edge.contact];
            contact.force.add(edge.edge, edge.force.max(f64::MIN_POSITIVE));
            self.pairs[contact.pair].force = contact.force;
            self.force += edge.force * self.solver.direction(edge.edge, contact);
        }
        // A whisker without contact is at rest.
        if step.is_newton && share >= 1.0 && active.is_empty() {
            self.shape.angles.fill(0.0);
        }
        self.shape.place(&self.rod, self.shape.base);
        step.is_newton && step.max_displacement < CONVERGED
    }

    /// Bends the whisker slightly.
    fn perturb(&mut self, base: Pose) {
        let count = self.rod.links() as f64;
        for (link, angle) in self.shape.angles.iter_mut().enumerate() {
            *angle += PERTURBATION * (link + 1) as f64 / count;
        }
        self.shape.place(&self.rod, base);
    }

    /// Stores the change of every angle as the prediction for the next sample. After a snap-off there is no prediction.
    fn update_predictor(&mut self, settled: bool, base_motion: f64) {
        let prediction = self.prediction.get_or_insert_with(Vec::new);
        prediction.clear();
        prediction.extend(
            self.shape.angles.iter().zip(&self.previous_angles).map(|(now, previous_angles)| now - previous_angles),
        );
        self.relative_motion = self.predicted_motion();
        if !settled || self.relative_motion > MAX_SMOOTH_RATIO * base_motion || self.shape.is_at_rest() {
            self.prediction = None;
        }
    }

    /// An upper bound (m) of the motion of any point due to the predicted change of angles.
    fn predicted_motion(&self) -> f64 {
        let rotations = self.prediction.iter().flatten().map(|turn| turn.abs());
        self.rod.length() * rotations.fold(0.0, f64::max)
    }
}

#[cfg(test)]
mod corner_traversal;
