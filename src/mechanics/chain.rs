//! The static equilibrium of a whisker's shaft under a force at its tip.

use nalgebra::{Matrix2, Vector2};

use crate::rig::Whisker;

/// A whisker's shaft as a chain of rigid links on planar springs, the very chain that the simulator holds.
///
/// The frame is that of the whisker's base: origin at the base, first axis along the undeflected shaft, second axis to its
/// left.
#[derive(Debug, Clone)]
pub struct ShaftChain {
    link_length: f64,
    hinge_stiffness: f64,
    /// From the root to the tip (N m/rad).
    joint_stiffnesses: Vec<f64>,
}

/// The shape of a chain in equilibrium.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Equilibrium {
    /// Angle of the base hinge (rad).
    pub base_angle: f64,
    /// Angle of the last link (rad).
    pub tip_angle: f64,
    /// Magnitude of the force at the tip (N).
    pub force: f64,
    /// Place of the tip's centre (m).
    pub tip_base: Vector2<f64>,
}

/// Steps of Newton's method after which a solution is given up.
const NEWTON_STEPS: usize = 30;

impl ShaftChain {
    /// The chain of `whisker`.
    #[must_use]
    pub fn new(whisker: &Whisker) -> Self {
        Self {
            link_length: whisker.shaft.link_length(),
            hinge_stiffness: whisker.hinge.stiffness,
            joint_stiffnesses: whisker.shaft.joint_stiffnesses().collect(),
        }
    }

    /// Solves for the equilibrium in which the base angle is `base_angle` (rad) under a tip force in the direction
    /// `force_direction` (rad), starting from the neighbouring solution `guess`; `None` if Newton's method does not settle.
    ///
    /// The unknowns are the angle of the last link and the magnitude of the force. Given both, the chain follows from its
    /// free end: the moment about each joint turns the link before it back by moment over stiffness. Two conditions remain
    /// at the base: the hinge's own angle is the moment over the hinge's stiffness, and it is the one asked for.
    #[must_use]
    pub fn solve(&self, base_angle: f64, force_direction: f64, guess: &Equilibrium) -> Option<Equilibrium> {
        let direction = Vector2::new(force_direction.cos(), force_direction.sin());
        let (mut tip_angle, mut force) = (guess.tip_angle, guess.force);
        for _ in 0..NEWTON_STEPS {
            let shot = self.shoot(tip_angle, force, direction);
            let residual = Vector2::new(shot.root.value - shot.hinge.value, shot.hinge.value - base_angle);
            let slope = Matrix2::new(
                shot.root.by_angle - shot.hinge.by_angle,
                shot.root.by_force - shot.hinge.by_force,
                shot.hinge.by_angle,
                shot.hinge.by_force,
            );
            let step = slope.lu().solve(&residual)?;
            tip_angle -= step.x;
            force -= step.y;
            if !(tip_angle.is_finite() && force.is_finite()) {
                return None;
            }
            if step.x.abs() < 1e-12 && step.y.abs() <= 1e-12 * force.abs() {
                return Some(Equilibrium { base_angle, tip_angle, force, tip_base: shot.tip_base });
            }
        }
        None
    }

    /// The straight chain.
    #[must_use]
    pub fn straight(&self) -> Equilibrium {
        let length = self.link_length * self.joint_stiffnesses.len() as f64;
        Equilibrium { base_angle: 0.0, tip_angle: 0.0, force: 0.0, tip_base: Vector2::new(length, 0.0) }
    }

    /// Follows the chain from its free end to the base.
    fn shoot(&self, tip_angle: f64, force: f64, direction: Vector2<f64>) -> Shot {
        let mut angle = Dual { value: tip_angle, by_angle: 1.0, by_force: 0.0 };
        let mut moment = Dual::default();
        let mut tip_base = Vector2::zeros();
        for &stiffness in self.joint_stiffnesses.iter().rev() {
            let (sin, cos) = angle.value.sin_cos();
            tip_base += self.link_length * Vector2::new(cos, sin);
            // The link's share of the lever, crossed with the force, and its change with the link's angle.
            let lever = self.link_length * (cos * direction.y - sin * direction.x);
            let turned = -self.link_length * force * (sin * direction.y + cos * direction.x);
            moment.value += force * lever;
            moment.by_angle += turned * angle.by_angle;
            moment.by_force += turned * angle.by_force + lever;
            angle.value -= moment.value / stiffness;
            angle.by_angle -= moment.by_angle / stiffness;
            angle.by_force -= moment.by_force / stiffness;
        }
        let hinge = Dual {
            value: moment.value / self.hinge_stiffness,
            by_angle: moment.by_angle / self.hinge_stiffness,
            by_force: moment.by_force / self.hinge_stiffness,
        };
        Shot { root: angle, hinge, tip_base }
    }
}

/// A number with its derivatives by the two unknowns.
#[derive(Debug, Clone, Copy, Default)]
struct Dual {
    value: f64,
    by_angle: f64,
    by_force: f64,
}

/// What following the chain gives at the base.
struct Shot {
    /// The angle that the base would have to have.
    root: Dual,
    /// The angle that the moment gives the base hinge.
    hinge: Dual,
    /// Place of the tip.
    tip_base: Vector2<f64>,
}
