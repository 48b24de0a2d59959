//! The procedure that calibrates an array by touches of a known pin.

use vibrissa_runtime::calibration::{
    FreeMotion, PlannedTouch, Stroke, TouchFit, TouchNoise, TouchPlan, TouchReading, TouchRefusal,
};
use vibrissa_runtime::math;
use vibrissa_runtime::mechanics::Obstacle;
use vibrissa_runtime::rig::{Rig, Whisker};

use std::f64::consts::{PI, TAU};

use super::array_pilot::{ArrayPilot, Rest, SETTLING};
use super::creep::{Pressed, damping};
use super::pluck::Pluck;
use super::sway::{Shaken, first_mode};
use super::whisker_touches::WhiskerTouches;
use vibrissa_world::geometry::{Point2, Pose, Vector2, perpendicular, rotate, turn_between, unit};
use vibrissa_world::world::{Fault, World};

/// A round pin at a known position.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Pin {
    /// Position of the axis (m, world frame).
    pub centre: Point2,
    /// Radius (m).
    pub radius: f64,
}

/// When the touches of an array end.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct TouchLimits {
    /// Maximum number of touches of a whisker.
    pub touches: usize,
    /// Time for all whiskers (s).
    pub time: f64,
    /// Standard deviation of tips (m) at which a whisker is calibrated.
    pub deviation: f64,
}

impl Default for TouchLimits {
    fn default() -> Self {
        Self { touches: 20, time: 300.0, deviation: 0.04e-3 }
    }
}

/// Distance (m) of the pin from a straight whisker that passes it. It exceeds the tolerances of the array.
pub(super) const CLEARANCE: f64 = 8e-3;
/// Share of the expected base angle below which the whisker has slipped off the pin.
const SLIPPED: f64 = 0.3;
/// Change of the reading in the air (rad) from touch to touch that is no drift.
const MOVED: f64 = 4e-6;
/// Number of touches of a whisker that end with a slide of the pin, and the least distance (m) of the pin from
/// the tip.
const STROKES: usize = 3;
const STROKE_ROOM: f64 = 15e-3;
/// Speeds (m/s) of these slides, and the path (m) over which their readings are averaged. Two speeds tell friction from a delay.
const STROKE_SPEEDS: [f64; STROKES] = [1e-3, 4e-3, 1e-3];
const STROKE_PATH: f64 = 2e-3;
/// Share of the deflection by which the pin swings back and forth while it presses the whisker, and the time (s) of a swing. A whisker
/// with a damping up to `(1 - SWING) SWING_TIME / (π SWING)`, 1.5 s, stays at the pin.
const SWING: f64 = 0.3;
const SWING_TIME: f64 = 2.0;
/// Speed (m/s) at which the pin leaves the tip, and the time (s) in the air after that.
const RELEASE_SPEED: f64 = 40e-3;
const RELEASED: f64 = 3.0;
/// Largest share of the motion of a swinging whisker that is not in its first mode.
const MOST_MISFIT: f64 = 0.05;
/// Frequency (Hz) at which the platform shakes a whisker that creeps, its speed (m/s), and the number of periods. A platform with slow
/// servos can still follow, and four times the frequency is the slowest first mode.
const SHAKE_RATE: f64 = 1.0;
const SHAKE_SPEED: f64 = 0.1;
const SHAKES: f64 = 3.0;
/// Number of touches without a response after which the whisker is given up.
const HOPELESS: usize = 4;
/// Time (s) of the last motions of a touch and of the motion in the air, for which some of the limit is left.
const LAST: f64 = 13.0 + 3.0 * SWING_TIME + SHAKES / SHAKE_RATE;
/// Standard deviation of the mechanics as a position (m), and of a reading that is not due to noise (rad).
const MODEL_POSITION: f64 = 1e-5;
const MODEL_ANGLE: f64 = 2e-8;
/// Expected standard deviation of a reading relative to the air (rad), for the plan.
pub(super) const EXPECTED_DEVIATION: f64 = 1e-7;

/// Calibrates all whiskers of an array one after the other. `rig` is the assumed array. The platform starts at rest in
/// `world`, with its whiskers in the air.
///
/// # Errors
/// [`Fault`] if the simulation can no longer be trusted.
pub fn touch_pin(
    world: &mut dyn World,
    rig: &Rig,
    pin: Pin,
    limits: &TouchLimits,
) -> Result<Vec<WhiskerTouches>, Fault> {
    let mut pilot = ArrayPilot::new(world, rig)?;
    let around = Around::of(rig, pin);
    let mut results = Vec::with_capacity(rig.whiskers.len());
    for index in 0..rig.whiskers.len() {
        let left = rig.whiskers.len() - index;
        let until = pilot.time() + (limits.time - pilot.time()) / left as f64;
        around.bring_pin(&mut pilot, pin, tip_body(&rig.whiskers[index]))?;
        results.push(Toucher::new(&mut pilot, rig, index, pin).touch(limits, until)?);
    }
    Ok(results)
}

