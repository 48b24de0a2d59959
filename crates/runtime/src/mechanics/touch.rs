//! The static equilibrium of a whisker that touches a known obstacle.

use std::f64::consts::FRAC_PI_2;

use nalgebra::{Matrix3, Vector3};

use crate::geometry::{Point2, Vector2, unit, wrap};
use crate::math;
use crate::rig::Whisker;

use super::continuation::continuation;
use super::obstacle::Obstacle;

/// A whisker against a known obstacle: its chain of links, with a constant curvature at rest and sliding friction.
///
/// The frame is that of the whisker's base. The whisker has been pressed against the obstacle, so that the contact has
/// slid towards the base. Friction then turns the force towards the tip.
#[derive(Debug, Clone)]
pub struct TouchMechanics {
    length: f64,
    link: f64,
    /// Radii (m) of the shaft at the base, and at the tip.
    radii: [f64; 2],
    hinge_stiffness: f64,
    joint_stiffnesses: Vec<f64>,
    /// Angles of the joints at rest (rad), and the curvature at rest (1/m), positive to the left.
    rest_angles: Vec<f64>,
    curvature: f64,
    /// Angle (rad) by which friction turns the force from the normal.
    friction_angle: f64,
    /// Unit of force (N).
    force_unit: f64,
}

/// The equilibrium of a touch.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Touch {
    /// Base angle (rad).
    pub base_angle: f64,
    /// Length of the shaft from the base to the contact (m). It is the whole length for a tip contact.
    pub contact_length: f64,
    /// Position of the shaft's axis at the contact (m).
    pub axis_base: Vector2,
    /// Direction of the surface normal at the contact, towards the whisker (rad).
    pub normal: f64,
    /// Direction of the shaft at the contact (rad).
    pub shaft_angle: f64,
    /// +1 for a bend to the left, −1 for one to the right.
    side: f64,
    state: State,
}

/// The unknowns of an equilibrium, for a bend to the left: the direction of the shaft at the contact (rad), the force in
/// the unit of the mechanics, and the place of the contact. Below 0 the place is the distance from the tip, negative and
/// as a share of the length. From 0 on the contact is at the tip. The place is then the angle (rad) by which the normal
/// is turned from perpendicular to the shaft towards the base.
type State = Vector3<f64>;

/// Maximum number of Newton steps.
const STEPS: usize = 25;
/// Largest Newton step of an unknown.
const REACH: f64 = 0.3;
/// Change of the unknowns and size of the residuals at which the iteration has converged.
const SETTLED: f64 = 1e-11;
/// Difference of an unknown for derivatives. The equations are smooth and of the order of 1.
const DIFFERENCE: f64 = 1e-6;
/// Ranges of the unknowns that a pressed whisker can have.
const SHAFT_ANGLE: (f64, f64) = (-0.5, 2.0);
const PLACE: (f64, f64) = (-0.95, 1.4);

/// The residuals of a state, and its base angle.
#[derive(Debug, Clone, Copy)]
struct Residual {
    value: Vector3<f64>,
    base_angle: f64,
    axis: Vector2,
    normal: f64,
}

impl TouchMechanics {
    /// Creates the mechanics of a whisker for a coefficient of friction.
    #[must_use]
    pub fn new(whisker: &Whisker, friction: f64) -> Self {
        let shaft = &whisker.shaft;
        Self {
            length: shaft.length,
            link: shaft.link_length(),
            radii: [shaft.radius, shaft.radius_at(1.0)],
            hinge_stiffness: whisker.hinge.stiffness,
            joint_stiffnesses: shaft.joint_stiffnesses().collect(),
            rest_angles: shaft.rest_angles().collect(),
            curvature: shaft.curvature,
            friction_angle: math::atan(friction),
            force_unit: shaft.bending_stiffness() / math::square(shaft.length),
        }
    }

