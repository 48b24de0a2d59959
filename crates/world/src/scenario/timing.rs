//! The consistency of simulation steps with the rate of samples.

use super::fault;
use super::reader::Reader;
use crate::physics::Physics;
use vibrissa_runtime::units::{Dimension, format_si};
use vibrissa_text::diagnostic::{Diagnostic, Span};
use vibrissa_yaml::rig::Places;

/// The relative tolerance for a step that is a rounded fraction of the sample period, such as 3.33 ms for 1/300 s.
const ROUNDED: f64 = 2e-3;

/// Adjusts the steps to the period of samples. Values without a key are those of a preset and need no check.
pub(super) fn fit(reader: &mut Reader<'_>, sample_rate: f64, physics: &mut Physics, places: &Places) {
    if let Some(place) = places.first(&["physics.step", "sensing.sample_rate"]) {
        fit_step(reader, physics, sample_rate, place);
    }
    fit_to_samples(physics, sample_rate);
}

/// Rounds the longest step and the contact time to the sample period, with the tolerance of a step.
fn fit_to_samples(physics: &mut Physics, sample_rate: f64) {
    let period = sample_rate.recip();
    for time in [&mut physics.calm_step, &mut physics.contact_time] {
        if (*time / period - 1.0).abs() <= ROUNDED {
            *time = period;
        }
    }
}

fn fit_step(reader: &mut Reader<'_>, physics: &mut Physics, sample_rate: f64, place: Span) {
    let period = sample_rate.recip();
    let steps = period / physics.step;
    let whole = steps.round();
    if whole >= 1.0 && (steps - whole).abs() <= ROUNDED * whole {
        physics.step = period / whole;
        return;
    }
    let seconds = |time| format_si(time, Dimension::TIME);
    let message =
        format!("a step of {} does not divide the sample period of {}", seconds(physics.step), seconds(period));
    let label = format!("{} steps a sample", format_si(steps, Dimension::NUMBER));
    let fitting = period / steps.ceil().max(1.0);
    let hint = format!("for example `step: {}` in `physics`, a whole part of the period", seconds(fitting));
    reader.report(Diagnostic::error(fault::TIMING, message, place, label).hint(hint));
}
