//! Names the sources that a simulated figure depends on, so that the program does not use what another version of it has kept.

use std::env;
use std::fs;
use std::hash::{DefaultHasher, Hasher};
use std::path::Path;

/// The code below the commands, from this package. A package of this crate alone has only its own.
const SOURCES: [&str; 9] = [
    "src",
    "../declare/src",
    "../language/grammar",
    "../language/src",
    "../mujoco/src",
    "../robot/src",
    "../runtime/src",
    "../world/src",
    "../../Cargo.lock",
];

/// Sets `VIBRISSA_SOURCES` to a hash of the sources.
fn main() {
    println!("cargo::rerun-if-changed=build.rs");
    let mut hash = DefaultHasher::new();
    for source in SOURCES.map(Path::new) {
        if source.exists() {
            println!("cargo::rerun-if-changed={}", source.display());
            add_source(source, &mut hash);
        }
    }
    hash.write(env::var("CARGO_PKG_VERSION").unwrap_or_default().as_bytes());
    println!("cargo::rustc-env=VIBRISSA_SOURCES={:016x}", hash.finish());
    // The unit tests run MuJoCo.
    for argument in env::var("DEP_VIBRISSA_MUJOCO_LINK").iter().flat_map(|arguments| arguments.split('\t')) {
        println!("cargo::rustc-link-arg={argument}");
    }
}

/// Adds the names and contents of files, in the order of their names.
#[allow(clippy::disallowed_methods, reason = "a build script cannot use the crate that it builds")]
fn add_source(path: &Path, hash: &mut DefaultHasher) {
    let Ok(entries) = fs::read_dir(path) else {
        hash.write(path.as_os_str().as_encoded_bytes());
        hash.write(&fs::read(path).unwrap_or_default());
        return;
    };
    let mut paths: Vec<_> = entries.flatten().map(|entry| entry.path()).collect();
    paths.sort();
    for path in paths {
        add_source(&path, hash);
    }
}
