//! What the laws of the standard library command, and that a left whisker is a right one in a mirror.
#![allow(clippy::unwrap_used, reason = "a test may panic")]

use std::f64::consts::{FRAC_PI_2, PI};
use std::sync::Arc;

use proptest::prelude::*;
use vibrissa::diagnostic::{Colour, Source, terminal};
use vibrissa::geometry::{Point2, Pose, Vector2, rotate, turn_between, unit};
use vibrissa::machine::{
    Action, BodyScalar, ContourVector, Machine, Mover, Senses, Turn, WhiskerScalar, WhiskerVector,
};
use vibrissa::motion::Steering;
use vibrissa::policy::{Checked, check, compile};
use vibrissa::rig::Rig;

/// A whisker that is felt as a test says: 0 is on the right, 1 on the left.
#[derive(Debug, Clone, Copy)]
struct Whisker {
    deflection: f64,
    tangent: Vector2,
    ready: bool,
}

/// What is felt.
#[derive(Debug, Clone, Copy)]
struct Felt {
    body: Pose,
    whiskers: [Whisker; 2],
}

const LENGTH: f64 = 0.1;
const FREE: Whisker = Whisker { deflection: 0.0, tangent: Vector2::new(1.0, 0.0), ready: false };

impl Felt {
    fn at(body: Pose) -> Self {
        Self { body, whiskers: [FREE; 2] }
    }

    /// The same in a mirror that lies along x; left and right change places.
    fn mirrored(&self) -> Self {
        let whisker = |whisker: Whisker| Whisker {
            deflection: -whisker.deflection,
            tangent: flipped(whisker.tangent),
            ..whisker
        };
        let Self { body, whiskers: [right, left] } = *self;
        let body = Pose { position: flipped(body.position.coords).into(), heading: -body.heading };
        Self { body, whiskers: [whisker(left), whisker(right)] }
    }

    fn side(whisker: usize) -> f64 {
        if whisker == 0 { -1.0 } else { 1.0 }
    }

    fn base(&self, whisker: usize) -> Point2 {
        self.body.point_to_world(Point2::new(0.053, 0.03 * Self::side(whisker)))
    }

    fn yaw(&self, whisker: usize) -> f64 {
        self.body.heading + 105_f64.to_radians() * Self::side(whisker)
    }

    fn tip_at_rest(&self, whisker: usize) -> Point2 {
        self.base(whisker) + LENGTH * unit(self.yaw(whisker))
    }

    fn is_touching(&self, whisker: usize) -> bool {
        self.whiskers[whisker].deflection.abs() > 2e-5
    }
}

fn flipped(vector: Vector2) -> Vector2 {
    Vector2::new(vector.x, -vector.y)
}

impl Senses for Felt {
    fn time(&self) -> f64 {
        0.0
    }

    fn body(&self, _: BodyScalar) -> f64 {
        self.body.heading
    }

    fn body_position(&self) -> Vector2 {
        self.body.position.coords
    }

    fn whisker(&self, whisker: usize, quantity: WhiskerScalar) -> f64 {
        let Whisker { deflection, ready, .. } = self.whiskers[whisker];
        match quantity {
            WhiskerScalar::Deflection => deflection,
            WhiskerScalar::Touching => f64::from(u8::from(self.is_touching(whisker))),
            WhiskerScalar::Yaw => self.yaw(whisker),
            WhiskerScalar::Side => Self::side(whisker),
            WhiskerScalar::Sense if self.is_touching(whisker) => deflection.signum() * Self::side(whisker),
            WhiskerScalar::Length => LENGTH,
            WhiskerScalar::ContourReady => f64::from(u8::from(ready)),
            WhiskerScalar::Sense | WhiskerScalar::ContourCurvature | WhiskerScalar::TipSpread => 0.0,
        }
    }

    fn whisker_vector(&self, whisker: usize, quantity: WhiskerVector) -> Vector2 {
        let tip_base = self.tip_at(whisker, self.whiskers[whisker].deflection);
        let tangent = self.whiskers[whisker].tangent;
        match quantity {
            WhiskerVector::TipBase => tip_base,
            WhiskerVector::Tip | WhiskerVector::ContourEnd => {
                self.base(whisker).coords + rotate(tip_base, self.yaw(whisker))
            }
            WhiskerVector::Base => self.base(whisker).coords,
            WhiskerVector::ContourTangent => tangent,
            WhiskerVector::ContourNormal => rotate(tangent, -FRAC_PI_2 * Self::side(whisker)),
        }
    }

