//! The baseline's results in its ten scenes.

use serde::Serialize;

/// A mean and a sample standard deviation (mm), as far as the baseline reports them.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct Reported {
    /// Mean.
    pub mean: f64,
    /// Sample standard deviation.
    pub std: Option<f64>,
}

/// The baseline's results in one scene (sections 5.1 to 5.3 of its report).
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct BaselineFigures {
    /// Name of the scenario.
    #[serde(skip)]
    pub scenario: &'static str,
    /// Mean absolute error of the contour.
    pub error_mm: Reported,
    /// Retrieval radius. `None` in scenes without a retrieval.
    pub radius_mm: Option<Reported>,
    /// Axis error. `None` outside of tunnels.
    pub axis_mm: Option<Reported>,
}

/// The ten scenes in the baseline's order.
pub const BASELINE: [BaselineFigures; 10] = [
    swiped("disk", (0.8, 0.5)),
    swiped("rounded-rectangle", (0.8, 0.6)),
    // "About 0.8", with no deviation.
    BaselineFigures { error_mm: Reported { mean: 0.8, std: None }, ..swiped("complex", (0.8, 0.0)) },
    retrieved("octagon", (1.1, 0.8), (20.9, 1.7)),
    retrieved("box", (0.7, 0.4), (11.2, 1.9)),
    retrieved("prism", (0.8, 0.6), (8.8, 0.6)),
    retrieved("wall", (1.1, 0.6), (10.2, 0.7)),
    tunnelled("smooth-tunnel", (1.3, 1.6), (4.0, 4.0)),
    tunnelled("zigzag-tunnel", (2.0, 2.0), (9.0, 10.0)),
    tunnelled("round-tunnel", (3.0, 2.0), (5.0, 6.0)),
];

/// The baseline's results in the scene with this name. `None` for a scene that the baseline does not have.
#[must_use]
pub(super) fn baseline_figures(scenario: &str) -> Option<&'static BaselineFigures> {
    BASELINE.iter().find(|figures| figures.scenario == scenario)
}

const fn swiped(scenario: &'static str, error: (f64, f64)) -> BaselineFigures {
    BaselineFigures { scenario, error_mm: reported(error), radius_mm: None, axis_mm: None }
}

const fn retrieved(scenario: &'static str, error: (f64, f64), radius: (f64, f64)) -> BaselineFigures {
    BaselineFigures { radius_mm: Some(reported(radius)), ..swiped(scenario, error) }
}

const fn tunnelled(scenario: &'static str, error: (f64, f64), axis: (f64, f64)) -> BaselineFigures {
    BaselineFigures { axis_mm: Some(reported(axis)), ..swiped(scenario, error) }
}

const fn reported((mean, std): (f64, f64)) -> Reported {
    Reported { mean, std: Some(std) }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "a test may panic")]
    use std::path::Path;

    use super::*;
    use crate::built_in::{POLICIES, SCENARIOS, TextFile};
    use vibrissa_language::{compile, gather};
    use vibrissa_text::diagnostic::Source;
    use vibrissa_world::scenario;

    #[test]
    fn the_bench_has_every_scenario_of_the_folder_and_each_is_called_like_its_file() {
        let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("scenarios");
        let files = folder.read_dir().unwrap().map(|entry| entry.unwrap().path());
        let files = files.filter(|path| path.extension().is_some_and(|end| end == "yaml"));
        let mut there: Vec<_> = files.map(|path| path.file_name().unwrap().to_owned()).collect();
        there.sort();
        let mut known: Vec<_> =
            SCENARIOS.iter().map(|file| Path::new(file.path).file_name().unwrap().to_owned()).collect();
        known.sort();
        assert_eq!(known, there, "list it in SCENARIOS");
        for file in SCENARIOS {
            let scene = scenario::read(&Source::new(file.path, file.text)).unwrap();
            assert_eq!(format!("scenarios/{}.yaml", scene.name), file.path);
            assert!(baseline_figures(&scene.name).is_some(), "{} is not a scene of the baseline", scene.name);
        }
        let order: Vec<_> = BASELINE.iter().map(|figures| format!("scenarios/{}.yaml", figures.scenario)).collect();
        let index = |file: &TextFile| order.iter().position(|path| path == file.path);
        assert!(SCENARIOS.iter().map(index).is_sorted());
    }

    #[test]
    fn the_policies_need_nothing_but_the_program() {
        for file in POLICIES {
            let source = gather(&Source::new(file.path, file.text), &mut |path| Err(format!("{path} is not built in")));
            compile(&source).unwrap();
        }
    }
}
