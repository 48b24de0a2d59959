//! Scenes that are drawn by chance are scenes, and what their families say of them.

use std::f64::consts::{FRAC_PI_2, FRAC_PI_6, PI};

use vibrissa::catalogue::{self, Parameter};
use vibrissa::diagnostic::Source;
use vibrissa::family::{Draw, FAMILIES, Family, SPEEDS, Values};
use vibrissa::geometry::{Contour, Piece, Point2, Pose, Vector2, unit};
use vibrissa::run::PassageWatch;
use vibrissa::scenario;
use vibrissa::scene::Scene;
use vibrissa_runtime::rig::Rig;
use vibrissa_runtime::units::parse_quantity;

const TRIALS: u64 = 200;

fn draws(family: &Family) -> impl Iterator<Item = Draw> {
    (0..TRIALS).map(move |trial| family.draw(7, trial).unwrap())
}

fn named(name: &str) -> impl Iterator<Item = Draw> {
    let family = Family::named(name).unwrap();
    (0..TRIALS).map(move |trial| family.draw(7, trial).unwrap())
}

/// The turns of an outline's corners (rad), the greatest first.
fn turns(outline: &Contour) -> Vec<f64> {
    let mut turns: Vec<f64> = outline.corners().iter().map(|corner| corner.turn).collect();
    turns.sort_by(|one, other| other.total_cmp(one));
    turns
}

#[test]
fn every_draw_is_a_scene_with_a_clear_start_an_aim_and_a_speed() {
    for family in FAMILIES {
        for (trial, draw) in draws(&family).enumerate() {
            let Draw { text, scene, speed } = draw;
            let context = format!("{}, trial {trial}:\n{text}", family.name);
            assert_eq!(scene.name, format!("{}-{trial}", family.name));
            assert!(!scene.solids.is_empty() && scene.is_clear_at(&scene.start), "{context}");
            let aims = [scene.stop.loop_closed.is_some(), scene.stop.passed.is_some(), scene.stop.succeeded];
            assert_eq!(aims.iter().filter(|aim| **aim).count(), 1, "{context}");
            // Only the policy itself knows that it has traced everything.
            assert_eq!(scene.stop.succeeded, ["shapes", "rooms"].contains(&&*family.name), "{context}");
            // The times and lengths of rooms have a test of their own.
            let is_room = family.name == "rooms";
            assert!(scene.stop.stalled.is_some(), "{context}");
            assert!(is_room || (60.0..2000.0).contains(&scene.stop.time), "{context}");
            assert!(SPEEDS.contains(&speed), "{context}");
            let length = scene.truth.reference.length();
            assert!(is_room || (0.3..8.0).contains(&length), "{length} m: {context}");
            let read = scenario::read(&Source::new("drawn.yaml", text)).unwrap();
            assert_eq!((read.start, read.stop), (scene.start, scene.stop), "{context}");
        }
    }
}

/// The start that those of a scene are near.
fn middle(scene: &Scene) -> Pose {
    let (family, trial) = scene.name.rsplit_once('-').unwrap();
    if family == "rooms" {
        // A room has a start of its own. The parameters say how far a start is from it.
        let none = ["start_x", "start_y", "start_heading"].map(|name| (name, 0.0));
        let family = Family::named(family).unwrap();
        return family.draw_with(7, trial.parse().unwrap(), &Values::from_iter(none)).unwrap().scene.start;
    }
    let hand = scene.truth.reference.contours().next().unwrap().point_at(0.0).x.signum();
    let turned = if scene.stop.passed.is_some() { 0.0 } else { 0.35 * hand };
    Pose { position: Point2::new(0.0, 0.072), heading: FRAC_PI_2 - turned }
}

/// How far that is from a start to either side, in shares of what is allowed: x, y, heading.
fn shares(scene: &Scene) -> [f64; 3] {
    let (start, middle) = (scene.start, middle(scene));
    let moved = (start.position - middle.position) / 0.04;
    [moved.x, moved.y, (start.heading - middle.heading) / FRAC_PI_6]
}

#[test]
fn starts_are_evenly_distributed_over_all_that_there_may_be() {
    for family in FAMILIES {
        let starts: Vec<_> = draws(&family).map(|draw| shares(&draw.scene)).collect();
        for of in 0..3 {
            let mut shares: Vec<f64> = starts.iter().map(|start| start[of]).collect();
            shares.sort_by(f64::total_cmp);
            // The test of Kolmogorov and Smirnov, at 1 in 10 000.
            let gap = |(index, share): (usize, &f64)| {
                (0.5 * (share + 1.0) - (index as f64 + 0.5) / TRIALS as f64).abs() - 0.5 / TRIALS as f64
            };
            let gap = shares.iter().enumerate().map(gap).fold(0.0, f64::max);
            assert!(gap < 2.23 / (TRIALS as f64).sqrt(), "{}, {of}: {gap}", family.name);
            assert!(shares.iter().all(|share| share.abs() < 1.0 + 1e-4));
        }
    }
}

