//! Passes the linker's arguments for MuJoCo on to the programs of this package, and names the commit.

#![allow(clippy::disallowed_methods, reason = "a build script cannot use the crate that it builds")]

use std::env;
use std::fs;
use std::path::Path;
use std::process::Command;

/// The code of this repository that the program is made of. Only a change of these runs this script again: a commit of other files
/// builds nothing anew, and the program still names a commit with the same sources.
const SOURCES: [&str; 6] = ["src", "grammar", "crates", "web/dist", "Cargo.toml", "Cargo.lock"];

fn main() {
    println!("cargo::rerun-if-changed=build.rs");
    for source in SOURCES.map(Path::new).into_iter().filter(|source| source.exists()) {
        println!("cargo::rerun-if-changed={}", source.display());
    }
    if let Some(commit) = commit() {
        println!("cargo::rustc-env=VIBRISSA_COMMIT={commit}");
    }
    // For binaries, tests, benches and examples alike.
    for argument in env::var("DEP_VIBRISSA_MUJOCO_LINK").iter().flat_map(|arguments| arguments.split('\t')) {
        println!("cargo::rustc-link-arg={argument}");
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
