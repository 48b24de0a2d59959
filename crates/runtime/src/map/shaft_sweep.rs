//! The ground that the straight shaft of a whisker has swept.

use crate::geometry::{Point2, Pose, Vector2, perpendicular, unit};
use crate::math;
use crate::rig::Whisker;

use super::margins::Margins;

/// Stations along the shaft, as shares of its length. A shaft that also moves along itself proves nothing at the end that it
/// moves to, so the stations are dense at both ends.
const SHARES: [f64; STATIONS] = [0.01, 0.05, 0.2, 0.35, 0.5, 0.65, 0.8, 0.92, 0.97, 0.99, 1.0];
const STATIONS: usize = 11;

/// Most keyframes that are remembered. With [`SPACING`] they are at least 48 mm, far more than two margins.
const KEYFRAMES: usize = 96;
/// Motion of the base or of the tip (m) after which a keyframe is taken. It is a quarter of the usual cell, so that the
/// chord between two keyframes is as good as the path.
const SPACING: f64 = 0.5e-3;

/// Keyframes by which a station's path is followed in a step. The path must catch up when the whisker becomes faster.
const SUBSTEPS: usize = 3;
/// Keyframes by which the one before a place is advanced for each place.
const LEADS: usize = 3;
/// Distance of the positions of two neighbouring stations over the length of the shaft, beyond which the straight line between
/// them says nothing about the path of the shaft. Neighbours are at most 0.15 apart on the shaft.
const LONGEST: f64 = 0.25;

/// Rounding (m) of a position.
const ROUNDING: f64 = 1e-9;

/// The straight shaft of a whisker at one time.
#[derive(Debug, Clone, Copy, Default)]
struct Line {
    /// Position of the base (m, world frame).
    base: Point2,
    /// Direction of the shaft.
    axis: Vector2,
}

impl Line {
    /// The point of the shaft at the distance `along` (m) from the base.
    fn at(&self, along: f64) -> Point2 {
        self.base + along * self.axis
    }

    /// Distances (m) of a point from the base along the shaft, and from the shaft to its left.
    fn coordinates(&self, point: Point2) -> (f64, f64) {
        let offset = point - self.base;
        (self.axis.dot(&offset), perpendicular(self.axis).dot(&offset))
    }
}

/// A station of the shaft in a run of straight poses.
#[derive(Debug, Clone, Copy, Default)]
struct Station {
    /// +1 while the station moves to the left of the shaft, −1 to its right, 0 before it has moved.
    sign: f64,
    /// Number of the keyframe up to which the station's path is a margin behind the shaft.
    trail: usize,
    /// Number of the last keyframe that is a margin before that place of the path.
    lead: usize,
    /// That place of the path (m, world frame), if such a keyframe exists.
    proved: Option<Point2>,
}

/// The ground that a straight shaft has swept, less its margins.
///
/// A shaft that reads straight may still be displaced by its [`Margins`]. So a place that the shaft has passed is free
/// only if the shaft was a margin before it and is now a margin behind it, and read straight all the time. An object
/// there would have displaced the shaft by more than the margin, to one side or to the other one.
///
/// Every station of the shaft keeps the part of its path that fulfils this. The ground between two stations and two
/// successive keyframes is a quadrilateral. Successive ones have common edges, so no seams remain.
#[derive(Debug, Clone)]
pub(super) struct ShaftSweep {
    mount: Pose,
    margins: Margins,
    keyframes: Box<[Line; KEYFRAMES]>,
    /// Number of keyframes since the run began.
    count: usize,
    stations: [Station; STATIONS],
}

/// What bounds the margins of a shaft.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Bounds {
    /// Base angle (rad) below which a shaft reads straight.
    pub(super) base_angle: f64,
    /// Error of the position (m) and of the heading (rad) of the body.
    pub(super) position: f64,
    pub(super) heading: f64,
    /// Largest motion (m) of a station in one step. A larger one is a jump of the measured pose.
    pub(super) jump: f64,
}

impl ShaftSweep {
    /// Creates the sweep of `whisker`, as perception models it.
    pub(super) fn new(whisker: &Whisker) -> Self {
        Self {
            mount: whisker.base_pose(),
            margins: Margins::new(whisker),
            keyframes: Box::new([Line::default(); KEYFRAMES]),
            count: 0,
            stations: [Station::default(); STATIONS],
        }
    }

    /// Ends the run: the whisker is bent, or its pose is unknown.
    pub(super) fn interrupt(&mut self) {
        self.count = 0;
    }

    /// Distance (m) of a station from the base. An object may overlap the tip by a little.
    fn along(&self, station: usize, bounds: &Bounds) -> f64 {
        let length = self.margins.length - self.margins.shortening(bounds.base_angle) - bounds.position;
        math::max(length, 0.0) * SHARES[station]
    }

    /// The margin (m) at the distance `along` (m) from the base.
    fn margin(&self, along: f64, bounds: &Bounds) -> f64 {
        let arm = self.mount.position.coords.norm() + along;
        self.margins.displacement(along, bounds.base_angle) + bounds.position + bounds.heading * arm
    }

