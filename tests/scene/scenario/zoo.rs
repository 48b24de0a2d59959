//! The shapes of the zoo.

use std::collections::BTreeSet;
use std::path::Path;

use vibrissa::built_in::{NAMED_SCENARIOS, TextFile, ZOO};
use vibrissa::diagnostic::{Colour, Source, terminal};
use vibrissa::family::Family;
use vibrissa::scenario;
use vibrissa::scene::{Expectation, Scene};
use vibrissa_declare::figures::Metric;

fn shapes() -> impl Iterator<Item = (&'static TextFile, Scene)> {
    ZOO.iter().map(|file| {
        let source = Source::new(file.path, file.text);
        let scene = scenario::read(&source).map_err(|faults| terminal(&source, &faults, Colour::Plain));
        (file, scene.unwrap_or_else(|faults| panic!("{faults}")))
    })
}

#[test]
fn the_program_has_every_shape_of_the_folder_by_the_name_of_its_scene() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("scenarios/zoo");
    let there: BTreeSet<_> = folder.read_dir().unwrap().map(|entry| entry.unwrap().file_name()).collect();
    let known: BTreeSet<_> = shapes().map(|(_, scene)| format!("{}.yaml", scene.name).into()).collect();
    assert_eq!(known, there, "list it in ZOO");
    for (file, scene) in shapes() {
        let name = format!("zoo/{}", scene.name);
        assert_eq!(TextFile::named(NAMED_SCENARIOS, Path::new(&name)).unwrap().path, file.path);
        assert!(file.text.contains(&format!("#     vibrissa run {name}\n")), "{name}");
    }
}

#[test]
fn every_shape_has_the_rig_of_inner_corners_and_one_expectation() {
    let corner = Family::named("concave-corner").unwrap().draw(1, 0).unwrap().scene;
    for (_, scene) in shapes() {
        assert_eq!((&scene.rig, &scene.physics), (&corner.rig, &corner.physics), "{}", scene.name);
        for (metric, bound) in [(Metric::CoverageInReach, 0.95), (Metric::Collisions, 0.0)] {
            assert!(scene.expect.contains(&Expectation::Bound { metric, bound }), "{}", scene.name);
        }
    }
}
