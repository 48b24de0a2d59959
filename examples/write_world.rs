//! Implements an own simulator and runs a policy in it.
//!
//!     cargo run --no-default-features --example write_world
//!
//! The simulator has a wall that is parallel to the y axis. Its platform follows commands without delay. A whisker in
//! contact keeps its tip on the wall and bends sideways, as a cantilever with small deflections.
#![allow(clippy::print_stdout, reason = "an example prints")]

use std::error::Error;
use std::sync::Arc;

use vibrissa::diagnostic::{Colour, Source, terminal};
use vibrissa::geometry::{Point2, Pose, Vector2, perpendicular, unit};
use vibrissa::trial::Trial;
use vibrissa::world::{Fault, World};
use vibrissa::{policy, scenario};
use vibrissa_runtime::math;
use vibrissa_runtime::rig::{Rig, Whisker};
use vibrissa_runtime::signal::{Command, MAX_WHISKERS, Reading, Sample};

/// The x coordinate of the surface of the wall (m). The scenario has the same wall.
const WALL: f64 = 0.122;

const SCENARIO: &str = "
name: wall
objects: [{polygon: {vertices: [[122 mm, -1 m], [1 m, -1 m], [1 m, 2 m], [122 mm, 2 m]]}}]
start: {position: [-10 mm, 0 m], heading: 90 deg}
stop: {time: 10 s}
";

/// Moves ahead, and sideways in proportion to the difference of the base angle from its target.
const POLICY: &str = "
machine beside
whisker r0 by one_channel
param target = 150 urad in 50 .. 300 urad
initial Following
state Following {
  if r0.touching { record r0 }
  steer body along direction(body.yaw - (1 - |r0.base_angle| / target) * 20 deg) at 50 mm/s facing 90 deg
}
";

/// A whisker rig beside a wall.
struct WallWorld {
    rig: Rig,
    time: f64,
    body: Pose,
    /// The samples of the last control period.
    samples: Vec<Sample>,
}

impl WallWorld {
    fn new(rig: Rig, start: Pose) -> Self {
        Self { rig, time: 0.0, body: start, samples: Vec::new() }
    }

    /// Pose of the base of a whisker. The heading is the direction of the undeflected shaft.
    fn base(&self, whisker: &Whisker) -> Pose {
        let position = self.body.point_to_world(whisker.base_body);
        Pose { position, heading: self.body.heading + whisker.direction_body }
    }

    /// Position of the tip in the frame of the base (m). It is on the wall if the straight shaft would reach beyond it.
    ///
    /// The sideways deflection `d` shortens the shaft along its undeflected direction by `3 d² / (5 L)`. So `d` is a
    /// root of a quadratic equation: the one with the smaller magnitude.
    fn tip_base(&self, whisker: &Whisker) -> Vector2 {
        let (base, length) = (self.base(whisker), whisker.shaft.length);
        let (ahead, left) = (unit(base.heading), perpendicular(unit(base.heading)));
        let beyond = (base.position + length * ahead).x - WALL;
        if beyond <= 0.0 {
            return Vector2::new(length, 0.0);
        }
        let root = (math::square(left.x) + 2.4 * ahead.x * beyond / length).sqrt();
        let deflection = -2.0 * beyond / (left.x + root.copysign(left.x));
        Vector2::new(length - 0.6 * math::square(deflection) / length, deflection)
    }

    /// The reading of a whisker. A cantilever of length `L` with the tip deflection `d` has the base moment
    /// `3 E I d / L²`. The base angle is the moment over the stiffness of the hinge.
    fn reading(&self, whisker: &Whisker) -> Reading {
        let moment =
            3.0 * whisker.shaft.tip_stiffness() * self.tip_base(whisker).y / math::square(whisker.shaft.length);
        Reading { base_angle: moment / whisker.hinge.stiffness, ..Reading::default() }
    }
}

impl World for WallWorld {
    fn advance(&mut self, command: &Command) -> Result<&[Sample], Fault> {
        let step = self.rig.sensing.sample_rate.recip();
        let period = self.rig.sensing.control_rate.recip();
        self.samples.clear();
        // Half a step avoids that rounding decides about the last sample.
        let end = self.time + period - 0.5 * step;
        while self.time < end {
            self.time += step;
            self.body.position += step * command.velocity_world;
            self.body.heading += step * command.yaw_rate;
            let mut whiskers = [Reading::default(); MAX_WHISKERS];
            for (reading, whisker) in whiskers.iter_mut().zip(&self.rig.whiskers) {
                *reading = self.reading(whisker);
            }
            self.samples.push(Sample { time: self.time, body: self.body, whiskers });
        }
        Ok(&self.samples)
    }

    fn body_touches(&self) -> bool {
        let corners = self.rig.platform.outline_body();
        corners.iter().any(|&corner| self.body.point_to_world(corner).x > WALL)
    }

    fn snapped_off(&self, _whisker: usize) -> bool {
        false
    }

    fn tip(&self, whisker: usize) -> Point2 {
        let whisker = &self.rig.whiskers[whisker];
        self.base(whisker).point_to_world(self.tip_base(whisker).into())
    }
}

fn main() -> Result<(), Box<dyn Error>> {
    let text = Source::new("wall.yaml", SCENARIO);
    let scene = scenario::read(&text).map_err(|errors| terminal(&text, &errors, Colour::Plain))?;
    let text = Source::new("beside.fsm", POLICY);
    let program = policy::compile(&text).map_err(|errors| terminal(&text, &errors, Colour::Plain))?;

    let mut world = WallWorld::new(scene.rig.clone(), scene.start);
    let trial = Trial::new(scene, Arc::new(program));
    // The score uses the exact geometry of the scene, whatever the simulator is.
    let result = trial.run_in(&mut world)?;

    let error = result.score.error.ok_or("the policy recorded no tip")?;
    println!("{} after {:.1} s of simulated time", result.run.outcome, world.time);
    println!("{} tips with a mean error of {:.2} mm", error.count, 1e3 * error.mean);
    println!("{} collisions of the body", result.score.collisions.count);
    Ok(())
}