    /// A whisker that bends like a circle, more than any does.
    fn tip_at(&self, _: usize, deflection: f64) -> Vector2 {
        LENGTH * unit(500.0 * deflection)
    }

    fn contour_at(&self, whisker: usize, _: f64, quantity: ContourVector) -> Vector2 {
        self.whisker_vector(
            whisker,
            match quantity {
                ContourVector::Point => WhiskerVector::ContourEnd,
                ContourVector::Tangent => WhiskerVector::ContourTangent,
                ContourVector::Normal => WhiskerVector::ContourNormal,
            },
        )
    }

    fn record(&mut self, _: usize) {}
}

/// A machine that does one thing, with the whisker `w` of the one side and `v` of the other.
fn machine(whisker: usize, does: &str) -> Machine {
    let (right, left) = if whisker == 0 { ("w", "v") } else { ("v", "w") };
    let text = format!(
        "machine m use std.guards use std.retrieval use std.swipe use std.tunnel whisker {right}, {left}
        initial Doing state Doing {{ {does} }}"
    );
    let source = Source::new("m.fsm", text);
    let program = compile(&source).unwrap_or_else(|faults| panic!("{}", terminal(&source, &faults, Colour::Plain)));
    Machine::new(Arc::new(program))
}

/// What a law commands: along, speed, and the heading or the rate of turning.
fn commanded(whisker: usize, does: &str, felt: &Felt) -> (Mover, Vector2, f64, Turn) {
    match machine(whisker, does).tick(&mut { *felt }).action {
        Action::Steer { mover, along_world, speed, turn } => (mover, along_world, speed, turn),
        other => panic!("{other:?}"),
    }
}

fn vector(vector: Vector2) -> String {
    format!("vector({:?}, {:?})", vector.x, vector.y)
}

fn place(place: Point2) -> String {
    format!("vector({:?} m, {:?} m)", place.x, place.y)
}

fn holds(guard: &str, whisker: usize, felt: &Felt) -> bool {
    let mut machine = machine(whisker, &format!("stop when {guard} -> Yes }} state Yes {{ stop"));
    machine.tick(&mut { *felt });
    machine.state_name() == "Yes"
}

fn is_near(a: Vector2, b: Vector2) -> bool {
    (a - b).norm() < 1e-9
}

#[test]
fn every_module_is_sound_by_itself_and_needs_nothing_that_it_does_not_use() {
    for module in ["guards", "retrieval", "swipe", "tunnel"] {
        let text = std::fs::read_to_string(format!("policies/std/{module}.fsm")).unwrap();
        let checked = check(&Source::new(module, text)).unwrap();
        let Checked::Library { name, warnings, .. } = checked else { panic!("{module}") };
        assert_eq!(name, module);
        assert!(warnings.is_empty(), "{warnings:?}");
    }
}

