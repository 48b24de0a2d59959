//! The robot's program for the Raspberry Pi: an archive and a Debian package.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, ExitStatus};

use thiserror::Error;

use crate::cargo::{NotStarted, cargo, target_directory};
use crate::cross::{self, Cross, CrossError};
use crate::pack::{self, PackError, TIME, copy, disk, set_modes, succeed};

/// The package, and its program.
const PACKAGE: &str = "vibrissa-robot";
/// The version. All packages of the workspace have the same one.
const VERSION: &str = env!("CARGO_PKG_VERSION");
/// Size (bytes) that the program must stay below.
const MOST_BYTES: u64 = 8_000_000;
/// The folder of the service files.
const SERVICE: &str = "deploy/pi";
/// The files of the Debian package besides the program and `control`: their paths in the checkout and in the package.
const FILES: [(&str, &str); 10] = [
    ("deploy/pi/vibrissa-robot.service", "usr/lib/systemd/system/vibrissa-robot.service"),
    ("deploy/pi/99-vibrissa.rules", "usr/lib/udev/rules.d/99-vibrissa.rules"),
    ("deploy/pi/array.yaml", "etc/vibrissa/array.yaml"),
    ("deploy/pi/README.md", "usr/share/doc/vibrissa-robot/README.md"),
    ("LICENSE-MIT", "usr/share/doc/vibrissa-robot/LICENSE-MIT"),
    ("LICENSE-APACHE", "usr/share/doc/vibrissa-robot/LICENSE-APACHE"),
    ("deploy/pi/debian/conffiles", "DEBIAN/conffiles"),
    ("deploy/pi/debian/postinst", "DEBIAN/postinst"),
    ("deploy/pi/debian/prerm", "DEBIAN/prerm"),
    ("deploy/pi/debian/postrm", "DEBIAN/postrm"),
];
/// The files of the archive besides the program, in the same form.
const ARCHIVED: [(&str, &str); 8] = [
    ("deploy/pi/vibrissa-robot.service", "vibrissa-robot.service"),
    ("deploy/pi/99-vibrissa.rules", "99-vibrissa.rules"),
    ("deploy/pi/array.yaml", "array.yaml"),
    ("deploy/pi/README.md", "README.md"),
    ("deploy/pi/install.sh", "install.sh"),
    ("deploy/pi/debian/postinst", "debian/postinst"),
    ("LICENSE-MIT", "LICENSE-MIT"),
    ("LICENSE-APACHE", "LICENSE-APACHE"),
];
/// The template of the package's description.
const CONTROL: &str = "deploy/pi/debian/control";

