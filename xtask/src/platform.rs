//! The platforms that MuJoCo is published for, and what is fetched on each.

use std::env::consts::{ARCH, OS};

/// The release of MuJoCo that the package's version of mujoco-rs is bound to.
pub(crate) const MUJOCO_VERSION: &str = "3.17.0";

/// One platform's wheel, and the library and the plugin within it.
///
/// The wheels of all Python versions carry the same ones; the one for CPython 3.11 is pinned, whichever Python
/// runs.
#[derive(Debug, PartialEq, Eq)]
pub(crate) struct Platform {
    os: &'static str,
    arch: &'static str,
    /// What pip calls this platform.
    pub(crate) pip_tag: &'static str,
    /// SHA-256 of the wheel, in lower-case hexadecimal.
    pub(crate) wheel_sha256: &'static str,
    /// The library's file name, which is also the name that a linked program asks the loader for.
    pub(crate) library: &'static str,
    /// The file name that the linker looks for.
    pub(crate) link_name: &'static str,
    /// The file name of MuJoCo's plugin for cables.
    pub(crate) plugin: &'static str,
}

const PLATFORMS: [Platform; 3] = [
    Platform {
        os: "linux",
        arch: "x86_64",
        pip_tag: "manylinux_2_28_x86_64",
        wheel_sha256: "d66928d86a2d1b601bbaa4dc11db50214d17d5301bb8afd84721313b67ff0874",
        library: "libmujoco.so.3.17.0",
        link_name: "libmujoco.so",
        plugin: "libelasticity.so",
    },
    Platform {
        os: "linux",
        arch: "aarch64",
        pip_tag: "manylinux_2_28_aarch64",
        wheel_sha256: "91a70ed9979c383ff1f5c03f25cc2e1280a8254c1a8e558d5dd7f4184f01efc9",
        library: "libmujoco.so.3.17.0",
        link_name: "libmujoco.so",
        plugin: "libelasticity.so",
    },
    Platform {
        os: "macos",
        arch: "aarch64",
        pip_tag: "macosx_11_0_arm64",
        wheel_sha256: "6c324addca24a24a7b0beff2ec49300e9d4481fd8ccd611514ba7ea8e4a5e870",
        library: "libmujoco.3.17.0.dylib",
        link_name: "libmujoco.dylib",
        plugin: "libelasticity.dylib",
    },
];

impl Platform {
    /// The platform of an operating system and a processor, by Rust's names for them.
    pub(crate) fn find(os: &str, arch: &str) -> Option<&'static Self> {
        PLATFORMS.iter().find(|platform| platform.os == os && platform.arch == arch)
    }

    /// The operating system and the processor that this program was built for.
    pub(crate) fn host() -> (&'static str, &'static str) {
        // MuJoCo's library needs glibc.
        (if cfg!(target_env = "musl") { "linux with musl" } else { OS }, ARCH)
    }

    /// The line of a pip requirements file that pins the wheel.
    pub(crate) fn requirement(&self) -> String {
        format!("mujoco=={MUJOCO_VERSION} --hash=sha256:{}\n", self.wheel_sha256)
    }

    /// The library's path within the wheel.
    pub(crate) fn library_in_wheel(&self) -> String {
        format!("mujoco/{}", self.library)
    }

    /// The plugin's path within the wheel.
    pub(crate) fn plugin_in_wheel(&self) -> String {
        format!("mujoco/plugin/{}", self.plugin)
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "a test may panic")]

    use std::collections::HashSet;
    use std::fs;

    use super::*;

    #[test]
    fn each_platform_has_a_wheel_and_a_hash_of_its_own() {
        let tags: HashSet<_> = PLATFORMS.iter().map(|platform| platform.pip_tag).collect();
        let hashes: HashSet<_> = PLATFORMS.iter().map(|platform| platform.wheel_sha256).collect();
        assert_eq!((tags.len(), hashes.len()), (PLATFORMS.len(), PLATFORMS.len()));
        for platform in &PLATFORMS {
            assert_eq!(platform.wheel_sha256.len(), 64);
            assert!(platform.wheel_sha256.bytes().all(|byte| matches!(byte, b'0'..=b'9' | b'a'..=b'f')));
        }
    }

    #[test]
    fn a_platform_is_found_by_the_names_that_rust_uses() {
        assert_eq!(Platform::find("linux", "aarch64").unwrap().pip_tag, "manylinux_2_28_aarch64");
        assert_eq!(Platform::find("macos", "aarch64").unwrap().link_name, "libmujoco.dylib");
    }

    #[test]
    fn a_platform_without_a_wheel_is_not_found() {
        assert_eq!(Platform::find("windows", "x86_64"), None);
        assert_eq!(Platform::find("macos", "x86_64"), None);
        assert_eq!(Platform::find("linux with musl", "x86_64"), None);
    }

    #[test]
    fn every_library_carries_the_version() {
        assert!(PLATFORMS.iter().all(|platform| platform.library.contains(MUJOCO_VERSION)));
    }

    #[test]
    fn the_requirement_pins_version_and_hash() {
        let requirement = Platform::find("linux", "x86_64").unwrap().requirement();
        assert_eq!(
            requirement,
            "mujoco==3.17.0 --hash=sha256:d66928d86a2d1b601bbaa4dc11db50214d17d5301bb8afd84721313b67ff0874\n"
        );
    }

    #[test]
    fn the_version_is_the_one_that_mujoco_rs_is_bound_to() {
        let lock = fs::read_to_string("../Cargo.lock").unwrap();
        let mujoco_rs = lock.split("[[package]]").find(|entry| entry.contains("name = \"mujoco-rs\"")).unwrap();
        assert!(mujoco_rs.contains(&format!("+mj-{MUJOCO_VERSION}\"")));
    }
}
