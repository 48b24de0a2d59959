//! Admission of a machine: the device measures itself and compares the result with the machine's needs.

use std::time::Instant;

use vibrissa_mlx90393::BusClock;
use vibrissa_runtime::control::Control;
use vibrissa_runtime::geometry::{Point2, Pose};
use vibrissa_runtime::machine::Program;
use vibrissa_runtime::rig::Rig;
use vibrissa_runtime::signal::{MAX_WHISKERS, Reading, Sample};

use crate::config::Config;

/// Ticks that are measured: two seconds of the loop.
const TICKS: u32 = 60;
/// Largest share of a control period for a tick, and of a sample period for a round.
const TICK_SHARE: f64 = 0.5;
const ROUND_SHARE: f64 = 0.7;

/// The measurements of the device.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Measured {
    /// Longest tick (s).
    pub(super) tick: f64,
    /// Clock of each bus.
    pub(super) clocks: Vec<BusClock>,
}

/// The reason why a machine is not admitted.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum Refusal {
    /// The rig lacks whiskers.
    #[error(
        "the machine needs the whisker `{0}`, which the array does not have; add a board, or compile another policy"
    )]
    Whisker(String),
    /// A tick takes too long.
    #[error(
        "a tick takes {tick_ms:.1} ms on this device, more than half of the control period of {period_ms:.1} ms; lower \
         the control rate, or simplify the policy"
    )]
    Tick {
        /// Longest tick (ms).
        tick_ms: f64,
        /// Control period (ms).
        period_ms: f64,
    },
    /// A bus is too slow for its boards.
    #[error(
        "a round on bus {bus} takes {round_us} µs at its clock of {clock_khz} kHz, more than 70 % of the sample period; set \
         its baud rate to 400000 in config.txt, or lower the sample rate"
    )]
    Bus {
        /// Index of the bus.
        bus: usize,
        /// Time of a round (µs).
        round_us: u32,
        /// Measured clock (kHz).
        clock_khz: u32,
    },
    /// A bus has a lower clock than the configuration demands.
    #[error(
        "the clock of bus {bus} is {clock_khz} kHz, less than the {least_khz} kHz of the configuration; set its baud rate in \
         config.txt, and update a kernel from before December 2023"
    )]
    Clock {
        /// Index of the bus.
        bus: usize,
        /// Measured clock (kHz).
        clock_khz: u32,
        /// Lowest clock of the configuration (kHz).
        least_khz: u32,
    },
}

impl Refusal {
    /// True if another machine may be admitted on the same device.
    pub(super) fn concerns_machine(&self) -> bool {
        matches!(self, Self::Whisker(_) | Self::Tick { .. })
    }
}

/// The longest tick (s) of a machine on this device, with samples of a whisker that sways.
pub(super) fn measure_tick(mut control: Control, rig: &Rig) -> f64 {
    let sample_period = rig.sensing.sample_rate.recip();
    let mut time = 0.0;
    let mut longest: f64 = 0.0;
    for tick in 0..TICKS {
        let samples: Vec<Sample> = (0..10)
            .map(|_| {
                time += sample_period;
                let mut whiskers = [Reading::default(); MAX_WHISKERS];
                for reading in &mut whiskers {
                    reading.base_angle = 150e-6 * (3.0 * time).sin();
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

/// Admits a machine on a device.
///
/// # Errors
/// [`Refusal`] with the first need that the device does not meet.
pub(super) fn admit(program: &Program, config: &Config, measured: &Measured) -> Result<(), Refusal> {
    let optional = program.optional.iter().copied().chain(std::iter::repeat(false));
    for (whisker, is_optional) in program.whiskers.iter().zip(optional) {
        if !is_optional && !config.rig.whiskers.iter().any(|fitted| fitted.name == *whisker) {
            return Err(Refusal::Whisker(whisker.clone()));
        }
    }
    let period = config.rig.sensing.control_rate.recip();
    if measured.tick > TICK_SHARE * period {
        return Err(Refusal::Tick { tick_ms: measured.tick * 1e3, period_ms: period * 1e3 });
    }
    for (bus, (entry, &clock)) in config.buses.iter().zip(&measured.clocks).enumerate() {
        let clock_khz = clock.frequency_hz / 1000;
        if f64::from(clock.frequency_hz) < entry.clock {
            #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "a frequency for a message")]
            let least_khz = (entry.clock / 1000.0) as u32;
            return Err(Refusal::Clock { bus, clock_khz, least_khz });
        }
        let boards = u32::try_from(entry.boards.len()).unwrap_or(u32::MAX);
        let round_us = vibrissa_mlx90393::round_time(boards, vibrissa_mlx90393::Axes::Y, clock);
        if f64::from(round_us) * 1e-6 > ROUND_SHARE / config.rig.sensing.sample_rate {
            return Err(Refusal::Bus { bus, round_us, clock_khz });
        }
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "a test may panic")]

    use super::*;
    use vibrissa_runtime::machine::Artifact;

    fn bang() -> Program {
        Artifact::from_bytes(include_bytes!("../../../runtime/fixtures/bang.machine")).unwrap().program
    }

    fn measured(frequency_hz: u32) -> Measured {
        Measured { tick: 1e-3, clocks: vec![BusClock { frequency_hz, overhead_ns: 30_000 }; 2] }
    }

    #[test]
    fn a_device_that_meets_every_need_admits_the_machine() {
        let config = Config::emulated(Rig::default(), 1.5);
        assert_eq!(admit(&bang(), &config, &measured(400_000)), Ok(()));
    }

    #[test]
    fn each_need_that_is_not_met_has_its_own_refusal() {
        let config = Config::emulated(Rig::default(), 1.5);
        let refusal = |program: &Program, config: &Config, measured: &Measured| {
            let refusal = admit(program, config, measured).unwrap_err();
            let message = refusal.to_string();
            let words: Vec<_> = message.split(' ').take(3).collect();
            let page = include_str!("../../../../docs/raspberry-pi.md");
            assert!(page.contains(&format!("\n| `{}", words.join(" "))), "Troubleshooting lacks: {message}");
            refusal
        };
        assert!(matches!(refusal(&bang(), &config, &measured(100_000)), Refusal::Clock { clock_khz: 100, .. }));
        let slow = Measured { tick: 20e-3, ..measured(400_000) };
        assert!(matches!(refusal(&bang(), &config, &slow), Refusal::Tick { .. }));
        let mut patient = config.clone();
        patient.buses.iter_mut().for_each(|bus| bus.clock = 0.0);
        assert!(matches!(refusal(&bang(), &patient, &measured(15_000)), Refusal::Bus { .. }));
        let mut other = bang();
        other.whiskers[0] = "r9".to_owned();
        assert_eq!(refusal(&other, &config, &measured(400_000)), Refusal::Whisker("r9".to_owned()));
    }
}
