//! Linker arguments of the extension module.

use std::env;

fn main() {
    println!("cargo::rerun-if-changed=build.rs");
    // On macOS, Python's symbols are there only when the module is loaded.
    pyo3_build_config::add_extension_module_link_args();
    if env::var_os("CARGO_CFG_TARGET_OS").is_some_and(|system| system == "linux") {
        // The module has functions under MuJoCo's names, which pass calls on. MuJoCo's library shall not take them for its own.
        println!("cargo::rustc-cdylib-link-arg=-Wl,--exclude-libs,ALL");
    }
}
