//! The contact of a tip that slides along a surface.

use std::f64::consts::{FRAC_PI_2, PI};
use std::sync::Arc;

use nalgebra::{Matrix2, RowVector2, Vector2 as Column};

use crate::geometry::{Point2, Pose, Vector2, perpendicular, rotate, unit};
use crate::rig::{Sensing, Whisker};
use crate::signal::Reading;

use super::base_angle::BaseAngle;
use super::contact::{CONTACT_DEVIATION, Contact};
use super::contact_estimator::ContactEstimator;
use super::shaft_rest::ShaftRest;
use super::tip_table::{TipPosition, TipTable};

/// Estimates where a tip touches, and how the surface goes there, from base angles and poses.
///
/// A base angle alone leaves the tip's place open by the direction of the contact force. But a tip slides where the surface goes, and
/// the surface is square to the force: so what is estimated, from reading to reading, is the place and the surface's direction
/// together, by an extended Kalman filter. Its errors fade while the tip slides, by a factor e for every 10 mm or so: that is by how
/// much the place moves along the normal when the direction turns by one radian. At a light touch the place hardly
/// depends on the direction, so that little is wrong to begin with.
///
/// Readings that do not go together with sliding, as when a tip springs off an edge, are left out; when the whisker has come to rest, it is
/// taken to touch what goes on from where the tip left, if it can be.
#[derive(Debug, Clone)]
pub(super) struct Sliding {
    table: Arc<TipTable>,
    tip_radius: f64,
    length: f64,
    /// Direction (rad, frame of the base) of the normal of a surface parallel to the heading, for a counter-clockwise bend.
    usual_normal: f64,
    /// By how much friction turns the force from the normal (rad).
    friction_angle: f64,
    angle: BaseAngle,
    contact_threshold: f64,
    /// Samples for which the base angle must have been calm before a contact is estimated anew.
    calm_samples: usize,
    /// For how many samples it has been.
    calm_for: usize,
    state: State,
    rest: ShaftRest,
    /// Where the base was (m, world frame), and the undeflected shaft's direction (rad), one sample before.
    base_before: Option<(Point2, f64)>,
}

#[derive(Debug, Clone, Copy)]
enum State {
    Free,
    /// Touching, but not sliding; with where the tip slid last, if it did.
    Unsettled {
        left: Option<Point2>,
        bend_sign: f64,
    },
    Settled(SlidingContact),
}

/// The contact of a sliding tip.
#[derive(Debug, Clone, Copy)]
struct SlidingContact {
    /// Which way the whisker is bent: +1 counter-clockwise, −1 clockwise.
    bend_sign: f64,
    /// The tip's centre (m, world frame), and where it was one, two and three samples before.
    centre: Point2,
    before: [Point2; 3],
    /// Direction of the surface's normal (rad, world frame), which points to the whisker's side.
    normal: f64,
    /// Of the normal's direction (rad) and the centre's place along the normal (m).
    covariance: Matrix2<f64>,
    /// The same with what the filter's gain does not regard: that contacts give more or less.
    considered: Matrix2<f64>,
    /// The tip by the mechanics, for its changes with the base angle and the normal's direction.
    tip: TipPosition,
    /// Where it came to touch (m, world frame), how far it has been from there since (m), and the variance of the place (m²) by which it
    /// may not have been the tip that touched there.
    first: Point2,
    farthest: f64,
    first_variance: f64,
}

/// Variance of a surface's direction for every way along it (rad²/m): a bend of 0.1 rad within 10 mm.
const BENDING: f64 = 1.0;
/// The same for every sample (rad²): what keeps the filter from being sure for ever.
const UNREST: f64 = 1e-9;
/// Variance of the place along the normal for every way along the surface (m²/m): contacts give more or less, and a tip that turns round
/// drags the other way. While a tip slides back its errors grow as they fade otherwise.
const GIVING: f64 = 1.5e-6;
/// Standard deviation (rad) of a surface's direction at the first touch.
const FIRST_DIRECTION: f64 = 30.0 * PI / 180.0;
/// The same behind an edge, where a surface may go anywhere.
const DIRECTION_BEHIND_EDGE: f64 = FRAC_PI_2 / 2.0;
/// Standard deviation of a centre's place at a light touch (m).
const FIRST_POSITION: f64 = 2e-5;
/// How far off the place of a tip may be (m, standard deviation) where it came to touch and nothing was known of the surface: an edge may
/// have met the shaft before it. And the way of the tip (m) on which that variance falls by a factor e, as it comes to the edge.
const SHAFT_FIRST: (f64, f64) = (2.7e-4, 1.5e-3);
/// How far a surface may lie off the place from which it is taken to go on (m), and for every way between.
const OFF_EDGE: (f64, f64) = (1e-4, 0.05);
/// How far from there a whisker that stays bent comes to rest (m, standard deviation).
const LANDED_WITHIN: f64 = 0.02;
/// The greatest doubt about the tip (m) with which its place is recorded.
const MOST_DOUBT: f64 = 0.2e-3;
/// An innovation farther off than this many standard deviations is not sliding.
const GATE: f64 = 4.0;
/// Steps by which a surface is turned back (rad) to where the mechanics have a tip, and how many there may be.
const TURN_BACK: f64 = 2.0 * PI / 180.0;
const TURNS_BACK: i32 = 3;
/// Time (s) for which the base angle must have been calm.
const CALM_TIME: f64 = 0.02;

