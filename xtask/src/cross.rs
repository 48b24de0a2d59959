//! Builds for aarch64, the processor of the Raspberry Pi.

use std::env;
use std::ffi::OsString;
use std::path::Path;
use std::process::Command;

use thiserror::Error;

use crate::standard_library::{self, LibraryError};

/// The target.
pub(crate) const TARGET: &str = "aarch64-unknown-linux-gnu";
/// What runs a program for aarch64 on another processor, with its arguments.
pub(crate) const EMULATOR: [&str; 3] = ["qemu-aarch64-static", "-L", "/usr/aarch64-linux-gnu"];
/// What a cross build needs besides Rust: the Debian package, and a file or a program of it.
const NEEDS: [(&str, &str); 3] = [
    ("gcc-aarch64-linux-gnu", "aarch64-linux-gnu-gcc"),
    ("libc6-dev-arm64-cross", "/usr/aarch64-linux-gnu/lib/crt1.o"),
    ("qemu-user-static", EMULATOR[0]),
];

/// The settings with which Cargo builds for aarch64 and runs what it has built.
#[derive(Debug, Default)]
pub(crate) struct Cross(Vec<(&'static str, OsString)>);

/// Why there is no build for aarch64, and what to do.
#[derive(Debug, Error)]
pub(crate) enum CrossError {
    #[error("a build for aarch64 needs {}. On Debian and Ubuntu:\n  apt-get install {}", .0.join(", "), .0.join(" "))]
    Packages(Vec<&'static str>),
    #[error("there is no standard library for {TARGET}. Install it:\n  rustup target add {TARGET}")]
    Library,
    #[error(transparent)]
    Built(#[from] LibraryError),
}

impl Cross {
    /// Looks for compiler, emulator and standard library. The standard library may have to be built first.
    pub(crate) fn find(root: &Path) -> Result<Self, CrossError> {
        if cfg!(all(target_arch = "aarch64", target_os = "linux")) {
            return Ok(Self::default());
        }
        let missing = missing(&is_there);
        if !missing.is_empty() {
            return Err(CrossError::Packages(missing));
        }
        let mut settings = vec![
            ("CARGO_TARGET_AARCH64_UNKNOWN_LINUX_GNU_LINKER", "aarch64-linux-gnu-gcc".into()),
            ("CARGO_TARGET_AARCH64_UNKNOWN_LINUX_GNU_RUNNER", EMULATOR.join(" ").into()),
        ];
        if !standard_library::is_installed(TARGET) {
            let folder = standard_library::built(root)?.ok_or(CrossError::Library)?;
            // Cargo separates the flags of this variable by this character, so that paths may have blanks.
            let mut flags = OsString::from("--sysroot\u{1f}");
            flags.push(folder);
            settings.push(("CARGO_ENCODED_RUSTFLAGS", flags));
        }
        Ok(Self(settings))
    }

    /// Adds the settings to a Cargo command with `--target`.
    pub(crate) fn set<'a>(&self, command: &'a mut Command) -> &'a mut Command {
        command.envs(self.0.iter().map(|(name, value)| (name, value)))
    }
}

impl CrossError {
    /// True if a developer's machine may do without. CI must not.
    pub(crate) fn may_be_left_out(&self) -> bool {
        matches!(self, Self::Packages(_) | Self::Library) && env::var_os("CI").is_none_or(|ci| ci.is_empty())
    }
}

/// The packages that are not installed.
fn missing(is_there: &dyn Fn(&str) -> bool) -> Vec<&'static str> {
    NEEDS.iter().filter(|(_, file)| !is_there(file)).map(|(package, _)| *package).collect()
}

/// True if a path exists, or a program is on the `PATH`.
fn is_there(file: &str) -> bool {
    // Joining an absolute path gives that path.
    let folders = env::var_os("PATH").unwrap_or_default();
    env::split_paths(&folders).any(|folder| folder.join(file).is_file())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_missing_packages_are_named_with_the_command_that_installs_them() {
        assert!(missing(&|_| true).is_empty());
        let text = CrossError::Packages(missing(&|file| file == "aarch64-linux-gnu-gcc")).to_string();
        assert!(text.ends_with("apt-get install libc6-dev-arm64-cross qemu-user-static"), "{text}");
    }

    #[test]
    fn programs_are_looked_for_on_the_path_and_files_at_their_place() {
        assert!(is_there("sh") && is_there("/bin/sh"));
        assert!(!is_there("no-such-program") && !is_there("/nonexistent/file"));
    }
}
