//! Fields without a base angle, and fields beyond the range of the sensors.

use std::sync::Arc;

use vibrissa_robot::array::ReadingState;
use vibrissa_robot::config::Config;
use vibrissa_robot::drive::LoopRecord;
use vibrissa_robot::emulation::{Emulation, Plant, PlantFault, PlantState, Settings, SwayingPlant};
use vibrissa_robot::fault::{FaultChange, FaultEvent, FaultKind};
use vibrissa_runtime::control::Control;
use vibrissa_runtime::geometry::{Point2, Pose};
use vibrissa_runtime::machine::Artifact;
use vibrissa_runtime::signal::{Command, MAX_WHISKERS};

use super::robot::{MACHINE, MS, config};

fn emulation<P: Plant>(config: &Config, plant: P) -> Emulation<P> {
    let program = Arc::new(Artifact::from_bytes(MACHINE).unwrap().program);
    let control = Control::new(&config.rig, program).unwrap();
    Emulation::new(config, control, plant, &Settings::default()).unwrap()
}

fn detected(events: &[FaultEvent]) -> Vec<(FaultKind, u8)> {
    let detected = events.iter().filter(|event| event.change == FaultChange::Detected);
    detected.map(|event| (event.fault.kind, event.fault.part)).collect()
}

#[test]
fn a_reading_that_is_never_finite_is_a_fault_of_its_whisker() {
    for gain in [0.0, f64::NAN] {
        let mut config = config(&Settings::default());
        // The magnet of l0, which is on the second bus.
        config.buses[1].boards[0].field_per_moment = gain;
        let plant = SwayingPlant::new(config.rig.sensing.sample_rate.recip());
        let mut robot = emulation(&config, plant);
        robot.run(3000 * MS, |_, _, _, _| true).unwrap();
        let events = robot.take_events();
        assert!(detected(&events).contains(&(FaultKind::InvalidReading, 1)), "{gain}: {events:?}");
        assert!(robot.last_packet().is_some_and(|packet| packet.is_stop), "{gain}");
    }
}

/// A platform that stands still, with one whisker whose base moment grows far beyond the range of its sensor and returns.
struct Pressed {
    time: f64,
    period: f64,
}

/// The base moment (N m) at a time (s). The range of the sensor ends at 1.12 mN m.
fn moment(time: f64) -> f64 {
    2.8e-3 * (1.0 - ((time - 4.0) / 1.5).abs()).max(0.0)
}

impl Plant for Pressed {
    fn start(&self) -> PlantState {
        PlantState { pose: Pose { position: Point2::origin(), heading: 0.0 }, base_moments: [0.0; MAX_WHISKERS] }
    }

    fn advance(&mut self, _: &Command) -> Result<PlantState, PlantFault> {
        self.time += self.period;
        let mut state = self.start();
        state.base_moments[0] = moment(self.time);
        Ok(state)
    }
}

#[test]
fn a_field_beyond_the_range_is_saturated_although_the_counts_wrap() {
    let mut config = config(&Settings::default());
    // The fault of the angle would end the run before.
    config.limits.base_angle = 1.0;
    let period = config.rig.sensing.sample_rate.recip();
    let mut robot = emulation(&config, Pressed { time: 0.0, period });
    let mut wrapped = 0;
    for until_ms in (0..7000).step_by(100) {
        robot.run(until_ms * MS, |_, _, _, _| true).unwrap();
        while let Some(record) = robot.next_record() {
            let LoopRecord::Round(round) = record else { continue };
            let time = round.ended_ns as f64 * 1e-9;
            match round.readings[0].state {
                // Offset and noise are below a tenth of the range, and a value is at most some milliseconds old.
                ReadingState::Fresh(counts) if round.bus == 0 => {
                    assert!(counts > -3000 && moment(time) < 1.25e-3, "{counts} at {time} s");
                }
                ReadingState::Saturated if round.bus == 0 => wrapped += 1,
                _ => {}
            }
        }
    }
    assert!(wrapped > 300, "{wrapped}");
    let events = robot.take_events();
    let of_field =
        |change| events.iter().any(|event| event.fault.kind == FaultKind::Saturated && event.change == change);
    assert!(of_field(FaultChange::Detected) && of_field(FaultChange::Recovered), "{events:?}");
}
