//! What is told of a file that gives no outlines.

use vibrissa::diagnostic::{Colour, Source, terminal};
use vibrissa::scenario;

use super::folder;
use crate::snapshots::snapshots;

#[test]
fn every_bad_file_is_answered_as_reviewed() {
    snapshots("outlines").bind(|| {
        insta::glob!("../../fixtures/outlines/bad", "*.yaml", |path| {
            let name = path.file_name().unwrap().to_string_lossy();
            let source = Source::new(name, std::fs::read_to_string(path).unwrap());
            let bad = folder().join("bad");
            let files = &mut |file: &str| std::fs::read(bad.join(file)).map_err(|error| error.to_string());
            let faults = scenario::read_with(&source, files).unwrap_err();
            insta::assert_snapshot!("bad", terminal(&source, &faults, Colour::Plain));
        });
    });
}