prop_compose! {
    /// Both whiskers touch, and the walls do not go opposite ways: else some laws keep the last command.
    fn felt()(
        (x, y, heading) in (-1.0..1.0_f64, -1.0..1.0_f64, -PI..PI),
        bends in [3e-5..6e-4_f64, 3e-5..6e-4_f64], senses in any::<[bool; 2]>(), direction in -PI..PI, between in -2.5..2.5_f64,
    ) -> Felt {
        let whisker = |index: usize| {
            let deflection = if senses[index] { bends[index] } else { -bends[index] };
            Whisker { deflection, tangent: unit(direction + between * index as f64), ready: true }
        };
        Felt { body: Pose { position: Point2::new(x, y), heading }, whiskers: [whisker(0), whisker(1)] }
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(60))]

    #[test]
    fn in_a_mirror_every_law_commands_the_mirrored(
        felt in felt(), whisker in 0_usize..2, px in -1.0..1.0_f64, py in -1.0..1.0_f64, direction in -PI..PI, law in 0_usize..10,
    ) {
        let (point, along) = (Point2::new(px, py), unit(direction));
        let does = |point: Point2, along: Vector2| {
            let (point, along) = (place(point), vector(along));
            [
                "do swipe(w, 300 urad, 50 mm/s)".to_owned(),
                "do swipe_tilted(w, 300 urad, 50 mm/s, 10 deg)".to_owned(),
                "do keep_centre(w, v, 300 urad, 50 mm/s)".to_owned(),
                format!("do detach(w, {along}, 50 mm/s)"),
                format!("do return_to_edge(w, {point}, {along}, 20 mm, 50 mm/s)"),
                format!("do reach_around(w, {point}, {along}, 10 mm, 40 deg, 20 deg, 50 mm/s)"),
                format!("do whisk_back(w, w.tip, {point}, 60 urad, 50 mm/s)"),
                format!("do reposition(w, {point}, {along}, 20 mm, 20 deg, 50 mm/s)"),
                format!("do approach(w, {along}, 50 mm/s)"),
                format!("do follow(w, {along}, 300 urad * w.side, 50 mm/s, 10 deg)"),
            ][law].clone()
        };
        let (mover, along_world, speed, turn) = commanded(whisker, &does(point, along), &felt);
        let mirrored = does(flipped(point.coords).into(), flipped(along));
        let (other_mover, other_along, other_speed, other_turn) = commanded(1 - whisker, &mirrored, &felt.mirrored());
        match (mover, other_mover) {
            (Mover::Whisker(one), Mover::Whisker(other)) => prop_assert_eq!((one, other), (whisker, 1 - whisker)),
            (one, other) => prop_assert_eq!(one, other),
        }
        prop_assert!(is_near(flipped(along_world), other_along) && (speed - other_speed).abs() < 1e-12);
        match (turn, other_turn) {
            (Turn::Facing(one), Turn::Facing(other)) => prop_assert!(turn_between(one, -other).abs() < 1e-9),
            (Turn::Rate(one), Turn::Rate(other)) => prop_assert!((one + other).abs() < 1e-12),
            (one, other) => prop_assert!(false, "{one:?} {other:?}"),
        }
        prop_assert!((0.0..=0.05).contains(&speed), "{speed}");
    }

    #[test]
    fn the_middle_between_two_walls_does_not_depend_on_which_is_named_first(felt in felt()) {
        let (_, one, _, one_turn) = commanded(0, "do keep_centre(w, v, 300 urad, 50 mm/s)", &felt);
        let (_, other, _, other_turn) = commanded(0, "do keep_centre(v, w, 300 urad, 50 mm/s)", &felt);
        prop_assert!(is_near(one, other));
        prop_assert_eq!(one_turn, other_turn);
    }
}

/// The platform at the origin heading along x, one whisker bent by `deflection` in units of its target, as forward motion does.
fn swiping(whisker: usize, bend: f64) -> Felt {
    let mut felt = Felt::at(Pose::default());
    let deflection = 3e-4 * bend * Felt::side(whisker);
    felt.whiskers[whisker] = Whisker { deflection, tangent: Vector2::new(1.0, 0.0), ready: true };
    felt
}

#[test]
fn swiping_goes_along_the_surface_nearer_when_bent_too_little_and_off_when_bent_too_much() {
    let law = "do swipe(w, 300 urad, 50 mm/s)";
    for whisker in [0, 1] {
        let off = |bend| {
            let (mover, along, speed, turn) = commanded(whisker, law, &swiping(whisker, bend));
            assert_eq!((mover, speed, turn), (Mover::Whisker(whisker), 0.05, Turn::Rate(0.0)));
            // Away from the object, which is on the whisker's side.
            -along.y * Felt::side(whisker)
        };
        assert!(off(1.0).abs() < 1e-12 && off(0.6) < -0.1 && off(1.4) > 0.1);
        let (_, along, ..) = commanded(whisker, law, &swiping(whisker, 1.0));
        assert!(is_near(along, Vector2::new(1.0, 0.0)));
        let mut unready = swiping(whisker, 1.0);
        unready.whiskers[whisker].ready = false;
        assert_eq!(machine(whisker, law).tick(&mut unready).action, Action::Hold);
    }
}

#[test]
fn a_whisker_that_is_hardly_bent_gets_on_along_the_surface() {
    for whisker in [0, 1] {
        let (_, along, ..) = commanded(whisker, "do swipe(w, 300 urad, 50 mm/s)", &swiping(whisker, 0.1));
        assert!(along.normalize().x > 0.4, "{along}");
    }
}

#[test]
fn a_whisker_follows_a_surface_that_it_does_not_feel_yet_and_comes_nearer() {
    for whisker in [0, 1] {
        let law = "do follow(w, vector(1, 0), 300 urad * w.side, 50 mm/s, 0 deg)";
        let (mover, along, speed, turn) = commanded(whisker, law, &Felt::at(Pose::default()));
        assert_eq!((mover, speed, turn), (Mover::Whisker(whisker), 0.05, Turn::Rate(0.0)));
        assert!(along.x > 0.0 && along.y * Felt::side(whisker) > 0.0);
    }
}

#[test]
fn a_tilt_turns_the_body_towards_the_object() {
    for whisker in [0, 1] {
        let (.., turn) = commanded(whisker, "do swipe_tilted(w, 300 urad, 50 mm/s, 10 deg)", &swiping(whisker, 1.0));
        let Turn::Rate(rate) = turn else { panic!() };
        assert!(rate * Felt::side(whisker) > 0.0);
    }
}

