//! Fits to sets, and how well they hold for sets that they have not seen.

use std::collections::BTreeMap;
use std::f64::consts::PI;

use serde::Serialize;

use vibrissa_runtime::calibration::{AngleSurface, Calibration, ContactCurve, ContactSet};
use vibrissa_runtime::rig::Whisker;

use super::hinge_fit::HingeFit;

/// What was fitted.
#[derive(Debug, Clone, PartialEq)]
pub struct Fitted {
    /// The fits to all sets.
    pub calibration: Calibration,
    /// How well each of them holds.
    pub held_out: Vec<HeldOut>,
}

/// How far a fit is off for sets that it has not seen: every fifth place is held out, with all its sets, five times.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
pub struct HeldOut {
    /// What was fitted, and what it is for.
    pub model: &'static str,
    /// How many sets were held out and are in its range.
    pub sets: usize,
    /// Root of the mean square of the distances (mm).
    pub rms_mm: f64,
    /// The greatest distance (mm).
    pub max_mm: f64,
    /// In what range it holds, or what was found.
    pub range: String,
}

/// The fewest places of touches by the tip that anything is fitted to.
pub const FEWEST_PLACES: usize = 50;
/// Into how many parts the places are divided.
const FOLDS: usize = 5;
/// How far a surface may be from parallel to the heading (rad) for a set to count for one channel: a standard deviation, and its weight
/// falls by a normal distribution.
const SURFACE_SPREAD: f64 = 10.0 * PI / 180.0;

/// Sets that count less are left out.
const LEAST_WEIGHT: f64 = 0.1;

/// Fits everything that can be fitted to sets of a whisker. Those of touches on the shaft are left out, and those that bend it to the
/// right count as their mirror images. With fewer places than [`FEWEST_PLACES`] nothing is fitted, and nothing that has too few in its range.
#[must_use]
pub fn fit(whisker: &Whisker, sets: &[ContactSet], about: String) -> Fitted {
    let sets: Vec<ContactSet> =
        sets.iter().filter(|set| !set.on_shaft && set.base_angle != 0.0).map(|set| set.to_left()).collect();
    let mut calibration = Calibration::new(about);
    let mut held_out = Vec::new();
    let places = places(&sets);
    if places.iter().max().is_none_or(|last| last + 1 < FEWEST_PLACES) {
        return Fitted { calibration, held_out };
    }

    let curve = |sets: &[ContactSet]| near_heading(whisker, sets);
    calibration.one_channel = near_heading(whisker, &sets);
    if let Some(ContactCurve { range, .. }) = &calibration.one_channel {
        let miss = |curve: &ContactCurve, set: &ContactSet| {
            // One standard deviation of the surface's direction, where it is known.
            let is_meant = weight(whisker, set) > 0.6 && (curve.range[0]..=curve.range[1]).contains(&set.base_angle);
            is_meant.then(|| (curve.at(set.base_angle) - set.contact_base).norm())
        };
        let range = format!("{:.0} to {:.0} urad, surface within 10 deg", 1e6 * range[0], 1e6 * range[1]);
        held_out.extend(hold_out("one_channel", (&sets, &places), curve, miss, range));
    }

    calibration.recursive = AngleSurface::fit(&sets);
    if let Some(surface) = &calibration.recursive {
        let miss = |surface: &AngleSurface, set: &ContactSet| {
            let (base_angle, gradient) = surface.at(set.contact_base);
            let is_within = surface.contains(set.contact_base);
            is_within.then(|| (base_angle - set.base_angle).abs() / gradient.norm())
        };
        let range = format!("between places within {:.1} mm", 1e3 * surface.reach);
        held_out.extend(hold_out("recursive", (&sets, &places), AngleSurface::fit, miss, range));
    }

    let hinge = HingeFit::new(whisker);
    calibration.hinge_stiffness = hinge.fit(&sets);
    if let Some(stiffness) = calibration.hinge_stiffness {
        let miss = |stiffness: &f64, set: &ContactSet| hinge.miss(set, *stiffness);
        let range = format!("base hinge {stiffness:.4} N m/rad");
        let fit = |sets: &[ContactSet]| hinge.fit(sets);
        held_out.extend(hold_out("sliding, moment_and_shear", (&sets, &places), fit, miss, range));
    }
    Fitted { calibration, held_out }
}

/// How much a set counts for one channel.
fn weight(whisker: &Whisker, set: &ContactSet) -> f64 {
    let off = set.normal.map_or(0.0, |normal| (normal - whisker.usual_normal()) / SURFACE_SPREAD);
    (-0.5 * off * off).exp()
}

/// The curve of one channel, by the sets that count for it.
fn near_heading(whisker: &Whisker, sets: &[ContactSet]) -> Option<ContactCurve> {
    let weighted = sets.iter().map(|set| (*set, weight(whisker, set))).filter(|(_, weight)| *weight > LEAST_WEIGHT);
    ContactCurve::fit(&weighted.collect::<Vec<_>>())
}

/// The number of every set's place, in the order in which the places come. Sets of one place are much alike: those that are fitted to
/// would tell of those that are held out.
fn places(sets: &[ContactSet]) -> Vec<usize> {
    let mut numbers = BTreeMap::new();
    let number = |set: &ContactSet| {
        let next = numbers.len();
        *numbers.entry([set.contact_base.x, set.contact_base.y].map(f64::to_bits)).or_insert(next)
    };
    sets.iter().map(number).collect()
}

/// Fits again and again without a part of the sets, by their places, and judges by that part.
fn hold_out<F>(
    model: &'static str,
    (sets, places): (&[ContactSet], &[usize]),
    fit: impl Fn(&[ContactSet]) -> Option<F>,
    miss: impl Fn(&F, &ContactSet) -> Option<f64>,
    range: String,
) -> Option<HeldOut> {
    let mut misses = Vec::with_capacity(sets.len());
    for fold in 0..FOLDS {
        let is_held = |index: &usize| places[*index] % FOLDS == fold;
        let part = |held: bool| (0..sets.len()).filter(move |index| is_held(index) == held).map(|index| sets[index]);
        let fitted = fit(&part(false).collect::<Vec<_>>())?;
        misses.extend(part(true).filter_map(|set| miss(&fitted, &set)));
    }
    let mean = misses.iter().map(|miss| miss * miss).sum::<f64>() / misses.len() as f64;
    let max = misses.iter().copied().fold(0.0, f64::max);
    (!misses.is_empty()).then(|| HeldOut {
        model,
        sets: misses.len(),
        rms_mm: 1e3 * mean.sqrt(),
        max_mm: 1e3 * max,
        range,
    })
}
