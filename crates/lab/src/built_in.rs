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
    /// Its name, such as `disk`, or `zoo/gear12` for a shape of the zoo.
    #[must_use]
    pub fn name(&self) -> &'static str {
        let in_zoo = self.path.strip_prefix("scenarios/").filter(|path| path.starts_with("zoo/"));
        in_zoo.and_then(|path| path.strip_suffix(".yaml")).unwrap_or_else(|| self.stem())
    }

    /// The name of the file without its ending.
    pub(crate) fn stem(&self) -> &'static str {
        Path::new(self.path).file_stem().and_then(|name| name.to_str()).unwrap_or(self.path)
    }

    /// The one of `files` with this name, such as `disk`. A path with an ending or another folder is no name.
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

/// Shapes that no policy was made for.
pub const ZOO: &[TextFile] = &[
    text_file!("scenarios/zoo/cad-bracket.yaml"),
    text_file!("scenarios/zoo/dead-end.yaml"),
    text_file!("scenarios/zoo/gear12.yaml"),
    text_file!("scenarios/zoo/letter-e.yaml"),
    text_file!("scenarios/zoo/plus.yaml"),
    text_file!("scenarios/zoo/poles.yaml"),
    text_file!("scenarios/zoo/ring-inside.yaml"),
    text_file!("scenarios/zoo/room.yaml"),
    text_file!("scenarios/zoo/sawtooth.yaml"),
    text_file!("scenarios/zoo/slots.yaml"),
    text_file!("scenarios/zoo/star5.yaml"),
    text_file!("scenarios/zoo/t-junction.yaml"),
];

/// All scenes that have a name: those of the bench, and the [`ZOO`].
pub const NAMED_SCENARIOS: &[TextFile] = &{
    let mut all = [SCENARIOS[0]; SCENARIOS.len() + ZOO.len()];
    let mut index = 1;
    while index < all.len() {
        all[index] = if index < SCENARIOS.len() { SCENARIOS[index] } else { ZOO[index - SCENARIOS.len()] };
        index += 1;
    }
    all
};

/// The policies that the bench runs unless it is given others. They use the standard library alone.
pub const POLICIES: &[TextFile] = &[text_file!("policies/thesis.fsm"), DEFAULT_POLICY];

/// The policy that maps rooms, which the playground offers.
pub const ROOM_POLICY: TextFile = text_file!("policies/explore.fsm");

/// The mismatch of an array that is made with care and that nobody has calibrated.
pub const PLAUSIBLE_MISMATCH: TextFile = text_file!("scenarios/mismatch/plausible.yaml");

/// The differences of a real array, which the bench has unless another is given.
pub const REAL_MISMATCH: TextFile = text_file!("scenarios/mismatch/real.yaml");

/// The mismatches that have a name.
pub const MISMATCHES: &[TextFile] = &[PLAUSIBLE_MISMATCH, REAL_MISMATCH];

/// The policy that runs in scenes of families unless another is given.
pub const DEFAULT_POLICY: TextFile = text_file!("policies/vibrissa.fsm");
