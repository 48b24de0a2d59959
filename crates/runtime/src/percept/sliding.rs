//! The contact estimator `sliding`.
//!
//! Why: docs/decisions/contact-estimators.md#the-sliding-contact-is-tracked-by-a-kalman-filter.

use std::f64::consts::{FRAC_PI_2, PI};
use std::sync::Arc;

use nalgebra::{Matrix2, RowVector2, Vector2 as Column};

use crate::geometry::{Point2, Pose, Vector2, perpendicular, rotate, unit};
use crate::math;
use crate::rig::{Sensing, Whisker};
use crate::signal::Reading;

use super::base_angle::BaseAngle;
use super::contact::Contact;
use super::contact_estimator::ContactEstimator;
use super::pose_delay::Misfit;
use super::shaft_rest::ShaftRest;
use super::sliding_contact::{SHAFT_FIRST, SlidingContact};
use super::tip_bias::TipBias;
use super::tip_table::{TipPosition, TipTable};

/// Estimates the contact position of a sliding tip and the direction of the surface from base angles and poses.
///
/// A base angle alone leaves the tip position undetermined by the direction of the contact force. But the force is
/// perpendicular to the surface, along which the tip slides. An extended Kalman filter therefore estimates the position
/// and the surface direction together. Its errors decrease by a factor e per 10 mm or so of sliding, which is the
/// motion of the position along the normal per radian of direction. At a light contact the position hardly depends on
/// the direction, so the initial error is small.
///
/// Readings inconsistent with sliding, as when a tip slips off an edge, are ignored. When the whisker is at rest again,
/// it is assumed to touch a surface that continues from where the tip left, if that is possible.
#[derive(Debug, Clone)]
pub(super) struct Sliding {
    /// Tip positions by base angle and force direction, for bends to the left and for those to the right. They differ for
    /// a curved shaft.
    tables: [Arc<TipTable>; 2],
    /// Errors of the calibration, if there is one.
    bias: Option<TipBias>,
    /// Radius of the tip (m).
    tip_radius: f64,
    /// Length of the shaft (m).
    length: f64,
    /// Direction (rad, frame of the base) of the normal of a surface parallel to the heading, for a counter-clockwise
    /// bend.
    usual_normal: f64,
    /// Angle (rad) by which friction rotates the force from the normal.
    friction_angle: f64,
    /// Equilibrium base angle.
    angle: BaseAngle,
    /// Number of calm samples required before a new contact is estimated.
    calm_samples: usize,
    /// Number of successive calm samples so far.
    calm_for: usize,
    /// State of the estimator.
    state: State,
    /// Detection of shaft contacts.
    rest: ShaftRest,
    /// Position of the base (m, world frame) and direction of the undeflected shaft (rad) at the previous sample.
    base_before: Option<(Point2, f64)>,
    /// Sample rate (Hz).
    sample_rate: f64,
    /// Misfit of the newest reading.
    misfit: Option<Misfit>,
}

/// Velocity of the base (m/s, world frame) and its yaw rate (rad/s).
type Velocity = (Vector2, f64);

/// The state of the estimator.
#[derive(Debug, Clone, Copy)]
#[expect(clippy::large_enum_variant, reason = "each whisker has one state, and most of the time it slides")]
enum State {
    /// Not in contact.
    Free,
    /// In contact but not sliding. `left` is the last position of sliding, if any.
    Unsettled { left: Option<Point2>, bend_sign: f64 },
    /// Sliding in contact.
    Settled(SlidingContact),
}

