//! One whisker, from equilibrium to equilibrium.

use crate::geometry::{Point2, Pose, Vector2, unit};
use vibrissa_runtime::rig::Whisker;

use super::balance::{Balance, Step};
use super::lag::Lag;
use super::surface::Surfaces;
use super::touch::{Contact, Pair, contacts, survey};
use super::wire::{Shape, Wire};

/// One whisker, from equilibrium to equilibrium.
#[derive(Debug)]
pub(super) struct Follower {
    wire: Wire,
    shape: Shape,
    hinge: Lag,
    balance: Balance,
    pairs: Vec<Pair>,
    contacts: Vec<Contact>,
    /// All but the pairs are at least this far apart (m).
    clear: f64,
    /// What the last sample added to every angle (rad), if it can be expected to go on so.
    pace: Option<Vec<f64>>,
    before: Vec<f64>,
    /// Samples for which it has been on its way.
    restless: usize,
    force: Vector2,
    /// How far (m) something of it went against its base in the last sample, at most.
    went: f64,
}

/// Why a whisker cannot be followed.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Lost {
    /// It is so deep (m) in a solid.
    Inside(f64),
    /// No equilibrium was found.
    Restless,
}

/// A step that moves nothing by more than this (m) is the last: the next would move it by the square, over the radius of the
/// whisker at worst.
const SETTLED: f64 = 2e-7;
/// Steps of Newton's method in a sample. A whisker that springs off takes the more of them the farther it goes; what is left it
/// goes in the next sample.
const STEPS: usize = 80;
/// The farthest (m) that a step downhill moves.
const DOWNHILL: f64 = 3e-4;
/// With less than this (m) to what is not watched, that is looked for anew.
const NARROW: f64 = 1e-3;
/// Samples for which a whisker may be on its way.
const PATIENCE: usize = 300;
/// Parts of a sample's motion.
const MOST_PARTS: f64 = 200.0;
/// A tip that goes this many times as far as the base does so evenly.
const EVEN: f64 = 3.0;
/// How far (rad) a whisker that is pushed straight against its base is bent, so that it can give way.
const NUDGE: f64 = 1e-4;

impl Follower {
    pub(super) fn new(whisker: &Whisker, base: Pose) -> Self {
        let wire = Wire::new(whisker);
        Self {
            shape: Shape::straight(&wire, base),
            hinge: Lag::new(whisker.hinge.damping / whisker.hinge.stiffness),
            balance: Balance::default(),
            pairs: Vec::new(),
            contacts: Vec::new(),
            clear: 0.0,
            pace: None,
            before: vec![0.0; wire.links()],
            restless: 0,
            force: Vector2::zeros(),
            went: 0.0,
            wire,
        }
    }

    /// Angle of the base hinge (rad), which its damper makes late.
    pub(super) fn base_angle(&self) -> f64 {
        self.hinge.value()
    }

    /// How far (m) something of it went against its base in the last sample, at most.
    pub(super) fn went(&self) -> f64 {
        self.went
    }

    /// Where the tip is (m, world frame).
    pub(super) fn tip(&self) -> Point2 {
        // Of a straight whisker in the air the links are not kept in their places.
        let along = self.shape.angles.iter().map(|angle| unit(self.shape.base.heading + angle)).sum::<Vector2>();
        self.shape.base.position + self.wire.link * along
    }

    /// The force (N) that the whisker passes on to its base, in the world. While it is on its way from one equilibrium to the next, that
    /// of the one that it left.
    pub(super) fn force(&self) -> Vector2 {
        self.force
    }

    /// The force (N) in the frame of the shaft at the base: along it, and across it to its left.
    pub(super) fn force_base(&self) -> Vector2 {
        crate::geometry::rotate(self.force, -(self.shape.base.heading + self.base_angle()))
    }

    /// Where the base is (m, world frame).
    pub(super) fn base(&self) -> Point2 {
        self.shape.base.position
    }

    /// Lets the base go to another place within a time (s), and takes the whisker's equilibrium there.
    pub(super) fn follow(&mut self, base: Pose, period: f64, surfaces: &Surfaces, limit: f64) -> Result<(), Lost> {
        let from = self.shape.base;
        let way = (base.position - from.position).norm() + self.wire.length() * (base.heading - from.heading).abs();
        let is_straight = self.restless == 0 && self.shape.is_straight();
        if is_straight && self.pairs.is_empty() && self.clear > way {
            self.clear -= way;
            self.went = 0.0;
            self.shape.base = base;
            self.hinge.follow(0.0, period);
            return Ok(());
        }
        if is_straight {
            self.pace = None;
        }
        self.before.copy_from_slice(&self.shape.angles);
        // How far anything of it goes before it is let go towards its equilibrium, at most.
        let reach = way + self.swept();
        let least = (0.5 * self.wire.end_radius(self.wire.links() - 1)).max(reach / MOST_PARTS);
        let (mut done, mut settled, force) = (0.0, true, self.force);
        while done < 1.0 {
            let stride = (0.8 * self.nearest(surfaces)).max(least);
            let share = if reach > 0.0 { (stride / reach).min(1.0 - done) } else { 1.0 };
            done += share;
            if done > 1.0 - 1e-9 {
                done = 1.0;
            }
            if let Some(pace) = &self.pace {
                for (angle, pace) in self.shape.angles.iter_mut().zip(pace) {
                    *angle += share * pace;
                }
            }
            let part = Pose {
                position: from.position + done * (base.position - from.position),
                heading: from.heading + done * (base.heading - from.heading),
            };
            self.clear -= share * reach;
            settled = self.settle(if done < 1.0 { part } else { base }, surfaces)?;
        }
        self.restless = if settled { 0 } else { self.restless + 1 };
        if !settled {
            // A step that was not taken as a whole has the forces of its end, which is nowhere near.
            self.force = force;
        }
        if self.restless > PATIENCE {
            return Err(Lost::Restless);
        }
        let deepest = self.contacts.iter().map(|contact| contact.gap).fold(0.0, f64::min);
        // The base cannot give way.
        let is_base_near = self.pairs.iter().any(Pair::is_at_base);
        let depth = if is_base_near { surfaces.depth(base.position).max(-deepest) } else { -deepest };
        if depth > limit {
            return Err(Lost::Inside(depth));
        }
        self.note_pace(settled, way);
        self.hinge.follow(self.wire.base_angle(&self.shape), period);
        Ok(())
    }

