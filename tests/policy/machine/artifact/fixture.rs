//! The compiled policies in the documentation and the tests of the runtime.

use std::path::Path;

use super::policies::artifact;

/// The runtime cannot compile policies, so its documentation and its tests load files.
#[test]
fn the_fixtures_of_the_runtime_are_the_compiled_policies() {
    for name in ["bang", "thesis", "vibrissa"] {
        let root = Path::new(concat!(env!("CARGO_MANIFEST_DIR"), "/../.."));
        let path = root.join(format!("crates/runtime/fixtures/{name}.machine"));
        let text = std::fs::read_to_string(root.join(format!("policies/{name}.fsm"))).unwrap();
        let compiled = artifact(&format!("{name}.fsm"), &text).to_bytes().unwrap();
        if std::env::var("INSTA_UPDATE").is_ok_and(|update| update == "always") {
            std::fs::write(&path, &compiled).unwrap();
        }
        let found = std::fs::read(&path).unwrap_or_default();
        assert!(
            found == compiled,
            "{} is stale; run `INSTA_UPDATE=always cargo test --workspace --test policy`",
            path.display()
        );
    }
}
