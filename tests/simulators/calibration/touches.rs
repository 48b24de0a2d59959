//! Calibrations of arrays by their own touches of a pin.

use vibrissa::calibration::{TouchLimits, WhiskerTouches};
use vibrissa::diagnostic::Source;
use vibrissa::mismatch::{Mismatch, Property};
use vibrissa::scene::{Scene, WorldKind};
use vibrissa::study::ArrayCalibration;
use vibrissa_runtime::calibration::Parameter;

/// A scene with an array that differs from its rig.
fn scene(mismatch: Mismatch) -> Scene {
    let text = std::fs::read_to_string("scenarios/disk.yaml").unwrap();
    let scene = vibrissa::scenario::read(&Source::new("disk.yaml", text)).unwrap();
    Scene { mismatch: Some(mismatch), ..scene }
}

fn plausible(text: &str) -> Mismatch {
    let text = std::fs::read_to_string(text).unwrap();
    vibrissa::scenario::read_mismatch(&Source::new("mismatch.yaml", text)).unwrap()
}

fn report(found: &ArrayCalibration) {
    for touches in &found.whiskers {
        let WhiskerTouches { whisker, readings, missed, tip_deviation, first_in_air, time, fit } = touches;
        let deviation = 1e6 * tip_deviation;
        println!(
            "{whisker}: {} touches, {missed} missed, tip sd {deviation:.1} um, {time:.0} s, air {first_in_air:e}",
            readings.len()
        );
        match fit {
            Ok(fit) => {
                for parameter in Parameter::ALL {
                    let index = parameter.index();
                    let deviation = fit.covariance[(index, index)].sqrt();
                    println!("   {:10} {:+.3e} +- {deviation:.1e}", parameter.name(), fit.parameters[index]);
                }
                println!("   chi-square {:.1}, residuals {:.1?}", fit.chi_square, fit.residuals);
            }
            Err(refusal) => println!("   {refusal}"),
        }
    }
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
    report(&found);
    for touches in &found.whiskers {
        let fit = touches.fit.as_ref().unwrap();
        assert!(touches.tip_deviation < 0.05e-3, "{touches:?}");
        // A stiffer shaft has larger base angles, like a softer hinge.
        let off = fit.parameters[Parameter::Stiffness.index()] - (1.0 / 1.05 - 1.0);
        assert!(off.abs() < 3.0 * fit.covariance[(0, 0)].sqrt(), "{touches:?}");
        assert!(touches.time < 150.0 && touches.readings.len() <= 20, "{touches:?}");
    }
}

#[test]
fn a_plausible_array_is_accepted_within_five_minutes() {
    for (file, kind) in [("scenarios/mismatch/plausible.yaml", WorldKind::Mujoco)] {
        let scene = scene(plausible(file));
        let found = ArrayCalibration::run(&scene, kind.into(), 0, &TouchLimits::default()).unwrap();
        report(&found);
        assert!(found.whiskers.iter().all(|touches| touches.fit.is_ok()));
        assert!(found.whiskers.iter().map(|touches| touches.time).sum::<f64>() < 300.0);
    }
}
