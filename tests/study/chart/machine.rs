//! A chart shows what the machine is.

use vibrissa::diagnostic::Source;
use vibrissa::policy::chart::{Chart, Guard, Origin, Target};
use vibrissa::policy::{chart, compile};
use vibrissa::report::{chart_dot, chart_mermaid, chart_svg};
use vibrissa_runtime::machine::{self, Program};

use super::charts::{HARD, NESTED, THESIS, chart_of, into};

fn program_of(text: &str) -> Program {
    compile(&Source::new("policy.fsm", text)).unwrap()
}

/// Checks that a chart's transitions lead where a machine's do, and wait where they wait.
fn agree(chart: &Chart, origin: Origin, machine: &[machine::Transition]) {
    let of_origin: Vec<_> = chart.transitions.iter().filter(|transition| transition.origin == origin).collect();
    assert_eq!(of_origin.len(), machine.len(), "{origin:?}");
    for (drawn, compiled) in of_origin.into_iter().zip(machine) {
        match (&drawn.target, &compiled.target) {
            (Target::Failure(drawn), machine::Target::Failure(compiled))
            | (Target::Success(drawn), machine::Target::Success(compiled)) => assert_eq!(**drawn, **compiled),
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