#[test]
fn the_reference_rig_stands_clear_wherever_starts_may_be() {
    let shares = [-1.0, 0.0, 1.0];
    for family in FAMILIES {
        for Draw { mut scene, text, .. } in draws(&family) {
            let middle = middle(&scene);
            // A start at which a feeler touches is drawn again.
            scene.rig.whiskers.truncate(2);
            for (x, y, turn) in thrice(&shares) {
                let position = middle.position + 0.04 * Vector2::new(x, y);
                let start = Pose { position, heading: middle.heading + FRAC_PI_6 * turn };
                assert!(scene.is_clear_at(&start), "{x}, {y}, {turn}: {text}");
            }
        }
    }
}

fn thrice(shares: &[f64]) -> impl Iterator<Item = (f64, f64, f64)> {
    shares.iter().flat_map(move |&x| shares.iter().flat_map(move |&y| shares.iter().map(move |&turn| (x, y, turn))))
}

#[test]
fn from_the_middle_of_all_starts_a_whisker_comes_upon_the_object_and_the_body_into_the_tunnel() {
    // In a room, all objects can be reached, which has a test of its own.
    for family in FAMILIES.into_iter().filter(|family| family.name != "rooms") {
        for Draw { scene, text, .. } in draws(&family) {
            let mut body = scene.clone();
            body.rig.whiskers.clear();
            let middle = middle(&scene);
            let ahead = |distance| Pose { position: middle.position + distance * unit(middle.heading), ..middle };
            // A shape is up to 90 cm long, and its farthest end may be the nearest to the path.
            let steps = if family.name == "shapes" { 300 } else { 200 };
            let distances = (0..steps).map(|step| 4e-3 * f64::from(step));
            if scene.stop.passed.is_some() {
                let mut passage = PassageWatch::new(&scene.truth.axes[0]);
                for distance in distances.take(75) {
                    assert!(body.is_clear_at(&ahead(distance)), "the body at {distance} m: {text}");
                    passage.add(&ahead(distance));
                }
                assert!(passage.share() > 0.0, "{text}");
            } else {
                let met = distances.into_iter().find(|&distance| !scene.is_clear_at(&ahead(distance)));
                let met = met.unwrap_or_else(|| panic!("nothing is met: {text}"));
                assert!(body.is_clear_at(&ahead(met + 0.02)), "the body at {met} m: {text}");
            }
        }
    }
}

#[test]
fn a_draw_depends_on_family_seed_and_trial_and_on_nothing_else() {
    for family in FAMILIES {
        let text = |seed, trial| family.draw(seed, trial).unwrap().text;
        assert_eq!(text(1, 5), text(1, 5));
        assert_ne!(text(1, 5).replace("-5", ""), text(1, 6).replace("-6", ""));
        assert_ne!(text(1, 5), text(2, 5));
    }
    let seeds: Vec<_> = FAMILIES.iter().map(|family| family.draw(1, 5).unwrap().scene.seed).collect();
    assert!(seeds.iter().enumerate().all(|(index, seed)| !seeds[..index].contains(seed)));
}

#[test]
fn convex_corners_are_convex_and_turn_as_much_as_they_say() {
    let mut drawn = Vec::new();
    for draw in named("convex-corner") {
        let outline = draw.scene.solids[0].outline().clone();
        assert!(outline.is_convex());
        let said: f64 = draw.scene.description.split(' ').next_back().unwrap().trim_end_matches('°').parse().unwrap();
        let said = said / 180.0 * PI;
        assert!((FRAC_PI_6..=PI).contains(&said), "{said}");
        let turns = turns(&outline);
        let is_there = turns.iter().any(|turn| (turn - said).abs() < 2e-3);
        assert!(is_there || said > 3.0 && (turns[0] + turns[1] - PI).abs() < 1e-3, "{said}: {turns:?}");
        drawn.push(said);
    }
    assert!(drawn.iter().any(|turn| *turn < 0.9) && drawn.iter().any(|turn| *turn > 2.6));
}

#[test]
fn concave_corners_have_one_inner_corner() {
    for draw in named("concave-corner") {
        let turns = turns(draw.scene.solids[0].outline());
        assert_eq!(turns.iter().filter(|turn| **turn < 0.0).count(), 1);
        assert!((15.0..=75.0).contains(&-turns.last().unwrap().to_degrees().round()));
    }
}

