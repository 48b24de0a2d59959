//! What a policy that compiles is warned of, as a user sees it: one fixture a kind, one snapshot a fixture.

use std::collections::BTreeMap;
use std::sync::Arc;

use crate::snapshots::snapshots;
use proptest::prelude::*;
use vibrissa_language::{compile, compile_with_warnings, gather};
use vibrissa_runtime::geometry::Vector2;
use vibrissa_runtime::machine::{BodyScalar, ContourVector, Machine, Senses, WhiskerScalar, WhiskerVector};
use vibrissa_runtime::units::parse_quantity;
use vibrissa_text::diagnostic::{Colour, Diagnostic, Severity, Source, terminal};

fn warnings(text: &str) -> Vec<Diagnostic> {
    let source = Source::new("policy.fsm", text);
    let compiled = compile_with_warnings(&source);
    compiled.unwrap_or_else(|faults| panic!("{}", terminal(&source, &faults, Colour::Plain))).warnings
}

fn codes(text: &str) -> Vec<&'static str> {
    warnings(text).iter().map(|warning| warning.code).collect()
}

/// The codes of the warnings about the transitions of a state, `A`, among others that have no others.
fn codes_of(transitions: &str) -> Vec<&'static str> {
    codes(&format!(
        "machine m whisker r, l initial A param p = 1 in 1 .. 2
        state A {{ stop {transitions} }} state B {{ record r record l }} state C {{ stop }}
        state Reached {{ stop when r.touching or p > 1.5 -> B }}
        always when time > 300 s -> Failure(\"too long\")"
    ))
    .into_iter()
    .filter(|code| !["P0501", "P0504"].contains(code))
    .collect()
}

#[test]
fn every_warning_is_given_as_reviewed() {
    snapshots("policies").bind(|| {
        insta::glob!("../fixtures/policies/warn", "*.fsm", |path| {
            let name = path.file_name().unwrap().to_string_lossy();
            let source = Source::new(name, std::fs::read_to_string(path).unwrap());
            let warnings = compile_with_warnings(&source).unwrap().warnings;
            assert!(warnings.iter().all(|warning| warning.severity == Severity::Warning));
            insta::assert_snapshot!("warn", terminal(&source, &warnings, Colour::Plain));
        });
    });
}