    /// The equilibrium of a whisker that the obstacle has bent to a `side` (+1 left, −1 right). The obstacle (frame of
    /// the base) moved there perpendicular to the shaft at rest. `None` if there is no stable equilibrium.
    #[must_use]
    pub fn press(&self, obstacle: &Obstacle, side: f64) -> Option<Touch> {
        let (mechanics, obstacle) = self.to_left(obstacle, side);
        let (start, first) = mechanics.start(&obstacle)?;
        // A fold on the path, where the whisker would snap off, changes the sign of the determinant.
        let sign = mechanics.slope(&first, &start)?.determinant().signum();
        let solve = |share: f64, near: &State| {
            let obstacle = between(&first, &obstacle, share);
            let state = mechanics.newton(&obstacle, *near)?;
            (mechanics.slope(&obstacle, &state)?.determinant() * sign > 0.0).then_some(state)
        };
        let state = continuation(start, solve).ok()?;
        mechanics.touch(&obstacle, state, side)
    }

    /// The equilibrium near a touch of whiskers and obstacles that differ slightly. `None` if there is none.
    #[must_use]
    pub fn near(&self, obstacle: &Obstacle, guess: &Touch) -> Option<Touch> {
        let (mechanics, obstacle) = self.to_left(obstacle, guess.side);
        mechanics.touch(&obstacle, mechanics.newton(&obstacle, guess.state)?, guess.side)
    }

    /// Difference of the base angle of a touch (rad), to first order, when mechanics and obstacle change from the first
    /// pair to the second one. `None` at a fold.
    #[must_use]
    pub fn change(touch: &Touch, pairs: [(&Self, &Obstacle); 2]) -> Option<f64> {
        let [(low, obstacle), (high, other)] =
            pairs.map(|(mechanics, obstacle)| mechanics.to_left(obstacle, touch.side));
        let (before, after) = (low.residual(&obstacle, &touch.state)?, high.residual(&other, &touch.state)?);
        let moved = low.slope(&obstacle, &touch.state)?.lu().solve(&(before.value - after.value))?;
        let by_state = low.angle_slope(&obstacle, &touch.state)?;
        Some(touch.side * (after.base_angle - before.base_angle + by_state.dot(&moved)))
    }

    /// These mechanics and an obstacle, mirrored if the bend is to the right.
    fn to_left(&self, obstacle: &Obstacle, side: f64) -> (Self, Obstacle) {
        let mut mechanics = self.clone();
        if side > 0.0 {
            return (mechanics, *obstacle);
        }
        mechanics.curvature = -self.curvature;
        for rest_angle in &mut mechanics.rest_angles {
            *rest_angle = -*rest_angle;
        }
        (mechanics, obstacle.mirrored())
    }

    /// The base angle over which the shaft bends by about a radian (rad).
    #[must_use]
    pub fn angle_unit(&self) -> f64 {
        self.force_unit * self.length / self.hinge_stiffness
    }

    /// The state of the straight whisker at its first contact, and the obstacle there.
    fn start(&self, obstacle: &Obstacle) -> Option<(State, Obstacle)> {
        match *obstacle {
            Obstacle::Pin { centre, radius } => {
                let beyond = centre.x - self.length;
                if beyond <= 0.0 {
                    let share = centre.x / self.length;
                    let off = radius + self.radius(share);
                    let first = Obstacle::Pin { centre: Point2::new(centre.x, -off), radius };
                    return (share > 1.0 + PLACE.0).then_some((State::new(0.0, 0.0, share - 1.0), first));
                }
                let reach = radius + self.radii[1];
                let aside = (math::square(reach) - math::square(beyond)).sqrt();
                let first = Obstacle::Pin { centre: Point2::new(centre.x, -aside), radius };
                let turn = math::atan2(beyond, aside);
                (turn < PLACE.1).then_some((State::new(0.0, 0.0, turn), first))
            }
            Obstacle::Face { normal, .. } => {
                let turn = wrap(normal - FRAC_PI_2);
                let point = Point2::new(self.length, 0.0) - self.radii[1] * unit(normal);
                (turn >= 0.0 && turn < PLACE.1)
                    .then_some((State::new(0.0, 0.0, turn), Obstacle::Face { point, normal }))
            }
        }
    }

    /// Radius of the shaft (m) at a share of its length.
    fn radius(&self, share: f64) -> f64 {
        self.radii[0] + share * (self.radii[1] - self.radii[0])
    }

