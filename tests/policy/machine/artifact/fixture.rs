//! The compiled policy in the documentation of the runtime.

use std::path::Path;

use super::policies::artifact;

/// The runtime cannot compile policies, so its documentation loads a file.
#[test]
fn the_fixture_of_the_runtime_is_the_compiled_policy() {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("crates/runtime/fixtures/bang.machine");
    let compiled = artifact("bang.fsm", include_str!("../../../../policies/bang.fsm")).to_bytes().unwrap();
    if std::env::var("INSTA_UPDATE").is_ok_and(|update| update == "always") {
        std::fs::write(&path, &compiled).unwrap();
    }
    let found = std::fs::read(&path).unwrap_or_default();
    assert!(found == compiled, "{} is stale; run `INSTA_UPDATE=always cargo test --test policy`", path.display());
}
