//! Ticks as pages show them.

use vibrissa_runtime::rig::Rig;

use super::guards::GuardNumbers;
use super::map::MapGrowth;
use super::message::{ChartInfo, ContourFrame, Frame, Metrics, Timing, WhiskerFrame};
use super::shadow::Shadow;
use super::shape::shaft_points;
use crate::run::{PlotRecord, TickRecord, Trace, WhiskerRecord};
use crate::score::CoverageTracker;
use vibrissa_world::geometry::{Point2, Pose, unit};
use vibrissa_world::scene::Truth;

/// The number of steps in a metre of a shown coordinate. A quotient of whole numbers is the double that has the fewest digits.
const STEPS: f64 = 1e6;

/// Makes the frames of a run.
#[derive(Debug)]
pub struct Frames {
    rig: Rig,
    /// For each whisker of the trace, its index in the rig.
    bound: Vec<usize>,
    truth: Option<Truth>,
    /// Sum and number of the errors, and of the standard deviations.
    errors: (f64, usize),
    spreads: (f64, usize),
    /// The coverage, if the scene is known.
    coverage: Option<CoverageTracker>,
    map: MapGrowth,
}

impl Frames {
    /// The frames of a run of `rig`, whose trace has the whiskers `bound`. `truth` is the exact scene, if it is known.
    #[must_use]
    pub fn new(rig: Rig, bound: Vec<usize>, truth: Option<Truth>) -> Self {
        let coverage = truth.as_ref().map(|truth| CoverageTracker::new(truth.reference.clone()));
        Self { rig, bound, truth, errors: (0.0, 0), spreads: (0.0, 0), coverage, map: MapGrowth::default() }
    }

    /// The frame of the newest tick of a trace. `None` if it has none.
    pub fn frame(
        &mut self,
        trace: &Trace,
        (shadow, numbers, chart): (&Shadow, &GuardNumbers, &ChartInfo),
        timing: Option<Timing>,
    ) -> Option<Frame> {
        let tick = trace.ticks.last()?;
        let index = trace.ticks.len() - 1;
        let contour = self.contour(index, tick);
        let messages = trace.messages.iter().rev().take_while(|message| message.tick == index);
        let mut messages: Vec<String> = messages.map(|message| message.message.text.to_string()).collect();
        messages.reverse();
        let plot = |plot: &PlotRecord| {
            let newest = plot.values.last().filter(|(tick, value)| *tick == index && value.is_finite());
            newest.map(|&(_, value)| value)
        };
        Some(Frame {
            tick: index,
            time: tick.time,
            states: chart.path(tick.state),
            pose: drawn_pose(&tick.body),
            whiskers: self.whiskers(tick),
            guards: shadow.guards(numbers),
            taken: shadow.taken(numbers),
            command: [tick.command.velocity_world.x, tick.command.velocity_world.y, tick.command.yaw_rate],
            contour,
            metrics: self.metrics(),
            timing,
            messages,
            plots: trace.plots.iter().map(plot).collect(),
            map: shadow.control().map().and_then(|map| self.map.frame(index, map)).map(Box::new),
        })
    }

    /// The figures of the contour until now.
    #[must_use]
    pub fn metrics(&self) -> Metrics {
        let mean = |(sum, count): (f64, usize)| (count > 0).then(|| sum / count as f64);
        let coverage = self.coverage.as_ref().map(CoverageTracker::coverage);
        Metrics { error: mean(self.errors), coverage, spread: mean(self.spreads) }
    }

    /// The recorded tips of the tick with this index.
    fn contour(&mut self, index: usize, tick: &TickRecord) -> Vec<ContourFrame> {
        let mut contour = Vec::new();
        for (whisker, record) in tick.whiskers.iter().enumerate().take(self.bound.len()) {
            let Some(tip) = record.tip else { continue };
            let spread = Some(record.tip_deviation).filter(|spread| spread.is_finite());
            let error = self.truth.as_ref().map(|truth| truth.surfaces.distance(tip)).filter(|error| error.is_finite());
            for (sum, value) in [(&mut self.errors, error), (&mut self.spreads, spread)] {
                if let Some(value) = value {
                    *sum = (sum.0 + value, sum.1 + 1);
                }
            }
            if let Some(coverage) = &mut self.coverage {
                coverage.add(whisker, index, tip);
            }
            contour.push(ContourFrame { whisker, point: point(tip), spread, error });
        }
        contour
    }

    /// The whiskers of a tick, bent to their true tips where these are known, or else to the estimated ones.
    fn whiskers(&self, tick: &TickRecord) -> Vec<WhiskerFrame> {
        let whisker = |(index, &in_rig): (usize, &usize)| {
            let whisker = self.rig.whiskers.get(in_rig)?;
            let &WhiskerRecord { deflection: base_angle, contact, tip_end, .. } = tick.whiskers.get(index)?;
            let is_known = |tip: &Point2| tip.coords.iter().all(|coordinate| coordinate.is_finite());
            let true_tip = tip_end.filter(is_known);
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
}

fn point(point: Point2) -> [f64; 2] {
    [rounded(point.x), rounded(point.y)]
}

/// A pose (m, rad) for a picture.
#[must_use]
pub fn drawn_pose(pose: &Pose) -> [f64; 3] {
    [rounded(pose.position.x), rounded(pose.position.y), pose.heading]
}

/// A coordinate (m) for a picture.
#[must_use]
pub fn rounded(coordinate: f64) -> f64 {
    (coordinate * STEPS).round() / STEPS
}
