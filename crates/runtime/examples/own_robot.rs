//! Drives a robot by a compiled policy, with the runtime alone. `docs/howto/own-robot.md` explains it.
//!
//!     cargo run --package vibrissa-runtime --example own_robot

use std::sync::Arc;

use vibrissa_runtime::control::Control;
use vibrissa_runtime::geometry::{Pose, unit};
use vibrissa_runtime::machine::{Artifact, Status};
use vibrissa_runtime::math;
use vibrissa_runtime::rig::Rig;
use vibrissa_runtime::signal::{Command, MAX_WHISKERS, Reading, Sample};

/// The y coordinate (m) of a wall on the right, and the base moment of a whisker per length beyond its surface (N).
const WALL: f64 = -0.16;
const MOMENT_PER_LENGTH: f64 = 0.05;

/// Replace this by the sensors of your robot. Here, the sensor of the right whisker is silent for half a second.
fn read_sensors(rig: &Rig, body: Pose, time: f64) -> Sample {
    let mut whiskers = [Reading::default(); MAX_WHISKERS];
    for (reading, whisker) in whiskers.iter_mut().zip(&rig.whiskers) {
        let shaft = whisker.shaft.length * unit(body.heading + whisker.direction_body);
        let beyond = math::max(WALL - (body.point_to_world(whisker.base_body) + shaft).y, 0.0);
        let is_silent = whisker.name == "r0" && (6.0..6.5).contains(&time);
        let moment = if is_silent { f64::NAN } else { whisker.side() * MOMENT_PER_LENGTH * beyond };
        reading.base_angle = moment / whisker.hinge.stiffness;
    }
    Sample { time, body, whiskers }
}

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let artifact = Artifact::from_bytes(include_bytes!("../fixtures/bang.machine"))?;
    let rig = Rig::default();
    let mut control = Control::new(&rig, Arc::new(artifact.program))?;
    let (mut body, mut command) = (Pose { heading: -0.3, ..Pose::default() }, Command::STOP);
    let (period, mut paused, mut followed) = (rig.sensing.sample_rate.recip(), 0.0, 0.0);
    for tick in 0..600 {
        let mut samples: [Sample; 10] = std::array::from_fn(|index| {
            // Replace this by the motors and the localisation of your robot. Here, they have no delay.
            body.position += period * command.velocity_world;
            body.heading += period * command.yaw_rate;
            read_sensors(&rig, body, period * (10 * tick + index + 1) as f64)
        });
        if samples.iter().all(|sample| sample.whiskers[0].base_angle.is_nan()) {
            // The robot stands still. The machine waits, and its time does not pass.
            (command, paused) = (Command::STOP, paused + 10.0 * period);
            continue;
        }
        for sample in &mut samples {
            sample.time -= paused;
        }
        let (next, output) = control.tick(&samples);
        command = next;
        assert_eq!(output.status, Status::Running, "{:?}", control.machine().failure());
        followed += control.perception().recorded_tip(0).map_or(0.0, |_| command.velocity_world.x * 10.0 * period);
        let base_angle = control.perception().base_angle(0);
        assert!(followed < 0.05 || (-200e-6..-100e-6).contains(&base_angle), "{base_angle} rad at tick {tick}");
    }
    assert!((0.4..0.6).contains(&paused) && followed > 0.4, "{paused} s paused, {followed} m of the wall followed");
    Ok(())
}
