//! The pictures of the behaviours in the documentation, and their tests.

use std::fs;
use std::path::Path;

use vibrissa::diagnostic::Source;
use vibrissa::policy::chart::View;
use vibrissa::policy::{Checked, chart, check};
use vibrissa::report::chart_svg;

#[test]
fn every_behaviour_has_its_statechart_in_the_documentation_and_a_test_file() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let mut drawn = 0;
    for entry in fs::read_dir(root.join("policies/std")).unwrap() {
        let path = entry.unwrap().path();
        if path.extension().is_none_or(|extension| extension != "fsm") {
            continue;
        }
        let source = Source::new("library.fsm", fs::read_to_string(&path).unwrap());
        let Ok(Checked::Library { behaviours, .. }) = check(&source) else { panic!("{}", path.display()) };
        for name in behaviours {
            let chart = chart(&source).unwrap();
            // The content of the behaviours that it uses has pictures of its own.
            let uses = chart
                .states
                .iter()
                .any(|state| state.name.starts_with(&format!("{name}.")) && state.behaviour.is_some());
            let view = View { state: Some(&name), depth: uses.then_some(1) };
            let svg = chart_svg(&chart.view(view).unwrap()).unwrap();
            let picture = root.join(format!("docs/pictures/behaviours/{name}.svg"));
            if std::env::var("INSTA_UPDATE").is_ok_and(|update| update == "always") {
                fs::write(&picture, &svg).unwrap();
            }
            let found = fs::read_to_string(&picture).unwrap_or_default();
            assert!(found == svg, "{} is stale; run `INSTA_UPDATE=always cargo test --test study`", picture.display());

            let tests = root.join("policies/tests").join(path.file_name().unwrap());
            let text = fs::read_to_string(&tests).unwrap_or_default();
            assert!(text.contains("\ntest ") && text.contains(&name), "{} does not test `{name}`", tests.display());
            drawn += 1;
        }
    }
    assert!(drawn >= 8, "{drawn}");
}
