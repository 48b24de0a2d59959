//! Inspected runs: transitions with their guards, breakpoints, and the first difference of two policies.

use std::sync::Arc;

use vibrissa::diagnostic::Source;
use vibrissa::inspect::{Breakpoints, Inspector, first_difference};
use vibrissa::run::TickRecord;
use vibrissa::scene::WorldKind;
use vibrissa::trial::{Trial, TrialResult};
use vibrissa::{built_in, scenario};

const THESIS: &str = include_str!("../../policies/thesis.fsm");

fn breakpoints(text: &str, places: &[&str]) -> Breakpoints {
    let places: Vec<String> = places.iter().map(|&place| place.to_owned()).collect();
    Breakpoints::new(&Source::new("policy.fsm", text), &places).unwrap()
}

/// The policy in a scene of the bench, in the quasi-static world.
fn trial(scene: &str, policy: &Breakpoints) -> Trial {
    let file = built_in::SCENARIOS.iter().find(|file| file.path.ends_with(&format!("/{scene}.yaml"))).unwrap();
    let scene = scenario::read(&Source::new(file.path, file.text)).unwrap();
    Trial { world: WorldKind::QuasiStatic.into(), ..Trial::new(scene, Arc::new(policy.explained.program.clone())) }
}

fn plain(scene: &str) -> TrialResult {
    let policy = breakpoints(THESIS, &[]);
    let program = vibrissa::policy::compile(&Source::new("policy.fsm", THESIS)).unwrap();
    Trial { program: Arc::new(program), ..trial(scene, &policy) }.run().unwrap()
}

#[test]
fn an_inspected_run_has_the_same_ticks_and_its_transitions_join_its_states() {
    let policy = breakpoints(THESIS, &[]);
    let mut inspector = Inspector::new(&policy, "box");
    let result = trial("box", &policy).run_watched(&mut inspector).unwrap();
    assert_eq!(result.run.trace, plain("box").run.trace);
    let (trace, lines) = (&result.run.trace, inspector.transitions());
    assert!(lines.len() > 20);
    for line in lines {
        let before = line.tick.checked_sub(1).and_then(|tick| trace.ticks[tick].state);
        if line.ticks_in_state > 0 {
            assert_eq!(Some(line.left.as_str()), before.map(|state| trace.states[state].as_str()), "{line:?}");
            let since = line.tick - line.ticks_in_state;
            assert!(trace.ticks[since..line.tick].iter().all(|tick| tick.state == before), "{line:?}");
        }
        assert!((line.time_s - trace.ticks[line.tick].time).abs() < 1e-12);
        assert!(line.taken.missing().is_empty(), "{line:?}");
    }
    // A tick without a transition does not change the state.
    for (index, pair) in trace.ticks.windows(2).enumerate() {
        let has_transition = lines.iter().any(|line| line.tick == index + 1);
        assert!(has_transition || pair[0].state == pair[1].state, "tick {}", index + 1);
    }
}

#[test]
fn a_run_stops_in_the_first_tick_in_which_a_state_is_active_or_a_condition_holds() {
    let trace = plain("box").run.trace;
    let named = |name: &str| trace.states.iter().position(|state| state == name);
    let first = |wanted: usize| trace.ticks.iter().position(|tick| tick.state == Some(wanted)).unwrap();
    let is_bent = |tick: &TickRecord| tick.whiskers[0].deflection.abs() > 100e-6;
    let bent = trace.ticks.iter().position(is_bent).unwrap();
    let lasting = 3 + trace.ticks.windows(4).position(|ticks| ticks.iter().all(is_bent)).unwrap();
    // Four consecutive ticks last 100 ms.
    let places = [
        ("Meeting", first(named("Meeting").unwrap())),
        ("|r0.base_angle| > 100 urad", bent),
        ("|r0.base_angle| > 100 urad for 100 ms", lasting),
    ];
    for (place, tick) in places {
        let policy = breakpoints(THESIS, &[place]);
        let mut inspector = Inspector::new(&policy, "box");
        assert!(trial("box", &policy).run_watched(&mut inspector).is_err());
        let stop = inspector.stop().unwrap();
        assert_eq!((stop.tick, stop.breakpoint.as_str()), (tick, place));
        assert_eq!(stop.states.last().unwrap(), &trace.states[trace.ticks[tick].state.unwrap()]);
        assert!(stop.guards.iter().all(|guard| !guard.missing().is_empty()), "{:?}", stop.guards);
    }
}

#[test]
fn a_breakpoint_changes_nothing_before_it() {
    let policy = breakpoints(THESIS, &["time < 0 s", "lowpass(r0.base_angle, 1 Hz) > 1 rad"]);
    let result = trial("disk", &policy).run_watched(&mut Inspector::new(&policy, "disk")).unwrap();
    assert_eq!(result.run.trace, plain("disk").run.trace);
}

