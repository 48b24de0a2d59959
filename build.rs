//! Lets programs find MuJoCo's library where set-up put it, with no environment variable, and names the commit and the sources.

#![allow(clippy::disallowed_methods, reason = "a build script cannot use the crate that it builds")]

use std::env;
use std::fs;
use std::hash::{DefaultHasher, Hasher};
use std::path::Path;
use std::process::{Command, exit};

/// The directory that mujoco-rs links against; `.cargo/config.toml` sets it.
const LINK_DIR: &str = "MUJOCO_DYNAMIC_LINK_DIR";
/// The code of this repository that the program is made of. A package does not have the folders of other crates, whose versions are in
/// the last file. Only a change of these runs this script again: a commit of other files builds nothing anew, and the program still names
/// a commit with the same sources.
const SOURCES: [&str; 9] = [
    "src",
    "grammar",
    "crates/mlx90393/src",
    "crates/mlx90393-emulator/src",
    "crates/robot/src",
    "crates/runtime/src",
    "web/dist",
    "Cargo.toml",
    "Cargo.lock",
];

fn main() {
    println!("cargo::rerun-if-changed=build.rs");
    name_sources();
    if let Some(commit) = commit() {
        println!("cargo::rustc-env=VIBRISSA_COMMIT={commit}");
    }
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

/// The commit of the sources, followed by `modified` if they differ from it: of the checkout, or of the package. `None` for sources
/// without either.
fn commit() -> Option<String> {
    // A package names the commit that it was made of. It may lie in the checkout of another project.
    let package = fs::read_to_string(".cargo_vcs_info.json").unwrap_or_default();
    if let Some(commit) =
        package.split('"').find(|word| word.len() == 40 && word.bytes().all(|c| c.is_ascii_hexdigit()))
    {
        let is_modified = package.contains("\"dirty\": true");
        return Some(if is_modified { format!("{commit} modified") } else { commit.to_owned() });
    }
    let own = Path::new(&env::var_os("CARGO_MANIFEST_DIR")?).canonicalize().ok()?;
    let top = git(&["rev-parse", "--show-toplevel"])?;
    if Path::new(&top).canonicalize().ok()? != own {
        return None;
    }
    let commit = git(&["rev-parse", "HEAD"])?;
    let changes = git(&[&["status", "--porcelain", "--"][..], &SOURCES].concat())?;
    Some(if changes.is_empty() { commit } else { format!("{commit} modified") })
}

/// The output of git. `None` if there is none, or if it fails.
fn git(arguments: &[&str]) -> Option<String> {
    let output = Command::new("git").arg("--no-optional-locks").args(arguments).output().ok()?;
    let text = String::from_utf8(output.stdout).ok()?;
    output.status.success().then(|| text.trim().to_owned())
}