impl Sliding {
    pub(super) fn new(whisker: &Whisker, table: Arc<TipTable>, sensing: &Sensing) -> Self {
        #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "a small count")]
        let calm_samples = (CALM_TIME * sensing.sample_rate).ceil() as usize;
        let angle = BaseAngle::new(whisker, sensing);
        Self {
            rest: ShaftRest::new(whisker, angle.deviation),
            table,
            tip_radius: whisker.shaft.radius_at(1.0),
            length: whisker.shaft.length,
            usual_normal: whisker.usual_normal(),
            friction_angle: sensing.friction.atan(),
            angle,
            contact_threshold: sensing.contact_threshold,
            calm_samples,
            calm_for: 0,
            state: State::Free,
            base_before: None,
        }
    }

    /// The contact, while the tip slides.
    fn sliding_contact(&self) -> Option<&SlidingContact> {
        if let State::Settled(contact) = &self.state { Some(contact) } else { None }
    }

    /// Where the tip's centre is (m, world frame), with its changes, on a surface whose normal has a direction (rad, world frame).
    fn tip(&self, angle: f64, base: Pose, normal: f64) -> Option<TipPosition> {
        let bend_sign = angle.signum();
        let force = (bend_sign * (normal - base.heading)).rem_euclid(2.0 * PI) - self.friction_angle;
        let position = self.table.at(angle.abs(), force)?;
        let turned = |v: Column<f64>| rotate(Vector2::new(v.x, bend_sign * v.y), base.heading);
        Some(TipPosition {
            tip_base: turned(position.tip_base) + base.position.coords,
            by_angle: bend_sign * turned(position.by_angle),
            by_direction: bend_sign * turned(position.by_direction),
        })
    }

    /// The first touch of a surface of which nothing is known.
    fn first(&self, angle: f64, base: Pose) -> State {
        let bend_sign = angle.signum();
        let normal = base.heading + bend_sign * self.usual_normal;
        let unsettled = State::Unsettled { left: None, bend_sign };
        let Some(tip) = self.tip(angle, base, normal) else { return unsettled };
        let contact = SlidingContact::begun(bend_sign, &tip, normal, FIRST_DIRECTION.powi(2));
        State::Settled(SlidingContact { first_variance: SHAFT_FIRST.0.powi(2), ..contact })
    }

    /// One step of sliding.
    fn slide(&self, last: &SlidingContact, angle: f64, base: Pose, path: f64) -> State {
        let unsettled = State::Unsettled { left: Some(last.before[0]), bend_sign: last.bend_sign };
        // At a light touch, noise may turn the surface farther than any force comes from that bends the whisker: it is as far off as it
        // has to be, if it may be.
        let deviation = last.covariance.m11.max(0.0).sqrt();
        let turns = (0..=TURNS_BACK).map(|turns| f64::from(turns) * TURN_BACK).take_while(|turn| *turn <= deviation);
        let mut directions = turns.map(|turn| last.normal - last.bend_sign * turn);
        let found = directions.find_map(|direction| Some((direction, self.tip(angle, base, direction)?)));
        let Some((direction, tip)) = found else { return unsettled };
        let normal = unit(direction);
        let tangent = perpendicular(normal);
        let slid = (Point2::from(tip.tip_base) - last.centre).dot(&tangent);
        let along = last.centre + slid * tangent;
        // A direction that is off takes the place along with it.
        let transition = Matrix2::new(1.0, 0.0, -slid, 1.0);
        let mut covariance = transition * last.covariance * transition.transpose();
        covariance.m11 += BENDING * path + UNREST;
        let mut considered = transition * last.considered * transition.transpose();
        considered.m11 += BENDING * path + UNREST;
        considered.m22 += GIVING * path;

        let innovation = normal.dot(&(Point2::from(tip.tip_base) - along));
        let measured = RowVector2::new(tip.by_direction.dot(&normal), -1.0);
        let noise = (tip.by_angle.dot(&normal) * self.angle.correlated_deviation).powi(2) + SMOOTHNESS.powi(2);
        let variance = (measured * covariance * measured.transpose()).x + noise;
        let is_sliding = innovation.powi(2) < GATE.powi(2) * variance;
        if !is_sliding {
            return unsettled;
        }
        let gain = covariance * measured.transpose() / variance;
        let centre = along - gain.y * innovation * normal;
        let left = Matrix2::identity() - gain * measured;
        State::Settled(SlidingContact {
            centre,
            before: [last.before[1], last.before[2], last.centre],
            normal: direction - gain.x * innovation,
            covariance: covariance - variance * gain * gain.transpose(),
            considered: left * considered * left.transpose() + noise * gain * gain.transpose(),
            tip,
            farthest: last.farthest.max((centre - last.first).norm()),
            ..*last
        })
    }

