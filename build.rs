//! Lets programs find MuJoCo's library where set-up put it, with no environment variable, and names the sources for the cache.

#![allow(clippy::disallowed_methods, reason = "a build script cannot use the crate that it builds")]

use std::env;
use std::fs;
use std::hash::{DefaultHasher, Hasher};
use std::path::Path;
use std::process::exit;

/// The directory that mujoco-rs links against; `.cargo/config.toml` sets it.
const LINK_DIR: &str = "MUJOCO_DYNAMIC_LINK_DIR";
/// Everything of this repository that the results of a simulation depend on. A package does not have the folder of the runtime, whose
/// version is in the other file.
const SOURCES: [&str; 3] = ["src", "crates/runtime/src", "Cargo.lock"];

fn main() {
    println!("cargo::rerun-if-changed=build.rs");
    name_sources();
    if env::var_os("CARGO_FEATURE_SIM").is_none() {
        return;
    }
    println!("cargo::rerun-if-env-changed={LINK_DIR}");
    // Without the variable, mujoco-rs looks for a MuJoCo of the system, which the loader finds by itself.
    let Ok(directory) = env::var(LINK_DIR) else { return };

    let link_name = match env::var("CARGO_CFG_TARGET_OS").as_deref() {
        Ok("macos") => "libmujoco.dylib",
        _ => "libmujoco.so",
    };
    let library = Path::new(&directory).join(link_name);
    println!("cargo::rerun-if-changed={}", library.display());
    if !library.is_file() {
        println!("cargo::error=MuJoCo is not set up: run `cargo x setup` ({} is missing)", library.display());
        exit(1);
    }
    // For binaries, tests, benches and examples alike. The library is looked for there when it is first needed.
    println!("cargo::rustc-link-arg=-Wl,-rpath,{directory}");
    if link_name.ends_with("dylib") {
        // Apple's linker notes every library down that it is given, others those that something is needed of.
        println!("cargo::rustc-link-arg=-Wl,-dead_strip_dylibs");
    } else {
        // Functions that the program has under MuJoCo's names are its own: the library shall not take them for those in itself.
        println!("cargo::rustc-link-arg=-Wl,--exclude-libs,ALL");
    }
}

/// Sets `VIBRISSA_SOURCES` to a hash of the sources, so that the program does not use what another version of it has kept.
fn name_sources() {
    let mut hash = DefaultHasher::new();
    for source in SOURCES.map(Path::new) {
        if source.exists() {
            println!("cargo::rerun-if-changed={}", source.display());
            add_source(source, &mut hash);
        }
    }
    println!("cargo::rustc-env=VIBRISSA_SOURCES={:016x}", hash.finish());
}

/// Adds the names and contents of files, in the order of their names.
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