    /// Continues the run with the body at `body`. Calls `quad` with the corners (m, world frame) of each quadrilateral
    /// that has been proved free. Neighbours have common edges.
    pub(super) fn take(&mut self, body: Pose, bounds: &Bounds, mut quad: impl FnMut([Point2; 4])) {
        let line =
            Line { base: body.point_to_world(self.mount.position), axis: unit(body.heading + self.mount.heading) };
        let Some(newest) = self.count.checked_sub(1) else { return self.begin(line) };
        let before = self.keyframe(newest);
        let moved = math::max(
            (line.base - before.base).norm(),
            (line.at(self.margins.length) - before.at(self.margins.length)).norm(),
        );
        if moved > bounds.jump {
            return self.begin(line);
        }
        if moved < SPACING {
            return;
        }
        self.keyframes[self.count % KEYFRAMES] = line;
        self.count += 1;
        self.stations = std::array::from_fn(|index| self.directed(self.stations[index], self.along(index, bounds)));
        for _ in 0..SUBSTEPS {
            let last = self.stations;
            self.stations = std::array::from_fn(|index| self.followed(last[index], self.along(index, bounds), bounds));
            if last.iter().zip(&self.stations).all(|(last, now)| last.trail == now.trail) {
                break;
            }
            let longest = LONGEST * self.margins.length;
            for index in 0..STATIONS - 1 {
                let [a, b] = [index, index + 1].map(|station| (last[station], self.stations[station]));
                let is_one_way = a.1.sign * b.1.sign > 0.0;
                if let (true, Some(a0), Some(a1), Some(b0), Some(b1)) =
                    (is_one_way, a.0.proved, a.1.proved, b.0.proved, b.1.proved)
                    && (a0 - b0).norm() < longest
                    && (a1 - b1).norm() < longest
                {
                    quad([a0, b0, b1, a1]);
                }
            }
        }
    }

    /// Begins a run with one line.
    fn begin(&mut self, line: Line) {
        self.keyframes[0] = line;
        self.count = 1;
        self.stations = [Station::default(); STATIONS];
    }

    /// A keyframe by its number.
    fn keyframe(&self, number: usize) -> Line {
        self.keyframes[number % KEYFRAMES]
    }

    /// A station at the distance `along` (m) from the base in the direction of the newest keyframe. One that reverses begins
    /// anew, and so does one whose keyframes the memory has lost.
    fn directed(&self, station: Station, along: f64) -> Station {
        let newest = self.count - 1;
        let sign = self.keyframe(newest - 1).coordinates(self.keyframe(newest).at(along)).1.signum();
        let oldest = self.count.saturating_sub(KEYFRAMES);
        if sign * station.sign > 0.0 && station.lead >= oldest {
            return station;
        }
        let first = (newest - 1).max(oldest);
        Station { sign, trail: first, lead: first, proved: None }
    }

    /// A station at the distance `along` (m) from the base, whose path is followed by at most one keyframe.
    fn followed(&self, mut station: Station, along: f64, bounds: &Bounds) -> Station {
        let newest = self.count - 1;
        // Places are on the side to which the shaft goes, and later on the one from which it has come.
        let is_aside = |number: usize, point: Point2, sign: f64| {
            let (place, aside) = self.keyframe(number).coordinates(point);
            let is_alongside = place >= -ROUNDING && place <= self.margins.length + ROUNDING;
            is_alongside && sign * aside >= self.margin(place, bounds)
        };
        if station.trail == newest {
            return station;
        }
        let next = self.keyframe(station.trail + 1).at(along);
        if !is_aside(newest, next, -station.sign) {
            return station;
        }
        station.trail += 1;
        for _ in 0..LEADS {
            if station.lead < station.trail && is_aside(station.lead + 1, next, station.sign) {
                station.lead += 1;
            }
        }
        station.proved = is_aside(station.lead, next, station.sign).then_some(next);
        station
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;
    use crate::rig::Rig;

    fn area(quad: &[Point2; 4]) -> f64 {
        (0..4).map(|corner| quad[corner].coords.perp(&quad[(corner + 1) % 4].coords) / 2.0).sum::<f64>().abs()
    }

    proptest! {
        #[test]
        fn a_shaft_that_moves_sidewards_claims_its_path_less_two_margins(
            travel in 0.02..0.2_f64, steps in 40_u32..400, base_angle in 1e-6..1e-5_f64, position in 0.0..5e-4_f64,
        ) {
            let whisker = Rig::default().whiskers.remove(1);
            let mut sweep = ShaftSweep::new(&whisker);
            let bounds = Bounds { base_angle, position, heading: 0.0, jump: 0.05 };
            let across = perpendicular(unit(whisker.direction_body));
            let mut claimed = 0.0;
            for step in 0..=steps {
                let moved = across * (travel * f64::from(step) / f64::from(steps));
                sweep.take(Pose { position: moved.into(), heading: 0.0 }, &bounds, |quad| claimed += area(&quad));
            }
            // The exact area between the margins, from a finer integral. A keyframe at each side may be missing.
            let length = whisker.shaft.length;
            let margin = |along: f64| Margins::new(&whisker).displacement(along, base_angle) + position;
            let exact: f64 = (0..1000)
                .map(|index| travel - 2.0 * margin((f64::from(index) + 0.5) * 1e-3 * length))
                .map(|width| math::max(width, 0.0) * 1e-3 * length)
                .sum();
            let step = math::max(travel / f64::from(steps), SPACING);
            prop_assert!(claimed < exact * (1.0 + 1e-3), "{claimed} {exact}");
            // The first hundredth of the shaft is given up.
            prop_assert!(claimed > 0.99 * exact - (5.0 * step + position) * length, "{claimed} {exact}");
        }

        #[test]
        fn a_shaft_that_moves_along_itself_claims_nothing(travel in 0.0..0.2_f64) {
            let whisker = Rig::default().whiskers.remove(1);
            let mut sweep = ShaftSweep::new(&whisker);
            let bounds = Bounds { base_angle: 5e-6, position: 1e-5, heading: 0.0, jump: 0.05 };
            let mut claimed = 0.0;
            for step in 0..100 {
                let moved = unit(whisker.direction_body) * (travel * f64::from(step) / 100.0);
                sweep.take(Pose { position: moved.into(), heading: 0.0 }, &bounds, |quad| claimed += area(&quad));
            }
            prop_assert!(claimed < 1e-9, "{claimed}");
        }
    }
}
