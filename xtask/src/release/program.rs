//! Archives of the program.

use std::fs;
use std::path::Path;

use super::{Places, ReleaseError, VERSION, host, succeed};
use crate::cargo::cargo;
use crate::cross::{self, Cross};
use crate::pack::{archive, copy, disk};
use crate::platform::Platform;
use crate::python;

/// What an archive has besides the program and [`README`].
const FILES: [&str; 6] = ["CHANGELOG.md", "LICENSE-MIT", "LICENSE-APACHE", "policies", "scenarios", "sweeps"];
/// The first page of an archive. That of the repository leads to pages that an archive does not have.
const README: &str = include_str!("archive.md");
/// The features of a program without MuJoCo: all of the default that do not need it.
const WITHOUT_MUJOCO: &str = "recording live lsp outlines";

/// The archive for this computer. MuJoCo's library and plugin lie beside the program, which looks for them there.
pub(super) fn native(places: &Places) -> Result<(), ReleaseError> {
    // With the crate of the wheel, so that both share their dependencies.
    let mut arguments = vec!["build"];
    arguments.extend(python::RELEASED);
    succeed(cargo(places.root, &arguments), "cargo")?;
    let (os, processor) = Platform::host();
    let libraries = Platform::find(os, processor).map(|platform| [platform.library, platform.plugin]);
    let libraries = libraries.into_iter().flatten().map(|name| Path::new(".mujoco/lib").join(name));
    let program = places.target.join("release/vibrissa");
    pack(places, &host(), &program, libraries.map(|path| places.root.join(path)))
}

/// The archive for aarch64.
pub(super) fn aarch64(places: &Places) -> Result<(), ReleaseError> {
    let cross = Cross::find(places.root)?;
    let arguments = ["build", "--release", "--package", "vibrissa", "--bin", "vibrissa", "--no-default-features"];
    let mut command = cargo(places.root, &arguments);
    command.args(["--features", WITHOUT_MUJOCO, "--target", cross::TARGET]);
    cross.set(&mut command);
    succeed(command, "cargo")?;
    let program = places.target.join(cross::TARGET).join("release/vibrissa");
    pack(places, AARCH64, &program, [])
}

/// The name of the archive for aarch64 says what it lacks.
pub(super) const AARCH64: &str = "aarch64-linux-without-mujoco";

/// The name of an archive and of the folder in it.
pub(super) fn name(kind: &str) -> String {
    format!("vibrissa-{VERSION}-{kind}")
}

fn pack(
    places: &Places,
    kind: &str,
    program: &Path,
    libraries: impl IntoIterator<Item = std::path::PathBuf>,
) -> Result<(), ReleaseError> {
    let name = name(kind);
    let files = places.staging.join(&name);
    copy(program, &files.join("vibrissa"))?;
    for library in libraries {
        copy(&library, &files.join(library.file_name().unwrap_or_default()))?;
    }
    for file in FILES {
        copy(&places.root.join(file), &files.join(file))?;
    }
    let readme = files.join("README.md");
    fs::write(&readme, README).map_err(disk("write", &readme))?;
    archive(&places.staging, &name, &places.folder)?;
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_first_page_of_an_archive_leads_to_nothing_that_the_archive_lacks() {
        assert!(!README.contains("]("), "links would lead to the repository");
        for file in ["policies", "scenarios", "sweeps", "CHANGELOG.md"] {
            assert!(FILES.contains(&file) && README.contains(&format!("`{file}`")), "{file}");
        }
    }
}
