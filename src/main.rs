//! The `vibrissa` command.

use std::panic::catch_unwind;
use std::process::ExitCode;

use vibrissa::cli::Exit;

fn main() -> ExitCode {
    let arguments = match vibrissa::cli::arguments() {
        Ok(arguments) => arguments,
        Err(status) => return status,
    };
    // A panic is a fault of the program, which has printed where by now; scripts know it by its exit status.
    catch_unwind(|| vibrissa::cli::main(&arguments)).unwrap_or(Exit::Internal).into()
}
