//! Scenes that are drawn by chance are scenes, and what their families say of them.
#![allow(clippy::unwrap_used, reason = "a test may panic")]

use std::f64::consts::{FRAC_PI_2, FRAC_PI_6, PI};

use vibrissa::diagnostic::Source;
use vibrissa::geometry::Contour;
use vibrissa::scene::Scene;
use vibrissa::scene::family::{Draw, FAMILIES, Family, SPEEDS};

const TRIALS: u64 = 60;

fn draws(family: &Family) -> impl Iterator<Item = Draw> {
    (0..TRIALS).map(move |trial| family.draw(7, trial).unwrap())
}

fn named(name: &str) -> impl Iterator<Item = Draw> {
    draws(FAMILIES.iter().find(|family| family.name == name).unwrap())
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
            let Draw { text, scene, settings } = draw;
            let context = format!("{}, trial {trial}:\n{text}", family.name);
            assert_eq!(scene.name, format!("{}-{trial}", family.name));
            assert!(!scene.solids.is_empty() && scene.is_clear_at(&scene.start), "{context}");
            assert!(scene.stop.loop_closed.is_some() != scene.stop.reached.is_some(), "{context}");
            assert!(scene.stop.stalled.is_some() && (60.0..2000.0).contains(&scene.stop.time), "{context}");
            let [("speed", speed)] = settings.as_slice() else { panic!("{context}") };
            assert!(SPEEDS.contains(&speed.value_si), "{context}");
            let length = scene.truth.reference.length();
            assert!((0.3..8.0).contains(&length), "{length} m: {context}");
            let read = Scene::from_yaml(&Source::new("drawn.yaml", text)).unwrap();
            assert_eq!((read.start, read.stop), (scene.start, scene.stop), "{context}");
        }
    }
}

#[test]
fn starts_vary_as_far_as_they_may_on_both_sides() {
    for family in FAMILIES {
        let starts: Vec<_> = draws(&family).map(|draw| draw.scene.start).collect();
        for start in &starts {
            assert!(start.position.x.abs() <= 0.040001 && (start.position.y - 0.072).abs() <= 0.040001);
            assert!((start.heading - FRAC_PI_2).abs() <= FRAC_PI_6 + 0.36);
        }
        let spread = |of: fn(&vibrissa::geometry::Pose) -> f64| {
            let least = starts.iter().map(of).fold(f64::MAX, f64::min);
            starts.iter().map(of).fold(f64::MIN, f64::max) - least
        };
        assert!(spread(|start| start.position.x) > 0.06, "{}", family.name);
        assert!(spread(|start| start.position.y) > 0.06, "{}", family.name);
        assert!(spread(|start| start.heading) > 0.6, "{}", family.name);
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
fn tunnels_are_as_wide_as_they_say() {
    for draw in named("zigzag-tunnel").chain(named("tunnel-mouth")) {
        let [left, right] = draw.scene.solids.as_slice() else { panic!("two walls") };
        let axis = draw.scene.truth.axis.as_ref().unwrap();
        let line = axis.contours().next().unwrap();
        // In the middle of an inner run both ends of which are corners; of a single run anywhere.
        let pieces = line.pieces();
        let piece = &pieces[pieces.len() / 2];
        let middle = piece.point_at(0.5 * piece.length());
        let clear = left.outline().signed_distance(middle) + right.outline().signed_distance(middle);
        assert!((0.1799..=0.2601).contains(&clear), "{clear}");
    }
}

#[test]
fn walls_are_thin_and_two_objects_are_two() {
    for draw in named("thin-wall") {
        let outline = draw.scene.solids[0].outline();
        let thinnest = outline.pieces().iter().map(vibrissa::geometry::Piece::length).fold(f64::MAX, f64::min);
        assert!((0.001999..=0.020001).contains(&thinnest), "{thinnest}");
    }
    assert!(named("two-objects").all(|draw| draw.scene.solids.len() == 2));
}

#[test]
fn polygons_have_sharp_and_rounded_corners() {
    let outlines: Vec<_> = named("polygon").map(|draw| draw.scene.solids[0].outline().clone()).collect();
    let is_round = |piece: &vibrissa::geometry::Piece| piece.curvature() > 0.0;
    assert!(outlines.iter().all(|outline| !turns(outline).is_empty()));
    assert!(outlines.iter().any(|outline| outline.pieces().iter().any(is_round)));
    for outline in outlines {
        let radii = outline.pieces().iter().filter(|piece| is_round(piece)).map(|piece| piece.curvature().recip());
        assert!(radii.into_iter().all(|radius| (0.0199..0.1001).contains(&radius)));
    }
}