    /// How near (m) anything is that does not bear yet, or a sharp corner, behind which an end may come out of another side than it
    /// went in.
    fn nearest(&self, surfaces: &Surfaces) -> f64 {
        let idle = self.contacts.iter().filter(|contact| contact.force == 0.0).map(|contact| contact.gap);
        let corners = self.pairs.iter().filter_map(|pair| pair.sharp_corner(&self.shape, surfaces));
        idle.chain(corners).fold(self.clear, f64::min)
    }

    /// Takes the equilibrium on a base, or goes towards it; whether it is there.
    fn settle(&mut self, base: Pose, surfaces: &Surfaces) -> Result<bool, Lost> {
        self.shape.place(&self.wire, base);
        for _ in 0..STEPS {
            if self.clear < NARROW {
                self.clear = survey(&self.wire, &self.shape, surfaces, &mut self.pairs);
            }
            contacts(&self.wire, &self.shape, surfaces, &mut self.pairs, &mut self.contacts);
            let is_free = self.contacts.iter().all(|contact| contact.gap >= 0.0 && contact.force == 0.0);
            if is_free && self.shape.is_straight() {
                self.force = Vector2::zeros();
                return Ok(true);
            }
            let Some(step) = self.balance.step(&self.wire, &self.shape, &self.contacts) else {
                self.nudge(base);
                continue;
            };
            if self.take(&step) {
                return Ok(true);
            }
            if !step.is_newtons && step.farthest < SETTLED {
                // It stands on the top of a hill.
                self.nudge(base);
            }
        }
        if !self.shape.angles.iter().all(|angle| angle.is_finite()) {
            return Err(Lost::Restless);
        }
        Ok(false)
    }

    /// Takes a step, as far as it can be trusted; whether that was the last.
    fn take(&mut self, step: &Step) -> bool {
        let trusted = if step.is_newtons { self.clear } else { DOWNHILL };
        let share = (trusted / step.farthest).min(1.0);
        self.balance.take(&mut self.shape, share);
        self.clear -= share * step.farthest;
        let bearing = &step.bearing[..step.count];
        for pair in &mut self.pairs {
            pair.force = 0.0;
        }
        self.force = Vector2::zeros();
        for contact in &mut self.contacts {
            contact.force = 0.0;
        }
        for &(index, force) in bearing {
            let contact = &mut self.contacts[index];
            contact.force = force.max(f64::MIN_POSITIVE);
            self.pairs[contact.pair].force = contact.force;
            self.force += force * contact.normal;
        }
        // A free whisker that has sprung back is straight.
        if step.is_newtons && share >= 1.0 && bearing.is_empty() {
            self.shape.angles.fill(0.0);
        }
        self.shape.place(&self.wire, self.shape.base);
        step.is_newtons && step.farthest < SETTLED
    }

    /// Bends it a little.
    fn nudge(&mut self, base: Pose) {
        let count = self.wire.links() as f64;
        for (link, angle) in self.shape.angles.iter_mut().enumerate() {
            *angle += NUDGE * (link + 1) as f64 / count;
        }
        self.shape.place(&self.wire, base);
    }

    /// Notes by how much every angle has changed while the base went a way (m), for the next sample to go on so; not where the
    /// whisker has sprung off something.
    fn note_pace(&mut self, settled: bool, way: f64) {
        let pace = self.pace.get_or_insert_with(Vec::new);
        pace.clear();
        pace.extend(self.shape.angles.iter().zip(&self.before).map(|(now, before)| now - before));
        self.went = self.swept();
        if !settled || self.went > EVEN * way || self.shape.is_straight() {
            self.pace = None;
        }
    }

    /// How far (m) anything of it goes at most while its angles change by its pace.
    fn swept(&self) -> f64 {
        let turns = self.pace.iter().flatten().map(|turn| turn.abs());
        self.wire.length() * turns.fold(0.0, f64::max)
    }
}

#[cfg(test)]
mod passing;