/// The pose of a platform from which its first whisker can begin to touch a pin. `heading` (rad) is kept by the procedure.
#[must_use]
pub fn start_beside_pin(rig: &Rig, pin: Pin, heading: f64) -> Pose {
    let first = rig.whiskers.first().map_or(Vector2::x(), tip_body);
    let around = Around::of(rig, pin);
    let pin_body = around.radius * first.try_normalize(0.0).unwrap_or(Vector2::x());
    Pose { position: pin.centre - rotate(pin_body, heading), heading }
}

/// The expected change of the reading per displacement of the pin (rad/m) in a planned touch, to which the pin comes from a position
/// beside the whisker.
fn by_displacement(planned: &PlannedTouch, beside: Point2) -> f64 {
    planned.base_angle.abs() / ((planned.pin_base - beside).norm() - CLEARANCE).max(CLEARANCE)
}

/// Position of the tip of a straight whisker (m, body frame).
fn tip_body(whisker: &Whisker) -> Vector2 {
    whisker.base_pose().point_to_world(Point2::new(whisker.shaft.length, 0.0)).coords
}

/// A circle about the centre of mass on which the pin passes the whole array.
struct Around {
    radius: f64,
}

/// Angle between two positions of the pin on its path around the array (rad).
const AROUND_STEP: f64 = 0.3;

impl Around {
    fn of(rig: &Rig, pin: Pin) -> Self {
        let corners = rig.platform.outline_body().map(|corner| corner.coords.norm());
        let tips = rig.whiskers.iter().map(|whisker| tip_body(whisker).norm());
        Self { radius: corners.into_iter().chain(tips).fold(0.0, f64::max) + pin.radius + 2.0 * CLEARANCE }
    }

    /// Moves the platform so that the pin leaves it, passes it and is in the direction of a tip (m, body frame).
    fn bring_pin(&self, pilot: &mut ArrayPilot<'_>, pin: Pin, tip: Vector2) -> Result<(), Fault> {
        let from = rotate(pin.centre - pilot.position(), -pilot.heading());
        let start = math::atan2(from.y, from.x);
        let turn = turn_between(start, math::atan2(tip.y, tip.x));
        let steps = (turn.abs() / AROUND_STEP).ceil();
        #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "at most eleven steps")]
        for step in 0..=steps as u32 {
            let direction = start + turn * if steps > 0.0 { f64::from(step) / steps } else { 0.0 };
            pilot.go(pin.centre - rotate(self.radius * unit(direction), pilot.heading()))?;
        }
        Ok(())
    }
}

/// The touches of one whisker while they are made.
struct Toucher<'p, 'w> {
    pilot: &'p mut ArrayPilot<'w>,
    rig: &'p Rig,
    index: usize,
    pin: Pin,
    /// Position of the pin (m, frame of the base that the rig assumes), as it was last commanded.
    pin_base: Option<Point2>,
    touched: Vec<(PlannedTouch, Rest)>,
    /// Slides of the pin along the whisker, outwards and back, each at the end of a touch with this index, and the velocity (m/s, world
    /// frame) of the platform outwards.
    strokes: Vec<(usize, [Rest; 2], Vector2)>,
    /// Rests in the air, one before each touch and one at the end.
    in_air: Vec<Rest>,
    missed: Vec<PlannedTouch>,
    /// Other whiskers that responded while this one did not.
    responded: Vec<usize>,
}

impl<'p, 'w> Toucher<'p, 'w> {
    fn new(pilot: &'p mut ArrayPilot<'w>, rig: &'p Rig, index: usize, pin: Pin) -> Self {
        let (touched, strokes, in_air, missed, responded) = Default::default();
        Self { pilot, rig, index, pin, pin_base: None, touched, strokes, in_air, missed, responded }
    }

