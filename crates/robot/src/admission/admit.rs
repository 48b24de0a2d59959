//! The decision about a machine.

use vibrissa_runtime::machine::{Artifact, Program};

use super::demands::{Demands, LongestRound};
use super::device::Device;
use super::rates::Rates;
use super::refusal::Refusal;
use super::slower::Slower;
use crate::config::Config;
use crate::sensor::{Sensor, SensorModel};

/// An admitted machine.
#[derive(Debug, Clone, PartialEq)]
pub struct Admission {
    /// The configuration with the rates of the loop, and with timeouts that ensure the age of samples.
    pub config: Config,
    /// The reason why the loop runs slower than configured, if it does.
    pub slower: Option<Slower>,
}

/// Admits a machine on a device.
///
/// The longest tick is the longest measured one, and the time of all operations that a tick of the machine can have. So some
/// operations count twice.
///
/// # Errors
/// [`Refusal`] with the first need that the device does not meet.
pub fn admit(artifact: &Artifact, config: &Config, device: &mut Device<'_>) -> Result<Admission, Refusal> {
    check_whiskers(&artifact.program, config)?;
    let sensor = config.sensor()?;
    let round = longest_round(config, &sensor, device)?;
    let needs = artifact.program.needs;
    let conversion = f64::from(sensor.conversion_us()) * 1e-6;
    let work = artifact.most_operations as f64 * device.operation;
    let demands = Demands {
        needs,
        round,
        latency: conversion + device.lateness,
        deadline: config.timeouts.control - device.lateness,
    };
    let mut tick = |rounds| (device.tick)(rounds) + work;

    let sensing = &config.rig.sensing;
    let rounds = u32::try_from(config.rounds_per_tick()).unwrap_or(u32::MAX);
    let configured = Rates { control: sensing.control_rate, sample: sensing.sample_rate, rounds };
    let mut admitted = config.clone();
    let slower = match demands.check(configured, &mut tick) {
        Ok(()) => None,
        Err(shortfall) => {
            let fastest = demands.limits(configured)?.fastest(tick);
            let rates = fastest.map_err(|closest| closest.unwrap_or(shortfall))?;
            let sensing = &mut admitted.rig.sensing;
            (sensing.control_rate, sensing.sample_rate) = (rates.control, rates.sample);
            let pair = |rates: Rates| [rates.control, rates.sample];
            Some(Slower { rates: pair(rates), configured: pair(configured), shortfall })
        }
    };
    if let Some(age) = needs.sample_age {
        // A value is as old as its conversion when it is read.
        let silence = age - conversion;
        let timeouts = &mut admitted.timeouts;
        (timeouts.sensor, timeouts.bus) = (timeouts.sensor.min(silence), timeouts.bus.min(silence));
    }
    Ok(Admission { config: admitted, slower })
}

/// Checks that the array has the whiskers of a machine.
fn check_whiskers(program: &Program, config: &Config) -> Result<(), Refusal> {
    let optional = program.optional.iter().copied().chain(std::iter::repeat(false));
    for (whisker, is_optional) in program.whiskers.iter().zip(optional) {
        if !is_optional && !config.rig.whiskers.iter().any(|fitted| fitted.name == *whisker) {
            return Err(Refusal::Whisker(whisker.clone()));
        }
    }
    Ok(())
}

/// The longest round of all buses, each of which must have the clock of the configuration.
fn longest_round(config: &Config, sensor: &SensorModel, device: &Device<'_>) -> Result<Option<LongestRound>, Refusal> {
    let mut longest: Option<LongestRound> = None;
    for (bus, (entry, &clock)) in config.buses.iter().zip(&device.clocks).enumerate() {
        let clock_khz = clock.frequency_hz / 1000;
        if f64::from(clock.frequency_hz) < entry.clock {
            #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "a frequency for a message")]
            let least_khz = (entry.clock / 1000.0) as u32;
            return Err(Refusal::Clock { bus, clock_khz, least_khz });
        }
        let boards = u32::try_from(entry.boards.len()).unwrap_or(u32::MAX);
        let time_us = sensor.round_us(boards, clock);
        if longest.is_none_or(|longest| time_us > longest.time_us) {
            longest = Some(LongestRound { bus, time_us, clock_khz });
        }
    }
    Ok(longest)
}