#[test]
fn inner_corners_pairs_shapes_and_rooms_are_for_a_rig_with_feelers_and_all_others_for_the_reference() {
    for family in FAMILIES {
        let has_feelers = ["concave-corner", "two-objects", "shapes", "rooms"].contains(&&*family.name);
        for draw in draws(&family) {
            let whiskers = draw.scene.rig.whiskers;
            assert_eq!(whiskers[..2], Rig::default().whiskers, "{}", family.name);
            assert_eq!(whiskers.len(), if has_feelers { 6 } else { 2 }, "{}", family.name);
            // Two that look ahead a side, mirror images of each other, from within the nose to before it.
            for feeler in &whiskers[2..] {
                let tip = feeler.base_body + feeler.shaft.length * unit(feeler.direction_body);
                assert!(feeler.base_body.x < 0.108 && tip.x > 0.15 && feeler.base_body.y.abs() < 0.015);
                assert!(feeler.side() * tip.y > 0.0 && feeler.side() * feeler.base_body.y > 0.0);
            }
        }
    }
}

#[test]
fn tunnels_are_as_wide_as_they_say_square_to_every_run() {
    for draw in named("zigzag-tunnel").chain(named("tunnel-mouth")) {
        let [left, right] = draw.scene.solids.as_slice() else { panic!("two walls") };
        let said = draw.scene.description.split(" mm clear").next().unwrap().rsplit(' ').next().unwrap();
        let said = 1e-3 * said.parse::<f64>().unwrap();
        assert!((0.18..=0.26).contains(&said));
        for run in draw.scene.truth.axes[0].line().pieces() {
            // From the middle of a run square to it: no inner corner is nearer there.
            let middle = run.point_at(0.5 * run.length());
            let clear = left.outline().signed_distance(middle) + right.outline().signed_distance(middle);
            assert!((clear - said).abs() < 0.5001e-3, "{clear} m for {said} m");
        }
    }
}

#[test]
fn zigzags_go_to_and_fro_by_one_angle() {
    let mut drawn = Vec::new();
    for draw in named("zigzag-tunnel") {
        let axis = draw.scene.truth.axes[0].line();
        let turns: Vec<f64> = axis.corners().iter().map(|corner| corner.turn).collect();
        assert!((3..=5).contains(&turns.len()));
        assert!(turns.windows(2).all(|turns| (turns[0] + turns[1]).abs() < 1e-4));
        drawn.push(turns[0].abs().to_degrees());
    }
    assert!(drawn.iter().all(|turn| (10.0..=60.0).contains(turn)));
    assert!(drawn.iter().any(|turn| *turn < 15.0) && drawn.iter().any(|turn| *turn > 55.0));
}

#[test]
fn smooth_curves_have_no_corners_and_bend_no_more_than_they_may() {
    let mut hollow = 0;
    for draw in named("smooth-curve") {
        let outline = draw.scene.solids[0].outline();
        assert!(outline.corners().is_empty());
        hollow += usize::from(!outline.is_convex());
        for piece in outline.pieces() {
            assert!((-1.02 / 0.25..1.02 / 0.08).contains(&piece.curvature()), "{}: {}", piece.curvature(), draw.text);
        }
    }
    assert!(hollow > 20, "{hollow}");
}

#[test]
fn walls_are_thin_and_two_objects_are_two() {
    for draw in named("thin-wall") {
        let outline = draw.scene.solids[0].outline();
        let thinnest = outline.pieces().iter().map(Piece::length).fold(f64::MAX, f64::min);
        assert!((0.001_999..=0.020_001).contains(&thinnest), "{thinnest}");
    }
    assert!(named("two-objects").all(|draw| draw.scene.solids.len() == 2));
}

#[test]
fn polygons_have_sharp_and_rounded_corners() {
    let outlines: Vec<_> = named("polygon").map(|draw| draw.scene.solids[0].outline().clone()).collect();
    let is_round = |piece: &Piece| piece.curvature() > 0.0;
    assert!(outlines.iter().all(|outline| !turns(outline).is_empty()));
    assert!(outlines.iter().any(|outline| outline.pieces().iter().any(is_round)));
    for outline in outlines {
        let radii = outline.pieces().iter().filter(|piece| is_round(piece)).map(|piece| piece.curvature().recip());
        assert!(radii.into_iter().all(|radius| (0.0199..0.1001).contains(&radius)));
    }
}

