//! What states in states mean, by example.

use vibrissa_runtime::machine::{Action, ActionPart, Failure, Guard, NonFinite};

use crate::common::{Feel, Script, program, run, states};

/// Whether two whiskers touch, tick by tick.
fn two(first: &str, second: &str) -> Script {
    let feel = |mark| Feel { touching: mark == 'x', ..Feel::default() };
    Script::new(first.chars().zip(second.chars()).map(|(a, b)| vec![feel(a), feel(b)]).collect())
}

fn speed(action: Action) -> f64 {
    if let Action::Steer { speed, .. } = action { speed } else { f64::NAN }
}

#[test]
fn an_outer_states_transition_comes_before_those_of_the_states_in_it() {
    let text = "machine m whisker w initial O
        state O { initial A  when w.touching -> Out
          state A { when w.touching -> B }  state B { stop } }
        state Out { stop }";
    assert_eq!(states(text, &mut Script::touches(".x")), ["A", "Out"]);
}

#[test]
fn an_outer_states_times_go_on_when_the_inner_state_changes() {
    let inner = "state A { when true for 50 ms -> B }  state B { when true for 50 ms -> A }";
    for outer in ["after 200 ms -> Out", "when true for 200 ms -> Out"] {
        let text = format!("machine m initial O  state O {{ initial A {outer} {inner} }}  state Out {{ stop }}");
        // An inner state leaves for the other at the second tick after it was entered.
        assert_eq!(states(&text, &mut Script::touches("........")).join(""), "AABBAAOutOut");
    }
}

#[test]
fn of_several_commands_that_of_the_innermost_state_counts() {
    let steer = |speed: u8| format!("steer body along vector(1, 0) at {speed} m/s turning 0 rad/s");
    let text = format!(
        "machine m whisker w initial O
        state O {{ initial A {} state A {{ when w.touching -> B }} state B {{ {} }} }}",
        steer(1),
        steer(2)
    );
    let (_, ticks) = run(&text, &mut Script::touches(".x"));
    assert_eq!(ticks.iter().map(|&(_, action)| speed(action)).collect::<Vec<_>>(), [1.0, 2.0]);
}

#[test]
fn a_command_that_is_not_finite_fails_with_the_name_of_the_state_that_gave_it() {
    let text = "machine m initial O
        state O { initial A  steer body along vector(1, 0) at 1 m/s / 0 turning 0 rad/s  state A { let x = 1 } }";
    let (machine, _) = run(text, &mut Script::touches("."));
    assert_eq!(
        machine.failure(),
        Some(&Failure::NotFinite {
            state: "O".into(),
            non_finite: NonFinite { part: ActionPart::Speed, is_nan: false }
        })
    );
}

#[test]
fn what_leads_from_a_state_into_it_leaves_it_alone_and_what_leads_to_itself_does_not() {
    let text = |target: &str| {
        format!(
            "machine m whisker w initial O
            state O {{ initial A  var n = 0  set n = n + 1
              steer body along vector(1, 0) at n * 1 m/s turning 0 rad/s
              when w.touching for 10 ms -> {target}
              state A {{ let x = 1 }}  state B {{ let x = 1 }} }}"
        )
    };
    let count = |target: &str| {
        let ticks = run(&text(target), &mut Script::touches("..xx..")).1;
        ticks.into_iter().map(|(state, action)| format!("{state}{}", speed(action))).collect::<Vec<_>>()
    };
    assert_eq!(count("B"), ["A1", "A2", "A3", "B4", "B5", "B6"]);
    assert_eq!(count("O"), ["A1", "A2", "A3", "A1", "A2", "A3"]);
}

#[test]
fn a_rule_does_not_enter_anew_what_is_active_and_those_behind_it_wait() {
    let text = "machine m whisker a, b initial A
        state A { var n = 0  set n = n + 1  steer body along vector(1, 0) at n * 1 m/s turning 0 rad/s }
        state B { stop }
        always when a.touching -> A
        always when b.touching -> B";
    let (_, ticks) = run(text, &mut two("xxx.", "..xx"));
    let seen: Vec<String> = ticks.iter().map(|(state, action)| format!("{state}{}", speed(*action))).collect();
    assert_eq!(seen, ["A1", "A2", "A3", "BNaN"]);
}

#[test]
fn the_time_of_a_rule_runs_while_its_target_is_active() {
    let text = "machine m whisker a, b initial A
        state A { when b.touching -> B }  state B { stop }
        always when a.touching for 100 ms -> A";
    assert_eq!(states(text, &mut two("xxxxx", "...x.")).join(""), "AAABA");
}

