//! Computes two own metrics from the trace of a run, and prints them beside the declared ones.
//!
//!     cargo run --no-default-features --example add_metric
//!
//! The page `docs/howto/extend.md` explains how to make a metric a part of the score.
#![allow(clippy::print_stdout, reason = "an example prints")]

use std::error::Error;
use std::sync::Arc;

use vibrissa::built_in::{DEFAULT_POLICY, SCENARIOS, TextFile};
use vibrissa::diagnostic::{Colour, Diagnostic, Source, terminal};
use vibrissa::figures::Metric;
use vibrissa::run::Trace;
use vibrissa::scene::WorldKind;
use vibrissa::trial::Trial;
use vibrissa::{policy, scenario};
use vibrissa_runtime::units::format_si;

fn main() -> Result<(), Box<dyn Error>> {
    let scene = scenario::read(&source(SCENARIOS[0])).map_err(|errors| shown(SCENARIOS[0], &errors))?;
    let program = policy::compile(&source(DEFAULT_POLICY)).map_err(|errors| shown(DEFAULT_POLICY, &errors))?;
    let mut trial = Trial::new(scene, Arc::new(program));
    trial.world = WorldKind::QuasiStatic.into();
    let result = trial.run()?;

    let (trace, score) = (&result.run.trace, &result.score);
    println!("declared metrics that scenarios can bound");
    for metric in Metric::ALL.into_iter().filter(|metric| metric.figure().bound.is_some()) {
        if let Some(value) = score.figure(metric) {
            println!("  {:<22} {}", metric.name(), format_si(value, metric.figure().dimension()));
        }
    }
    println!("own metrics");
    match mean_contact_duration(trace) {
        Some(duration) => println!("  mean contact duration  {duration:.2} s"),
        None => println!("  mean contact duration  no contact"),
    }
    let traced = score.coverage * trial.scene.truth.reference.length();
    println!("  path efficiency        {:.2} m of contour per m of path", traced / score.path);
    Ok(())
}

/// The mean duration (s) of the contacts of all whiskers. A contact is a series of ticks in which a whisker touches.
/// `None` without contacts. A figure that a run does not have is not zero.
fn mean_contact_duration(trace: &Trace) -> Option<f64> {
    let (mut contacts, mut ticks) = (0_usize, 0_usize);
    for whisker in 0..trace.whiskers.len() {
        let mut touched = false;
        for tick in &trace.ticks {
            let touches = tick.whiskers[whisker].contact.is_touching;
            ticks += usize::from(touches);
            contacts += usize::from(touches && !touched);
            touched = touches;
        }
    }
    (contacts > 0).then(|| ticks as f64 * trace.period / contacts as f64)
}

fn source(file: TextFile) -> Source {
    Source::new(file.path, file.text)
}

/// The errors of a text, as the commands print them.
fn shown(file: TextFile, errors: &[Diagnostic]) -> String {
    terminal(&source(file), errors, Colour::Plain)
}