/// Why there is nothing for the Raspberry Pi, and what to do.
#[derive(Debug, Error)]
pub(crate) enum PiError {
    #[error(transparent)]
    Cross(#[from] CrossError),
    #[error(transparent)]
    Cargo(#[from] NotStarted),
    #[error("{program}: it failed ({status}); what it said is above")]
    Failed { program: &'static str, status: ExitStatus },
    #[error(
        "the program has {0} bytes, and must have fewer than {MOST_BYTES}. See what is large:\n  cargo bloat --profile robot --package {PACKAGE} --crates"
    )]
    TooLarge(u64),
    #[error(transparent)]
    Pack(#[from] PackError),
}

/// Builds the program, checks its size, and packs it with the service files of `deploy/pi`.
/// The result are the paths of the archive and of the package.
pub(crate) fn pack(root: &Path) -> Result<[PathBuf; 2], PiError> {
    let target = target_directory(root);
    let program = build(root, &target)?;
    let size = fs::metadata(&program).map_err(disk("read", &program))?.len();
    if size >= MOST_BYTES {
        return Err(PiError::TooLarge(size));
    }
    let folder = target.join("pi");
    let staging = folder.join("staging");
    if staging.exists() {
        fs::remove_dir_all(&staging).map_err(disk("clear", &staging))?;
    }
    let archive = archive(root, &program, &folder, &staging)?;
    let package = package(root, &program, &folder, &staging)?;
    fs::remove_dir_all(&staging).map_err(disk("clear", &staging))?;
    println!("{PACKAGE} {VERSION} for aarch64, {size} bytes:\n  {}\n  {}", archive.display(), package.display());
    println!("{SERVICE}/README.md says how to install it.");
    Ok([archive, package])
}

/// Builds the program and gives its path.
fn build(root: &Path, target: &Path) -> Result<PathBuf, PiError> {
    let cross = Cross::find(root)?;
    let arguments = ["build", "--profile", "robot", "--package", PACKAGE, "--target", cross::TARGET];
    println!("cargo {}", arguments.join(" "));
    let mut command = cargo(root, &arguments);
    let status = cross.set(&mut command).status();
    let status = status.map_err(|source| NotStarted { program: "cargo", source })?;
    if !status.success() {
        return Err(PiError::Failed { program: "cargo", status });
    }
    Ok(target.join(cross::TARGET).join("robot").join(PACKAGE))
}

/// Writes the archive with `install.sh`.
fn archive(root: &Path, program: &Path, folder: &Path, staging: &Path) -> Result<PathBuf, PiError> {
    let name = format!("{PACKAGE}-{VERSION}-aarch64");
    let files = staging.join(&name);
    copy(program, &files.join(PACKAGE))?;
    for (from, to) in ARCHIVED {
        copy(&root.join(from), &files.join(to))?;
    }
    Ok(pack::archive(staging, &name, folder)?)
}

/// Writes the Debian package.
fn package(root: &Path, program: &Path, folder: &Path, staging: &Path) -> Result<PathBuf, PiError> {
    let files = staging.join("debian");
    copy(program, &files.join("usr/bin").join(PACKAGE))?;
    for (from, to) in FILES {
        copy(&root.join(from), &files.join(to))?;
    }
    let from = root.join(CONTROL);
    let text = fs::read_to_string(&from).map_err(disk("read", &from))?;
    let size = fs::metadata(program).map_err(disk("read", program))?.len();
    let to = files.join("DEBIAN/control");
    fs::write(&to, control(&text, size)).map_err(disk("write", &to))?;
    set_modes(&files)?;
    let path = folder.join(format!("{PACKAGE}_{VERSION}_arm64.deb"));
    let mut command = Command::new("dpkg-deb");
    // The number of threads of xz would change the bytes.
    command.env("SOURCE_DATE_EPOCH", TIME).env("DPKG_DEB_THREADS_MAX", "1");
    command.args(["--root-owner-group", "-Zxz", "--build"]).arg(&files).arg(&path);
    succeed(&mut command, "dpkg-deb", "dpkg")?;
    Ok(path)
}

/// The control file of the Debian package, for a program of this size (bytes). The other files are small.
fn control(text: &str, size: u64) -> String {
    text.replace("@VERSION@", VERSION).replace("@KIB@", &size.div_ceil(1024).to_string())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn root() -> &'static Path {
        Path::new(env!("CARGO_MANIFEST_DIR")).parent().unwrap_or(Path::new("."))
    }

    #[test]
    fn all_packed_files_exist() {
        for (from, _) in FILES.into_iter().chain(ARCHIVED) {
            assert!(root().join(from).is_file(), "{from}");
        }
    }

    #[test]
    fn the_description_has_version_and_size() {
        let text = control(&fs::read_to_string(root().join(CONTROL)).unwrap_or_default(), 5_000_000);
        assert!(
            text.contains(&format!("\nVersion: {VERSION}\n")) && text.contains("\nInstalled-Size: 4883\n"),
            "{text}"
        );
        assert!(!text.contains('@'), "{text}");
    }

    #[test]
    fn files_with_settings_are_packed_as_such() {
        let listed = fs::read_to_string(root().join("deploy/pi/debian/conffiles")).unwrap_or_default();
        let listed: Vec<_> = listed.lines().map(|line| line.trim_start_matches('/')).collect();
        let settings: Vec<_> = FILES.iter().map(|(_, to)| *to).filter(|to| to.starts_with("etc/")).collect();
        assert_eq!(listed, settings);
    }

    #[test]
    fn the_service_runs_the_packed_program_with_the_packed_settings() {
        let unit = fs::read_to_string(root().join(FILES[0].0)).unwrap_or_default();
        let start = unit.lines().find_map(|line| line.strip_prefix("ExecStart=")).unwrap_or_default();
        assert!(
            start.starts_with(&format!("/usr/bin/{PACKAGE} ")) && start.contains("/etc/vibrissa/array.yaml"),
            "{start}"
        );
        // The default store of the program is in the service's directory of state.
        assert!(!start.contains("--store") && unit.contains("\nStateDirectory=vibrissa\n"), "{unit}");
    }
}
