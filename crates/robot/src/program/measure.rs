//! Measurement of the device for the admission of a machine.

use std::time::Instant;

use vibrissa_runtime::control::Control;
use vibrissa_runtime::geometry::{Point2, Pose};
use vibrissa_runtime::machine::{Op, compute};
use vibrissa_runtime::math;
use vibrissa_runtime::rig::Rig;
use vibrissa_runtime::signal::{MAX_WHISKERS, Reading, Sample};

use super::real_time::{CONTROL_PRIORITY, raise_priority};
use super::system_clock::SystemClock;
use crate::admission::Device;
use crate::sensor::BusClock;

/// Repetitions of every measurement: two seconds of the loop.
const REPETITIONS: u32 = 60;
/// Time between wake-ups for the lateness (ns).
const WAKE_UP_NS: u64 = 2_000_000;

/// Measures the device with the priority of the control thread, and passes it to `decide`, which runs on the same thread.
pub(super) fn measured<T: Send>(
    control: &Control,
    rig: &Rig,
    clocks: Vec<BusClock>,
    clock: SystemClock,
    decide: impl FnOnce(&mut Device<'_>) -> T + Send,
) -> T {
    let measure = || {
        raise_priority(CONTROL_PRIORITY);
        let mut device = Device {
            clocks,
            lateness: lateness(clock),
            operation: operation_time(control),
            tick: Box::new(|rounds| longest_tick(control.clone(), rig, rounds)),
        };
        decide(&mut device)
    };
    match std::thread::scope(|scope| scope.spawn(measure).join()) {
        Ok(decision) => decision,
        Err(panic) => std::panic::resume_unwind(panic),
    }
}

/// The longest tick (s) that takes `rounds` samples of a whisker that sways.
fn longest_tick(mut control: Control, rig: &Rig, rounds: u32) -> f64 {
    let sample_period = rig.sensing.sample_rate.recip();
    let mut time = 0.0;
    let mut longest: f64 = 0.0;
    for tick in 0..REPETITIONS {
        let samples: Vec<Sample> = (0..rounds)
            .map(|_| {
                time += sample_period;
                let mut whiskers = [Reading::default(); MAX_WHISKERS];
                for reading in &mut whiskers {
                    reading.base_angle = 150e-6 * math::sin(3.0 * time);
                }
                Sample { time, body: Pose { position: Point2::new(0.05 * time, 0.0), heading: 0.1 * time }, whiskers }
            })
            .collect();
        let before = Instant::now();
        control.tick(&samples);
        // The first tick fills caches.
        if tick > 0 {
            longest = longest.max(before.elapsed().as_secs_f64());
        }
    }
    longest
}

/// The mean time (s) of the machine's own operations, each of which runs once, in the slowest of several repetitions.
fn operation_time(control: &Control) -> f64 {
    let program = control.machine().program();
    // Without jumps, all operations run. Their results are of no use, and nothing depends on them.
    let code: Vec<Op> = program.code.iter().copied().filter(|op| op.target().is_none()).collect();
    let Ok(end) = u32::try_from(code.len()) else { return f64::INFINITY };
    let mut registers = program.initial_registers.clone();
    let mut perception = control.perception().clone();
    let mut longest: f64 = 0.0;
    for repetition in 0..REPETITIONS {
        let before = Instant::now();
        compute(&code, &(0..end), &mut registers, &mut perception);
        if repetition > 0 {
            longest = longest.max(before.elapsed().as_secs_f64());
        }
    }
    longest / f64::from(end.max(1))
}

/// The largest lateness (s) of wake-ups.
fn lateness(clock: SystemClock) -> f64 {
    let mut latest_ns = 0;
    for _ in 0..REPETITIONS {
        let due_ns = clock.now_ns() + WAKE_UP_NS;
        clock.sleep_until_ns(due_ns);
        latest_ns = latest_ns.max(clock.now_ns().saturating_sub(due_ns));
    }
    latest_ns as f64 * 1e-9
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "a test may panic")]

    use std::sync::Arc;

    use vibrissa_runtime::machine::Artifact;

    use super::*;

    #[test]
    fn every_time_of_the_device_is_measured_and_more_rounds_take_longer() {
        let artifact = Artifact::from_bytes(include_bytes!("../../../runtime/fixtures/bang.machine")).unwrap();
        let rig = Rig::default();
        let control = Control::new(&rig, Arc::new(artifact.program)).unwrap();
        measured(&control, &rig, Vec::new(), SystemClock::start(), |device| {
            assert!(device.lateness > 0.0 && device.operation > 0.0);
            // The shortest of several maxima, so that other programs do not matter.
            let mut tick = |rounds| (0..5).map(|_| (device.tick)(rounds)).fold(f64::INFINITY, f64::min);
            assert!(tick(64) > tick(1));
        });
    }
}
