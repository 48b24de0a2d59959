//! The `vibrissa` command.

fn main() -> std::process::ExitCode {
    vibrissa::command_line()
}
