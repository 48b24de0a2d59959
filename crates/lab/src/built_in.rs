//! The scenarios and policies that the program carries, so that the bench runs wherever it does.

use std::path::Path;

/// A text that is part of the program.
#[derive(Debug, Clone, Copy)]
pub struct TextFile {
    /// Where it is in the repository.
    pub path: &'static str,
    /// What it says.
    pub text: &'static str,
}

impl TextFile {
    /// Its name, such as `disk`.
    #[must_use]
    pub fn name(&self) -> &'static str {
        Path::new(self.path).file_stem().and_then(|name| name.to_str()).unwrap_or(self.path)
    }

    /// The one of `files` with this name, such as `disk`. A path with a folder or an ending is no name.
    #[must_use]
    pub fn named(files: &'static [Self], name: &Path) -> Option<&'static Self> {
        files.iter().find(|file| Path::new(file.name()) == name)
    }
}

macro_rules! text_file {
    ($path:literal) => {
        TextFile { path: $path, text: include_str!(concat!("../", $path)) }
    };
}

/// The baseline's scenes, in its order.
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

/// The mismatch of an array that is made with care and that nobody has calibrated.
pub const PLAUSIBLE_MISMATCH: TextFile = text_file!("scenarios/mismatch/plausible.yaml");

/// The mismatches that have a name.
pub const MISMATCHES: &[TextFile] = &[PLAUSIBLE_MISMATCH];

/// The policy that runs in scenes of families unless another is given.
pub const DEFAULT_POLICY: TextFile = text_file!("policies/vibrissa.fsm");
