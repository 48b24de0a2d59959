//! The texts of a chart, in a picture and without.

use proptest::prelude::*;
use vibrissa::policy::chart::{Chart, Guard, Origin, Target, Transition};
use vibrissa::report::{chart_dot, chart_mermaid, chart_svg};

use super::charts::{HARD, NESTED, THESIS, chart_of, charts, state};
use crate::seen::{see, within};
use crate::snapshots::snapshots;

#[test]
fn the_texts_are_as_reviewed() {
    snapshots("charts").bind(|| {
        for (name, text) in [("thesis", THESIS), ("hard", HARD), ("nested", NESTED)] {
            let chart = chart_of(text);
            insta::assert_snapshot!(format!("{name}.mermaid"), chart_mermaid(&chart));
            insta::assert_snapshot!(format!("{name}.dot"), chart_dot(&chart));
        }
        // A picture is reviewed where it is small. `picture` has claims about all of them.
        for (name, text) in [("hard", HARD), ("nested", NESTED)] {
            insta::assert_snapshot!(format!("{name}.svg"), chart_svg(&chart_of(text)).unwrap());
        }
    });
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
        for wanted in ["Exploring", "Swiping", "any state", "Failure", "Success", "the contour is closed"] {
            assert!(shown.contains(wanted), "no {wanted:?} in {shown}");
        }
        for wanted in ["1 when r0.touching", "/ w = l0", "3 after 5 m / speed", "a whisker at its limit"] {
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
            number: None,
            exits: Vec::new(),
            guard: Guard::When { condition, lasting: None },
            target: reason,
        }],
        contracts: Vec::new(),
        parents: vec![None],
        is_overview: false,
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
        contracts: Vec::new(),
        parents: vec![None, Some(0), None],
        is_overview: false,
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
fn contracts_are_in_the_boxes_of_what_keeps_them() {
    let chart = chart_of(
        "machine m
        never body.blocked for 3 s
        initial Going
        state Going is go(50 mm/s) {
          assume not body.blocked
          on done -> Failure(\"done\")
        }
        behaviour go(speed: speed) {
          exit done
          assume speed > 0 mm/s
          initial Moving
          state Moving {
            steer body along direction(body.yaw) at speed turning 0 deg/s
            after 5 s -> exit done
          }
        }",
    );
    assert_eq!(chart.contracts, ["never body.blocked for 3 s"]);
    assert_eq!(chart.states[0].contracts, ["assume not body.blocked", "assume speed > 0 mm/s"]);
    for drawn in shown(&chart) {
        for contract in ["never body.blocked for 3 s", "assume not body.blocked"] {
            assert!(drawn.contains(contract), "{drawn}");
        }
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(200))]

    #[test]
    fn the_texts_of_any_chart_have_a_line_a_transition(chart in charts()) {
        let mermaid = chart_mermaid(&chart);
        let last = usize::from(chart.has_failure()) + usize::from(chart.has_success());
        let initial = chart.states.iter().filter(|state| state.initial).count();
        let arrows = chart.transitions.len() + initial;
        prop_assert_eq!(mermaid.lines().filter(|line| line.contains(" --> ")).count(), arrows + last);
        let dot = chart_dot(&chart);
        prop_assert_eq!(dot.lines().filter(|line| line.contains("\" -> \"")).count(), arrows);
    }
}
