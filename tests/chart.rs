//! The statechart of a policy, and its three renderings.
#![allow(clippy::unwrap_used, reason = "a test may panic")]

use std::collections::BTreeSet;

use proptest::prelude::*;
use svg::node::element::tag::Type;
use svg::parser::Event;
use vibrissa::diagnostic::Source;
use vibrissa::machine::{self, Program};
use vibrissa::policy::chart::{Argument, Chart, Guard, Origin, State, Target, Transition};
use vibrissa::policy::{chart, compile};
use vibrissa::report::{chart_dot, chart_mermaid, chart_svg};

const THESIS: &str = include_str!("../policies/thesis.fsm");
/// Ten states with all that makes a chart hard to draw.
const HARD: &str = include_str!("fixtures/charts/hard.fsm");
/// Three levels of states.
const NESTED: &str = include_str!("fixtures/charts/nested.fsm");

fn state(name: &str, parent: Option<usize>, initial: bool) -> State {
    State { name: name.to_owned(), arguments: Vec::new(), parent, initial, values: Vec::new() }
}

fn into(state: usize, values: Vec<String>) -> Target {
    Target::State { state, outer: Vec::new(), values, resume: false }
}

fn chart_of(text: &str) -> Chart {
    chart(&Source::new("policy.fsm", text)).unwrap()
}

fn program_of(text: &str) -> Program {
    compile(&Source::new("policy.fsm", text)).unwrap()
}

#[test]
fn the_texts_are_as_reviewed() {
    let mut settings = insta::Settings::clone_current();
    settings.set_snapshot_path("../snapshots/charts");
    settings.set_prepend_module_to_snapshot(false);
    settings.set_omit_expression(true);
    settings.bind(|| {
        for (name, text) in [("thesis", THESIS), ("hard", HARD), ("nested", NESTED)] {
            let chart = chart_of(text);
            insta::assert_snapshot!(format!("{name}.mermaid"), chart_mermaid(&chart));
            insta::assert_snapshot!(format!("{name}.dot"), chart_dot(&chart));
            insta::assert_snapshot!(format!("{name}.svg"), chart_svg(&chart).unwrap());
        }
    });
}

/// Checks that a chart's transitions lead where a machine's do, and wait where they wait.
fn agree(chart: &Chart, origin: Origin, machine: &[machine::Transition]) {
    let of_origin: Vec<_> = chart.transitions.iter().filter(|transition| transition.origin == origin).collect();
    assert_eq!(of_origin.len(), machine.len(), "{origin:?}");
    for (drawn, compiled) in of_origin.into_iter().zip(machine) {
        match (&drawn.target, &compiled.target) {
            (Target::Failure(drawn), machine::Target::Failure(compiled)) => assert_eq!(**drawn, **compiled),
            (
                Target::State { state, values, resume, .. },
                machine::Target::State { state: compiled, resume: resumes, .. },
            ) => {
                assert_eq!((state, resume), (compiled, resumes));
                assert_eq!(values.len(), chart.states[*state].arguments.len());
            }
            others => panic!("{others:?}"),
        }
        match (&drawn.guard, &compiled.guard) {
            (Guard::After(_), machine::Guard::After { .. }) => {}
            (Guard::When { lasting, .. }, guard @ machine::Guard::When { .. }) => {
                assert_eq!(lasting.is_some(), guard.is_timed());
            }
            others => panic!("{others:?}"),
        }
    }
}

#[test]
fn a_chart_has_every_state_and_transition_of_the_machine_in_their_order() {
    for text in [THESIS, HARD, NESTED] {
        let (chart, program) = (chart_of(text), program_of(text));
        assert_eq!(chart.machine, program.name);
        let names: Vec<_> = chart.states.iter().map(|state| &*state.name).collect();
        assert_eq!(names, program.states.iter().map(|state| &*state.name).collect::<Vec<_>>());
        for (index, (drawn, compiled)) in chart.states.iter().zip(&program.states).enumerate() {
            assert_eq!(drawn.parent, compiled.parent);
            let outer = compiled.parent.and_then(|outer| program.states[outer].initial.as_ref());
            assert_eq!(drawn.initial, outer.map_or(program.initial, |&(inner, _)| inner) == index);
        }
        agree(&chart, Origin::AnyState, &program.always);
        for (index, state) in program.states.iter().enumerate() {
            agree(&chart, Origin::State(index), &state.transitions);
        }
    }
}