    /// Coming to rest without having been free: the whisker may be caught.
    fn come_to_rest(&self, left: Option<Point2>, angle: f64, base: Pose) -> State {
        let state = left.map_or_else(|| self.first(angle, base), |left| self.land(left, angle, base));
        match state {
            State::Settled(mut contact) => {
                contact.considered.m22 += CAUGHT.powi(2);
                State::Settled(contact)
            }
            other => other,
        }
    }

    /// Coming to rest, after the tip left a surface at `left`, on what goes on from there.
    fn land(&self, left: Point2, angle: f64, base: Pose) -> State {
        let bend_sign = angle.signum();
        let unsettled = State::Unsettled { left: Some(left), bend_sign };
        let usual = base.heading + bend_sign * self.usual_normal;
        let Some(near) = self.tip(angle, base, usual) else { return unsettled };
        let off = OFF_EDGE.0.hypot(OFF_EDGE.1 * (near.tip_base - left.coords).norm());
        let turned = |normal: f64| ((normal - usual) / DIRECTION_BEHIND_EDGE).powi(2);
        // The tip, and how far the surface through it and the tip itself are from where the tip left, in standard deviations and with the
        // direction's.
        let judged = |normal: f64| {
            let tip = self.tip(angle, base, normal)?;
            let gone = tip.tip_base - left.coords;
            let miss = unit(normal).dot(&gone);
            let apart = (miss / off).powi(2) + gone.norm_squared() / LANDED_WITHIN.powi(2) + turned(normal);
            Some((tip, miss, apart))
        };
        // From the usual direction on either way, as far as one may still be nearer than the nearest so far.
        let mut nearest: Option<(f64, f64)> = None;
        for step in std::iter::once(0).chain((1..=LANDING_STEPS).flat_map(|steps| [-steps, steps])) {
            let normal = usual + f64::from(step) * LANDING_STEP;
            if nearest.is_none_or(|(_, least)| turned(normal) <= least)
                && let Some((.., apart)) = judged(normal)
                && nearest.is_none_or(|(at, least)| apart.total_cmp(&least).then(normal.total_cmp(&at)).is_lt())
            {
                nearest = Some((normal, apart));
            }
        }
        let Some((mut normal, _)) = nearest else { return unsettled };
        let prior = DIRECTION_BEHIND_EDGE.powi(-2);
        for _ in 0..LANDING_ITERATIONS {
            let Some((tip, miss, _)) = judged(normal) else { return unsettled };
            let slope = miss_slope(&tip, normal, left) / off;
            let going = tip.by_direction / LANDED_WITHIN;
            let gone = (tip.tip_base - left.coords) / LANDED_WITHIN;
            let gradient = slope * miss / off + going.dot(&gone) + (normal - usual) * prior;
            let step = gradient / (slope * slope + going.norm_squared() + prior);
            normal -= step.clamp(-LANDING_STEP, LANDING_STEP);
        }
        let Some((tip, _, _)) = judged(normal) else { return unsettled };
        let slope = miss_slope(&tip, normal, left) / off;
        let going = tip.by_direction / LANDED_WITHIN;
        let variance = (slope * slope + going.norm_squared() + prior).recip();
        State::Settled(SlidingContact::begun(bend_sign, &tip, normal, variance))
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
        self.base_before = Some((base.position, base.heading));
        if angle.abs() < self.contact_threshold {
            self.state = State::Free;
            self.rest.end();
            return;
        }
        self.state = match self.state {
            State::Free if self.calm_for > 0 => self.first(angle, base),
            State::Settled(contact) if contact.bend_sign * bend_sign > 0.0 => self.slide(&contact, angle, base, path),
            State::Unsettled { left, bend_sign: before } if before * bend_sign > 0.0 => {
                if self.calm_for < self.calm_samples {
                    State::Unsettled { left, bend_sign }
                } else {
                    self.come_to_rest(left, angle, base)
                }
            }
            _ => State::Unsettled { left: None, bend_sign },
        };
        match self.state {
            State::Settled(contact) => {
                let normal = (contact.bend_sign * (contact.normal - base.heading)).rem_euclid(2.0 * PI);
                self.rest.take(angle, base, path, contact.centre, normal);
            }
            _ => self.rest.interrupt(),
        }
    }

