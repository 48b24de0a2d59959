//! Where reviewed output lies.

use std::path::Path;

/// Snapshots in a folder of `snapshots/`, called as they are named and no more.
pub(crate) fn snapshots(folder: &str) -> insta::Settings {
    let mut settings = insta::Settings::clone_current();
    // A test of a crate has the manifest of the crate.
    let manifests = Path::new(env!("CARGO_MANIFEST_DIR")).ancestors();
    let root = manifests.into_iter().find(|folder| folder.join("snapshots").is_dir());
    settings.set_snapshot_path(root.unwrap().join("snapshots").join(folder));
    settings.set_prepend_module_to_snapshot(false);
    settings.set_omit_expression(true);
    settings
}