    /// The touch of a state that is bent to the left, and mirrored for a side of −1.
    fn touch(&self, obstacle: &Obstacle, state: State, side: f64) -> Option<Touch> {
        let Residual { base_angle, axis, normal, .. } = self.residual(obstacle, &state)?;
        Some(Touch {
            base_angle: side * base_angle,
            contact_length: self.length * (1.0 + math::min(state.z, 0.0)),
            axis_base: Vector2::new(axis.x, side * axis.y),
            normal: side * normal,
            shaft_angle: side * state.x,
            side,
            state,
        })
    }

    /// Newton's method from a neighbouring state.
    fn newton(&self, obstacle: &Obstacle, mut state: State) -> Option<State> {
        for _ in 0..STEPS {
            let value = self.residual(obstacle, &state)?.value;
            let step = self.slope(obstacle, &state)?.lu().solve(&value)?;
            let size = step.amax();
            if !size.is_finite() {
                return None;
            }
            state -= step * math::min(REACH / math::max(size, REACH), 1.0);
            if size < SETTLED && value.amax() < SETTLED {
                return (state.y > 0.0).then_some(state);
            }
        }
        // Where the contact crosses a joint, the equations have a kink and the last steps may alternate.
        let value = self.residual(obstacle, &state)?.value;
        (value.amax() < 1e-9 && state.y > 0.0).then_some(state)
    }

    /// Derivatives of the residuals by the unknowns.
    fn slope(&self, obstacle: &Obstacle, state: &State) -> Option<Matrix3<f64>> {
        let mut slope = Matrix3::zeros();
        for index in 0..3 {
            let [low, high] = self.beside(obstacle, state, index)?;
            slope.set_column(index, &((high.value - low.value) / (2.0 * DIFFERENCE)));
        }
        Some(slope)
    }

    /// Derivatives of the base angle by the unknowns.
    fn angle_slope(&self, obstacle: &Obstacle, state: &State) -> Option<Vector3<f64>> {
        let mut slope = Vector3::zeros();
        for index in 0..3 {
            let [low, high] = self.beside(obstacle, state, index)?;
            slope[index] = (high.base_angle - low.base_angle) / (2.0 * DIFFERENCE);
        }
        Some(slope)
    }

    /// The residuals on both sides of a state.
    fn beside(&self, obstacle: &Obstacle, state: &State, index: usize) -> Option<[Residual; 2]> {
        let at = |by: f64| {
            let mut beside = *state;
            beside[index] += by;
            self.residual(obstacle, &beside)
        };
        Some([at(-DIFFERENCE)?, at(DIFFERENCE)?])
    }

    /// Shoots the chain from the contact to the base. `None` outside of the ranges of the unknowns.
    fn residual(&self, obstacle: &Obstacle, state: &State) -> Option<Residual> {
        let (shaft_angle, force, place) = (state.x, state.y * self.force_unit, state.z);
        if !((SHAFT_ANGLE.0..=SHAFT_ANGLE.1).contains(&shaft_angle) && (PLACE.0..=PLACE.1).contains(&place)) {
            return None;
        }
        let contact = self.length * (1.0 + math::min(place, 0.0));
        let normal = shaft_angle + FRAC_PI_2 + math::max(place, 0.0);
        let push: Vector2 = unit(normal - self.friction_angle);
        let last = self.joint_stiffnesses.len() - 1;
        #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "between 0 and the last link")]
        let link = ((contact / self.link) as usize).min(last);
        let mut part = contact - self.link * link as f64;
        // The smooth direction of a curved shaft, which has no jump at a joint, is that of the link in its middle.
        let mut angle = shaft_angle - self.curvature * (part - 0.5 * self.link);
        let (mut axis, mut moment) = (Vector2::zeros(), 0.0);
        let joints = self.joint_stiffnesses.iter().zip(&self.rest_angles);
        for (stiffness, rest_angle) in joints.take(link + 1).rev() {
            let along = part * unit(angle);
            axis += along;
            moment += force * along.perp(&push);
            angle -= moment / stiffness + rest_angle;
            part = self.link;
        }
        let base_angle = moment / self.hinge_stiffness;
        let radius = self.radius(contact / self.length);
        let gap = match *obstacle {
            Obstacle::Pin { centre, radius: pin } => {
                (axis - (pin + radius) * unit(normal) - centre.coords) / self.length
            }
            Obstacle::Face { point, normal: face } => {
                let height = (axis - point.coords).dot(&unit(face)) - radius;
                Vector2::new(wrap(normal - face), height / self.length)
            }
        };
        Some(Residual { value: Vector3::new(angle - base_angle, gap.x, gap.y), base_angle, axis, normal })
    }
}

