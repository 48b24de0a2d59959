//! The command line of the program on the robot.

use std::process::ExitCode;

use clap::{Parser, Subcommand};

use super::control::{self, ControlArguments};
use super::drive::{self, DriveArguments};
use super::receive::{self, ReceiveArguments};
use super::sensor_io::{self, SensorIoArguments};
use super::sensors::{self, SensorsArguments};
use super::status::{self, StatusArguments};
use super::verdict::{self, GoodArguments, RejectArguments};
use crate::store::StoreError;

/// Drives a whisker array by a compiled machine.
#[derive(Debug, Parser)]
#[command(name = "vibrissa-robot", version, about, max_term_width = 100, after_help = EXIT_STATUS)]
struct Arguments {
    #[command(subcommand)]
    command: Command,
}

const EXIT_STATUS: &str = "Exit status: 0 done, or a signal ended the loop; 1 the machine or the program failed; 2 unusable input or device; \
                           3 the store has no machine; 130 `sensors` interrupted.";

#[derive(Debug, Subcommand)]
enum Command {
    /// Drive the robot by a compiled machine until a signal ends the program
    Drive(DriveArguments),
    /// Read the sensors and forward commands for a controller, which may run on another computer
    SensorIo(SensorIoArguments),
    /// Control the robot of a sensor IO by a compiled machine
    Control(ControlArguments),
    /// Show the values, rates and errors of all sensors
    Sensors(SensorsArguments),
    /// Receive a signed machine on standard input and verify it. It is tentative until a run marks it good
    Receive(ReceiveArguments),
    /// Show the machines of the store
    Status(StatusArguments),
    /// Mark the tentative machine good
    Good(GoodArguments),
    /// Give the tentative machine up. The last good one returns
    Reject(RejectArguments),
}

/// Runs the program with the arguments of the process.
#[must_use]
pub fn main() -> ExitCode {
    let result = match Arguments::parse().command {
        Command::Drive(arguments) => drive::drive(&arguments),
        Command::SensorIo(arguments) => sensor_io::sensor_io(&arguments),
        Command::Control(arguments) => control::control(&arguments),
        Command::Sensors(arguments) => sensors::sensors(&arguments),
        Command::Receive(arguments) => receive::receive(&arguments),
        Command::Status(arguments) => status::status(&arguments),
        Command::Good(arguments) => verdict::good(&arguments),
        Command::Reject(arguments) => verdict::reject(&arguments),
    };
    match result {
        Ok(code) => code,
        Err(error) => {
            print_error(&error.to_string());
            match error.downcast_ref() {
                Some(StoreError::NoMachine { .. }) => ExitCode::from(3),
                _ => ExitCode::from(2),
            }
        }
    }
}

/// Prints a message to standard error, where the journal of the system reads it.
#[expect(clippy::print_stderr, reason = "the only place that prints messages")]
pub(super) fn print_error(message: &str) {
    eprintln!("vibrissa-robot: {message}");
}

/// Prints a result to standard output.
#[expect(clippy::print_stdout, reason = "the only place that prints results")]
pub(super) fn print_result(text: &str) {
    println!("{text}");
}
