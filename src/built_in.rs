//! The scenarios and policies that the program carries, so that the bench runs wherever it does.

/// A text that is part of the program.
#[derive(Debug, Clone, Copy)]
pub struct TextFile {
    /// Where it is in the repository.
    pub path: &'static str,
    /// What it says.
    pub text: &'static str,
}

macro_rules! text_file {
    ($path:literal) => {
        TextFile { path: $path, text: include_str!(concat!("../", $path)) }
    };
}

/// The scenes of the thesis, in its order.
pub const SCENARIOS: &[TextFile] = &[
    text_file!("scenarios/disk.yaml"),
    text_file!("scenarios/rounded-rectangle.yaml"),
    text_file!("scenarios/complex.yaml"),
    text_file!("scenarios/octagon.yaml"),
    text_file!("scenarios/box.yaml"),
    text_file!("scenarios/prism.yaml"),
    text_file!("scenarios/wall.yaml"),
    text_file!("scenarios/smooth-tunnel.yaml"),
    text_file!("scenarios/zigzag-tunnel.yaml"),
    text_file!("scenarios/round-tunnel.yaml"),
];

/// The policies that the bench runs unless it is given others. They use the standard library alone.
pub const POLICIES: &[TextFile] = &[text_file!("policies/thesis.fsm"), DEFAULT_POLICY];

/// The policy that runs in scenes of families unless another is given.
pub const DEFAULT_POLICY: TextFile = text_file!("policies/vibrissa.fsm");

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "a test may panic")]
    use std::path::Path;

    use super::*;
    use crate::diagnostic::Source;
    use crate::policy::{compile, gather};
    use crate::scenario;
    use crate::study::bench::{THESIS, thesis_figures};

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
            assert!(thesis_figures(&scene.name).is_some(), "{} is no scene of the thesis", scene.name);
        }
        let order: Vec<_> = THESIS.iter().map(|figures| format!("scenarios/{}.yaml", figures.scenario)).collect();
        let place = |file: &TextFile| order.iter().position(|path| path == file.path);
        assert!(SCENARIOS.iter().map(place).is_sorted());
    }

    #[test]
    fn the_policies_need_nothing_but_the_program() {
        for file in POLICIES {
            let source = gather(&Source::new(file.path, file.text), &mut |path| Err(format!("{path} is not built in")));
            compile(&source).unwrap();
        }
    }
}