    fn interrupt(&mut self) {
        self.angle.clear();
        self.calm_for = 0;
        self.base_before = None;
        self.state = State::Free;
        self.rest.end();
    }

    fn contact(&mut self, _: f64, _: Pose) -> Option<Contact> {
        let contact = self.sliding_contact()?;
        Some(Contact {
            point_world: contact.centre - self.tip_radius * unit(contact.normal),
            covariance_world: contact.position_covariance(self.tip_radius, self.angle.deviation),
            deviation: contact.position_deviation(&contact.covariance),
            recorded_deviation: contact.position_deviation(&contact.considered),
            is_recordable: self.rest.doubt() < MOST_DOUBT,
            contact_length: self.length,
        })
    }

    fn contact_at(&self, base_angle: f64, yaw: f64) -> Option<Vector2> {
        let contact = self.sliding_contact()?;
        let bend_sign = base_angle.signum();
        // On the other side of the shaft it would be the mirror image.
        let normal = contact.bend_sign * (contact.normal - yaw);
        let force = normal.rem_euclid(2.0 * PI) - self.friction_angle;
        let tip = self.table.at(base_angle.abs(), force)?.tip_base - self.tip_radius * unit(normal);
        Some(Vector2::new(tip.x, bend_sign * tip.y))
    }
}

/// What is left of a tip's place (m) even when readings are exact.
const SMOOTHNESS: f64 = 5e-6;
/// Directions that are tried for a surface behind an edge: every 3° up to 105° either way.
const LANDING_STEP: f64 = 3.0 * PI / 180.0;
const LANDING_STEPS: i32 = 35;
/// How far off a tip may be (m, standard deviation) whose whisker may be caught.
const CAUGHT: f64 = 5e-3;
/// Steps of the Gauss-Newton method from the best of them.
const LANDING_ITERATIONS: usize = 6;

/// How fast a surface through the tip moves away from `left` when its normal turns (m/rad).
fn miss_slope(tip: &TipPosition, normal: f64, left: Point2) -> f64 {
    let normal = unit(normal);
    tip.by_direction.dot(&normal) + perpendicular(normal).dot(&(tip.tip_base - left.coords))
}

impl SlidingContact {
    /// The contact of a tip that has just come to touch, with the direction of the normal (rad, world frame) and its variance (rad²).
    fn begun(bend_sign: f64, tip: &TipPosition, normal: f64, variance: f64) -> Self {
        let centre = Point2::from(tip.tip_base);
        // The place goes along with the direction.
        let slope = tip.by_direction.dot(&unit(normal));
        let covariance = variance * Matrix2::new(1.0, slope, slope, slope * slope)
            + Matrix2::new(0.0, 0.0, 0.0, FIRST_POSITION.powi(2));
        let before = [centre; 3];
        Self {
            bend_sign,
            centre,
            before,
            normal,
            covariance,
            considered: covariance,
            tip: *tip,
            first: centre,
            farthest: 0.0,
            first_variance: 0.0,
        }
    }

    /// Standard deviation of the place along the normal (m), by a covariance as the contact's own.
    fn position_deviation(&self, covariance: &Matrix2<f64>) -> f64 {
        let first = self.first_variance * (-self.farthest / SHAFT_FIRST.1).exp();
        (covariance.m22.max(0.0) + first).sqrt().hypot(CONTACT_DEVIATION)
    }

    /// Covariance of the place touched (m², world frame) with a tip of this radius (m), when the base angle may be off by
    /// `angle_deviation` (rad). Along the surface the place goes by what base angle and direction tell.
    fn position_covariance(&self, tip_radius: f64, angle_deviation: f64) -> Matrix2<f64> {
        let normal = unit(self.normal);
        let tangent = perpendicular(normal);
        let by_direction = self.tip.by_direction.dot(&tangent) - tip_radius;
        let along =
            by_direction.powi(2) * self.covariance.m11 + (self.tip.by_angle.dot(&tangent) * angle_deviation).powi(2);
        let both = by_direction * self.covariance.m12;
        along * tangent * tangent.transpose()
            + both * (tangent * normal.transpose() + normal * tangent.transpose())
            + self.position_deviation(&self.covariance).powi(2) * normal * normal.transpose()
    }
}
