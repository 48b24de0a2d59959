//! Finds MuJoCo's library where set-up put it, and passes the linker's arguments to the packages that make programs.

use std::env;
use std::path::Path;
use std::process::exit;

/// The directory that mujoco-rs links against; `.cargo/config.toml` sets it.
const LINK_DIR: &str = "MUJOCO_DYNAMIC_LINK_DIR";

fn main() {
    println!("cargo::rerun-if-changed=build.rs");
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
    // The library is looked for there when it is first needed.
    let directory = format!("-Wl,-rpath,{directory}");
    let own_functions = if link_name.ends_with("dylib") {
        // Apple's linker notes every library down that it is given, others those that something is needed of.
        "-Wl,-dead_strip_dylibs"
    } else {
        // Functions that a program has under MuJoCo's names are its own: the library shall not take them for those in itself.
        "-Wl,--exclude-libs,ALL"
    };
    for argument in [&directory, own_functions] {
        println!("cargo::rustc-link-arg={argument}");
    }
    // These count for this package alone. Others get them as the variable `DEP_VIBRISSA_MUJOCO_LINK`.
    println!("cargo::metadata=link={directory}\t{own_functions}");
}