#[test]
fn a_state_is_resumed_where_it_was_with_what_it_had_and_begins_the_first_time() {
    let text = "machine m whisker a, b initial Idle
        state Idle { when a.touching -> resume O(2 m/s) }
        state O(base: speed) {
          initial P(1)
          when not a.touching -> Idle
          state P(x: number) {
            initial Q(x)
            state Q(y: number) {
              var n = 0
              set n = n + 1
              steer body along vector(1, 0) at (10 * x + y) * base turning n * 1 rad/s
              when b.touching for 30 ms -> R(y + 2)
            }
            state R(z: number) { steer body along vector(1, 0) at (10 * x + z) * base turning 0 rad/s }
          }
        }";
    // It begins in Q, goes to R, and comes back to R with the values that P and R had.
    let (_, ticks) = run(text, &mut two(".xxx.xx", "..xx..."));
    let seen: Vec<String> = ticks.iter().map(|(state, action)| format!("{state}{}", speed(*action))).collect();
    assert_eq!(seen, ["IdleNaN", "Q22", "Q22", "R26", "IdleNaN", "R26", "R26"]);
}

#[test]
fn operations_count_those_of_the_outer_states() {
    let program = program(
        "machine m whisker w initial O
        state O { initial A  record w  when w.touching -> Out  state A { record w record w when w.sense > 0 -> B } state B { stop } }
        state Out { stop }",
    );
    let counts: Vec<usize> = (0..4).map(|state| program.operations(state)).collect();
    let guard = |state: usize| match &program.states[state].transitions[0].guard {
        Guard::When { code, .. } | Guard::After { code, .. } => code.len(),
    };
    assert_eq!(counts, [1 + guard(0), 1 + guard(0) + 2 + guard(1), 1 + guard(0) + 1, 1]);
}

#[test]
fn a_failure_is_taken_behind_a_rule_that_has_led_where_it_leads() {
    let rest = "state A { stop }  state Out { stop }";
    let text = format!(
        "machine m whisker v, w initial A {rest}
        always when v.touching -> Out  always when w.touching for 10 ms -> Failure(\"why\")"
    );
    assert_eq!(states(&text, &mut two(".xxxx", "...xx")), ["A", "Out", "Out", "Out", "Failure"]);
    let text = "machine m whisker v, w initial O
        state O { initial A  when v.touching -> B  when w.touching -> Failure(\"why\")
          state A { let x = 1 }  state B { let x = 1 } }";
    assert_eq!(states(text, &mut two(".xx", "..x")), ["A", "B", "Failure"]);
}

#[test]
fn the_failsafe_is_that_of_the_state_that_gave_the_command_or_of_one_around_it() {
    let steer = |speed: &str| format!("steer body along vector(1, 0) at {speed} turning 0 rad/s");
    let text = |outer: &str, inner: &str| {
        format!(
            "machine m initial O  failsafe -> Rest
            state O {{ initial I {outer} state I {{ {inner} failsafe -> J }} state J {{ stop }} }}
            state Rest {{ stop }}"
        )
    };
    let (good, bad) = (steer("1 m/s"), steer("1 m/s / 0"));
    assert_eq!(states(&text(&bad, ""), &mut Script::touches(".")), ["Rest"]);
    assert_eq!(states(&text(&good, &bad), &mut Script::touches(".")), ["J"]);
    let around = text(&format!("failsafe -> Out {good}"), &bad).replace("failsafe -> J", "") + " state Out { stop }";
    assert_eq!(states(&around, &mut Script::touches(".")), ["Out"]);
}

#[test]
fn a_failsafe_within_an_outer_state_lets_that_act_once_in_the_tick() {
    let text = "machine m whisker w initial O
        state O { initial I  var n = 0  set n = n + 1
          state I { steer body along vector(1, 0) at 1 m/s / 0 turning 0 rad/s  failsafe -> J }
          state J { steer body along vector(1, 0) at n * 1 m/s turning 0 rad/s } }";
    let ticks = run(text, &mut Script::touches("..")).1;
    assert_eq!(ticks.iter().map(|&(_, action)| speed(action)).collect::<Vec<_>>(), [1.0, 2.0]);
}

#[test]
fn a_value_that_was_named_stays_what_it_was_when_memory_is_set() {
    let text = "machine m initial A
        state A { var n = 0  let old = n  set n = n + 1
          steer body along vector(1, 0) at (n - old) * 1 m/s turning 0 rad/s }";
    let ticks = run(text, &mut Script::touches("...")).1;
    assert_eq!(ticks.iter().map(|&(_, action)| speed(action)).collect::<Vec<_>>(), [1.0, 1.0, 1.0]);
}

#[test]
fn a_filter_in_an_entry_begins_anew_at_every_entry() {
    let text = "machine m initial A
        state A { var seen = 0  entry { set seen = lowpass(time / 1 s, 0.1 Hz) - time / 1 s }
          steer body along vector(1, 0) at |seen| * 1 m/s turning 0 rad/s  after 50 ms -> A }";
    let ticks = run(text, &mut Script::touches("........")).1;
    assert!(ticks.iter().all(|&(_, action)| speed(action) == 0.0), "{ticks:?}");
}
