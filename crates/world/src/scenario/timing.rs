//! Reader of `rig.sensing`, and the consistency of its rates with the simulation step.

use super::fault;
use super::fields::Fields;
use super::key::Key;
use super::node::Entry;
use super::reader::Reader;
use crate::physics::Physics;
use vibrissa_runtime::rig::keys::sensing::{
    ANGLE_NOISE, CONTACT_THRESHOLD, CONTROL_RATE, FILTER_CUTOFF, SAMPLE_RATE, SURFACE_ROUGHNESS,
};
use vibrissa_runtime::rig::{Estimation, Rig, Sensing};
use vibrissa_runtime::units::{Dimension, format_si};
use vibrissa_text::diagnostic::{Diagnostic, Span};

pub(super) const STEP: Key = Key::new("step", Dimension::TIME, (1e-6, 1.0), "3.33 ms");
pub(super) const CALM_STEP: Key = Key::new("calm_step", Dimension::TIME, (1e-6, 1.0), "3.33 ms");

const FRICTION: Key = Key::new("friction", Dimension::NUMBER, (0.0, 10.0), "0.3");
const FORCE_NOISE: Key = Key::new("force_noise", Dimension::FORCE, (0.0, 1.0), "0.002 mN");
const ANGLE_RESOLUTION: Key = Key::new("angle_resolution", Dimension::ANGLE, (0.0, 1.0), "1 urad");

/// The relative tolerance for a step that is a rounded fraction of the sample period, such as 3.33 ms for 1/300 s.
const ROUNDED: f64 = 2e-3;

/// The spans of the keys that must be consistent, as far as they are given.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct TimingSpans {
    pub(super) step: Option<Span>,
    pub(super) sample_rate: Option<Span>,
    pub(super) control_rate: Option<Span>,
    pub(super) filter_cutoff: Option<Span>,
}

/// Reads `sensing`, and stores the spans of its rates.
pub(super) fn read_sensing(reader: &mut Reader<'_>, entry: &Entry, sensing: &mut Sensing, places: &mut TimingSpans) {
    let Some(mut fields) = Fields::of(reader, &entry.value, "the sensing", entry.key.span) else { return };
    places.sample_rate = fields.set(reader, &SAMPLE_RATE, &mut sensing.sample_rate);
    places.control_rate = fields.set(reader, &CONTROL_RATE, &mut sensing.control_rate);
    places.filter_cutoff = fields.set(reader, &FILTER_CUTOFF, &mut sensing.filter_cutoff);
    fields.set(reader, &CONTACT_THRESHOLD, &mut sensing.contact_threshold);
    fields.set(reader, &FRICTION, &mut sensing.friction);
    fields.set(reader, &SURFACE_ROUGHNESS, &mut sensing.surface_roughness);
    fields.set(reader, &ANGLE_NOISE, &mut sensing.angle_noise);
    fields.set(reader, &ANGLE_RESOLUTION, &mut sensing.angle_resolution);
    if let Some(entry) = fields.entry("forces")
        && let Some(forces) = reader.flag(&entry.value)
    {
        sensing.forces = forces;
    }
    fields.set(reader, &FORCE_NOISE, &mut sensing.force_noise);
    if let Some(entry) = fields.entry("estimation") {
        read_estimation(reader, entry, &mut sensing.estimation);
    }
    fields.finish(reader);
}

/// Reads the switches of the estimates of perception.
fn read_estimation(reader: &mut Reader<'_>, entry: &Entry, estimation: &mut Estimation) {
    let Some(mut fields) = Fields::of(reader, &entry.value, "the estimation", entry.key.span) else { return };
    let Estimation { lost_readings, offset, noise, delay, friction, pose_noise } = estimation;
    for (name, switch) in [
        ("lost_readings", lost_readings),
        ("offset", offset),
        ("noise", noise),
        ("delay", delay),
        ("friction", friction),
        ("pose_noise", pose_noise),
    ] {
        if let Some(entry) = fields.entry(name)
            && let Some(flag) = reader.flag(&entry.value)
        {
            *switch = flag;
        }
    }
    fields.finish(reader);
}

/// Checks that a tick is a whole number of samples, and adjusts the step to the sample period. Values without a key are
/// those of the reference rig and need no check.
pub(super) fn check(reader: &mut Reader<'_>, rig: &Rig, physics: &mut Physics, places: TimingSpans) {
    if let Some(place) = places.control_rate.or(places.sample_rate) {
        check_rates(reader, &rig.sensing, place);
    }
    if let Some(place) = places.step.or(places.sample_rate) {
        fit_step(reader, physics, rig.sensing.sample_rate, place);
    }
    fit_to_samples(physics, rig.sensing.sample_rate);
    if let Some(place) = places.filter_cutoff.or(places.sample_rate) {
        check_cutoff(reader, &rig.sensing, place);
    }
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

fn check_cutoff(reader: &mut Reader<'_>, sensing: &Sensing, place: Span) {
    let highest = 0.5 * sensing.sample_rate;
    if sensing.filter_cutoff < highest {
        return;
    }
    let hertz = |rate| format_si(rate, Dimension::FREQUENCY);
    let message = format!("a filter cannot have its cutoff at {}", hertz(sensing.filter_cutoff));
    let label = format!("must be below half of the sample rate, {}", hertz(highest));
    let fault = Diagnostic::error(fault::TIMING, message, place, label);
    reader.report(fault.hint("for example `filter_cutoff: 20 Hz`, or sample faster"));
}

fn check_rates(reader: &mut Reader<'_>, sensing: &Sensing, place: Span) {
    let samples = sensing.sample_rate / sensing.control_rate;
    if samples.round() >= 1.0 && (samples - samples.round()).abs() <= 1e-9 * samples {
        return;
    }
    let hertz = |rate| format_si(rate, Dimension::FREQUENCY);
    let label = format!("{} samples a tick", format_si(samples, Dimension::NUMBER));
    let message = format!(
        "the sample rate of {} is no whole multiple of the control rate of {}",
        hertz(sensing.sample_rate),
        hertz(sensing.control_rate)
    );
    let whole = samples.round().max(1.0);
    let hint = format!(
        "for example `sample_rate: {}`, or `control_rate: {}`",
        hertz(sensing.control_rate * whole),
        hertz(sensing.sample_rate / whole)
    );
    reader.report(Diagnostic::error(fault::TIMING, message, place, label).hint(hint));
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
