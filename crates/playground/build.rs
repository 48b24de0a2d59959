//! Passes the linker's arguments for MuJoCo on to the tests. Beside the other packages, they are built with it.

use std::env;

fn main() {
    println!("cargo::rerun-if-changed=build.rs");
    for argument in env::var("DEP_VIBRISSA_MUJOCO_LINK").iter().flat_map(|arguments| arguments.split('\t')) {
        println!("cargo::rustc-link-arg={argument}");
    }
}
