//! Runs a scenario from a file under a policy from a file. Prints its figures and writes a picture of the run.
//!
//!     cargo run --no-default-features --example run_scenario -- disk.svg
//!
//! Without an argument, the picture is written to the folder for temporary files.
#![allow(clippy::print_stdout, reason = "an example prints")]
#![allow(clippy::disallowed_methods, reason = "an example opens files by the standard library")]

use std::error::Error;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::{env, fs};

use vibrissa::diagnostic::{Colour, Diagnostic, Source, terminal};
use vibrissa::report::picture;
use vibrissa::scene::WorldKind;
use vibrissa::trial::Trial;
use vibrissa::{policy, scenario};
use vibrissa_runtime::units::Dimension;

fn main() -> Result<(), Box<dyn Error>> {
    let to = env::args_os().nth(1).map_or_else(|| env::temp_dir().join("run_scenario.svg"), PathBuf::from);

    // Errors in a text refer to positions in it. `terminal` shows them with the lines of the text.
    let text = read("scenarios/disk.yaml")?;
    let scene = scenario::read(&text).map_err(|errors| shown(&text, &errors))?;
    let text = read("policies/thesis.fsm")?;
    let mut program = policy::compile(&text).map_err(|errors| shown(&text, &errors))?;

    // A parameter is set by its name. The value is in SI units and must be in the range that the policy states.
    program.set("speed", 0.04, Dimension::SPEED)?;

    // A trial starts with the simulator and the seed of the scenario. Both can be changed.
    let mut trial = Trial::new(scene, Arc::new(program));
    trial.world = WorldKind::QuasiStatic.into();
    let result = trial.run()?;

    let score = &result.score;
    println!("outcome     {}", result.run.outcome);
    if let Some(error) = score.error {
        println!("mean error  {:.3} mm over {} tips", 1e3 * error.mean, error.count);
    }
    println!("coverage    {:.1} %", 100.0 * score.coverage);
    println!("path        {:.2} m", score.path);
    for violation in &result.violations {
        println!("expectation that fails: {violation}");
    }

    fs::write(&to, picture(&trial.scene, &trial.program.name, &result.run, score))?;
    println!("picture     {}", to.display());
    Ok(())
}

/// Reads a text of the repository.
fn read(name: &str) -> Result<Source, std::io::Error> {
    Ok(Source::new(name, fs::read_to_string(Path::new(env!("CARGO_MANIFEST_DIR")).join(name))?))
}

/// The errors of a text, as the commands print them.
fn shown(text: &Source, errors: &[Diagnostic]) -> String {
    terminal(text, errors, Colour::Plain)
}