#[test]
fn a_failsafe_is_a_way_out_and_uses_what_it_hands_over() {
    for (own, machines) in [("failsafe -> B(p)", ""), ("", "failsafe -> B(p)")] {
        let text = format!(
            "machine m initial A param p = 1 {machines} state A {{ stop {own} }}
            state B(x: number) {{ steer body along vector(x, 0) at 1 m/s turning 0 rad/s after 1 s -> Failure(\"late\") }}"
        );
        assert_eq!(codes(&text), [""; 0], "{text}");
        assert_eq!(codes(&text.replace("failsafe -> B(p)", "")), ["P0504", "P0502", "P0501"]);
    }
}

#[test]
fn what_decides_by_intent_is_no_overlap() {
    assert_eq!(codes_of("when r.touching -> B  when l.touching -> C"), ["P0512"]);
    for fine in [
        // The second is the rest.
        "when r.touching and l.touching -> B  when r.touching -> C",
        "when r.sense < 0 -> B  when r.touching -> C",
        // They exclude each other.
        "when r.touching -> B  when l.touching and not r.touching -> C",
        "when r.sense > 0 -> B  when r.sense < 0 -> C",
        "when r.base_angle > p * 1 mrad -> B  when r.base_angle < 200 urad -> C",
        // A failure goes first.
        "when r.touching -> Failure(\"touched\")  when l.touching -> C",
        // Both lead to the same.
        "when r.touching -> B  when l.touching -> B",
        // An earlier one comes before both.
        "when r.touching and l.touching -> A2  when r.touching -> B  when l.touching -> C",
        // Times seldom end at once.
        "when r.touching for 100 ms -> B  when l.touching -> C",
        "after 5 s -> B  when l.touching -> C",
    ] {
        let fine = fine.replace("A2", "Reached");
        assert_eq!(codes_of(&fine), [""; 0], "{fine}");
    }
}

#[test]
fn what_may_hold_or_fail_is_let_be() {
    for fine in [
        "when r.contour.curvature > 0 rad/m -> B",
        "when r.contour.curvature == r.contour.curvature -> B",
        "when |r.contour.tangent| > 0.5 -> B",
        "when turn(body.yaw, r.yaw) > 170 deg -> B",
        "when |r.contour.point(5 mm) - r.contour.end| > 1 mm -> B",
        "when dot(r.contour.normal, r.contour.tangent) > 0.5 -> B",
        "when r.tip_deviation > 1 mm -> B",
        "when exp(p) > 3 and floor(2.5 * p) == 3 -> B",
        "when |r.tip_at(300 urad) - r.tip_base| > 1 mm -> B",
        "when |r.base_angle| > p * 1000 urad and r.base_angle < 0 rad -> B",
        "when p >= 2 -> B",
        "when p > 1 -> B",
        "when true -> B",
    ] {
        assert_eq!(codes_of(fine), [""; 0], "{fine}");
    }
}

#[test]
fn what_never_or_always_holds_is_told() {
    for (guard, code) in [
        ("r.tip_deviation < 0 m", "P0508"),
        ("exp(p) < 2.7", "P0508"),
        ("floor(p) < 1", "P0508"),
        ("wrap(body.yaw) > 190 deg", "P0508"),
        ("r.touching and r.sense == 0", "P0508"),
        ("r.sense > 0 and r.base_angle * r.side < 0 rad", "P0508"),
        ("|r.base_angle| > 361 deg", "P0508"),
        ("turn(body.yaw, r.yaw) > 190 deg", "P0508"),
        ("p > 2", "P0508"),
        ("r.contour.ready and not |r.contour.curvature| >= 0 rad/m", "P0508"),
        ("sin(r.yaw) > 1.1", "P0508"),
        ("sqrt(p) < 0.9", "P0508"),
        ("time < 0 s", "P0508"),
        ("p >= 1", "P0509"),
        ("r.sense <= 0 or r.touching", "P0509"),
        ("|unit(r.tip_base)| < 1.5", "P0509"),
        ("clamp(r.length, 5 mm, 8 mm) > 4 mm", "P0509"),
    ] {
        assert_eq!(codes_of(&format!("when {guard} -> B")), [code], "{guard}");
    }
}

/// What a whisker called `r` or `l` feels, as a witness says; what it does not say is nothing.
#[derive(Debug, Clone, Default)]
struct Told(BTreeMap<String, f64>);

impl Told {
    /// The values behind "both hold at".
    fn new(hint: &str) -> Self {
        let value = |text: &str| match text {
            "true" => 1.0,
            "false" => 0.0,
            text => parse_quantity(text).unwrap().value_si,
        };
        let told = hint.strip_prefix("both hold at ").unwrap();
        Self(
            told.split(", ")
                .map(|word| word.split_once(" = ").unwrap())
                .map(|(name, text)| (name.to_owned(), value(text)))
                .collect(),
        )
    }

    fn get(&self, name: &str) -> f64 {
        self.0.get(name).copied().unwrap_or(f64::NAN)
    }
}

impl Senses for Told {
    fn time(&self) -> f64 {
        self.0.get("time").copied().unwrap_or(0.0)
    }

    fn body(&self, quantity: BodyScalar) -> f64 {
        self.get(match quantity {
            BodyScalar::Yaw => "body.yaw",
            BodyScalar::Blocked => "body.blocked",
            BodyScalar::Shortfall => "body.shortfall",
            BodyScalar::Length => "body.length",
            BodyScalar::Width => "body.width",
            BodyScalar::NoseWidth => "body.nose_width",
            BodyScalar::TailWidth => "body.tail_width",
            BodyScalar::NoseReach => "nose",
            BodyScalar::Flexibility => "body.flexibility",
            BodyScalar::Decay => "body.decay",
            BodyScalar::Sway => "body.sway",
        })
    }

    fn body_position(&self) -> Vector2 {
        Vector2::new(f64::NAN, f64::NAN)
    }

    fn whisker(&self, whisker: usize, quantity: WhiskerScalar) -> f64 {
        let name = match quantity {
            WhiskerScalar::BaseAngle => "base_angle",
            WhiskerScalar::Touching => "touching",
            WhiskerScalar::Side => "side",
            WhiskerScalar::Sense => "sense",
            WhiskerScalar::Length => "length",
            WhiskerScalar::ContourReady => "contour.ready",
            WhiskerScalar::ContourCurvature => "contour.curvature",
            WhiskerScalar::Yaw => "yaw",
            WhiskerScalar::TipDeviation => "tip_deviation",
            WhiskerScalar::BaseAngleDeviation => "base_angle_deviation",
            WhiskerScalar::RecordedDeviation => "recorded_deviation",
            WhiskerScalar::Fitted => "fitted",
        };
        self.get(&format!("{}.{name}", ["r", "l"][whisker]))
    }

    fn whisker_vector(&self, _: usize, _: WhiskerVector) -> Vector2 {
        Vector2::new(f64::NAN, f64::NAN)
    }

    fn tip_at(&self, _: usize, _: f64) -> Vector2 {
        Vector2::new(f64::NAN, f64::NAN)
    }

    fn contour_at(&self, _: usize, _: f64, _: ContourVector) -> Vector2 {
        Vector2::new(f64::NAN, f64::NAN)
    }

    fn loop_closed(&self, _: usize, _: f64, _: f64) -> bool {
        false
    }

    fn record(&mut self, _: usize) {}

    fn record_position(&mut self, _: usize, _: Vector2) {}
}

/// A random condition over what can be felt.
fn condition() -> impl Strategy<Value = String> {
    let whisker = prop::sample::select(&["r", "l"]);
    let number = |least: i32, most: i32| (least..most).prop_map(|number| f64::from(number) / 4.0);
    let side = prop::sample::select(&["<", "<=", ">", ">=", "==", "!="]);
    let leaf = prop_oneof![
        whisker.clone().prop_map(|w| format!("{w}.touching")),
        whisker.clone().prop_map(|w| format!("{w}.contour.ready")),
        (whisker.clone(), side.clone(), -1..2).prop_map(|(w, side, sense)| format!("{w}.sense {side} {sense}")),
        (whisker.clone(), side.clone(), number(-8, 8))
            .prop_map(|(w, side, bend)| format!("{w}.base_angle {side} {bend:?} rad")),
        (whisker.clone(), whisker.clone(), side.clone(), number(-4, 5), number(-4, 5)).prop_map(
            |(w, u, side, factor, bend)| format!("|{w}.base_angle - {factor:?} * {u}.base_angle| {side} {bend:?} rad")
        ),
        (whisker.clone(), whisker.clone(), side.clone(), number(-20, 20))
            .prop_map(|(w, u, side, bend)| format!("{w}.side * {u}.contour.curvature {side} {bend:?} rad/m")),
        (whisker, side.clone(), number(-4, 4), number(-4, 4)).prop_map(|(w, side, most, sine)| {
            format!("min(sin(body.yaw) + {w}.length / 1 m, {most:?}) {side} {sine:?}")
        }),
        (side.clone(), number(-2, 30)).prop_map(|(side, time)| format!("sqrt(time / 1 s - 1) {side} {time:?}")),
        (side, number(0, 12), number(1, 9))
            .prop_map(|(side, value, divisor)| format!("(p + 1 / p) / {divisor:?} {side} {value:?}")),
    ];
    leaf.prop_recursive(3, 8, 2, |inner| {
        prop_oneof![
            (inner.clone(), inner.clone()).prop_map(|(a, b)| format!("({a} and {b})")),
            (inner.clone(), inner.clone()).prop_map(|(a, b)| format!("({a} or {b})")),
            inner.prop_map(|a| format!("not ({a})")),
        ]
    })
}

/// Something to feel, by two whiskers, in ranges that all that can be felt lies in.
fn felt() -> impl Strategy<Value = Told> {
    // A contour that was left off is not ready, and has a curvature all the same.
    let contour = || prop_oneof![Just((true, true)), Just((false, true)), Just((false, false))];
    let whisker = move || (any::<bool>(), 0..3_u8, -1.5..1.5_f64, contour(), -30.0..30.0_f64, 0.01..0.2_f64);
    (whisker(), whisker(), 0.0..100.0_f64, -7.0..7.0_f64).prop_map(|(r, l, time, yaw)| {
        let mut told = BTreeMap::from([("time".to_owned(), time), ("body.yaw".to_owned(), yaw)]);
        for (name, (is_left, contact, bend, (is_ready, is_there), curvature, length)) in [("r", r), ("l", l)] {
            let side = if is_left { 1.0 } else { -1.0 };
            let sense = f64::from(contact) - 1.0;
            let base_angle = if sense == 0.0 { bend } else { bend.abs() * side * sense };
            for (quantity, value) in [
                ("side", side),
                ("sense", sense),
                ("touching", sense.abs()),
                ("base_angle", base_angle),
                ("contour.ready", f64::from(u8::from(is_ready))),
                ("contour.curvature", if is_there { curvature } else { f64::NAN }),
                ("length", length),
            ] {
                told.insert(format!("{name}.{quantity}"), value);
            }
        }
        Told(told)
    })
}

const PREAMBLE: &str = "machine m whisker r, l param p = 1.5 in 1 .. 2 initial A state B { stop } state C { stop }
    always when time > 1e6 s -> Failure(\"late\")";

/// Where a machine goes from `A` in one tick.
fn goes(transitions: &str, told: &Told) -> String {
    let program = compile(&Source::new("policy.fsm", format!("{PREAMBLE} state A {{ stop {transitions} }}")));
    let mut program = program.unwrap();
    if let Some(&p) = told.0.get("p") {
        program.set("p", p, vibrissa_runtime::units::Dimension::NUMBER).unwrap();
    }
    let mut machine = Machine::new(Arc::new(program));
    machine.tick(&mut told.clone());
    machine.state_name().to_owned()
}

fn code(warning: &Diagnostic) -> &'static str {
    warning.code
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(500))]

    #[test]
    fn both_guards_hold_at_the_witness(first in condition(), second in condition()) {
        let text = format!("{PREAMBLE} state A {{ stop when {first} -> B when {second} -> C }}");
        for warning in warnings(&text).iter().filter(|warning| code(warning) == "P0512") {
            let told = Told::new(&warning.hints[0]);
            for guard in [&first, &second] {
                prop_assert_eq!(goes(&format!("when {guard} -> B"), &told), "B", "{} at {:?}", guard, told);
            }
        }
    }

    #[test]
    fn no_feeling_gainsays_what_is_said_of_guards(
        first in condition(), second in condition(), felt in prop::collection::vec(felt(), 20), p in 1.0..2.0_f64,
    ) {
        let text = format!("{PREAMBLE} state A {{ stop when {first} -> B when {second} -> C }}");
        let told = warnings(&text);
        let start = text.find(&format!("{first} -> B")).unwrap();
        let is_first = |warning: &Diagnostic| warning.primary.span.start <= start;
        for mut felt in felt {
            felt.0.insert("p".to_owned(), p);
            let goes_to = goes(&format!("when {first} -> B when {second} -> C"), &felt);
            for warning in &told {
                let guard = if is_first(warning) { &first } else { &second };
                match code(warning) {
                    "P0508" => prop_assert_eq!(goes(&format!("when {guard} -> B"), &felt), "A", "{} {:?}", guard, felt),
                    "P0509" => prop_assert_eq!(goes(&format!("when {guard} -> B"), &felt), "B", "{} {:?}", guard, felt),
                    "P0511" => prop_assert!(goes_to != "C", "{} {:?}", text, felt),
                    _ => {}
                }
            }
        }
    }
}

#[test]
fn good_policies_have_no_warnings() {
    let files = std::fs::read_dir(concat!(env!("CARGO_MANIFEST_DIR"), "/../../policies"))
        .unwrap()
        .map(|entry| entry.unwrap().path());
    let policies: Vec<_> = files.filter(|path| path.extension().is_some_and(|extension| extension == "fsm")).collect();
    assert!(!policies.is_empty());
    for path in policies {
        let file = &mut |path: &str| std::fs::read_to_string(path).map_err(|error| error.to_string());
        let main = Source::new(path.display().to_string(), std::fs::read_to_string(&path).unwrap());
        let source = gather(&main, file);
        let warnings = compile_with_warnings(&source).unwrap().warnings;
        assert!(warnings.is_empty(), "{}", terminal(&source, &warnings, Colour::Plain));
    }
}
