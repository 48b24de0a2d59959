//! `vibrissa-robot sensors`

use std::path::PathBuf;
use std::process::ExitCode;

use clap::Args;

use super::command_line::print_result;
use super::drive::{Error, read_config};
use super::system_bus::SystemBus;
use super::system_clock::SystemClock;
use crate::array::{Acquisition, Bus, ReadingState, period_ns};
use crate::config::Config;
use crate::sensor::Sensor;

const EXAMPLE: &str = "Example:\n  vibrissa-robot sensors --config /etc/vibrissa/array.yaml";

/// The arguments of `vibrissa-robot sensors`.
#[derive(Debug, Args)]
#[command(after_help = EXAMPLE)]
pub(super) struct SensorsArguments {
    /// Configuration of the robot
    #[arg(long, value_name = "FILE")]
    config: PathBuf,
    /// End after this many seconds. Without it, the program goes on until a signal ends it
    #[arg(long = "for", value_name = "SECONDS")]
    duration: Option<u64>,
    /// Print one line of JSON per whisker and second
    #[arg(long)]
    json: bool,
}

/// Counts of one whisker over a second.
#[derive(Debug, Clone, Default, serde::Serialize)]
struct WhiskerLine {
    whisker: String,
    field_microtesla: Option<f64>,
    rate_hz: u32,
    stale: u32,
    saturated: u32,
    garbled: u32,
    silent: u32,
    lost: u32,
}

/// Reads all buses in turn, and prints a line for each whisker and second.
pub(super) fn sensors(arguments: &SensorsArguments) -> Result<ExitCode, Error> {
    let (config, _) = read_config(&arguments.config)?;
    let clock = SystemClock::start();
    let sensor = config.sensor()?;
    let microtesla = sensor.microtesla_per_count();
    let mut buses = Vec::new();
    for (index, bus) in (0_u8..).zip(&config.buses) {
        let mut opened = SystemBus::open(&bus.device, clock)?;
        let mut acquisition = Acquisition::new(index, &bus.boards, &sensor)?;
        if let Err(error) = acquisition.start(&mut opened) {
            super::command_line::print_error(&format!("warning: {}: {error}", bus.device.display()));
        }
        buses.push((opened, acquisition));
    }
    let period_ns = period_ns(config.rig.sensing.sample_rate);
    let mut slot = clock.now_ns() / period_ns + 1;
    for second in 1.. {
        let mut lines = empty_lines(&config);
        while slot * period_ns < second * 1_000_000_000 {
            clock.sleep_until_ns(slot * period_ns);
            for (bus, (opened, acquisition)) in buses.iter_mut().enumerate() {
                count(&acquisition.round(slot, opened).readings, &config.whiskers_on(bus), microtesla, &mut lines);
            }
            slot = (buses.first().map_or(0, |(bus, _)| bus.now_ns()) / period_ns).max(slot) + 1;
        }
        show(&lines, arguments.json)?;
        if arguments.duration.is_some_and(|duration| second >= duration) {
            break;
        }
    }
    Ok(ExitCode::SUCCESS)
}

fn empty_lines(config: &Config) -> Vec<WhiskerLine> {
    let line = |whisker: &vibrissa_runtime::rig::Whisker| WhiskerLine {
        whisker: whisker.name.clone(),
        ..WhiskerLine::default()
    };
    config.rig.whiskers.iter().map(line).collect()
}

fn count(readings: &[crate::array::BoardReading], whiskers: &[usize], microtesla: f64, lines: &mut [WhiskerLine]) {
    for (&whisker, reading) in whiskers.iter().zip(readings) {
        let Some(line) = lines.get_mut(whisker) else { continue };
        match reading.state {
            ReadingState::Fresh(counts) => {
                line.rate_hz += 1;
                line.field_microtesla = Some(f64::from(counts) * microtesla);
            }
            ReadingState::Saturated => line.saturated += 1,
            ReadingState::Stale => line.stale += 1,
            ReadingState::Garbled => line.garbled += 1,
            ReadingState::Silent => line.silent += 1,
            ReadingState::Lost => line.lost += 1,
        }
    }
}

fn show(lines: &[WhiskerLine], is_json: bool) -> Result<(), Error> {
    if !is_json {
        print_result("whisker    field uT    new/s  stale  saturated  garbled  silent  lost");
    }
    for line in lines {
        if is_json {
            print_result(&serde_json::to_string(line)?);
        } else {
            let field = line.field_microtesla.map_or_else(|| "-".to_owned(), |field| format!("{field:.2}"));
            print_result(&format!(
                "{:<8}{field:>12}{:>9}{:>7}{:>11}{:>9}{:>8}{:>6}",
                line.whisker, line.rate_hz, line.stale, line.saturated, line.garbled, line.silent, line.lost
            ));
        }
    }
    Ok(())
}