/// An obstacle between two positions, in the frame of the base.
fn between(from: &Obstacle, to: &Obstacle, share: f64) -> Obstacle {
    let point = |a: Point2, b: Point2| Point2::from((1.0 - share) * a.coords + share * b.coords);
    match (*from, *to) {
        (Obstacle::Pin { centre: a, .. }, Obstacle::Pin { centre: b, radius }) => {
            Obstacle::Pin { centre: point(a, b), radius }
        }
        (Obstacle::Face { point: a, .. }, Obstacle::Face { point: b, normal }) => {
            Obstacle::Face { point: point(a, b), normal }
        }
        (_, other) => other,
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "a test may panic")]

    use proptest::prelude::*;

    use super::*;
    use crate::mechanics::Elastica;
    use crate::rig::Rig;

    fn fine(links: usize) -> Whisker {
        let mut whisker = Rig::default().whiskers.remove(0);
        whisker.shaft.links = links;
        whisker
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(48))]

        #[test]
        fn a_touch_of_a_fine_chain_is_that_of_the_elastica(
            share in 0.4..0.95_f64,
            radius in 0.0..0.02_f64,
            depth in 2e-3..25e-3_f64,
            is_left in any::<bool>(),
        ) {
            let (whisker, side) = (fine(400), if is_left { 1.0 } else { -1.0 });
            let centre = Point2::new(share * 0.1, side * (depth - radius - 0.125e-3));
            let touch = TouchMechanics::new(&whisker, 0.0).press(&Obstacle::Pin { centre, radius }, side);
            prop_assume!(touch.is_some_and(|touch| touch.contact_length < 0.0999));
            let touch = touch.unwrap();
            let elastica = Elastica::new(&whisker);
            let normal = touch.normal;
            let shape = elastica.solve_at(touch.contact_length, touch.base_angle, normal, &elastica.straight()).unwrap();
            let off = shape.contact_base - touch.axis_base;
            prop_assert!(off.norm() < 5e-6, "{off}");
            let on_pin = touch.axis_base - (radius + 0.125e-3) * unit(normal) - centre.coords;
            prop_assert!(on_pin.norm() < 1e-9, "{on_pin}");
        }

        #[test]
        fn the_change_of_a_touch_is_its_difference(
            x in 50e-3..104e-3_f64,
            depth in 3e-3..15e-3_f64,
            curvature in -0.4..0.4_f64,
            is_left in any::<bool>(),
        ) {
            let (whisker, side) = (fine(16), if is_left { 1.0 } else { -1.0 });
            let radius = 10e-3;
            let pin = |by: f64| Obstacle::Pin { centre: Point2::new(x, side * (depth + by - radius)), radius };
            let mechanics = |by: f64| {
                let mut whisker = whisker.clone();
                whisker.shaft.length += by;
                whisker.hinge.stiffness *= 1.0 + 10.0 * by;
                whisker.shaft.curvature = curvature;
                TouchMechanics::new(&whisker, 0.1)
            };
            let touch = mechanics(0.0).press(&pin(0.0), side);
            prop_assume!(touch.is_some());
            let (touch, by) = (touch.unwrap(), 1e-7);
            let moved = mechanics(by).near(&pin(by), &touch).unwrap();
            let change = TouchMechanics::change(&touch, [(&mechanics(0.0), &pin(0.0)), (&mechanics(by), &pin(by))]).unwrap();
            let difference = moved.base_angle - touch.base_angle;
            prop_assert!((change - difference).abs() < 1e-3 * difference.abs() + 1e-13, "{change} {difference}");
        }
    }
}
