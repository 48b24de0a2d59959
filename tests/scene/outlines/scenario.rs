//! Scenarios with outlines from files.

use std::path::Path;

use vibrissa::diagnostic::Source;
use vibrissa::geometry::Point2;
use vibrissa::scene::Scene;

/// Reads a scenario's text, its files from the folder of the example.
fn scene(text: &str) -> Scene {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("scenarios/outlines");
    let files = &mut |file: &str| std::fs::read(folder.join(file)).map_err(|error| error.to_string());
    Scene::from_yaml_with(&Source::new("gripper.yaml", text), files).unwrap()
}

#[test]
fn the_example_is_as_large_as_it_is_drawn_and_stands_where_it_should() {
    let scene = scene(include_str!("../../../scenarios/outlines/gripper.yaml"));
    let outline = scene.solids[0].outline();
    let bounds = outline.bounding_box();
    assert!((bounds.min - Point2::new(0.115, 0.29)).norm() + (bounds.max - Point2::new(0.635, 1.16)).norm() < 2e-6);
    assert!(outline.corners().is_empty() && !outline.is_convex());
    assert!(outline.contains(Point2::new(0.375, 0.42)), "no hole for the bolt");
}

#[test]
fn the_page_shows_an_object_that_can_be_read() {
    let page = include_str!("../../../docs/scenarios.md");
    let from = page.find("    objects:\n      - outline:").unwrap();
    let lines: Vec<&str> = page[from..].lines().map_while(|line| line.strip_prefix("    ")).collect();
    let rest = "start: {position: [0 m, 72 mm], heading: 90 deg}\nstop: {time: 1 s}";
    let scene = scene(&format!("name: page\n{}\n{rest}", lines.join("\n")));
    assert_eq!(scene.solids.len(), 1);
}