    fn whisker(&self) -> &'p Whisker {
        &self.rig.whiskers[self.index]
    }

    fn touch(mut self, limits: &TouchLimits, until: f64) -> Result<WhiskerTouches, Fault> {
        let (start, whisker) = (self.pilot.time(), self.whisker());
        let plan = TouchPlan::new(whisker, self.pin.radius, EXPECTED_DEVIATION, &self.noise());
        // Touches take minutes, and no reading is more exact than the model.
        if let Err(refusal) = plan.check(whisker, limits.touches, MODEL_ANGLE) {
            let untouched = WhiskerTouches::fitted(self.rig, self.index, Vec::new(), self.noise());
            return Ok(WhiskerTouches { fit: Err(refusal), time: Some(0.0), ..untouched });
        }
        let mut fit = TouchFit::untouched(whisker);
        let rest = ArrayPilot::rest_time((until - start) / limits.touches as f64);
        while self.touched.len() + self.missed.len() < limits.touches && self.pilot.time() + LAST < until {
            let is_hopeless = self.touched.is_empty() && self.missed.len() >= HOPELESS;
            if is_hopeless || plan.tip_deviation(&fit) < limits.deviation {
                break;
            }
            let Some(planned) = plan.next(&fit, &self.missed) else { break };
            self.touch_once(planned, rest)?;
            if let Some(next) = TouchFit::new(whisker, &self.readings(), &self.noise()) {
                fit = next;
            }
        }
        let free_motion = self.free_motion()?;
        self.leave()?;
        let mut touches = WhiskerTouches::fitted(self.rig, self.index, self.readings(), self.noise());
        touches.fit = touches.fit.map(|fit| fit.with_strokes(&self.strokes(), &touches.noise));
        if let Some(refusal) = self.swapped() {
            touches.fit = Err(refusal);
        }
        Ok(WhiskerTouches {
            missed: self.missed.len(),
            free_motion,
            first_in_air: self.pilot.first_base_angle(self.index),
            time: Some(self.pilot.time() - start),
            ..touches
        })
    }

    /// Moves to a planned touch, rests before it and in it, and moves off the whisker again.
    fn touch_once(&mut self, planned: PlannedTouch, rest: f64) -> Result<(), Fault> {
        let before = self.beside(planned.pin_base.x, planned.side);
        self.approach(before, planned.side)?;
        let mut in_air = self.pilot.rest_in_air()?;
        if self.is_moved(&in_air) {
            // The whisker may have slipped off during the last touch, so that the pin now bends it from the other side.
            self.go(Point2::new(self.beyond_tip(), before.y))?;
            self.approach(before, planned.side)?;
            in_air = self.pilot.rest_in_air()?;
            if !self.is_moved(&in_air)
                && let Some((slipped, _)) = self.touched.pop()
            {
                self.strokes.retain(|(touch, ..)| *touch < self.touched.len());
                self.in_air.pop();
                self.missed.push(slipped);
            }
        }
        self.pin_base = Some(planned.pin_base);
        let touch = self.pilot.press(self.body(planned.pin_base), rest, by_displacement(&planned, before))?;
        let change = |index: usize| touch.base_angle(index).0 - in_air.base_angle(index).0;
        if (change(self.index) / planned.base_angle).abs() < SLIPPED {
            let other = (0..self.rig.whiskers.len())
                .find(|&other| other != self.index && change(other).abs() > SLIPPED * planned.base_angle.abs());
            self.responded.extend(other);
            self.missed.push(planned);
            // The pin may be on the other side of the whisker, so it leaves along the shaft.
            let beyond = Point2::new(self.beyond_tip(), planned.pin_base.y);
            self.go(beyond)?;
        } else {
            self.in_air.push(in_air);
            self.touched.push((planned, touch));
            if self.strokes.len() < STROKES && planned.pin_base.x < self.whisker().shaft.length - STROKE_ROOM {
                self.stroke()?;
            }
            self.go(before)?;
        }
        Ok(())
    }

    /// Slides the pin along the bent whisker towards its tip and back. Both readings are over the same path, so that an error of the
    /// fitted parameters, which changes the slope of the readings along the whisker, is not taken for friction.
    fn stroke(&mut self) -> Result<(), Fault> {
        let along = rotate(unit(self.whisker().base_pose().heading), self.pilot.heading());
        let speed = STROKE_SPEEDS[self.strokes.len() % STROKE_SPEEDS.len()];
        let (velocity_world, time) = (-speed * along, STROKE_PATH / speed);
        self.pilot.watch(SETTLING, |_, _| velocity_world, |_| ())?;
        let outwards = self.pilot.slide(velocity_world, time)?;
        self.pilot.watch(SETTLING, |_, _| velocity_world, |_| ())?;
        self.pilot.watch(SETTLING, |_, _| -velocity_world, |_| ())?;
        let back = self.pilot.slide(-velocity_world, time)?;
        self.strokes.push((self.touched.len() - 1, [outwards, back], velocity_world));
        Ok(())
    }

    /// Measures the motion of the whisker in the air. The pin of the last touch presses the whisker to and fro, which shows its
    /// damping. Then it slides along the shaft beyond the tip, which releases the whisker.
    fn free_motion(&mut self) -> Result<Option<FreeMotion>, Fault> {
        let Some(&(planned, _)) = self.touched.last() else { return Ok(None) };
        let before = self.beside(planned.pin_base.x, planned.side);
        self.approach(before, planned.side)?;
        self.pin_base = Some(planned.pin_base);
        self.pilot.press(self.body(planned.pin_base), SWING_TIME, by_displacement(&planned, before))?;
        let back = self.body(before) - self.body(planned.pin_base);
        let Some(away) = back.try_normalize(0.0) else { return Ok(None) };
        let swing = SWING * (back.norm() - CLEARANCE);
        let (index, from, heading, mut time) = (self.index, self.pilot.position(), self.pilot.heading(), f64::NAN);
        let mut pressed: Vec<Pressed> = Vec::new();
        let speed =
            |_: &ArrayPilot<'_>, time: f64| (PI * swing / SWING_TIME) * math::sin(TAU * time / SWING_TIME) * away;
        self.pilot.watch(2.0 * SWING_TIME, speed, |sample| {
            let Some(reading) = sample.whiskers.get(index) else { return };
            let period = sample.time - std::mem::replace(&mut time, sample.time);
            let off = sample.body.position - from;
            let (displacement, aside) = (off.dot(&away), away.perp(&off));
            let turn = turn_between(heading, sample.body.heading);
            if [period, displacement, turn, reading.base_angle].iter().all(|value| value.is_finite()) {
                pressed.push(Pressed { period, displacement, aside, turn, reading: reading.base_angle });
            }
        })?;
        let along = rotate(unit(self.whisker().base_pose().heading), self.pilot.heading());
        let out = self.beyond_tip() - planned.pin_base.x;
        let mut readings = Vec::new();
        self.pilot.watch(
            out / RELEASE_SPEED + RELEASED,
            |_, _| -RELEASE_SPEED * along,
            |sample| {
                readings.extend(sample.whiskers.get(index).map(|reading| (sample.time, reading.base_angle)));
            },
        )?;
        self.pin_base = Some(Point2::new(planned.pin_base.x + out + RELEASED * RELEASE_SPEED, planned.pin_base.y));
        // What creeps back looks like a slow mode that explains only a part of the motion.
        let mode = Pluck::of(&readings).ok().filter(|mode| mode.misfit < MOST_MISFIT);
        let mode = mode.map(|Pluck { first_mode, decay, .. }| FreeMotion::Mode { first_mode, decay });
        // The damping of the hinge delays what the damping of the shaft advances.
        let hinge = &self.whisker().hinge;
        let of_shaft = damping(&pressed).map(|damping| damping + hinge.damping / hinge.stiffness);
        if let (None, Some(damping)) = (mode, of_shaft) {
            return Ok(Some(FreeMotion::Creep { damping, first_mode: self.shake()? }));
        }
        Ok(mode)
    }

    /// The first mode (Hz) of the whisker in the air, far from the pin, by its sway on a platform that moves to and fro.
    fn shake(&mut self) -> Result<Option<f64>, Fault> {
        let along = rotate(unit(self.whisker().base_pose().heading), self.pilot.heading());
        let (index, left, from) = (self.index, perpendicular(along), self.pilot.position());
        let mut shaken = Vec::new();
        let velocity = |_: &ArrayPilot<'_>, time: f64| SHAKE_SPEED * math::sin(TAU * SHAKE_RATE * time) * left;
        self.pilot.watch(SHAKES / SHAKE_RATE, velocity, |sample| {
            let Some(reading) = sample.whiskers.get(index) else { return };
            let (displacement, reading) = ((sample.body.position - from).dot(&left), reading.base_angle);
            if displacement.is_finite() && reading.is_finite() {
                shaken.push(Shaken { time: sample.time, displacement, reading });
            }
        })?;
        Ok(first_mode(self.whisker(), SHAKE_RATE, &shaken))
    }

    /// True if the whisker in the air reads another base angle than before the last touch.
    fn is_moved(&self, in_air: &Rest) -> bool {
        let before = self.in_air.last().map(|before| before.base_angle(self.index).0);
        before.is_some_and(|before| (in_air.base_angle(self.index).0 - before).abs() > MOVED)
    }

    /// Position of the pin beside the straight whisker, from where it bends it to a side.
    fn beside(&self, along: f64, side: f64) -> Point2 {
        Point2::new(along, -side * (self.pin.radius + CLEARANCE))
    }

    /// Distance of the pin from the base at which it passes the tip.
    fn beyond_tip(&self) -> f64 {
        self.whisker().shaft.length + self.pin.radius + CLEARANCE
    }

    /// Moves the pin to a position beside the whisker, around the tip if it is on the other side.
    fn approach(&mut self, to: Point2, side: f64) -> Result<(), Fault> {
        let beyond = self.beyond_tip();
        match self.pin_base {
            Some(from) if from.y * side < 0.0 && from.x < beyond => {}
            from => {
                if let Some(from) = from {
                    self.go(Point2::new(beyond, from.y))?;
                }
                self.go(Point2::new(beyond, to.y))?;
            }
        }
        self.go(to)
    }

    /// Moves the pin beyond the tip and measures the whisker in the air.
    fn leave(&mut self) -> Result<(), Fault> {
        if let Some(from) = self.pin_base {
            let in_air = self.pilot.rest_in_air()?;
            self.in_air.push(in_air);
            self.go(Point2::new(self.beyond_tip(), from.y))?;
        }
        Ok(())
    }

    fn go(&mut self, pin_base: Point2) -> Result<(), Fault> {
        self.pin_base = Some(pin_base);
        let body = self.body(pin_base);
        self.pilot.go(body)
    }

    /// Position of the platform (m, world frame) with the pin at a position in the frame of the base.
    fn body(&self, pin_base: Point2) -> Point2 {
        let pin_body = self.whisker().base_pose().point_to_world(pin_base);
        let to_pin: Vector2 = rotate(pin_body.coords, self.pilot.heading());
        self.pin.centre - to_pin
    }

    /// The touches, each with the reading in the air at its time.
    fn readings(&self) -> Vec<TouchReading> {
        let reading =
            |(number, (planned, touch)): (usize, &(PlannedTouch, Rest))| self.reading(number, planned.side, touch);
        self.touched.iter().enumerate().filter_map(reading).collect()
    }

    /// The strokes, with the reading in the air at their times.
    fn strokes(&self) -> Vec<Stroke> {
        let stroke = |(number, [outwards, back], velocity_world): &(usize, [Rest; 2], Vector2)| {
            let (planned, _) = self.touched.get(*number)?;
            let [outwards, back] = [outwards, back].map(|rest| self.reading(*number, planned.side, rest));
            Some(Stroke { outwards: outwards?, back: back?, velocity_world: *velocity_world })
        };
        self.strokes.iter().filter_map(stroke).collect()
    }

    /// The reading of the touch with this number, or of a stroke at its end.
    fn reading(&self, number: usize, side: f64, touch: &Rest) -> Option<TouchReading> {
        let (base_angle, deviation) = touch.base_angle(self.index);
        let before = self.in_air.get(number)?;
        let after = self.in_air.get(number + 1).unwrap_or(before);
        let span = after.time - before.time;
        let share = if span > 0.0 { (touch.time - before.time) / span } else { 0.0 };
        let ((first, noise), (second, later)) = (before.base_angle(self.index), after.base_angle(self.index));
        let noises = [deviation, (1.0 - share) * noise, share * later, MODEL_ANGLE];
        Some(TouchReading {
            body: touch.body,
            obstacle: Obstacle::Pin { centre: self.pin.centre, radius: self.pin.radius },
            is_known: true,
            side,
            base_angle,
            in_air: first + share * (second - first),
            deviation: noises.iter().map(|noise| noise * noise).sum::<f64>().sqrt(),
        })
    }

    /// The noise of the poses. That of the mean over a rest is at most as large as that of a single pose.
    fn noise(&self) -> TouchNoise {
        let TouchNoise { position, heading } = self.pilot.noise;
        TouchNoise { position: math::hypot(position, MODEL_POSITION), heading }
    }

    /// The refusal of a whisker that did not respond, if another one did.
    fn swapped(&self) -> Option<TouchRefusal> {
        if !self.touched.is_empty() || self.missed.is_empty() {
            return None;
        }
        let reason = match self.responded.first() {
            Some(&other) => format!("the readings of `{}` respond to its touches", self.rig.whiskers[other].name),
            None => "its readings do not respond to touches".to_owned(),
        };
        Some(TouchRefusal::Swapped { name: self.whisker().name.clone(), reason })
    }
}
