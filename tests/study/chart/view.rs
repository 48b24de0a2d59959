//! A part of a chart, or one with fewer levels.

use proptest::prelude::*;
use vibrissa::policy::chart::{Chart, Guard, Origin, Target, Transition, View};
use vibrissa::report::{chart_dot, chart_mermaid, chart_svg};

use super::charts::{NESTED, chart_of, charts};
use crate::seen::see;

const VIBRISSA: &str = include_str!("../../../policies/vibrissa.fsm");

fn depth(depth: usize) -> View<'static> {
    View { state: None, depth: Some(depth) }
}

fn of_state(name: &str) -> View<'_> {
    View { state: Some(name), depth: None }
}

fn names(chart: &Chart) -> Vec<&str> {
    chart.states.iter().map(|state| state.name.as_str()).collect()
}

/// The ends of a transition by names.
fn ends<'c>(chart: &'c Chart, transition: &'c Transition) -> (&'c str, &'c str) {
    let name = |state: usize| chart.states[state].name.as_str();
    let from = match transition.origin {
        Origin::AnyState => "any state",
        Origin::State(state) => name(state),
    };
    let to = match &transition.target {
        Target::State { state, .. } => name(*state),
        Target::Failure(_) => "Failure",
        Target::Success(_) => "Success",
        Target::Exit { name, .. } => name,
    };
    (from, to)
}

#[test]
fn a_large_policy_at_depth_1_fits_a_screen() {
    let whole = chart_of(VIBRISSA);
    let overview = whole.view(depth(1)).unwrap();
    assert!(overview.states.iter().all(|state| state.parent.is_none()));
    let shown: usize = overview.states.iter().map(|state| 1 + state.hidden).sum();
    assert_eq!(shown, whole.states.len());
    assert!(see(&chart_svg(&whole).unwrap()).size.0 > 5000.0, "it has become small by itself");
    assert!(see(&chart_svg(&overview).unwrap()).size.0 < 1600.0);
}

