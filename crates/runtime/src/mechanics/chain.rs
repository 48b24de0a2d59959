//! The static equilibrium of a chain of links under a force at its tip.

use nalgebra::{Matrix2, Vector2};

use crate::geometry::unit;
use crate::math;
use crate::rig::Whisker;

/// A whisker's shaft as a chain of rigid links with planar springs, with its curvature at rest. The simulators use the
/// same chain.
///
/// The frame is that of the whisker's base: origin at the base, first axis along the undeflected shaft, second axis to
/// its left.
#[derive(Debug, Clone)]
pub struct ShaftChain {
    /// Length of a link (m).
    link_length: f64,
    /// Stiffness of the base hinge (N m/rad).
    hinge_stiffness: f64,
    /// Joint stiffnesses from the base to the tip (N m/rad).
    joint_stiffnesses: Vec<f64>,
    /// Angles of the joints at rest, from the base to the tip (rad).
    rest_angles: Vec<f64>,
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
    /// Position of the tip's centre (m).
    pub tip_base: Vector2<f64>,
}

/// The conditions of an equilibrium, and an initial guess.
#[derive(Debug, Clone, Copy)]
pub struct EquilibriumProblem {
    /// The base angle (rad).
    pub base_angle: f64,
    /// The direction of the force at the tip (rad).
    pub force_direction: f64,
    /// Initial guess of the iteration: a neighbouring solution.
    pub guess: Equilibrium,
}

/// Maximum number of Newton steps.
const NEWTON_STEPS: usize = 30;

impl ShaftChain {
    /// Creates the chain of `whisker`.
    #[must_use]
    pub fn new(whisker: &Whisker) -> Self {
        Self {
            link_length: whisker.shaft.link_length(),
            hinge_stiffness: whisker.hinge.stiffness,
            joint_stiffnesses: whisker.shaft.joint_stiffnesses().collect(),
            rest_angles: whisker.shaft.rest_angles().collect(),
        }
    }

    /// Solves for the equilibrium with the base angle `base_angle` (rad) under a tip force in the direction
    /// `force_direction` (rad). `guess` is a neighbouring solution. `None` if Newton's method does not converge.
    ///
    /// The unknowns are the angle of the last link and the magnitude of the force. They determine the chain from its
    /// free end: the moment about each joint, divided by its stiffness, is the rotation between its links. Two
    /// conditions remain at the base. The hinge angle must be the moment over the hinge stiffness, and must equal
    /// `base_angle`.
    #[must_use]
    pub fn solve(&self, base_angle: f64, force_direction: f64, guess: &Equilibrium) -> Option<Equilibrium> {
        let [found] = self.solve_each([Some(EquilibriumProblem { base_angle, force_direction, guess: *guess })]);
        found
    }

    /// Solves several problems like [`solve`](Self::solve). They are independent, so a processor can execute their
    /// chains in parallel.
    pub fn solve_each<const N: usize>(&self, problem: [Option<EquilibriumProblem>; N]) -> [Option<Equilibrium>; N] {
        let mut unknowns = problem.map(|problem| {
            problem.map_or((0.0, 0.0), |EquilibriumProblem { guess, .. }| (guess.tip_angle, guess.force))
        });
        let directions = problem.map(|problem| unit(problem.map_or(0.0, |problem| problem.force_direction)));
        let (mut open, mut found) = (problem, [None; N]);
        for _ in 0..NEWTON_STEPS {
            if open.iter().all(Option::is_none) {
                break;
            }
            let shots = self.shoot(unknowns, directions);
            for (((open, found), (tip_angle, force)), shot) in
                open.iter_mut().zip(&mut found).zip(&mut unknowns).zip(shots)
            {
                let Some(EquilibriumProblem { base_angle, .. }) = *open else { continue };
                let Some(step) = shot.step(base_angle) else {
                    *open = None;
                    continue;
                };
                *tip_angle -= step.x;
                *force -= step.y;
                if !(tip_angle.is_finite() && force.is_finite()) {
                    *open = None;
                } else if step.x.abs() < 1e-12 && step.y.abs() <= 1e-12 * force.abs() {
                    *open = None;
                    let (tip_angle, force) = (*tip_angle, *force);
                    *found = Some(Equilibrium { base_angle, tip_angle, force, tip_base: shot.tip_base });
                }
            }
        }
        found
    }