/// Growth of the variance of the surface direction per path (rad²/m): a curve of 0.1 rad in 10 mm.
const BENDING: f64 = 1.0;
/// Growth of that variance per sample (rad²). It keeps the filter from becoming certain.
const UNREST: f64 = 1e-9;
/// Growth of the variance of the position along the normal per path (m²/m). Contacts differ in compliance, and a tip
/// that reverses lags to the other side. While a tip slides back, its errors grow as they otherwise decrease.
const GIVING: f64 = 1.5e-6;
/// Standard deviation (rad) of the surface direction at the first contact.
const FIRST_DIRECTION: f64 = 30.0 * PI / 180.0;
/// The same after an edge, where a surface may have any direction.
const DIRECTION_BEHIND_EDGE: f64 = FRAC_PI_2 / 2.0;
/// Distance (m) of a surface from the position from which it is assumed to continue: a constant, and a share of the
/// distance between the two.
const OFF_EDGE: (f64, f64) = (1e-4, 0.05);
/// Distance (m, standard deviation) from that position at which a bent whisker comes to rest.
const LANDED_WITHIN: f64 = 0.02;
/// Largest possible error of the tip (m) at which its position is recorded.
pub(super) const MAX_POSSIBLE_ERROR: f64 = 0.2e-3;
/// Innovations beyond this many standard deviations are inconsistent with sliding.
const GATE: f64 = 4.0;
/// Standard deviation (rad) of the surface direction below which a misfit is linear in a delay of poses.
const KNOWN_DIRECTION: f64 = 0.05;
/// Step (rad) and maximum number of steps by which the surface is rotated back until the mechanics have a tip position.
const TURN_BACK: f64 = 2.0 * PI / 180.0;
const TURNS_BACK: i32 = 3;
/// Time (s) for which the base angle must be calm.
const CALM_TIME: f64 = 0.02;

impl Sliding {
    /// Creates the estimator of `whisker`.
    pub(super) fn new(whisker: &Whisker, sensing: &Sensing) -> Self {
        #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "a small count")]
        let calm_samples = (CALM_TIME * sensing.sample_rate).ceil() as usize;
        let angle = BaseAngle::new(whisker, sensing);
        Self {
            rest: ShaftRest::new(whisker, angle.deviation),
            tables: [TipTable::shared(whisker), TipTable::shared(&whisker.mirrored())],
            bias: TipBias::new(whisker, sensing),
            tip_radius: whisker.shaft.radius_at(1.0),
            length: whisker.shaft.length,
            usual_normal: whisker.usual_normal(),
            friction_angle: math::atan(whisker.friction(sensing)),
            angle,
            calm_samples,
            calm_for: 0,
            state: State::Free,
            base_before: None,
            sample_rate: sensing.sample_rate,
            misfit: None,
        }
    }

    /// The contact, if the tip slides.
    fn sliding_contact(&self) -> Option<&SlidingContact> {
        if let State::Settled(contact) = &self.state { Some(contact) } else { None }
    }

    /// Tip positions for bends with this sign.
    fn table(&self, bend_sign: f64) -> &TipTable {
        let [left, right] = &self.tables;
        if bend_sign < 0.0 { right } else { left }
    }

    /// Standard deviation of the position (m, along the normal) that the errors of the calibration cause.
    fn bias(&self, contact: &SlidingContact, base: Pose) -> f64 {
        let Some(bias) = &self.bias else { return 0.0 };
        let (angle, _) = self.angle.value();
        let bend_sign = contact.bend_sign;
        let normal = (bend_sign * (contact.normal - base.heading)).rem_euclid(2.0 * PI);
        let force = normal - self.friction_angle;
        let tip = self.table(bend_sign).at(angle.abs(), force);
        tip.map_or(0.0, |tip| bias.deviation(angle.abs(), bend_sign, [force, normal], &tip))
    }