#[test]
fn what_leads_to_and_from_inner_states_leads_to_and_from_what_holds_them() {
    let chart = chart_of(
        "machine m initial A
        state A { initial B  state B { stop after 1 s -> C after 9 s -> D(3).E after 2 s -> D(3).E }
                             state C { stop after 9 s -> D(3) after 3 s -> A after 4 s -> Failure(\"end\") } }
        state D(x: number) { initial E steer body along vector(x, 0) at 1 m/s turning 0 rad/s
                             state E { after 1 s -> A.C after 5 s -> A } }",
    );
    let view = chart.view(depth(1)).unwrap();
    assert_eq!(names(&view), ["A", "D"]);
    let [svg, mermaid, dot] = [chart_svg(&view).unwrap(), chart_mermaid(&view), chart_dot(&view)];
    for text in [&svg, &mermaid, &dot] {
        assert!(text.contains("+ 2 states in it"), "{text}");
    }
    // Of B's and C's ways to D that are the same one is left, and nothing of what stays within A but the way in anew.
    let lines: Vec<_> = mermaid.lines().filter(|line| line.contains("-->")).collect();
    assert_eq!(
        lines,
        [
            "[*] --> s0",
            "s0 --> s1: after 9 s / x = 3",
            "s0 --> s1: after 2 s / x = 3",
            "s0 --> s0: after 3 s",
            "s0 --> failure: after 4 s / #quot;end#quot;",
            "s1 --> s0: after 1 s",
            "s1 --> s0: after 5 s",
            "failure --> [*]",
        ]
    );
}

#[test]
fn a_state_is_shown_with_its_inside_and_where_that_leads() {
    let whole = chart_of(VIBRISSA);
    let view = whole.view(of_state("Meeting")).unwrap();
    assert_eq!(names(&view), ["Meeting", "Meeting.Halting", "Meeting.Drawing", "Meeting.Probing", "Facing"]);
    assert_eq!(view.states.iter().find(|state| state.name == "Meeting.Halting").map(|state| state.initial), Some(true));
    let inside: Vec<_> = whole.transitions.iter().filter(|way| is_of(&whole, way, "Meeting")).collect();
    assert_eq!(view.transitions.len(), inside.len());
    let shallow = whole.view(View { state: Some("Meeting"), depth: Some(0) }).unwrap();
    assert_eq!(names(&shallow), ["Meeting", "Facing"]);
}

/// Whether a transition is of a state in the state of this name, or of that itself.
fn is_of(chart: &Chart, transition: &Transition, name: &str) -> bool {
    let outer = chart.states.iter().position(|state| state.name == name).unwrap();
    matches!(transition.origin, Origin::State(state) if chart.contains(outer, state))
}

/// A behaviour in the middle of a machine, and one in it.
const BEHAVIOURS: &str = "machine m whisker r0 initial A
    behaviour outer(w: whisker) {
      exit far(d: length)  exit lost
      initial B
      when time > 9 s -> exit lost
      state B { stop  after 1 s -> C  when w.touching -> exit far(w.length) }
      state C is inner { on done -> exit far(1 mm)  on stuck -> B }
    }
    behaviour inner { exit done  exit stuck  stop  after 1 s -> exit done  after 2 s -> exit stuck }
    state A { stop  after 1 s -> Whole(r0) }
    state Whole(w: whisker) is outer(w) { on far(d) -> Gone(d)  on lost -> A }
    state Gone(how_far: length) { stop  after how_far / 1 m/s -> Whole(r0) }";

#[test]
fn a_behaviour_is_one_box_whose_arrows_have_the_names_of_exits() {
    let whole = chart_of(BEHAVIOURS);
    assert_eq!(names(&whole), ["A", "Whole", "Whole.B", "Whole.C", "Gone"]);
    assert_eq!(whole.states[1].behaviour.as_deref(), Some("outer(w)"));
    assert_eq!(whole.states[3].behaviour.as_deref(), Some("inner"));
    let view = whole.view(depth(1)).unwrap();
    assert_eq!(names(&view), ["A", "Whole", "Gone"]);
    let exits: Vec<_> = view.transitions.iter().filter(|way| way.origin == Origin::State(1)).collect();
    let told = |guard: &Guard| if let Guard::Exit(name) = guard { name.clone() } else { "when".to_owned() };
    let told: Vec<_> = exits.iter().map(|way| (told(&way.guard), ends(&view, way).1)).collect();
    assert_eq!(told, [("lost".to_owned(), "A"), ("far".to_owned(), "Gone")]);
    see(&chart_svg(&whole).unwrap());
    see(&chart_svg(&view).unwrap());
}

#[test]
fn the_behaviours_of_a_library_are_drawn_with_their_exits_as_ends() {
    let library =
        BEHAVIOURS.replace("machine m whisker r0 initial A", "library m").split("state A").next().unwrap().to_owned();
    let chart = chart_of(&library);
    assert_eq!(names(&chart), ["outer", "outer.B", "outer.C", "inner"]);
    assert_eq!(chart.ends(), [("outer", "lost"), ("outer", "far"), ("inner", "done"), ("inner", "stuck")]);
    let view = chart.view(of_state("inner")).unwrap();
    assert_eq!((names(&view), view.ends()), (vec!["inner"], vec![("inner", "done"), ("inner", "stuck")]));
    for text in [chart_svg(&chart).unwrap(), chart_mermaid(&chart), chart_dot(&chart)] {
        assert!(["lost", "far", "done", "stuck"].iter().all(|exit| text.contains(exit)), "{text}");
    }
}

#[test]
fn a_state_that_there_is_none_of_is_told_with_one_that_is_near() {
    let chart = chart_of(NESTED);
    let name = names(&chart)[0].to_owned();
    let message = chart.view(of_state(&format!("{name}x"))).unwrap_err().to_string();
    assert!(message.contains(&format!("do you mean `{name}`?")), "{message}");
    let message = chart.view(of_state("Zyzzyva")).unwrap_err().to_string();
    assert!(message.contains(&format!("there are {}", names(&chart).join(", "))), "{message}");
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(200))]

    #[test]
    fn a_view_of_any_chart_shows_what_it_should_and_nothing_twice(chart in charts(), levels in 1..5_usize) {
        let view = chart.view(depth(levels)).unwrap();
        // The states of so many levels, and for each of the others the one around it.
        let path = |state: usize| {
            let mut path: Vec<_> = std::iter::successors(Some(state), |&state| chart.states[state].parent).collect();
            path.reverse();
            path
        };
        let shown = |state: usize| *path(state).iter().take(levels).next_back().unwrap();
        let expected: Vec<_> = (0..chart.states.len()).filter(|&state| path(state).len() <= levels).collect();
        prop_assert_eq!(view.states.iter().map(|state| state.index).collect::<Vec<_>>(), expected);
        let name = |state: usize| chart.states[state].name.as_str();
        for way in &chart.transitions {
            let (from, inner) = match way.origin {
                Origin::AnyState => ("any state", None),
                Origin::State(state) => (name(shown(state)), Some(shown(state))),
            };
            let (to, is_within) = match &way.target {
                &Target::State { state, .. } => (name(shown(state)), inner == Some(shown(state)) && shown(state) != state),
                Target::Failure(_) => ("Failure", false),
                Target::Success(_) => ("Success", false),
                Target::Exit { name, .. } => (name.as_str(), false),
            };
            let is_there = view.transitions.iter().any(|seen| ends(&view, seen) == (from, to) && seen.guard == way.guard);
            prop_assert!(is_there || is_within, "{} -> {}", from, to);
        }
        for (index, way) in view.transitions.iter().enumerate() {
            prop_assert!(!view.transitions[..index].contains(way));
        }
        for state in &chart.states {
            let view = chart.view(View { state: Some(&state.name), depth: Some(levels) }).unwrap();
            prop_assert!(names(&view).contains(&state.name.as_str()));
            see(&chart_svg(&view).unwrap());
        }
    }

    #[test]
    fn with_all_levels_a_view_is_the_whole_chart(chart in charts()) {
        let view = chart.view(View::default()).unwrap();
        prop_assert_eq!(&view.states, &chart.states);
        let mut once = Vec::new();
        for way in &chart.transitions {
            if !once.contains(way) { once.push(way.clone()); }
        }
        prop_assert_eq!(view.transitions, once);
    }
}