    /// The chain without a force. It is straight unless the shaft is curved at rest.
    #[must_use]
    pub fn at_rest(&self) -> Equilibrium {
        let (mut tip_angle, mut links) = (0.0, Vector2::zeros());
        for rest_angle in &self.rest_angles {
            tip_angle += rest_angle;
            links += unit(tip_angle);
        }
        Equilibrium { base_angle: 0.0, tip_angle, force: 0.0, tip_base: self.link_length * links }
    }

    /// Shoots chains from their free ends to the base, for given angles of the last link and forces.
    fn shoot<const N: usize>(&self, unknowns: [(f64, f64); N], directions: [Vector2<f64>; N]) -> [Shot; N] {
        let mut shots = unknowns.map(|(tip_angle, _)| Shot {
            root: Dual { value: tip_angle, by_angle: 1.0, by_force: 0.0 },
            hinge: Dual::default(),
            tip_base: Vector2::zeros(),
        });
        for (&stiffness, &rest_angle) in self.joint_stiffnesses.iter().zip(&self.rest_angles).rev() {
            for ((Shot { root: angle, hinge: moment, tip_base }, (_, force)), direction) in
                shots.iter_mut().zip(unknowns).zip(directions)
            {
                let (sin, cos) = math::sin_cos(angle.value);
                *tip_base += self.link_length * Vector2::new(cos, sin);
                // The link's contribution to the lever, as a cross product with the force, and its derivative by the
                // link's angle.
                let lever = self.link_length * (cos * direction.y - sin * direction.x);
                let turned = -self.link_length * force * (sin * direction.y + cos * direction.x);
                moment.value += force * lever;
                moment.by_angle += turned * angle.by_angle;
                moment.by_force += turned * angle.by_force + lever;
                angle.value -= moment.value / stiffness + rest_angle;
                angle.by_angle -= moment.by_angle / stiffness;
                angle.by_force -= moment.by_force / stiffness;
            }
        }
        for Shot { hinge: moment, .. } in &mut shots {
            moment.value /= self.hinge_stiffness;
            moment.by_angle /= self.hinge_stiffness;
            moment.by_force /= self.hinge_stiffness;
        }
        shots
    }
}

/// A number with its derivatives by the two unknowns.
#[derive(Debug, Clone, Copy, Default)]
struct Dual {
    /// Value.
    value: f64,
    /// Derivative by the angle of the last link.
    by_angle: f64,
    /// Derivative by the magnitude of the force.
    by_force: f64,
}

/// The result of shooting at the base.
struct Shot {
    /// Direction of the chain at the base (rad).
    root: Dual,
    /// Hinge angle that follows from the moment (rad). During the shooting it is the moment (N m).
    hinge: Dual,
    /// Position of the tip's centre (m).
    tip_base: Vector2<f64>,
}

impl Shot {
    /// The Newton step for a base angle (rad), to be subtracted from the tip angle and the force.
    fn step(&self, base_angle: f64) -> Option<Vector2<f64>> {
        let residual = Vector2::new(self.root.value - self.hinge.value, self.hinge.value - base_angle);
        let slope = Matrix2::new(
            self.root.by_angle - self.hinge.by_angle,
            self.root.by_force - self.hinge.by_force,
            self.hinge.by_angle,
            self.hinge.by_force,
        );
        slope.lu().solve(&residual)
    }
}

#[cfg(test)]
mod tests {
    use nalgebra::Vector2;

    use super::{EquilibriumProblem, ShaftChain};
    use crate::geometry::unit;
    use crate::rig::Rig;

