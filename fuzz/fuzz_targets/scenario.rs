//! Any text as a scenario.
#![no_main]

use vibrissa::diagnostic::{Colour, Source, terminal};
use vibrissa::scene::Scene;

libfuzzer_sys::fuzz_target!(|text: &str| {
    let source = Source::new("scenario.yaml", text);
    if let Err(faults) = Scene::from_yaml(&source) {
        assert!(!faults.is_empty() && !terminal(&source, &faults, Colour::Plain).is_empty());
    }
});