    /// The tip's centre (m, world frame) with its derivatives, for a surface whose normal has the direction `normal`
    /// (rad, world frame).
    fn tip(&self, angle: f64, base: Pose, normal: f64) -> Option<TipPosition> {
        let bend_sign = angle.signum();
        let force = (bend_sign * (normal - base.heading)).rem_euclid(2.0 * PI) - self.friction_angle;
        let position = self.table(bend_sign).at(angle.abs(), force)?;
        let rotated = |v: Column<f64>| rotate(Vector2::new(v.x, bend_sign * v.y), base.heading);
        Some(TipPosition {
            tip_base: rotated(position.tip_base) + base.position.coords,
            by_angle: bend_sign * rotated(position.by_angle),
            by_direction: bend_sign * rotated(position.by_direction),
        })
    }

    /// The first contact with an unknown surface.
    fn first(&self, angle: f64, base: Pose) -> State {
        let bend_sign = angle.signum();
        let normal = base.heading + bend_sign * self.usual_normal;
        let unsettled = State::Unsettled { left: None, bend_sign };
        let Some(tip) = self.tip(angle, base, normal) else { return unsettled };
        let contact = SlidingContact::new(bend_sign, &tip, normal, math::square(FIRST_DIRECTION));
        State::Settled(SlidingContact { first_variance: math::square(SHAFT_FIRST.0), ..contact })
    }

    /// One step of the filter while the tip slides, and the misfit of the reading.
    fn slide(
        &self,
        last: &SlidingContact,
        angle: f64,
        base: Pose,
        path: f64,
        velocity: Velocity,
    ) -> (State, Option<Misfit>) {
        let unsettled = State::Unsettled { left: Some(last.before[0]), bend_sign: last.bend_sign };
        // At a light contact, noise may rotate the surface beyond every force direction that bends the whisker. The
        // nearest possible direction is used if it is within the uncertainty.
        let deviation = math::max(last.covariance.m11, 0.0).sqrt();
        let turns = (0..=TURNS_BACK).map(|turns| f64::from(turns) * TURN_BACK).take_while(|turn| *turn <= deviation);
        let mut directions = turns.map(|turn| last.normal - last.bend_sign * turn);
        let found = directions.find_map(|direction| Some((direction, self.tip(angle, base, direction)?)));
        let Some((direction, tip)) = found else { return (unsettled, None) };
        let normal = unit(direction);
        let tangent = perpendicular(normal);
        let slid = (Point2::from(tip.tip_base) - last.centre).dot(&tangent);
        let along = last.centre + slid * tangent;
        // An error of the direction shifts the position along with it.
        let transition = Matrix2::new(1.0, 0.0, -slid, 1.0);
        let mut covariance = transition * last.covariance * transition.transpose();
        covariance.m11 += BENDING * path + UNREST;
        let mut considered = transition * last.considered * transition.transpose();
        considered.m11 += BENDING * path + UNREST;
        considered.m22 += GIVING * path;

        let innovation = normal.dot(&(Point2::from(tip.tip_base) - along));
        let measured = RowVector2::new(tip.by_direction.dot(&normal), -1.0);
        let noise =
            math::square(tip.by_angle.dot(&normal) * self.angle.correlated_deviation) + math::square(SMOOTHNESS);
        let variance = (measured * covariance * measured.transpose()).x + noise;
        let is_sliding = math::square(innovation) < math::square(GATE) * variance;
        let carried = carried(&tip, base, velocity);
        let by_delay = transition * Column::new(last.by_delay.0, normal.dot(&last.by_delay.1));
        let misfit_by_delay = (measured * by_delay).x - normal.dot(&carried);
        let has_direction = covariance.m11 < math::square(KNOWN_DIRECTION);
        let misfit = has_direction.then_some(Misfit { distance: innovation, by_delay: misfit_by_delay, variance });
        if !is_sliding {
            return (unsettled, misfit);
        }
        let gain = covariance * measured.transpose() / variance;
        let centre = along - gain.y * innovation * normal;
        let left = Matrix2::identity() - gain * measured;
        let by_delay = by_delay - gain * misfit_by_delay;
        let state = State::Settled(SlidingContact {
            centre,
            before: [last.before[1], last.before[2], last.centre],
            normal: direction - gain.x * innovation,
            covariance: covariance - variance * gain * gain.transpose(),
            considered: left * considered * left.transpose() + noise * gain * gain.transpose(),
            tip,
            by_delay: (by_delay.x, by_delay.y * normal - tangent.dot(&carried) * tangent),
            farthest: math::max(last.farthest, (centre - last.first).norm()),
            ..*last
        });
        (state, misfit)
    }