    #[test]
    fn side_by_side_chains_are_solved_as_each_by_itself_to_the_same_bit() {
        let chain = ShaftChain::new(&Rig::default().whiskers[0]);
        let guess = chain.solve(1e-4, 2.0, &super::Equilibrium { tip_angle: 0.1, force: 0.02, ..chain.at_rest() });
        let guess = guess.unwrap_or_else(|| chain.at_rest());
        let problem = [(1.1e-4, 2.0), (2e-4, 1.2), (9e-5, 2.6), (f64::NAN, 2.0)]
            .map(|(base_angle, force_direction)| Some(EquilibriumProblem { base_angle, force_direction, guess }));
        let [a, b, c, d] = problem;
        let found = chain.solve_each([a, None, b, c, d]);
        let alone = |problem: Option<EquilibriumProblem>| chain.solve_each([problem])[0];
        assert_eq!(found, [alone(a), None, alone(b), alone(c), None]);
        assert!(found.iter().flatten().count() >= 2, "{found:?}");
    }

    /// Energy (J) of a chain whose hinge and links have these angles (rad), including that of the tip force (N).
    fn energy(chain: &ShaftChain, angles: &[f64], force: Vector2<f64>) -> f64 {
        let springs = std::iter::once(&chain.hinge_stiffness).chain(&chain.joint_stiffnesses);
        let before = std::iter::once(&0.0).chain(angles);
        let bends = angles.iter().zip(before).map(|(angle, before)| angle - before);
        let stored: f64 = springs.zip(bends).map(|(stiffness, bend)| 0.5 * stiffness * bend * bend).sum();
        stored - force.dot(&tip(chain, angles))
    }

    fn tip(chain: &ShaftChain, angles: &[f64]) -> Vector2<f64> {
        angles[1..].iter().map(|angle| chain.link_length * unit(*angle)).sum()
    }

    #[test]
    fn the_energy_has_no_slope_where_a_chain_is_in_equilibrium() {
        let chain = ShaftChain::new(&Rig::default().whiskers[0]);
        let start = super::Equilibrium { tip_angle: 0.1, force: 0.02, ..chain.at_rest() };
        let guess = chain.solve(1e-4, 2.0, &start).unwrap_or(start);
        let problem = [(1e-4, 2.0), (1.1e-4, 2.1), (1.2e-4, 1.8), (0.9e-4, 2.3)]
            .map(|(base_angle, force_direction)| Some(EquilibriumProblem { base_angle, force_direction, guess }));
        for (problem, found) in problem.into_iter().zip(chain.solve_each(problem)) {
            let (Some(problem), Some(found)) = (problem, found) else { panic!("{problem:?}: {found:?}") };
            let force = found.force * unit(problem.force_direction);
            // From the base, where the solver ends, to the tip: every spring bends by the moment about it.
            let mut moment = chain.hinge_stiffness * found.base_angle;
            let mut angles = vec![found.base_angle];
            for stiffness in &chain.joint_stiffnesses {
                let angle = angles[angles.len() - 1] + moment / stiffness;
                moment -= (chain.link_length * unit(angle)).perp(&force);
                angles.push(angle);
            }
            let scale = chain.hinge_stiffness * found.base_angle;
            for index in 0..angles.len() {
                let turned = |by: f64| {
                    let mut turned = angles.clone();
                    turned[index] += by;
                    energy(&chain, &turned, force)
                };
                let slope = (turned(1e-4) - turned(-1e-4)) / 2e-4;
                assert!(slope.abs() < 1e-6 * scale, "{problem:?}, angle {index}: {slope} N m of {scale}");
            }
            assert!((angles[angles.len() - 1] - found.tip_angle).abs() < 1e-9, "{problem:?}: {found:?}");
            assert!((tip(&chain, &angles) - found.tip_base).norm() < 1e-11, "{problem:?}: {found:?}");
        }
    }
}
