//! Families that users write: scenarios whose values are drawn.

use vibrissa::diagnostic::{Diagnostic, Source};
use vibrissa::family::{Draw, Family};
use vibrissa::scenario::{self, DrawnScenario};
use vibrissa::scene::Scene;

const POSTS: &str = include_str!("../../scenarios/families/posts.yaml");

fn read(text: &str) -> Result<Option<DrawnScenario>, Vec<Diagnostic>> {
    DrawnScenario::read(&Source::new("family.yaml", text))
}

fn draw(text: &str, trial: u64) -> Draw {
    Family::written(read(text).unwrap().unwrap()).draw(5, trial).unwrap()
}

/// The disks of a scene: centres and radii (m).
fn disks(scene: &Scene) -> Vec<(f64, f64, f64)> {
    let boxes = scene.solids.iter().skip(1).map(|solid| solid.surface().bounding_box());
    boxes
        .map(|bounds| {
            (
                0.5 * (bounds.min.x + bounds.max.x),
                0.5 * (bounds.min.y + bounds.max.y),
                0.5 * (bounds.max.x - bounds.min.x),
            )
        })
        .collect()
}

#[test]
fn every_scene_has_values_of_its_ranges_and_the_gap_that_is_required() {
    let mut counts = [0; 5];
    for trial in 0..60 {
        let Draw { text, scene, .. } = draw(POSTS, trial);
        let posts = disks(&scene);
        counts[posts.len()] += 1;
        for &(x, y, radius) in &posts {
            assert!((0.06..=0.15).contains(&radius) && (-0.6..=1.4).contains(&x) && (0.7..=1.6).contains(&y), "{text}");
        }
        for (k, &(x, y, radius)) in posts.iter().enumerate() {
            for &(other_x, other_y, other_radius) in &posts[..k] {
                assert!((x - other_x).hypot(y - other_y) - radius - other_radius >= 0.3, "{text}");
            }
        }
        let again = scenario::read(&Source::new("drawn.yaml", &*text)).unwrap();
        assert_eq!((again.name, again.start, again.seed), (scene.name, scene.start, scene.seed), "{text}");
        assert_eq!(disks(&scenario::read(&Source::new("drawn.yaml", &*text)).unwrap()), posts, "{text}");
    }
    assert!(counts[0] + counts[1] == 0 && counts[2..].iter().all(|count| *count > 5), "{counts:?}");
}

#[test]
fn a_scene_depends_on_its_seed_and_its_number_alone() {
    assert_eq!(draw(POSTS, 3).text, draw(POSTS, 3).text);
    assert_ne!(draw(POSTS, 3).text, draw(POSTS, 4).text);
    let family = Family::written(read(POSTS).unwrap().unwrap());
    assert_ne!(family.draw(5, 3).unwrap().text, family.draw(6, 3).unwrap().text);
}

const START: &str = "name: f\nstart: {position: [0 m, 0 m], heading: 90 deg}\nstop: {time: 1 s}\n";

#[test]
fn names_stand_for_values_of_all_kinds() {
    let text = format!(
        "{START}draw:\n  r: [10 mm, 20 mm]\n  half: [$r]\n  shape: [{{circle: {{centre: [1 m, $y], radius: $half}}}}]\n  \
         y: 1 .. 2 m\nobjects: [$shape, {{circle: {{centre: [-1 m, -$y], radius: $r}}}}]\n"
    );
    // A value contains those that are drawn before it.
    let message = &Family::written(read(&text).unwrap().unwrap()).draw(1, 0).unwrap_err().to_string();
    assert!(message.contains("`y` is not drawn"), "{message}");
    let text = text.replace("  y: 1 .. 2 m\n", "").replace("draw:\n", "draw:\n  y: 1 .. 2 m\n");
    for trial in 0..20 {
        let scene = draw(&text, trial).scene;
        let [first, second] = [0, 1].map(|k| scene.solids[k].surface().bounding_box());
        assert!((first.max.y - first.min.y - (second.max.y - second.min.y)).abs() < 1e-12);
        assert!((first.max.y + second.min.y).abs() < 1e-12, "the signs are opposite");
    }
}

#[test]
fn what_cannot_be_drawn_is_told_with_its_place() {
    let told = |draw: &str, objects: &str| {
        let text = format!("{START}draw: {draw}\nobjects: [{objects}]\n");
        match read(&text) {
            Err(faults) => faults[0].message.clone(),
            Ok(family) => Family::written(family.unwrap()).draw(1, 0).unwrap_err().to_string(),
        }
    };
    let disk = "{circle: {centre: [1 m, 1 m], radius: $r}}";
    for (draw, objects, expected) in [
        ("{r: 30 .. 10 mm}", disk, "`r` is drawn from a range or from a list"),
        ("{r: 30 mm .. 10 deg}", disk, "`r` is drawn from a range or from a list"),
        ("{r: 30 mm}", disk, "`r` is drawn from a range or from a list"),
        ("{r: []}", disk, "`r` is drawn from a range or from a list"),
        ("3", disk, "expected names with ranges"),
        ("{r: 1 .. 3 cm, s: 1 .. 2}", disk, "`s` is drawn, and nothing uses it"),
        ("{q: 1 .. 3 cm}", "{circle: {centre: [1 m, $q], radius: $r}}", "`r` is not drawn"),
        ("{r: 1 .. 3 deg}", disk, "`radius`"),
        ("{r: 1 .. 3 cm}", "{repeat: 101, circle: {centre: [1 m, 1 m], radius: $r}}", "repeated 0 to 100 times"),
        ("{r: [one, two]}", "{circle: {centre: [-$r, 1 m], radius: 1 cm}}", "is not a number"),
    ] {
        let found = told(draw, objects);
        assert!(found.contains(expected), "{draw} {objects}: {found}");
    }
    let far = format!(
        "{START}draw: {{x: 1 .. 2 m}}\nrequire: {{gap: 3 m}}\nobjects: [{{circle: {{centre: [$x, 1 m], radius: 1 cm}}}}, {{circle: {{centre: [0 m, 1 m], radius: 1 cm}}}}]\n"
    );
    let message = Family::written(read(&far).unwrap().unwrap()).draw(1, 0).unwrap_err().to_string();
    assert!(message.contains("none of 200 draws has this gap"), "{message}");
}

#[test]
fn a_scenario_without_draws_is_no_family_and_a_family_is_no_scenario() {
    let disk = include_str!("../../scenarios/disk.yaml");
    assert!(read(disk).unwrap().is_none());
    let faults = scenario::read(&Source::new("posts.yaml", POSTS)).unwrap_err();
    let messages: Vec<_> = faults.iter().map(|fault| fault.message.as_str()).collect();
    assert_eq!(messages, ["this file describes a family of scenes"]);
}