    /// The state of a whisker that comes to rest without having been free. It may be caught.
    fn come_to_rest(&self, left: Option<Point2>, angle: f64, base: Pose) -> State {
        let state = left.map_or_else(|| self.first(angle, base), |left| self.land(left, angle, base));
        match state {
            State::Settled(mut contact) => {
                contact.considered.m22 += math::square(CAUGHT);
                State::Settled(contact)
            }
            other => other,
        }
    }

    /// The state of a whisker that comes to rest after its tip left a surface at `left`, on a surface that continues
    /// from there.
    fn land(&self, left: Point2, angle: f64, base: Pose) -> State {
        let bend_sign = angle.signum();
        let unsettled = State::Unsettled { left: Some(left), bend_sign };
        let usual = base.heading + bend_sign * self.usual_normal;
        let Some(near) = self.tip(angle, base, usual) else { return unsettled };
        let off = math::hypot(OFF_EDGE.0, OFF_EDGE.1 * (near.tip_base - left.coords).norm());
        let direction_cost = |normal: f64| math::square((normal - usual) / DIRECTION_BEHIND_EDGE);
        // The tip, the distance of the surface through it from `left`, and the total squared misfit in standard
        // deviations, including that of the direction.
        let evaluate = |normal: f64| {
            let tip = self.tip(angle, base, normal)?;
            let displacement = tip.tip_base - left.coords;
            let offset = unit(normal).dot(&displacement);
            let cost = math::square(offset / off)
                + displacement.norm_squared() / math::square(LANDED_WITHIN)
                + direction_cost(normal);
            Some((tip, offset, cost))
        };
        // The search goes outwards from the usual direction on both sides, as long as the direction's own misfit is
        // below the best total.
        let mut nearest: Option<(f64, f64)> = None;
        for step in std::iter::once(0).chain((1..=LANDING_STEPS).flat_map(|steps| [-steps, steps])) {
            let normal = usual + f64::from(step) * LANDING_STEP;
            if nearest.is_none_or(|(_, least)| direction_cost(normal) <= least)
                && let Some((.., cost)) = evaluate(normal)
                && nearest.is_none_or(|(at, least)| cost.total_cmp(&least).then(normal.total_cmp(&at)).is_lt())
            {
                nearest = Some((normal, cost));
            }
        }
        let Some((mut normal, _)) = nearest else { return unsettled };
        let prior = math::square(DIRECTION_BEHIND_EDGE).recip();
        for _ in 0..LANDING_ITERATIONS {
            let Some((tip, offset, _)) = evaluate(normal) else { return unsettled };
            let slope = offset_slope(&tip, normal, left) / off;
            let displacement_slope = tip.by_direction / LANDED_WITHIN;
            let displacement = (tip.tip_base - left.coords) / LANDED_WITHIN;
            let gradient = slope * offset / off + displacement_slope.dot(&displacement) + (normal - usual) * prior;
            let step = gradient / (slope * slope + displacement_slope.norm_squared() + prior);
            normal -= step.clamp(-LANDING_STEP, LANDING_STEP);
        }
        let Some((tip, _, _)) = evaluate(normal) else { return unsettled };
        let slope = offset_slope(&tip, normal, left) / off;
        let displacement_slope = tip.by_direction / LANDED_WITHIN;
        let variance = (slope * slope + displacement_slope.norm_squared() + prior).recip();
        State::Settled(SlidingContact::new(bend_sign, &tip, normal, variance))
    }
}

