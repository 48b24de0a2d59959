//! Fits to contact sets, and their errors for sets that were not used.

use std::collections::BTreeMap;
use std::f64::consts::PI;

use serde::Serialize;

use vibrissa_runtime::calibration::{AngleSurface, Calibration, ContactCurve, ContactSet, DeflectionPolynomial};
use vibrissa_runtime::math;
use vibrissa_runtime::rig::Whisker;

use super::hinge_fit::HingeFit;

/// The fits and their errors.
#[derive(Debug, Clone, PartialEq)]
pub struct Fitted {
    /// The fits to all sets.
    pub calibration: Calibration,
    /// The error of each of them.
    pub held_out: Vec<HeldOut>,
}

/// The error of a fit for sets that were not used, by five-fold cross-validation. The sets of one position are held out
/// together.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct HeldOut {
    /// The name of the fit and the estimators that use it.
    pub model: &'static str,
    /// Number of held-out sets within its range.
    pub sets: usize,
    /// Root mean square of the distances (mm).
    pub rms_mm: f64,
    /// The greatest distance (mm).
    pub max_mm: f64,
    /// The range of the fit, or the fitted value.
    pub range: String,
}

/// The fewest positions of tip contacts for a fit.
pub const MIN_POSITIONS: usize = 50;
/// Number of parts into which the positions are divided.
const FOLDS: usize = 5;
/// Standard deviation of the angle between a surface and the heading (rad) for the fits that assume none. The weight of a
/// set follows a normal distribution of this angle.
const SURFACE_DEVIATION: f64 = 10.0 * PI / 180.0;

/// Sets of less weight are omitted.
const MIN_WEIGHT: f64 = 0.1;

/// Fits everything that can be fitted to contact sets of a whisker. Contacts of the shaft are omitted. Sets with a bend
/// to the right are mirrored. There are no fits with fewer than `FEWEST_PLACES` positions, and no fit with too few
/// positions within its range.
#[must_use]
pub fn fit(whisker: &Whisker, sets: &[ContactSet], about: String) -> Fitted {
    let sets: Vec<ContactSet> =
        sets.iter().filter(|set| !set.on_shaft && set.base_angle != 0.0).map(|set| set.to_left()).collect();
    let mut calibration = Calibration::new(about);
    let mut held_out = Vec::new();
    let positions = positions(&sets);
    if positions.iter().max().is_none_or(|last| last + 1 < MIN_POSITIONS) {
        return Fitted { calibration, held_out };
    }

    // One standard deviation of the surface's direction, if it is known.
    let is_meant = |set: &ContactSet| weight(whisker, set) > 0.6;
    let curve = |sets: &[ContactSet]| ContactCurve::fit(&near_heading(whisker, sets));
    calibration.one_channel = ContactCurve::fit(&near_heading(whisker, &sets));
    if let Some(ContactCurve { range, .. }) = &calibration.one_channel {
        let error = |curve: &ContactCurve, set: &ContactSet| {
            let is_within = is_meant(set) && (curve.range[0]..=curve.range[1]).contains(&set.base_angle);
            is_within.then(|| (curve.at(set.base_angle) - set.contact_base).norm())
        };
        let range = format!("{:.0} to {:.0} urad, surface within 10 deg", 1e6 * range[0], 1e6 * range[1]);
        held_out.extend(hold_out("one_channel", (&sets, &positions), curve, error, range));
    }

    let polynomial =
        |sets: &[ContactSet]| DeflectionPolynomial::fit(&near_heading(whisker, sets), whisker.shaft.length);
    calibration.polynomial = DeflectionPolynomial::fit(&near_heading(whisker, &sets), whisker.shaft.length);
    if let Some(DeflectionPolynomial { range, .. }) = calibration.polynomial {
        let error = |polynomial: &DeflectionPolynomial, set: &ContactSet| {
            let is_within = is_meant(set) && set.base_angle <= polynomial.range;
            is_within.then(|| (polynomial.at(set.base_angle) - set.contact_base).norm())
        };
        let range = format!("up to {:.0} urad, surface within 10 deg", 1e6 * range);
        held_out.extend(hold_out("polynomial", (&sets, &positions), polynomial, error, range));
    }

    calibration.recursive = AngleSurface::fit(&sets);
    if let Some(surface) = &calibration.recursive {
        let error = |surface: &AngleSurface, set: &ContactSet| {
            let (base_angle, gradient) = surface.at(set.contact_base);
            let is_within = surface.contains(set.contact_base);
            is_within.then(|| (base_angle - set.base_angle).abs() / gradient.norm())
        };
        let range = format!("between positions within {:.1} mm", 1e3 * surface.reach);
        held_out.extend(hold_out("recursive", (&sets, &positions), AngleSurface::fit, error, range));
    }

    let hinge = HingeFit::new(whisker);
    calibration.hinge_stiffness = hinge.fit(&sets);
    if let Some(stiffness) = calibration.hinge_stiffness {
        let error = |stiffness: &f64, set: &ContactSet| hinge.error(set, *stiffness);
        let range = format!("base hinge {stiffness:.4} N m/rad");
        let fit = |sets: &[ContactSet]| hinge.fit(sets);
        held_out.extend(hold_out("sliding, moment_and_shear", (&sets, &positions), fit, error, range));
    }
    Fitted { calibration, held_out }
}

/// Weight of a set for the fits that assume a surface parallel to the heading.
fn weight(whisker: &Whisker, set: &ContactSet) -> f64 {
    let off = set.normal.map_or(0.0, |normal| (normal - whisker.usual_normal()) / SURFACE_DEVIATION);
    math::exp(-0.5 * off * off)
}

/// The sets with sufficient weight.
fn near_heading(whisker: &Whisker, sets: &[ContactSet]) -> Vec<(ContactSet, f64)> {
    sets.iter().map(|set| (*set, weight(whisker, set))).filter(|(_, weight)| *weight > MIN_WEIGHT).collect()
}

/// The index of each set's position, in the order in which the positions occur. Sets of one position are similar: if
/// some were fitted to, the errors of the others would be too small.
fn positions(sets: &[ContactSet]) -> Vec<usize> {
    let mut numbers = BTreeMap::new();
    let number = |set: &ContactSet| {
        let next = numbers.len();
        *numbers.entry([set.contact_base.x, set.contact_base.y].map(f64::to_bits)).or_insert(next)
    };
    sets.iter().map(number).collect()
}

/// Fits repeatedly without a part of the sets, selected by position, and evaluates the fit on that part.
fn hold_out<F>(
    model: &'static str,
    (sets, positions): (&[ContactSet], &[usize]),
    fit: impl Fn(&[ContactSet]) -> Option<F>,
    error: impl Fn(&F, &ContactSet) -> Option<f64>,
    range: String,
) -> Option<HeldOut> {
    let mut errors = Vec::with_capacity(sets.len());
    for fold in 0..FOLDS {
        let is_held = |index: &usize| positions[*index] % FOLDS == fold;
        let part = |held: bool| (0..sets.len()).filter(move |index| is_held(index) == held).map(|index| sets[index]);
        let fitted = fit(&part(false).collect::<Vec<_>>())?;
        errors.extend(part(true).filter_map(|set| error(&fitted, &set)));
    }
    let mean = errors.iter().map(|error| error * error).sum::<f64>() / errors.len() as f64;
    let max = errors.iter().copied().fold(0.0, f64::max);
    (!errors.is_empty()).then(|| HeldOut {
        model,
        sets: errors.len(),
        rms_mm: 1e3 * mean.sqrt(),
        max_mm: 1e3 * max,
        range,
    })
}
