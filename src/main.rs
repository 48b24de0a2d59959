//! The `vibrissa` command.

fn main() -> std::process::ExitCode {
    // Here and in no library, so that a change of these texts builds only this file again.
    vibrissa::policy::install(&include!("../policies/std/modules.rs"));
    vibrissa::command_line()
}
