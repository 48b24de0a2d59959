//! The program on the robot.

use std::process::ExitCode;

fn main() -> ExitCode {
    vibrissa_robot::program::main()
}
