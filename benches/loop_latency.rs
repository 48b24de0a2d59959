//! The latency of the control loop in every scene of the bench and every phase of a policy.
//!
//! `POLICY=FILE cargo bench --bench loop_latency` measures the policy in that file instead of the built-in ones. The samples are
//! those of runs in the quasi-static simulator, which works between the ticks as other programs do on a robot.

#![allow(clippy::print_stdout, clippy::print_stderr, reason = "a bench prints")]

use std::env;
use std::error::Error;
use std::fs;
use std::process::ExitCode;
use std::sync::Arc;

use vibrissa::built_in::{POLICIES, SCENARIOS};
use vibrissa::diagnostic::{Colour, Source, terminal};
use vibrissa::policy::{compile, gather};
use vibrissa::report::latency_table;
use vibrissa::scenario;
use vibrissa::scene::WorldKind;
use vibrissa::study::latency::LatencyRow;
use vibrissa::trial::{ExecuteError, Trial};
use vibrissa_runtime::machine::Program;

/// Repetitions of each run.
const REPETITIONS: usize = 5;

fn main() -> ExitCode {
    match measure() {
        Ok(rows) => {
            println!("{}", latency_table(&rows).wide());
            ExitCode::SUCCESS
        }
        Err(error) => {
            eprintln!("error: {error}");
            ExitCode::FAILURE
        }
    }
}

fn measure() -> Result<Vec<LatencyRow>, Box<dyn Error>> {
    // Cargo passes `--bench` to measure. Without it, as in CI, one run shows that this program works.
    let is_measured = env::args().any(|argument| argument == "--bench");
    let (scenarios, repetitions) = if is_measured { (SCENARIOS, REPETITIONS) } else { (&SCENARIOS[..1], 1) };
    let programs = programs()?;
    let mut rows = Vec::new();
    for file in scenarios {
        let scene = scenario::read(&Source::new(file.path, file.text)).map_err(|faults| format!("{faults:?}"))?;
        for program in &programs {
            let trial = Trial::new(scene.clone(), Arc::clone(program));
            let trial = Trial { world: WorldKind::QuasiStatic.into(), ..trial };
            let runs = (0..repetitions).map(|_| Ok(trial.run()?.run)).collect::<Result<Vec<_>, ExecuteError>>();
            let runs = runs.map_err(|error| format!("{} under {}: {error}", scene.name, program.name))?;
            rows.extend(LatencyRow::of(&scene.name, &program.name, &runs));
        }
    }
    Ok(rows)
}

/// The policy that `POLICY` names, or the built-in ones.
fn programs() -> Result<Vec<Arc<Program>>, Box<dyn Error>> {
    let sources = match env::var("POLICY") {
        Ok(path) => vec![Source::new(path.clone(), read(&path)?)],
        Err(_) => POLICIES.iter().map(|file| Source::new(file.path, file.text)).collect(),
    };
    let compiled = |source: &Source| -> Result<Arc<Program>, Box<dyn Error>> {
        let source = gather(source, &mut read);
        let program = compile(&source).map_err(|faults| terminal(&source, &faults, Colour::Plain))?;
        Ok(Arc::new(program))
    };
    sources.iter().map(compiled).collect()
}

/// The text of a policy or of a file that it uses.
#[expect(clippy::disallowed_methods, reason = "a bench may open files")]
fn read(path: &str) -> Result<String, String> {
    fs::read_to_string(path).map_err(|error| format!("cannot read {path}: {error}"))
}
