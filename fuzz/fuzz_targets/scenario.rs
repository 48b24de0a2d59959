//! Any text as a scenario.
#![no_main]

use vibrissa::scenario;
use vibrissa::diagnostic::{Colour, Source, terminal};

libfuzzer_sys::fuzz_target!(|text: &str| {
    let source = Source::new("scenario.yaml", text);
    if let Err(faults) = scenario::read(&source) {
        assert!(!faults.is_empty() && !terminal(&source, &faults, Colour::Plain).is_empty());
    }
});
