//! Calibrations of arrays by their own touches of a pin.

use vibrissa::calibration::{ArrayCalibration, TouchLimits};
use vibrissa::diagnostic::Source;
use vibrissa::mismatch::{Mismatch, Property};
use vibrissa::scene::{Scene, WorldKind};
use vibrissa_runtime::calibration::{Parameter, TouchRefusal};

/// A scene with an array that differs from its rig.
fn scene(mismatch: Mismatch) -> Scene {
    let text = std::fs::read_to_string("scenarios/disk.yaml").unwrap();
    let scene = vibrissa::scenario::read(&Source::new("disk.yaml", text)).unwrap();
    Scene { mismatch: Some(mismatch), ..scene }
}

#[cfg(feature = "sim")]
fn plausible(text: &str) -> Mismatch {
    let text = std::fs::read_to_string(text).unwrap();
    vibrissa::scenario::read_mismatch(&Source::new("mismatch.yaml", text)).unwrap()
}

#[test]
fn an_array_measures_its_own_differences_from_the_rig() {
    let mut mismatch = Mismatch::default();
    for (property, value) in [
        (Property::Stiffness, 0.05),
        (Property::Length, 0.5e-3),
        (Property::Direction, 1_f64.to_radians()),
        (Property::Offset, 2e-6),
    ] {
        mismatch.common.set(property, value);
    }
    let scene = scene(mismatch);
    let found = ArrayCalibration::run(&scene, WorldKind::QuasiStatic.into(), 0, &TouchLimits::default()).unwrap();
    assert_eq!(found.within(), [Some(true), Some(true)]);
    for touches in &found.whiskers {
        let fit = touches.fit.as_ref().unwrap();
        assert!(touches.tip_deviation < 0.05e-3, "{touches:?}");
        // A stiffer shaft has larger base angles, like a softer hinge.
        let off = fit.parameters[Parameter::Stiffness.index()] - (1.0 / 1.05 - 1.0);
        assert!(off.abs() < 3.0 * fit.covariance[(0, 0)].sqrt(), "{touches:?}");
        assert!(touches.time.unwrap() < 150.0 && touches.readings.len() <= 20, "{touches:?}");
    }
}

#[test]
fn a_bent_shaft_is_refused_as_bent() {
    let mut mismatch = Mismatch::default();
    mismatch.common.set(Property::TipAside, 8e-3);
    let found =
        ArrayCalibration::run(&scene(mismatch), WorldKind::QuasiStatic.into(), 0, &TouchLimits::default()).unwrap();
    for touches in &found.whiskers {
        assert!(matches!(touches.fit, Err(TouchRefusal::Bent { .. })), "{:?}", touches.fit);
    }
    assert_eq!(found.within(), [None, None]);
}

#[cfg(feature = "sim")]
#[test]
fn a_plausible_array_is_accepted_within_five_minutes() {
    let scene = scene(plausible("scenarios/mismatch/plausible.yaml"));
    let found = ArrayCalibration::run(&scene, WorldKind::Mujoco.into(), 0, &TouchLimits::default()).unwrap();
    for touches in &found.whiskers {
        assert!(touches.fit.is_ok() && touches.tip_deviation < 0.1e-3, "{touches:?}");
        let [friction, deviation] = touches.fit.as_ref().unwrap().sliding_friction;
        assert!((friction - 0.1).abs() < 3.0 * deviation && deviation < 0.02, "{friction} ± {deviation}");
    }
    assert!(found.whiskers.iter().map(|touches| touches.time.unwrap()).sum::<f64>() < 300.0);
}
