//! Scenarios with outlines from files.

use std::path::Path;

use vibrissa::diagnostic::Source;
use vibrissa::geometry::Point2;
use vibrissa::scenario;
use vibrissa::scene::Scene;

/// Reads a scenario's text, its files from the folder of the example.
fn scene(text: &str) -> Scene {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("scenarios/outlines");
    let files = &mut |file: &str| std::fs::read(folder.join(file)).map_err(|error| error.to_string());
    scenario::read_with(&Source::new("gripper.yaml", text), files).unwrap()
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

#[test]
fn a_scenario_says_what_is_done_with_a_hole() {
    let plate = "<svg><rect width='50' height='60'/><circle cx='20' cy='20' r='3'/></svg>";
    let read = |holes: &str| {
        let objects = format!("[{{outline: {{file: plate.svg, unit: 1 mm{holes}}}}}]");
        let rest = "start: {position: [-1 m, 72 mm], heading: 90 deg}\nstop: {time: 1 s}";
        let text = format!("name: plate\nobjects: {objects}\n{rest}\n");
        scenario::read_with(&Source::new("plate.yaml", text), &mut |_| Ok(plate.as_bytes().to_vec()))
    };
    let scene = read(", holes: ignore").unwrap();
    assert!(scene.solids.len() == 1 && (scene.solids[0].outline().area() - 0.003).abs() < 1e-12);
    for refused in ["", ", holes: refuse"] {
        assert!(read(refused).unwrap_err()[0].primary.text.contains("inside another"));
    }
    assert!(read(", holes: ignored").is_err_and(|faults| faults[0].hints[0] == "did you mean `ignore`?"));
}

/// A box as a mesh, from one corner (mm) to the opposite one.
fn mesh(from: [f64; 3], to: [f64; 3]) -> String {
    let corner = |index: usize| (0..3).map(move |axis| if index >> axis & 1 == 0 { from[axis] } else { to[axis] });
    let sides = [[0, 1, 3, 2], [4, 5, 7, 6], [0, 1, 5, 4], [2, 3, 7, 6], [0, 2, 6, 4], [1, 3, 7, 5]];
    let mut text = "solid box\n".to_owned();
    for [a, b, c, d] in sides {
        for triangle in [[a, b, c], [a, c, d]] {
            text += "facet normal 0 0 0\nouter loop\n";
            for index in triangle {
                let place: Vec<String> = corner(index).map(|value| value.to_string()).collect();
                text += "vertex ";
                text += &place.join(" ");
                text += "\n";
            }
            text += "endloop\nendfacet\n";
        }
    }
    text + "endsolid box\n"
}

#[test]
fn meshes_that_touch_or_overlap_are_one_object() {
    // The handle ends where the head begins, but for the rounding of its file; the plug is in the head.
    let files = |path: &str| match path {
        "head.stl" => Ok(mesh([0.0, 0.0, 0.0], [333.3, 100.1, 20.0]).into_bytes()),
        "handle.stl" => Ok(mesh([333.300_02, 30.0, 0.0], [600.0, 70.0, 20.0]).into_bytes()),
        "plug.svg" => Ok(
            b"<svg><rect x='20' y='-130' width='50' height='60'/><rect x='40' y='-140' width='9' height='20'/></svg>"
                .to_vec(),
        ),
        other => Err(format!("there is no {other}")),
    };
    let objects =
        "[{outline: {file: head.stl, unit: 1 mm, height: 10 mm}}, {circle: {centre: [0.2 m, 2 m], radius: 10 cm}},
                    {outline: {file: handle.stl, unit: 1 mm, height: 10 mm}}, {outline: {file: plug.svg, unit: 1 mm}}]";
    let rest = "start: {position: [-1 m, 72 mm], heading: 90 deg}\nstop: {time: 1 s}";
    let text = format!("name: meshes\nobjects: {objects}\n{rest}\n");
    let scene = scenario::read_with(&Source::new("meshes.yaml", text), &mut |path| files(path)).unwrap();
    let [whole, disk] = scene.solids.as_slice() else { panic!("{} solids", scene.solids.len()) };
    let outline = whole.outline();
    // Head and handle side by side, what stands out of the plug, and what stands out of that.
    let area = 0.3333 * 0.1001 + 0.2667 * 0.04 + 0.05 * (0.13 - 0.1001) + 0.009 * 0.01;
    assert!((outline.area() - area).abs() < 1e-7, "{} m² for {area} m²", outline.area());
    assert_eq!(outline.corners().len(), 16);
    assert!((disk.outline().area() - 0.01 * std::f64::consts::PI).abs() < 1e-9);
    assert_eq!(scene.truth.reference.contours().count(), 2);
}
