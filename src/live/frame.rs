//! Ticks as pages show them.

use std::time::{Duration, Instant};

use vibrissa_runtime::rig::Rig;

use super::guards::GuardNumbers;
use super::log::RunLog;
use super::message::{ContourFrame, Frame, Metrics, Timing, WhiskerFrame};
use super::shadow::Shadow;
use crate::geometry::{Point2, unit};
use crate::recording::shaft_points;
use crate::run::{TickRecord, Trace};
use crate::scene::Truth;
use crate::score::{Estimate, coverage};

/// Coverage is computed at most this often.
const COVERAGE_PERIOD: Duration = Duration::from_secs(1);
/// Its computation takes at most one in this many parts of the time.
const COVERAGE_SHARE: u32 = 20;
/// Shown coordinates are multiples of this (m).
const RESOLUTION: f64 = 1e-6;

/// Makes the frames of a run.
#[derive(Debug)]
pub(super) struct Frames {
    rig: Rig,
    /// For each whisker of the trace, its index in the rig.
    bound: Vec<usize>,
    truth: Option<Truth>,
    /// Sum and number of the errors, and of the standard deviations.
    errors: (f64, usize),
    spreads: (f64, usize),
    coverage: Option<f64>,
    next_coverage: Instant,
}

impl Frames {
    /// The frames of a run of `rig`, whose trace has the whiskers `bound`. `truth` is the exact scene, if it is known.
    pub(super) fn new(rig: Rig, bound: Vec<usize>, truth: Option<Truth>) -> Self {
        let next_coverage = Instant::now();
        Self { rig, bound, truth, errors: (0.0, 0), spreads: (0.0, 0), coverage: None, next_coverage }
    }

    /// The frame of the newest tick of a trace. `None` if it has none.
    pub(super) fn frame(
        &mut self,
        trace: &Trace,
        (shadow, numbers, log): (&Shadow, &GuardNumbers, &RunLog),
        timing: Option<Timing>,
    ) -> Option<Frame> {
        let tick = trace.ticks.last()?;
        let index = trace.ticks.len() - 1;
        let contour = self.contour(tick);
        self.update_coverage(trace);
        let messages = trace.messages.iter().rev().take_while(|message| message.tick == index);
        let mut messages: Vec<String> = messages.map(|message| message.message.text.to_string()).collect();
        messages.reverse();
        let Point2 { coords } = tick.body.position;
        Some(Frame {
            tick: index,
            time: tick.time,
            states: log.path(tick.state),
            pose: [rounded(coords.x), rounded(coords.y), tick.body.heading],
            whiskers: self.whiskers(tick),
            guards: shadow.guards(numbers),
            taken: shadow.taken(numbers),
            command: [tick.command.velocity_world.x, tick.command.velocity_world.y, tick.command.yaw_rate],
            contour,
            metrics: self.metrics(),
            timing,
            messages,
        })
    }

    /// The figures of the contour until now.
    fn metrics(&self) -> Metrics {
        let mean = |(sum, count): (f64, usize)| (count > 0).then(|| sum / count as f64);
        Metrics { error: mean(self.errors), coverage: self.coverage, spread: mean(self.spreads) }
    }

    /// The figures of a whole run.
    pub(super) fn final_metrics(&mut self, trace: &Trace) -> Metrics {
        self.next_coverage = Instant::now();
        self.update_coverage(trace);
        self.metrics()
    }

    /// The recorded tips of a tick.
    fn contour(&mut self, tick: &TickRecord) -> Vec<ContourFrame> {
        let mut contour = Vec::new();
        for whisker in 0..self.bound.len() {
            let Some(tip) = tick.tips.get(whisker).copied().flatten() else { continue };
            let spread = tick.tip_deviations.get(whisker).copied().filter(|spread| spread.is_finite());
            let error = self.truth.as_ref().map(|truth| truth.surfaces.distance(tip)).filter(|error| error.is_finite());
            for (sum, value) in [(&mut self.errors, error), (&mut self.spreads, spread)] {
                if let Some(value) = value {
                    *sum = (sum.0 + value, sum.1 + 1);
                }
            }
            contour.push(ContourFrame { whisker, point: point(tip), spread, error });
        }
        contour
    }

    /// The whiskers of a tick, bent to their true tips where these are known, or else to the estimated ones.
    fn whiskers(&self, tick: &TickRecord) -> Vec<WhiskerFrame> {
        let whisker = |(index, &in_rig): (usize, &usize)| {
            let whisker = self.rig.whiskers.get(in_rig)?;
            let (base_angle, contact) = (*tick.deflections.get(index)?, tick.contacts.get(index)?);
            let is_known = |tip: &Point2| tip.coords.iter().all(|coordinate| coordinate.is_finite());
            let true_tip = tick.tip_ends.get(index).copied().flatten().filter(is_known);
            let estimated = contact.tip_world.filter(is_known);
            let straight = whisker.base_body + whisker.shaft.length * unit(whisker.direction_body + base_angle);
            let tip_body = true_tip.or(estimated).map_or(straight, |tip| tick.body.point_from_world(tip));
            let shaft = shaft_points(whisker, base_angle, tip_body).into_iter();
            Some(WhiskerFrame {
                base_angle,
                touching: contact.is_touching,
                shaft: shaft.map(|body| point(tick.body.point_to_world(body))).collect(),
                tip: estimated.filter(|_| contact.is_touching).map(point),
            })
        };
        self.bound.iter().enumerate().filter_map(whisker).collect()
    }

    /// Computes the coverage about once a second. It takes longer the longer the contour is, and never much of the time.
    fn update_coverage(&mut self, trace: &Trace) {
        let Some(truth) = &self.truth else { return };
        let before = Instant::now();
        if before < self.next_coverage {
            return;
        }
        self.coverage = Some(coverage(&Estimate::new(trace), &truth.reference));
        self.next_coverage = before + COVERAGE_PERIOD.max(COVERAGE_SHARE * before.elapsed());
    }
}

fn point(point: Point2) -> [f64; 2] {
    [rounded(point.x), rounded(point.y)]
}

/// A coordinate (m) for a picture.
pub(super) fn rounded(coordinate: f64) -> f64 {
    (coordinate / RESOLUTION).round() * RESOLUTION
}