#[test]
fn a_breakpoint_with_an_error_has_its_place() {
    let source = Source::new("policy.fsm", THESIS);
    let (shown, faults) = Breakpoints::new(&source, &["r0.deflecton > 1 rad".to_owned()]).unwrap_err();
    assert_eq!(faults[0].code, "P0203");
    assert_eq!(shown.slice(faults[0].primary.span), "deflecton");
}

#[test]
fn the_expression_at_which_a_number_is_not_finite_is_named() {
    let text = "machine m  whisker r0  initial A
        state A {
          let ratio = 50 mm/s / (r0.base_angle - r0.base_angle) * 1 rad
          let speed = ratio + 1 mm/s
          steer body along direction(body.yaw) at speed turning 0 deg/s
        }";
    let policy = breakpoints(text, &[]);
    let mut inspector = Inspector::new(&policy, "disk");
    trial("disk", &policy).run_watched(&mut inspector).unwrap();
    assert_eq!(inspector.origin_of_non_finite(), Some("50 mm/s / (r0.base_angle - r0.base_angle)"));
}

#[test]
fn policies_differ_first_where_the_edited_transition_is_taken() {
    let edited = THESIS.replacen("when r0.touching ->", "when r0.touching and time > 2 s ->", 1);
    assert_ne!(edited, THESIS);
    let [own, other] = [THESIS, &edited].map(|text| breakpoints(text, &[]));
    let difference = first_difference(&trial("box", &own), [&own, &other], &trial("box", &other)).unwrap();
    let first = difference.first.unwrap();
    // Until there, states may differ, but no command.
    assert!(difference.states_differ_from.is_some_and(|tick| tick <= first.tick));
    assert_eq!(first.tick, difference.equal_ticks);
    let waits = first.second.guards.iter().find(|guard| guard.guard == "r0.touching and time > 2 s").unwrap();
    assert_eq!(waits.parts.iter().map(|part| part.text.as_str()).collect::<Vec<_>>(), ["time > 2 s"]);
    let equal = first_difference(&trial("box", &own), [&own, &own], &trial("box", &own)).unwrap();
    assert_eq!((equal.first, equal.states_differ_from), (None, None));
    assert_eq!(equal.equal_ticks, plain("box").run.trace.ticks.len());
}

#[test]
fn a_breakpoint_that_names_no_state_or_transition_is_shown_as_it_was_written() {
    let source = Source::new("policy.fsm", THESIS);
    for (text, message, hint) in [
        ("Swipping", "there is no state `Swipping`", "did you mean `Swiping`?"),
        (" exploring", "there is no state `exploring`", "did you mean `Exploring`?"),
        ("Nowhere.Swipng", "there is no state `Nowhere.Swipng`", "did you mean `Swiping`?"),
        (
            "Exploring: r0.touchin",
            "the state `Exploring` has no transition with the guard `r0.touchin`",
            "its guards are `",
        ),
        ("Explorin: r0.touching", "there is no state `Explorin`", "did you mean `Exploring`?"),
        ("", "a breakpoint is empty", "write a state such as `Following`"),
        ("  ", "a breakpoint is empty", "write a state such as `Following`"),
        ("Qqqqqqq", "there is no state `Qqqqqqq`", "the states are `Exploring`"),
    ] {
        let (shown, faults) = Breakpoints::new(&source, &["time > 1 s".to_owned(), text.to_owned()]).unwrap_err();
        assert_eq!(faults.len(), 1, "{faults:?}");
        assert_eq!(faults[0].message, message);
        assert!(faults[0].hints[0].starts_with(hint), "{:?}", faults[0].hints);
        // The place is in what was written, in the first line of it.
        assert_eq!((shown.name.as_str(), shown.slice(shown.part_span(0))), ("--break", text));
        assert_eq!(shown.line_column(faults[0].primary.span.start).line, 1);
        assert_eq!(shown.part_at(faults[0].primary.span.end), 0);
    }
}

#[test]
fn an_error_in_a_breakpoint_refers_to_the_policy_where_it_is() {
    let source = Source::new("policy.fsm", THESIS);
    for text in ["speed", "r0.touchin", "time > ", "(time > 1 s", "r0.tip_at(", "both(r0)"] {
        let (shown, faults) = Breakpoints::new(&source, &[text.to_owned()]).unwrap_err();
        for fault in &faults {
            assert_eq!(shown.part_at(fault.primary.span.start), 0, "{fault:?}");
            for label in &fault.secondary {
                assert!(shown.text.get(label.span.start..label.span.end).is_some(), "{fault:?}");
            }
        }
        assert!(!faults.is_empty());
    }
}