impl ContactEstimator for Sliding {
    fn take(&mut self, reading: &Reading, base: Pose) {
        self.angle.take(reading.base_angle);
        let (angle, is_calm) = self.angle.value();
        self.calm_for = if is_calm { self.calm_for + 1 } else { 0 };
        let bend_sign = angle.signum();
        let path = self.base_before.map_or(0.0, |(position, heading)| {
            (base.position - position).norm() + self.length * (base.heading - heading).abs()
        });
        let velocity = self.base_before.map_or((Vector2::zeros(), 0.0), |(position, heading)| {
            ((base.position - position) * self.sample_rate, (base.heading - heading) * self.sample_rate)
        });
        self.base_before = Some((base.position, base.heading));
        self.misfit = None;
        if angle.abs() < self.angle.contact_threshold {
            self.state = State::Free;
            self.rest.end();
            return;
        }
        let is_new = self.sliding_contact().is_none();
        self.state = match self.state {
            State::Free if self.calm_for > 0 => self.first(angle, base),
            State::Settled(contact) if contact.bend_sign * bend_sign > 0.0 => {
                let (state, misfit) = self.slide(&contact, angle, base, path, velocity);
                self.misfit = misfit;
                state
            }
            State::Unsettled { left, bend_sign: before } if before * bend_sign > 0.0 => {
                if self.calm_for < self.calm_samples {
                    State::Unsettled { left, bend_sign }
                } else {
                    self.come_to_rest(left, angle, base)
                }
            }
            _ => State::Unsettled { left: None, bend_sign },
        };
        match &mut self.state {
            State::Settled(contact) => {
                if is_new {
                    // A new contact is where the tip is by the measured pose.
                    contact.by_delay.1 = -carried(&contact.tip, base, velocity);
                }
                let normal = (contact.bend_sign * (contact.normal - base.heading)).rem_euclid(2.0 * PI);
                self.rest.take(angle, base, path, contact.centre, normal);
            }
            _ => self.rest.interrupt(),
        }
    }

    fn misfit(&self) -> Option<Misfit> {
        self.misfit
    }

    fn interrupt(&mut self) {
        self.angle.clear();
        self.misfit = None;
        self.calm_for = 0;
        self.base_before = None;
        self.state = State::Free;
        self.rest.end();
    }

    fn set_noise(&mut self, noise: f64) {
        self.angle.set_noise(noise);
        self.rest.set_deviation(self.angle.deviation);
    }

    fn set_offset_deviation(&mut self, deviation: f64) {
        if let Some(bias) = &mut self.bias {
            bias.set_offset_deviation(deviation);
        }
    }

    fn contact(&mut self, _: f64, base: Pose) -> Option<Contact> {
        let contact = self.sliding_contact()?;
        Some(Contact {
            point_world: contact.centre - self.tip_radius * unit(contact.normal),
            covariance_world: contact.position_covariance(self.tip_radius, self.angle.deviation),
            deviation: contact.position_deviation(&contact.covariance),
            recorded_deviation: contact.position_deviation(&contact.considered),
            bias: self.bias(contact, base),
            is_recordable: self.rest.possible_error() < MAX_POSSIBLE_ERROR,
            contact_length: self.length,
        })
    }

    fn contact_at(&self, base_angle: f64, yaw: f64) -> Option<Vector2> {
        let contact = self.sliding_contact()?;
        let bend_sign = base_angle.signum();
        // A bend to the other side is the mirror image.
        let normal = contact.bend_sign * (contact.normal - yaw);
        let force = normal.rem_euclid(2.0 * PI) - self.friction_angle;
        let tip = self.table(bend_sign).at(base_angle.abs(), force)?.tip_base - self.tip_radius * unit(normal);
        Some(Vector2::new(tip.x, bend_sign * tip.y))
    }
}