#[test]
fn the_body_turns_as_fast_as_its_speed_bears_and_no_faster() {
    let felt = Felt { body: Pose { heading: 2.0, ..Pose::default() }, ..swiping(0, 1.0) };
    for (speed, limit) in [(0.01, 0.01 / 0.06), (0.03, 0.5), (0.1, 45_f64.to_radians())] {
        let (.., turn) = commanded(0, &format!("do swipe(w, 300 urad, {speed:?} m/s)"), &felt);
        let Turn::Rate(rate) = turn else { panic!() };
        assert!((rate + limit).abs() < 1e-9, "{rate} {limit}");
    }
}

#[test]
fn between_two_walls_the_platform_goes_to_the_side_that_bends_less() {
    let mut felt = swiping(0, 1.0);
    felt.whiskers[1] = swiping(1, 1.0).whiskers[1];
    let law = "do keep_centre(w, v, 300 urad, 50 mm/s)";
    let (mover, along, speed, turn) = commanded(0, law, &felt);
    assert_eq!((mover, speed, turn), (Mover::Body, 0.05, Turn::Facing(0.0)));
    assert!(is_near(along, Vector2::new(1.0, 0.0)));
    // The right whisker is bent by half a target more than the left: to the left, by a quarter.
    felt.whiskers[0].deflection *= 1.5;
    assert!(is_near(commanded(0, law, &felt).1, Vector2::new(1.0, 0.25)));
    felt.whiskers[0].deflection *= 9.0;
    assert!(is_near(commanded(0, law, &felt).1, Vector2::new(1.0, 0.5)), "by half at most");
    // Walls that turn to the left, one by 10 deg and the other by 20 deg.
    felt.whiskers[0] = Whisker { tangent: unit(0.2), ..swiping(0, 1.0).whiskers[0] };
    felt.whiskers[1].tangent = unit(0.4);
    let (_, along, _, turn) = commanded(0, law, &felt);
    let Turn::Facing(heading) = turn else { panic!() };
    assert!(is_near(along, unit(0.3)) && (heading - 0.3).abs() < 1e-12);
    felt.whiskers[0].ready = false;
    assert_eq!(machine(0, law).tick(&mut felt).action, Action::Hold);
}

#[test]
fn detaching_lifts_the_whisker_off_its_surface_without_turning() {
    for whisker in [0, 1] {
        let law = "do detach(w, w.contour.tangent, 40 mm/s)";
        let (mover, along, speed, turn) = commanded(whisker, law, &swiping(whisker, 1.0));
        assert_eq!((mover, speed, turn), (Mover::Whisker(whisker), 0.04, Turn::Rate(0.0)));
        assert!(is_near(along, Vector2::new(0.0, -Felt::side(whisker))));
    }
}

#[test]
fn whisking_back_goes_straight_from_the_contact_to_the_edge() {
    let law = "do whisk_back(w, vector(0.1 m, 0.2 m), vector(0.1 m, 0.19 m), 60 urad, 40 mm/s)";
    let (mover, along, speed, turn) = commanded(0, law, &swiping(0, 0.2));
    assert_eq!((mover, speed, turn), (Mover::Whisker(0), 0.04, Turn::Rate(0.0)));
    assert!(is_near(along.normalize(), Vector2::new(0.0, -1.0)));
}

#[test]
fn an_approach_goes_ahead_and_as_much_towards_the_object() {
    for whisker in [0, 1] {
        let law = "do approach(w, vector(1, 0), 40 mm/s)";
        let (mover, along, speed, turn) = commanded(whisker, law, &Felt::at(Pose::default()));
        assert_eq!((mover, speed, turn), (Mover::Whisker(whisker), 0.04, Turn::Rate(0.0)));
        assert!(is_near(along, Vector2::new(1.0, Felt::side(whisker))));
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(40))]

    #[test]
    fn a_corner_is_where_two_surfaces_meet_and_not_far_from_its_edge(
        (x, y) in (-1.0..1.0_f64, -1.0..1.0_f64), way in -PI..PI, around in 0.5..2.6_f64, short in -0.02..0.02_f64, beyond in 0.0..0.02_f64,
    ) {
        let (true_corner, way, surface) = (Point2::new(x, y), unit(way), unit(way - around));
        let (edge, contact) = (true_corner - short * way, true_corner + beyond * surface);
        let near = true_corner + (short.clamp(-0.006, 0.006) - short) * way;
        let [edge, contact, near] = [edge, contact, near].map(place);
        let guard = format!(
            "is_near(corner({edge}, {}, {contact}, {}, 6 mm), {near}, 0.001 mm)", vector(way), vector(surface)
        );
        prop_assert!(holds(&guard, 0, &Felt::at(Pose::default())));
    }
}