/// All parameters of a family at the ends that `choose` selects.
fn values(family: &Family, choose: impl Fn(&Parameter) -> f64) -> Values {
    family.parameters.iter().map(|parameter| (parameter.name, choose(parameter))).collect()
}

#[test]
fn parameters_have_names_of_their_own_and_values_in_their_ranges() {
    for family in FAMILIES {
        assert!(catalogue::entry(&family.name).is_some());
        for (index, parameter) in family.parameters.iter().enumerate() {
            let Parameter { name, range, limits, simplest, step, .. } = *parameter;
            assert!(family.parameters[..index].iter().all(|other| other.name != name), "{}: {name}", family.name);
            assert!(limits.0 <= range.0 && range.0 < range.1 && range.1 <= limits.1 && step > 0.0, "{name}");
            assert!((limits.0..=limits.1).contains(&simplest) && parameter.fault(simplest).is_none(), "{name}");
            let beyond = limits.1 + 0.01 * (limits.1 - limits.0);
            assert!(parameter.fault(beyond).is_some() && parameter.fault(f64::NAN).is_some(), "{name}");
            let text = parameter.text(range.1);
            let read = parse_quantity(&text).unwrap();
            assert!(read.dimension == parameter.dimension && (read.value_si - range.1).abs() < 1e-5, "{text}");
        }
    }
}

#[test]
fn the_parameters_of_a_family_determine_its_scenes() {
    for family in FAMILIES {
        let draw = |seed, trial, given: &Values| family.draw_with(seed, trial, given).unwrap();
        let simplest = values(&family, |parameter| parameter.simplest);
        // The seed is that of the sensors' noise, and does not affect the geometry.
        let geometry = |draw: Draw| draw.text.split("rig:").nth(1).unwrap().to_owned();
        assert_eq!(geometry(draw(1, 0, &simplest)), geometry(draw(2, 5, &simplest)), "{}", family.name);
        assert_eq!(geometry(draw(1, 0, &simplest)), geometry(family.scene(&simplest).unwrap()));
        for parameter in family.parameters {
            // A whole turn is the same direction.
            let (low, high) = parameter.range;
            let other = if parameter.is_stepped { high } else { low + 0.4 * (high - low) };
            let with = |value: f64| {
                let given = |other: &Parameter| if other.name == parameter.name { value } else { other.simplest };
                // A rounding shows only if there are so many corners.
                let given =
                    |other: &Parameter| if other.name.ends_with("corners") { other.range.1 } else { given(other) };
                geometry(family.scene(&values(&family, given)).unwrap())
            };
            if !family.is_default {
                // What a parameter of a feature or an object does depends on the kinds of all. It shows in one of the scenes.
                let with = |trial, value| geometry(draw(7, trial, &Values::from_iter([(parameter.name, value)])));
                let is_shown = (0..TRIALS).any(|trial| with(trial, low) != with(trial, other));
                assert!(is_shown, "{}: {} has no effect", family.name, parameter.name);
                continue;
            }
            let is_hidden = parameter.name == "thickness" && family.name == "convex-corner"
                || parameter.name.starts_with("phase_")
                || parameter.name.ends_with("corners");
            assert!(is_hidden || with(low) != with(other), "{}: {} has no effect", family.name, parameter.name);
        }
    }
}

#[test]
fn a_given_value_leaves_all_other_numbers_of_a_scene_as_they_are() {
    let family = Family::named("convex-corner").unwrap();
    for trial in 0..50 {
        let random = family.draw(3, trial).unwrap();
        let given = |value: f64| Values::from_iter([("speed", value)]);
        let slow = family.draw_with(3, trial, &given(0.03)).unwrap();
        assert!((slow.speed - 0.03).abs() < 1e-12);
        let vertices = |draw: &Draw| draw.scene.solids[0].outline().corners();
        assert_eq!((slow.scene.start, vertices(&slow)), (random.scene.start, vertices(&random)));
        let angle = 50_f64.to_radians();
        let turned = family.draw_with(3, trial, &Values::from_iter([("angle", angle)])).unwrap();
        assert_eq!((turned.scene.start, turned.speed), (random.scene.start, random.speed));
        let turns = turns(turned.scene.solids[0].outline());
        assert!(turns.iter().any(|turn| (turn - angle).abs() < 1e-4), "{turns:?}");
    }
}

#[test]
fn a_value_without_a_scene_is_refused_with_the_reason() {
    let family = Family::named("two-objects").unwrap();
    let given = Values::from_iter([("ahead", 0.0), ("aside", 0.0)]);
    let error = family.scene(&given).unwrap_err().to_string();
    assert!(error.contains("`two-objects` has no scene with these values") && error.contains("starts in"), "{error}");
}
