//! Shape of a whisker's shaft.

use nalgebra::Vector2;

use crate::run::{TickRecord, Trace};
use vibrissa_runtime::mechanics::{Elastica, ShaftShape};
use vibrissa_runtime::rig::Whisker;
use vibrissa_world::geometry::{Point2, rotate, unit};

/// Directions of the force (degrees, frame of the base) among which the one is searched that brings the tip to its
/// estimated position.
const DIRECTIONS: (f64, f64) = (60.0, 210.0);
/// Step sizes of the search (degrees). Each search is within one step of the previous result. The last one corresponds
/// to 0.1 mm at the tip.
const STEPS: [f64; 3] = [10.0, 2.0, 0.5];

/// The shape of a `whisker`'s shaft in a tick as a cubic curve: its ends and, between them, its control points (body
/// frame). It is straight without a known bend.
pub(super) fn shaft_body(whisker: &Whisker, trace: &Trace, tick: &TickRecord) -> [Point2; 4] {
    let bend = bend(whisker, trace, tick).unwrap_or_else(|| Elastica::new(whisker).straight());
    curve_base(whisker, &bend).map(|position| whisker.base_body + rotate(position, whisker.direction_body))
}

/// The same in the frame of the base. A uniform shaft under a small force at its tip has exactly a cubic shape.
fn curve_base(whisker: &Whisker, bend: &ShaftShape) -> [Vector2<f64>; 4] {
    let third = whisker.shaft.length / 3.0;
    let tip = bend.tip_base;
    [Vector2::zeros(), third * unit(bend.base_angle), tip - third * unit(bend.tip_angle), tip]
}

/// The elastica with the measured base angle whose tip is nearest to the estimated position. `None` without contact.
fn bend(whisker: &Whisker, trace: &Trace, tick: &TickRecord) -> Option<ShaftShape> {
    let index = trace.whiskers.iter().position(|name| *name == whisker.name)?;
    let (base_angle, contact) = (tick.whiskers[index].deflection, tick.whiskers[index].contact);
    if !contact.is_touching || base_angle == 0.0 || !base_angle.is_finite() {
        return None;
    }
    let position = contact.tip_world.filter(|tip| tip.coords.iter().all(|coordinate| coordinate.is_finite()));
    let position_base =
        position.map(|tip| rotate(tick.body.point_from_world(tip) - whisker.base_body, -whisker.direction_body));
    bend_to(whisker, base_angle, position_base)
}

/// The same for a base angle (rad) and a contact position (m, frame of the base). Without a position the surface is
/// assumed to be parallel to the heading.
fn bend_to(whisker: &Whisker, base_angle: f64, contact_base: Option<Vector2<f64>>) -> Option<ShaftShape> {
    if base_angle < 0.0 {
        let mirrored = contact_base.map(|position| Vector2::new(position.x, -position.y));
        return bend_to(whisker, -base_angle, mirrored).map(|bend| bend.mirrored());
    }
    let elastica = Elastica::new(whisker);
    let solve = |direction: f64, guess: &ShaftShape| elastica.solve_tip(base_angle, direction, guess);
    let Some(contact_base) = contact_base else {
        return solve(whisker.usual_normal(), &elastica.straight());
    };
    let tip_radius = whisker.shaft.radius_at(1.0);
    let miss = |bend: &ShaftShape| (bend.tip_base - tip_radius * unit(bend.force_direction) - contact_base).norm();
    let (mut nearest, mut between) = (None, DIRECTIONS);
    for step in STEPS {
        let mut guess = nearest.unwrap_or_else(|| elastica.straight());
        let count = ((between.1 - between.0) / step).round();
        for direction in std::iter::successors(Some(0.0), |k| Some(k + 1.0)).take_while(|k| *k <= count) {
            let direction = (between.0 + step * direction).to_radians();
            let Some(bend) = solve(direction, &guess) else { continue };
            guess = bend;
            if nearest.is_none_or(|nearest| miss(&bend) < miss(&nearest)) {
                nearest = Some(bend);
            }
        }
        let middle = nearest?.force_direction.to_degrees();
        between = (middle - step, middle + step);
    }
    nearest
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "a test may panic")]
    use super::*;
    use vibrissa_runtime::math;
    use vibrissa_runtime::mechanics::ShaftChain;
    use vibrissa_runtime::rig::Rig;

    /// The ends of a chain's links for the base angle of `bend` and a force in the same direction.
    fn chain(whisker: &Whisker, bend: &ShaftShape) -> Vec<Vector2<f64>> {
        let shaft = &whisker.shaft;
        let stiffnesses: Vec<f64> = shaft.joint_stiffnesses().collect();
        let solved = ShaftChain::new(whisker);
        let near = solved.at_rest();
        let steps = 20;
        let found = (1..=steps).try_fold(near, |near, step| {
            let angle = bend.base_angle * f64::from(step) / f64::from(steps);
            let guess = if step == 1 {
                let force = angle * whisker.hinge.stiffness / (shaft.length * math::sin(bend.force_direction));
                vibrissa_runtime::mechanics::Equilibrium { force, ..near }
            } else {
                near
            };
            solved.solve(angle, bend.force_direction, &guess)
        });
        let found = found.unwrap();
        let (force, mut angle, mut moment) = (found.force * unit(bend.force_direction), found.tip_angle, 0.0);
        let mut positions = vec![found.tip_base];
        for stiffness in stiffnesses.iter().rev() {
            let link = shaft.link_length() * unit(angle);
            positions.push(positions[positions.len() - 1] - link);
            moment += link.x * force.y - link.y * force.x;
            angle -= moment / stiffness;
        }
        positions
    }

    fn on_curve([a, b, c, d]: [Vector2<f64>; 4], t: f64) -> Vector2<f64> {
        let s = 1.0 - t;
        s * s * s * a + 3.0 * s * s * t * b + 3.0 * s * t * t * c + t * t * t * d
    }

    #[test]
    fn the_curve_goes_along_the_chain_that_is_simulated() {
        let whisker = &Rig::default().whiskers[0];
        for (base_angle, direction) in [(1e-4_f64, 90.0_f64), (3e-4, 105.0), (3e-4, 150.0), (8e-4, 105.0), (1e-3, 90.0)]
        {
            let straight = Elastica::new(whisker).straight();
            let bend = Elastica::new(whisker).solve_tip(base_angle, direction.to_radians(), &straight).unwrap();
            let curve = curve_base(whisker, &bend);
            for position in chain(whisker, &bend) {
                let distances = (0..=400).map(|k| (on_curve(curve, f64::from(k) / 400.0) - position).norm());
                let distance = distances.fold(f64::INFINITY, f64::min);
                assert!(distance < 1.5e-3, "{base_angle}, {direction}: {distance} m at {position}");
            }
        }
    }

    #[test]
    fn the_tip_comes_to_where_it_was_perceived_on_either_side() {
        let whisker = &Rig::default().whiskers[0];
        let elastica = Elastica::new(whisker);
        for direction in [80.0_f64, 100.0, 127.0, 160.0] {
            let bend = elastica.solve_tip(3e-4, direction.to_radians(), &elastica.straight()).unwrap();
            let contact = bend.tip_base - whisker.shaft.radius_at(1.0) * unit(bend.force_direction);
            let found = bend_to(whisker, 3e-4, Some(contact)).unwrap();
            assert!((found.tip_base - bend.tip_base).norm() < 2e-4, "{direction}");
            let right = bend_to(whisker, -3e-4, Some(Vector2::new(contact.x, -contact.y))).unwrap();
            assert_eq!(right, found.mirrored());
        }
    }
}