/// The platform after a law has been done for some seconds by the reference rig's steering, with nothing in its way.
fn after(whisker: usize, law: &str, body: Pose, seconds: u32) -> Felt {
    let rig = Rig::default();
    let (mut machine, mut steering) = (machine(whisker, law), Steering::new(&rig, &[0, 1]));
    let mut felt = Felt::at(body);
    for _ in 0..30 * seconds {
        let action = machine.tick(&mut felt).action;
        let command = steering.command(&action, felt.body);
        felt.body.position += command.velocity_world / 30.0;
        felt.body.heading += command.yaw_rate / 30.0;
    }
    felt
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(40))]

    /// The edge of an object on the whisker's side, the way along x up to it; for a whisker on the left all in a mirror.
    #[test]
    fn the_unbent_tip_comes_to_where_the_steps_of_retrieval_want_it(
        whisker in 0_usize..2, heading in -1.0..1.0_f64, x in -0.1..0.1_f64, y in -0.1..0.1_f64, around in 0.0..PI, step in 0_usize..3,
    ) {
        let side = Felt::side(whisker);
        // Where and along what the new surface goes from the edge: turned towards the object.
        let surface = unit(side * around);
        let off = rotate(surface, -FRAC_PI_2 * side);
        let edge = Point2::new(0.3, 0.4);
        let (at, new) = (place(edge), vector(surface));
        let tilt = side * 20_f64.to_radians();
        let (law, place, heading_due) = match step {
            0 => (
                format!("do return_to_edge(w, {at}, vector(1, 0), 20 mm, 50 mm/s)"),
                edge - 0.02 * side * Vector2::new(0.0, 1.0),
                0.0,
            ),
            1 => (
                format!("do reach_around(w, {at}, vector(2, 0), 10 mm, {around:?} rad, 20 deg, 50 mm/s)"),
                edge + 0.01 * surface,
                side * around + tilt,
            ),
            _ => (
                format!("do reposition(w, {at}, {new}, 20 mm, 20 deg, 50 mm/s)"),
                edge + 0.02 * off - 0.012 * surface,
                side * around + tilt,
            ),
        };
        let felt = after(whisker, &law, Pose { position: Point2::new(0.2 + x, 0.4 + y), heading }, 20);
        prop_assert!((felt.tip_at_rest(whisker) - place).norm() < 1e-3, "{} {}", felt.tip_at_rest(whisker), place);
        prop_assert!(turn_between(felt.body.heading, heading_due).abs() < 0.01, "{} {heading_due}", felt.body.heading);
    }
}

#[test]
fn guards_hold_when_they_say() {
    for whisker in [0, 1] {
        let (bent, back, free) = (swiping(whisker, 1.0), swiping(whisker, -1.0), Felt::at(Pose::default()));
        assert!(holds("lost(w)", whisker, &free) && !holds("lost(w)", whisker, &bent));
        assert!(holds("bent_wrong_way(w)", whisker, &back) && !holds("bent_wrong_way(w)", whisker, &bent));
        assert!(!holds("bent_wrong_way(w)", whisker, &free));
        for felt in [&bent, &back] {
            assert!(holds("at_limit(w, 299 urad)", whisker, felt) && !holds("at_limit(w, 301 urad)", whisker, felt));
        }
        assert!(!holds("same_sense(v, w)", whisker, &bent), "one of them is free");
        let mut both = bent;
        both.whiskers[1 - whisker] = swiping(1 - whisker, 0.5).whiskers[1 - whisker];
        assert!(holds("same_sense(v, w)", whisker, &both));
        both.whiskers[whisker].deflection *= -1.0;
        assert!(!holds("same_sense(v, w)", whisker, &both));
        let turned = Felt::at(Pose { position: Point2::new(0.1, 0.0), heading: PI - 0.01 });
        assert!(holds("is_facing(-179 deg, 2 deg)", whisker, &turned));
        assert!(!holds("is_facing(-179 deg, 1 deg)", whisker, &turned));
        assert!(holds("is_near(body.position, vector(0.1 m, 3 mm), 4 mm)", whisker, &turned));
        assert!(!holds("is_near(body.position, vector(0.1 m, 5 mm), 4 mm)", whisker, &turned));
    }
}