/// Standard deviation (m) of the tip position with exact readings.
const SMOOTHNESS: f64 = 5e-6;
/// Directions that are tried for a surface after an edge: every 3° up to 105° to both sides.
const LANDING_STEP: f64 = 3.0 * PI / 180.0;
const LANDING_STEPS: i32 = 35;
/// Standard deviation (m) of the tip of a whisker that may be caught.
const CAUGHT: f64 = 5e-3;
/// Steps of the Gauss-Newton method from the best of these directions.
const LANDING_ITERATIONS: usize = 6;

/// Velocity (m/s) with which the tip's centre by the mechanics is carried along with its base. A delay of poses shifts the
/// centre back by as much per second.
fn carried(tip: &TipPosition, base: Pose, (velocity, yaw_rate): Velocity) -> Vector2 {
    let arm = tip.tip_base - base.position.coords;
    velocity + yaw_rate * (perpendicular(arm) - tip.by_direction)
}

/// Rate (m/rad) at which a surface through the tip moves away from `left` when its normal rotates.
fn offset_slope(tip: &TipPosition, normal: f64, left: Point2) -> f64 {
    let normal = unit(normal);
    tip.by_direction.dot(&normal) + perpendicular(normal).dot(&(tip.tip_base - left.coords))
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;
    use crate::mechanics::Elastica;
    use crate::rig::Rig;

    /// A reading of a whisker that slides along the wall `y = 0` with its tip, and the pose of its base, at a time (s).
    fn on_wall(whisker: &Whisker, time: f64, (press, turn, speed): (f64, f64, f64)) -> Option<(f64, Pose)> {
        let shaft = &whisker.shaft;
        let force = (1.2 + press * math::sin(12.0 * time)) * shaft.bending_stiffness() / math::square(shaft.length);
        let heading = turn * math::sin(3.0 * time);
        let direction = 105.0 * PI / 180.0 - heading;
        let shape = Elastica::new(whisker).under(shaft.length, direction, force)?;
        // The wall's normal points to the whisker, so the world is turned until it does.
        let turned = heading - 105.0 * PI / 180.0 + FRAC_PI_2;
        let tip = Point2::new(-speed * time, shaft.radius_at(1.0));
        Some((shape.base_angle, Pose { position: tip - rotate(shape.tip_base, turned), heading: turned }))
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(30))]

        /// The oracle is a second estimator whose poses are late.
        #[test]
        fn a_misfit_grows_with_the_delay_of_poses_as_is_said(press in -0.4..0.4_f64, turn in -0.15..0.15_f64, speed in 0.02..0.06_f64) {
            let whisker = Rig::default().whiskers.remove(0);
            let sensing = Rig::default().sensing;
            let [mut exact, mut late] = [(); 2].map(|()| Sliding::new(&whisker, &sensing));
            let (delay, mut worst, mut largest) = (1e-4, 0.0_f64, 0.0_f64);
            for index in 3..600 {
                let time = f64::from(index) / 300.0;
                let at = |time: f64| on_wall(&whisker, time, (press, turn, speed));
                let (Some((base_angle, base)), Some((_, before))) = (at(time), at(time - delay)) else { continue };
                // The whisker touches in the second step, so that its velocity is known.
                let base_angle = if index == 3 { 0.0 } else { base_angle };
                let reading = Reading { base_angle, ..Reading::default() };
                exact.take(&reading, base);
                late.take(&reading, before);
                // Earlier the surface is not known well, so that a misfit is not linear in the delay.
                if let (true, Some(exact), Some(late)) = (index > 300, exact.misfit(), late.misfit()) {
                    worst = math::max(worst, ((late.distance - exact.distance) / delay - exact.by_delay).abs());
                    largest = math::max(largest, exact.by_delay.abs());
                }
            }
            prop_assert!(largest > 0.01 * press.abs(), "{largest} m/s");
            prop_assert!(worst < 0.25 * largest + 1e-4, "{worst} m/s of {largest} m/s");
        }
    }
}
