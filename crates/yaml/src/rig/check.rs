//! Checks of several values of a rig. Values without a key are those of a predefined rig and need no check.

use vibrissa_runtime::rig::{Platform, Rig, Sensing, Shaft};
use vibrissa_runtime::units::{Dimension, format_si};
use vibrissa_text::diagnostic::{Diagnostic, Span};

use super::Places;
use crate::fault;
use crate::reader::Reader;

/// Checks the platform, and that a tick is a whole number of samples.
pub(super) fn check(reader: &mut Reader<'_>, rig: &Rig, places: &Places) {
    if let Some(place) = places.first(&["platform.centre_of_mass", "platform.length"]) {
        centre_of_mass(reader, &rig.platform, place);
    }
    if let Some(place) = places.first(&["sensing.control_rate", "sensing.sample_rate"]) {
        rates(reader, &rig.sensing, place);
    }
    if let Some(place) = places.first(&["sensing.filter_cutoff", "sensing.sample_rate"]) {
        cutoff(reader, &rig.sensing, place);
    }
}

fn centre_of_mass(reader: &mut Reader<'_>, platform: &Platform, place: Span) {
    if platform.centre_of_mass <= platform.length {
        return;
    }
    let label = format!(
        "the centre of mass is {} ahead of the tail, and the platform {} long",
        format_si(platform.centre_of_mass, Dimension::LENGTH),
        format_si(platform.length, Dimension::LENGTH)
    );
    let fault = Diagnostic::error(fault::RIG, "the centre of mass is in front of the platform", place, label);
    reader.report(fault.hint("give `length` and `centre_of_mass`, the second from 0 mm to the first"));
}

/// Reports a shaft that is thicker at the tip than at the base, if `place` has its radius at the tip.
pub(super) fn tip(reader: &mut Reader<'_>, shaft: &Shaft, place: Option<Span>) {
    let (Some(tip_radius), Some(place)) = (shaft.tip_radius, place) else { return };
    if tip_radius <= shaft.radius {
        return;
    }
    let millimetres = |radius| format_si(radius, Dimension::LENGTH);
    let label = format!("at the base the radius is {}", millimetres(shaft.radius));
    let message = format!("the shaft is thicker at the tip: {}", millimetres(tip_radius));
    let fault = Diagnostic::error(fault::RIG, message, place, label);
    reader.report(fault.hint("set `tip_radius` to at most `radius`; without it, the shaft has one radius"));
}

fn cutoff(reader: &mut Reader<'_>, sensing: &Sensing, place: Span) {
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

fn rates(reader: &mut Reader<'_>, sensing: &Sensing, place: Span) {
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