#[test]
fn expressions_are_on_one_line_without_comments() {
    let text = "machine m whisker w initial S
        state S {
          when not(w.touching)   # why?
            and   1 # and \"this
            < 2 for
              100 ms -> T ( vector(1 m,
                -2 m) , w )
        }
        state T(place: vector   of length, which: whisker) { after 2 * 1 s -> Failure(\"a  #  b\") }";
    let chart = chart_of(text);
    let condition = "not(w.touching) and 1 < 2".to_owned();
    assert_eq!(chart.transitions[0].guard, Guard::When { condition, lasting: Some("100 ms".to_owned()) });
    let values = vec!["vector(1 m, -2 m)".to_owned(), "w".to_owned()];
    assert_eq!(chart.transitions[0].target, into(1, values));
    assert_eq!(chart.states[1].arguments[0].type_name, "vector of length");
    assert_eq!(chart.transitions[1].guard, Guard::After("2 * 1 s".to_owned()));
    assert_eq!(chart.transitions[1].target, Target::Failure("a  #  b".to_owned()));
}

#[test]
fn a_failsafe_is_drawn_and_has_no_number() {
    let chart = chart_of(
        "machine m initial S failsafe -> T(2)
        state S { stop when time > 1 s -> T(1) after 2 s -> T(3) failsafe -> Failure(\"lost\") }
        state T(x: number) { steer body along vector(x, 0) at 1 m/s turning 0 rad/s after 1 s -> S }",
    );
    let failsafes = chart.transitions.iter().filter(|transition| transition.guard == Guard::Failsafe);
    let failsafes: Vec<_> = failsafes.map(|transition| (transition.origin, &transition.target)).collect();
    let (all, own) = (
        Target::State { state: 1, outer: Vec::new(), values: vec!["2".to_owned()], resume: false },
        Target::Failure("lost".to_owned()),
    );
    assert_eq!(failsafes, [(Origin::AnyState, &all), (Origin::State(0), &own)]);
    let mermaid = chart_mermaid(&chart);
    for line in [
        "any --> s1: failsafe / x = 2",
        "s0 --> s1: 2 after 2 s / x = 3",
        "s0 --> failure: failsafe / #quot;lost#quot;",
    ] {
        assert!(mermaid.contains(line), "{line}: {mermaid}");
    }
    assert!(chart_dot(&chart).contains("failsafe") && chart_svg(&chart).unwrap().contains("failsafe"));
}

#[test]
fn a_policy_with_a_fault_has_no_chart() {
    let source = Source::new("policy.fsm", "machine m initial S state S { when 1 -> Nowhere }");
    assert_eq!(chart(&source).unwrap_err(), compile(&source).unwrap_err());
}

/// What a picture shows: the boxes of its texts, with them, and the frames of its states (left, top, right, bottom in px).
#[derive(Default)]
struct Seen {
    texts: Vec<(String, [f64; 4])>,
    frames: Vec<[f64; 4]>,
    size: (f64, f64),
}

/// Reads a picture, whose tags are shown to be balanced and whose numbers to be finite.
fn see(picture: &str) -> Seen {
    let (mut open, mut seen, mut current) = (Vec::new(), Seen::default(), None::<(f64, f64, f64, f64, String)>);
    let mut shift = (0.0, 0.0);
    for event in svg::read(picture).unwrap() {
        match event {
            Event::Tag(name, kind, attributes) => {
                for value in attributes.values() {
                    assert!(!value.contains("NaN") && !value.contains("inf"), "{name}: {value:?}");
                }
                match kind {
                    Type::Start => open.push(name.to_owned()),
                    Type::End => assert_eq!(open.pop().as_deref(), Some(name)),
                    Type::Empty => {}
                }
                let number = |key: &str| attributes.get(key).and_then(|value| value.parse::<f64>().ok());
                match (name, kind) {
                    ("svg", Type::Start) => seen.size = (number("width").unwrap(), number("height").unwrap()),
                    ("g", Type::Start) => {
                        if let Some(transform) = attributes.get("transform") {
                            let numbers = transform.trim_matches(|c: char| !c.is_ascii_digit()).split_once(' ');
                            let (x, y) = numbers.unwrap();
                            shift = (x.parse().unwrap(), y.parse().unwrap());
                        }
                    }
                    ("rect", _) if attributes.contains_key("stroke") => {
                        let [x, y, width, height] = ["x", "y", "width", "height"].map(|key| number(key).unwrap());
                        let (x, y) = (x + shift.0, y + shift.1);
                        seen.frames.push([x, y, x + width, y + height]);
                    }
                    ("text", Type::Start) => {
                        let before = if &*attributes["text-anchor"] == "start" { 0.0 } else { 0.5 };
                        let [x, y, size] = ["x", "y", "font-size"].map(|key| number(key).unwrap());
                        current = Some((x + shift.0, y + shift.1, size, before, String::new()));
                    }
                    ("text", Type::End) => {
                        let (x, y, size, before, content) = current.take().unwrap();
                        let width = 0.6 * size * content.chars().count() as f64;
                        let left = x - before * width;
                        seen.texts.push((content, [left, y - 0.8 * size, left + width, y + 0.2 * size]));
                    }
                    _ => {}
                }
            }
            Event::Text(content) => {
                if let Some((.., text)) = &mut current {
                    let entities = [
                        ("&lt;", "<"),
                        ("&gt;", ">"),
                        ("&quot;", "\""),
                        ("&apos;", "'"),
                        ("&#39;", "'"),
                        ("&amp;", "&"),
                    ];
                    let plain =
                        entities.iter().fold(content.trim().to_owned(), |text, (from, to)| text.replace(from, to));
                    text.push_str(&plain);
                }
            }
            Event::Error(error) => panic!("{error}"),
            _ => {}
        }
    }
    assert!(open.is_empty(), "{open:?}");
    seen.texts.retain(|(content, _)| !content.is_empty());
    seen
}

fn apart(a: &[f64; 4], b: &[f64; 4]) -> bool {
    a[0] >= b[2] || b[0] >= a[2] || a[1] >= b[3] || b[1] >= a[3]
}

fn within(inner: &[f64; 4], outer: &[f64; 4]) -> bool {
    inner[0] >= outer[0] && inner[1] >= outer[1] && inner[2] <= outer[2] && inner[3] <= outer[3]
}

/// Texts lie in the picture, apart from each other, and each in a frame or apart from it.
fn stands_clear(picture: &str) {
    let seen = see(picture);
    let all = [0.0, 0.0, seen.size.0, seen.size.1];
    for (index, (a, place)) in seen.texts.iter().enumerate() {
        assert!(within(place, &all), "{a} is cut off");
        for (b, other) in &seen.texts[..index] {
            assert!(apart(place, other), "`{a}` and `{b}` overlap");
        }
        for frame in &seen.frames {
            assert!(apart(place, frame) || within(place, frame), "`{a}` overlaps a frame");
        }
    }
    for (index, a) in seen.frames.iter().enumerate() {
        assert!(within(a, &all));
        for b in &seen.frames[..index] {
            assert!(apart(a, b) || within(a, b) || within(b, a), "frames overlap");
        }
    }
}

#[test]
fn in_a_picture_nothing_hides_anything() {
    for text in [THESIS, HARD, NESTED] {
        stands_clear(&chart_svg(&chart_of(text)).unwrap());
    }
}

#[test]
fn a_picture_stands_by_itself_and_is_always_the_same() {
    let picture = chart_svg(&chart_of(HARD)).unwrap();
    assert_eq!(picture.matches("http").count(), 1, "the namespace alone");
    assert!(picture == chart_svg(&chart_of(HARD)).unwrap());
}

/// What each rendering of a chart shows, on one line if it is a picture.
fn shown(chart: &Chart) -> [String; 3] {
    let seen = see(&chart_svg(chart).unwrap()).texts.into_iter().map(|(text, _)| text);
    [seen.collect::<Vec<_>>().join(" "), chart_mermaid(chart), chart_dot(chart)]
}

#[test]
fn every_rendering_shows_every_state_guard_value_and_reason() {
    let chart = chart_of(THESIS);
    for shown in shown(&chart) {
        for wanted in ["Exploring", "Swiping", "any state", "Failure"] {
            assert!(shown.contains(wanted), "no {wanted:?} in {shown}");
        }
        for wanted in ["1 when r0.touching", "/ w = l0", "when not w.touching for lost", "the whisker lost the object"]
        {
            assert!(shown.contains(wanted), "no {wanted:?} in {shown}");
        }
    }
}

#[test]
fn hostile_texts_stay_texts() {
    let hostile = "\"]; <script>x</script> \\l \\\" & &lt; : ; #35; %% --> [*] } \u{1b}\u{0}\r\u{ffff}";
    let reason = Target::Failure(hostile.to_owned());
    let condition = hostile.to_owned();
    let chart = Chart {
        machine: "m".to_owned(),
        states: vec![state("S", None, true)],
        transitions: vec![Transition {
            origin: Origin::State(0),
            guard: Guard::When { condition, lasting: None },
            target: reason,
        }],
    };
    let [svg, mermaid, dot] = [chart_svg(&chart).unwrap(), chart_mermaid(&chart), chart_dot(&chart)];
    for text in [&svg, &mermaid, &dot] {
        assert!(!text.contains(|c: char| (c.is_control() && c != '\n') || c == '\u{ffff}'));
    }
    assert!(!svg.contains("<script"));
    see(&svg);
    // Of all that Mermaid would end the text at, or take for something else, nothing is left.
    let label = mermaid.lines().find_map(|line| line.strip_prefix("s0 --> failure: ")).unwrap();
    let entities = label.split('#').skip(1);
    assert!(entities.clone().all(|rest| rest.split(';').next().unwrap().chars().all(char::is_alphanumeric)));
    assert_eq!(label.matches(';').count(), entities.count());
    assert!(!label.contains([':', '"', '<', '&', '[', '{', '}', '\\', '%', '`', '*', '_']));
    // In Graphviz's text every quote within is behind a backslash that is not itself behind one.
    let label = dot.lines().find_map(|line| line.trim().strip_prefix("\"S\" -> \"Failure\" [label=\"")).unwrap();
    let mut escaped = false;
    let end = label.find(|c| {
        let ends = c == '"' && !escaped;
        escaped = c == '\\' && !escaped;
        ends
    });
    assert_eq!(&label[end.unwrap()..], "\"]");
    assert!(label.contains("&amp;lt;"));
}

#[test]
fn nested_states_are_drawn_as_such() {
    let chart = Chart {
        machine: "m".to_owned(),
        states: vec![state("Outer", None, true), state("Inner", Some(0), true), state("Other", None, false)],
        transitions: vec![],
    };
    let mermaid = chart_mermaid(&chart);
    assert!(
        mermaid.contains("state \"Outer\" as s0 {\n  state \"Inner\" as s1\n  [*] --> s1\n}\n[*] --> s0\n"),
        "{mermaid}"
    );
    let dot = chart_dot(&chart);
    assert!(dot.contains("subgraph \"cluster Outer\" {\n    \"Outer\" [label=\"Outer\"]\n    \"Inner\""), "{dot}");
    let seen = see(&chart_svg(&chart).unwrap());
    let place = |name: &str| seen.texts.iter().find(|(text, _)| text == name).unwrap().1;
    let around = |name: &str| seen.frames.iter().filter(|frame| within(&place(name), frame)).count();
    assert_eq!(["Outer", "Inner", "Other"].map(around), [1, 2, 1]);
}

#[test]
fn a_chart_that_nobody_could_make_out_has_no_picture() {
    let states: Vec<_> = (0..101).map(|k| format!("state S{k} {{ after 1 s -> S{} }}", (k + 1) % 101)).collect();
    let chart = chart_of(&format!("machine m initial S0 {}", states.join("\n")));
    assert!(chart_svg(&chart).unwrap_err().to_string().contains("101 states"));
    assert_eq!(chart_dot(&chart).matches("after").count(), 101);
}

/// A chart of up to 12 states, in one another or not, with texts of any length.
fn charts() -> impl Strategy<Value = Chart> {
    let text = prop_oneof!["[a-z.]{1,12}( [a-z0-9<>|]{1,30}){0,12}", "[a-z]{1,120}", "\\PC{0,40}"];
    let transition = (0..14_usize, 0..13_usize, text.clone(), prop::option::of(text));
    let states = prop::collection::vec(("[A-Z][a-z]{0,30}", 0..4_usize), 1..12);
    (states, prop::collection::vec(transition, 0..40), any::<prop::sample::Index>()).prop_map(
        |(states, transitions, initial)| {
            let count = states.len();
            // Each state lies beside the one before it, in it, or beside one around it.
            let mut parents: Vec<Option<usize>> = vec![None];
            for (before, (_, depth)) in states[1..].iter().enumerate() {
                let around = std::iter::successors(Some(before), |&state| parents[state]);
                let around: Vec<usize> = around.collect();
                parents.push(around.iter().rev().take(*depth).next_back().copied());
            }
            let outermost: Vec<usize> = (0..count).filter(|&state| parents[state].is_none()).collect();
            let initial = outermost[initial.index(outermost.len())];
            let argument = |k: usize| Argument { name: format!("a{k}"), type_name: "vector of length".to_owned() };
            let numbered = |(k, (name, _)): (usize, (String, usize))| {
                let is_first = parents[k].is_some() && !parents[..k].contains(&parents[k]);
                let arguments = (0..k % 4).map(argument).collect();
                State { arguments, ..state(&format!("{name}{k}"), parents[k], k == initial || is_first) }
            };
            let transition = |(from, to, text, lasting): (usize, usize, String, Option<String>)| Transition {
                origin: if from >= 12 { Origin::AnyState } else { Origin::State(from % count) },
                target: if to >= 12 {
                    Target::Failure(text.clone())
                } else {
                    into(to % count, vec![text.clone(); (to % count) % 4])
                },
                guard: Guard::When { condition: text, lasting },
            };
            Chart {
                machine: "m".to_owned(),
                states: states.into_iter().enumerate().map(numbered).collect(),
                transitions: transitions.into_iter().map(transition).collect(),
            }
        },
    )
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(200))]

    #[test]
    fn in_the_picture_of_any_chart_nothing_hides_anything(chart in charts()) {
        let picture = chart_svg(&chart).unwrap();
        stands_clear(&picture);
        // One arrow for all transitions between two states, and one to each initial state.
        let ends = |transition: &Transition| match transition.target {
            Target::State { state, .. } => (format!("{:?}", transition.origin), Some(state)),
            Target::Failure(_) => (format!("{:?}", transition.origin), None),
        };
        let arrows: BTreeSet<_> = chart.transitions.iter().map(ends).collect();
        let initial = chart.states.iter().filter(|state| state.initial).count();
        prop_assert_eq!(picture.matches("stroke-width=\"1.3\"").count(), arrows.len() + initial);
    }

    #[test]
    fn the_texts_of_any_chart_have_a_line_a_transition(chart in charts()) {
        let mermaid = chart_mermaid(&chart);
        let last = usize::from(chart.has_failure());
        let initial = chart.states.iter().filter(|state| state.initial).count();
        let arrows = chart.transitions.len() + initial;
        prop_assert_eq!(mermaid.lines().filter(|line| line.contains(" --> ")).count(), arrows + last);
        let dot = chart_dot(&chart);
        prop_assert_eq!(dot.lines().filter(|line| line.contains("\" -> \"")).count(), arrows);
    }
}
