//! What `docs/scenarios.md` says is true.

use vibrissa::diagnostic::Source;
use vibrissa::scenario;
use vibrissa::scene::Scene;
use vibrissa_runtime::rig::Rig;

const DOCUMENT: &str = include_str!("../../../docs/scenarios.md");

fn scenarios() -> Vec<Scene> {
    let blocks = DOCUMENT.split("```yaml\n").skip(1).map(|rest| rest.split("```").next().unwrap());
    blocks.map(|block| scenario::read(&Source::new("docs/scenarios.md", block)).unwrap()).collect()
}

#[test]
fn the_rig_that_is_written_out_is_the_reference_rig() {
    let scenarios = scenarios();
    assert_eq!(scenarios.len(), 4);
    // A tunnel wants shorter steps.
    for scenario in scenarios.iter().filter(|scenario| scenario.name != "tunnel") {
        assert_eq!(scenario.rig, Rig::default(), "{}", scenario.name);
    }
}
