//! What a policy means: order, time, arguments, failure.
#![allow(clippy::unwrap_used, clippy::float_cmp, reason = "a test may panic, and what is exact is compared exactly")]

use std::sync::Arc;

use crate::common::{Feel, Script, program, run, states};
use proptest::prelude::*;
use vibrissa_runtime::machine::{
    Action, ActionPart, Cause, Failure, Fallback, MICROSTEP_LIMIT, Machine, Mark, Mover, NonFinite, SetError, Status,
    Turn,
};
use vibrissa_runtime::units::Dimension;

/// The speed (m/s) that an action asks for.
fn speed(action: Action) -> f64 {
    match action {
        Action::Steer { speed, .. } => speed,
        Action::Hold => -1.0,
        Action::Stop => -2.0,
    }
}

#[test]
fn what_holds_always_comes_before_the_states_own_transitions() {
    let text = "machine m whisker w initial A
        state A { when w.touching -> B }  state B { stop }  state C { stop }
        always when w.touching and not w.contour.ready -> C
        always when w.touching -> Failure(\"always\")";
    assert_eq!(states(text, &mut Script::touches(".x")), ["A", "Failure"]);
    let unready = Feel { touching: true, ready: false, ..Feel::default() };
    assert_eq!(states(text, &mut Script::new(vec![vec![unready]])), ["C"], "the first rule that holds is taken");
}

#[test]
fn a_run_ends_by_success_as_by_failure() {
    let text = "machine m whisker w initial A
        state A { steer body along vector(1, 0) at 2 m/s turning 0 rad/s  when w.touching -> B }  state B { stop }
        always when w.touching -> B
        always when not w.contour.ready -> Success(\"done\")
        always when time > 9 s -> Failure(\"late\")";
    let feel = |touching, ready| vec![Feel { touching, ready, ..Feel::default() }];
    let mut script = Script::new(vec![feel(false, true), feel(true, true), feel(true, false), feel(false, true)]);
    let mut machine = Machine::new(Arc::new(program(text)));
    let ticks: Vec<_> = (0..4)
        .map(|now| {
            script.now = now;
            let tick = machine.tick(&mut script);
            (machine.state_name().to_owned(), tick.status, speed(tick.action))
        })
        .collect();
    let running = |state: &str, speed| (state.to_owned(), Status::Running, speed);
    // In `B` the first rule is what it wants, and the success behind it counts all the same.
    let end = ("Success".to_owned(), Status::Succeeded, -2.0);
    assert_eq!(ticks, [running("A", 2.0), running("B", -2.0), end.clone(), end]);
    assert_eq!((machine.success(), machine.failure()), (Some("done"), None));
}

#[test]
fn transitions_are_tried_in_the_order_written() {
    let text = "machine m whisker w initial A
        state A { when w.touching -> B  when w.touching -> C }  state B { stop }  state C { stop }";
    assert_eq!(states(text, &mut Script::touches(".x")), ["A", "B"]);
}

#[test]
fn the_state_entered_acts_in_the_same_tick() {
    let text = "machine m whisker w initial A
        state A { stop when w.touching -> B }  state B { steer body along vector(1, 0) at 2 m/s turning 0 rad/s }";
    let (_, ticks) = run(text, &mut Script::touches(".x"));
    assert_eq!(ticks.iter().map(|&(_, action)| speed(action)).collect::<Vec<_>>(), [-2.0, 2.0]);
}

#[test]
fn a_duration_is_exact_to_the_tick_and_a_break_begins_it_anew() {
    let text = "machine m whisker w initial A
        state A { when w.touching for 100 ms -> B }  state B { stop }";
    // 100 ms are three ticks of a thirtieth of a second: it must hold at four ticks in a row.
    assert_eq!(states(text, &mut Script::touches("xxxx")), ["A", "A", "A", "B"]);
    assert_eq!(states(text, &mut Script::touches("xxx.xxxx")).join(""), "AAAAAAAB");
}

#[test]
fn entering_a_state_begins_its_durations_anew_and_not_those_that_hold_always() {
    let text = "machine m whisker w initial A
        state A { when w.touching for 100 ms -> B }  state B { when w.touching for 100 ms -> A }
        always when w.touching for 200 ms -> Failure(\"long\")";
    let states = states(text, &mut Script::touches("xxxxxxx"));
    assert_eq!(states, ["A", "A", "A", "B", "B", "B", "Failure"]);
}

#[test]
fn after_counts_from_the_entry_into_the_state() {
    let text = "machine m whisker w initial A
        state A { when w.touching -> B }  state B { after 100 ms -> C }  state C { stop }";
    assert_eq!(states(text, &mut Script::touches("..x....")).join(""), "AABBBCC");
    let own = "machine m initial A  state A { after 0 s -> B }  state B { stop }";
    assert_eq!(states(own, &mut Script::touches(".")), ["B"], "no time has passed at once");
}

#[test]
fn memory_is_set_on_entry_and_kept_from_tick_to_tick() {
    let text = "machine m whisker w initial A
        state A { var count = 0  set count = count + 1  steer body along vector(1, 0) at count * 1 m/s turning 0 rad/s
                  when count >= 3 -> B(count) }
        state B(before: number) { var twice = 2 * before  steer body along vector(1, 0) at twice * 1 m/s turning 0 rad/s
                  when true -> A }";
    let (_, ticks) = run(text, &mut Script::touches("......"));
    // B leaves at once, so that A counts from 1 again in the tick in which it had 3.
    assert_eq!(ticks.iter().map(|&(_, action)| speed(action)).collect::<Vec<_>>(), [1.0, 2.0, 3.0, 1.0, 2.0, 3.0]);
}

#[test]
fn entry_and_exit_are_done_once_a_stay_in_their_order() {
    let text = "machine m whisker w initial A
        state A { var x = 1  entry { set x = 10 * x + 2 }  exit { set x = 10 * x + 4 }
                  set x = 10 * x + 3  when w.touching -> B(x) }
        state B(x: number) { steer body along vector(1, 0) at x * 1 m/s turning 0 rad/s }";
    let (_, ticks) = run(text, &mut Script::touches(".x"));
    assert_eq!(speed(ticks[1].1), 1234.0);
}

#[test]
fn filters_and_controllers_begin_anew_when_their_state_is_entered() {
    let text = "machine m whisker w initial A
        law go(x: number) { steer body along vector(1, 0) at lowpass(x, 1 Hz) * 1 m/s turning 0 rad/s }
        state A { do go(time / 1 s)  after 0.2 s -> B }
        state B { do go(time / 1 s)  after 0.2 s -> A }";
    let (_, ticks) = run(text, &mut Script::touches("............"));
    let speeds: Vec<f64> = ticks.iter().map(|&(_, action)| speed(action)).collect();
    assert_eq!(speeds[6], 6.0 / 30.0, "at the first tick in B the filter is where its input is");
    assert!(speeds[5] < 4.0 / 30.0, "before, it lags");
    assert!(speeds[7] > 6.0 / 30.0 && speeds[7] < 7.0 / 30.0);
}

#[test]
fn a_duration_that_is_not_a_number_never_passes() {
    let text = "machine m whisker w initial A
        state A { when true for sqrt(-1) * 1 s -> B  after 0 s / 0 -> B }  state B { stop }";
    assert_eq!(states(text, &mut Script::touches("....")).join(""), "AAAA");
}

#[test]
fn arguments_are_handed_over_and_can_change_places() {
    let text = "machine m whisker w initial A
        state A { when true -> B(1 m/s, 2 m/s, vector(0, 3), w) }
        state B(x: speed, y: speed, v: vector, u: whisker) {
          record u
          steer body along v at x turning y / 1 m * 1 rad
          when w.touching and x < y -> B(y, x, rotate(v, 180 deg), u)
        }";
    let mut script = Script::touches(".x.");
    let (_, ticks) = run(text, &mut script);
    assert_eq!(ticks[0].1, steer(3.0, 1.0, 2.0));
    assert_eq!(script.recorded, [0, 0, 0]);
    let Action::Steer { along_world, speed, turn, .. } = ticks[1].1 else { panic!("a steering action") };
    assert!((along_world.y + 3.0).abs() < 1e-12);
    assert_eq!((speed, turn), (2.0, Turn::Rate(1.0)));
    assert_eq!(ticks[1], ticks[2]);
}

fn steer(y: f64, speed: f64, rate: f64) -> Action {
    let along_world = vibrissa_runtime::geometry::Vector2::new(0.0, y);
    Action::Steer { mover: Mover::Body, along_world, speed, turn: Turn::Rate(rate) }
}

#[test]
fn a_tick_takes_eight_transitions_and_not_nine() {
    let chain = |length: usize| {
        let link = |index: usize| format!("state S{index} {{ when true -> S{} }}", index + 1);
        let states: Vec<String> = (0..length).map(link).collect();
        format!("machine m initial S0 {} state S{length} {{ stop }}", states.join(" "))
    };
    assert_eq!(states(&chain(MICROSTEP_LIMIT), &mut Script::touches(".")), [format!("S{MICROSTEP_LIMIT}")]);
    let (machine, ticks) = run(&chain(MICROSTEP_LIMIT + 1), &mut Script::touches(".."));
    assert_eq!(ticks, vec![("Failure".to_owned(), Action::Stop); 2]);
    assert_eq!(machine.failure(), Some(&Failure::MicrostepLimit { state: "S8".into() }));
}

#[test]
fn a_chain_may_end_in_a_failure() {
    let text = "machine m initial A  state A { when true -> B }  state B { when true -> Failure(\"why\") }";
    let (machine, _) = run(text, &mut Script::touches("."));
    assert_eq!(machine.failure().unwrap().to_string(), "why");
}

#[test]
fn a_command_that_is_not_finite_fails_with_the_states_name_and_the_number() {
    use ActionPart::{Along, Heading, Speed, YawRate};
    for (along, speed, turn, part, is_nan, told) in [
        ("v / 0", "1 m/s", "facing 0 rad", Along, false, "the direction behind `along` is infinite"),
        ("0 / 0 * v", "1 m/s", "facing 0 rad / 0", Along, true, "the direction behind `along` is not a number"),
        ("v", "1 m/s / 0", "facing 0 rad", Speed, false, "the speed behind `at` is infinite"),
        ("v", "1 m/s", "facing 0 rad / 0", Heading, true, "the heading behind `facing` is not a number"),
        ("v", "1 m/s", "turning 0 rad/s / 0", YawRate, true, "the yaw rate behind `turning` is not a number"),
    ] {
        let text = format!(
            "machine m initial Bad let v = vector(1, 0) state Bad {{ steer body along {along} at {speed} {turn} }}"
        );
        let (machine, ticks) = run(&text, &mut Script::touches(".."));
        assert_eq!(ticks, vec![("Failure".to_owned(), Action::Stop); 2], "and stands still for good");
        let failure = machine.failure().unwrap();
        assert_eq!(failure, &Failure::NotFinite { state: "Bad".into(), non_finite: NonFinite { part, is_nan } });
        assert_eq!(failure.to_string(), format!("state Bad gave a command that is not finite: {told}"));
    }
}

#[test]
fn a_state_that_gives_no_finite_command_is_left_by_its_failsafe_in_the_same_tick() {
    let text = "machine m whisker w initial A
        state A {
          var x = 1
          exit { set x = 10 * x + 2 }
          set x = x + 2
          steer body along vector(1, 0) at 1 m/s / w.side turning 0 rad/s
          failsafe -> Safe(x)
        }
        state Safe(x: number) {
          var y = 10 * x
          entry { set y = y + 3 }
          steer body along vector(1, 0) at y * 1 m/s turning 0 rad/s
          when true -> A
        }";
    let feel = |side| vec![Feel { side, ..Feel::default() }];
    let mut script = Script::new(vec![feel(1.0), feel(0.0), feel(1.0)]);
    let (machine, ticks) = run(text, &mut script);
    let ticks: Vec<_> = ticks.iter().map(|(state, action)| (state.as_str(), speed(*action))).collect();
    // The statements of A (x = 3, then 5), its exit (52), the value, the entry of Safe, its statements; its transition waits.
    assert_eq!(ticks, [("A", 1.0), ("Safe", 523.0), ("A", 1.0)]);
    assert_eq!(machine.failure(), None);
}

#[test]
fn the_failsafe_of_a_state_comes_before_that_of_the_machine() {
    let text = |own: &str| {
        format!(
            "machine m initial A failsafe -> B
            state A {{ steer body along vector(1, 0) at 1 m/s / 0 turning 0 rad/s {own} }}
            state B {{ stop }} state C {{ stop }}"
        )
    };
    assert_eq!(states(&text("failsafe -> C"), &mut Script::touches("..")), ["C", "C"]);
    assert_eq!(states(&text(""), &mut Script::touches("..")), ["B", "B"]);
    let (machine, _) = run(&text("failsafe -> Failure(\"lame\")"), &mut Script::touches("."));
    assert_eq!(machine.failure().unwrap().to_string(), "lame");
}

#[test]
fn a_tick_says_which_state_was_left_by_its_failsafe_and_why() {
    let bad = "steer body along vector(1, 0) at 1 m/s / 0 turning 0 rad/s";
    let text = format!(
        "machine m initial A state A {{ stop when true -> B }} state B {{ {bad} failsafe -> C }} state C {{ {bad} }}"
    );
    let mut machine = Machine::new(program(&text).into());
    let tick = machine.tick(&mut Script::touches("."));
    let flaw = NonFinite { part: ActionPart::Speed, is_nan: false };
    assert_eq!(tick.fallback, Some(Fallback { left: 1, cause: Cause::NotFinite(flaw) }));
    // The state that a failsafe leads to is the last that is tried.
    assert_eq!((tick.action, tick.status), (Action::Stop, Status::Failed));
    assert_eq!(machine.failure(), Some(&Failure::NotFinite { state: "C".into(), non_finite: flaw }));
    assert_eq!(machine.tick(&mut Script::touches(".")).fallback, None);
}

#[test]
fn a_ninth_transition_takes_the_failsafe_of_the_state_that_wants_it() {
    let link =
        |index: usize| format!("state S{index} {{ when true -> S{} failsafe -> Failure(\"S{index}\") }}", index + 1);
    let states: Vec<String> = (0..MICROSTEP_LIMIT).map(link).collect();
    let last = format!(
        "state S{MICROSTEP_LIMIT} {{ when true -> Last failsafe -> Safe }} state Last {{ }} state Safe {{ stop }}"
    );
    let mut machine = Machine::new(program(&format!("machine m initial S0 {} {last}", states.join(" "))).into());
    let tick = machine.tick(&mut Script::touches("."));
    assert_eq!(machine.state_name(), "Safe");
    assert_eq!(tick.fallback, Some(Fallback { left: MICROSTEP_LIMIT, cause: Cause::MicrostepLimit }));
    assert_eq!((tick.action, tick.status), (Action::Stop, Status::Running));
}

#[test]
fn a_state_that_does_nothing_holds_and_of_several_actions_the_last_counts() {
    let idle = "machine m initial A  state A { }";
    assert_eq!(run(idle, &mut Script::touches(".")).1[0].1, Action::Hold);
    let several = "machine m initial A  state A { stop steer body along vector(0, 1) at 1 m/s turning 0 rad/s hold }";
    assert_eq!(run(several, &mut Script::touches(".")).1[0].1, Action::Hold);
}

#[test]
fn of_a_conditional_the_first_branch_that_holds_is_taken() {
    let text = "machine m whisker w initial A
        state A {
          if w.side < 0 { let s = 1 m/s steer body along vector(1, 0) at s turning 0 rad/s }
          else if w.side > 0 { let s = 2 m/s steer body along vector(1, 0) at s turning 0 rad/s }
          else if w.side > 0 { stop }
          else { hold }
        }";
    let feel = |side| vec![Feel { side, ..Feel::default() }];
    let (_, ticks) = run(text, &mut Script::new(vec![feel(-1.0), feel(1.0), feel(0.0), feel(f64::NAN)]));
    assert_eq!(ticks.iter().map(|&(_, action)| speed(action)).collect::<Vec<_>>(), [1.0, 2.0, -1.0, -1.0]);
}

#[test]
fn only_the_branch_that_is_taken_records() {
    let text = "machine m whisker a, b initial A
        state A { if a.touching { record a } else { record b } }";
    let mut script = Script::touches("x.");
    run(text, &mut script);
    assert_eq!(script.recorded, [0, 1]);
}

#[test]
fn marks_are_made_on_entry_on_exit_and_in_statements_and_give_no_command() {
    let text = "machine m whisker a, b initial A
        law noted(w: whisker) { mark lost w }
        state A { exit { mark lost a } when a.touching -> B }
        state B { entry { mark found b } do noted(b) stop }";
    let mut script = Script::touches(".xx");
    let (_, ticks) = run(text, &mut script);
    assert_eq!(script.marked, [(0, Mark::Lost), (1, Mark::Found), (1, Mark::Lost), (1, Mark::Lost)]);
    assert_eq!(ticks.iter().map(|&(_, action)| action).collect::<Vec<_>>(), [Action::Hold, Action::Stop, Action::Stop]);
}

#[test]
fn whiskers_can_be_told_apart() {
    let text = "machine m whisker a, b initial A
        law go(w: whisker) {
          if w == b { steer w along vector(1, 0) at 2 m/s turning 0 rad/s }
          if w != b { steer w along vector(1, 0) at 1 m/s turning 0 rad/s }
        }
        state A { when true -> Go(a) }
        state Go(w: whisker) { do go(w) when a.touching and w == a -> Go(b) }";
    let (_, ticks) = run(text, &mut Script::touches(".x"));
    let movers: Vec<Action> = ticks.into_iter().map(|(_, action)| action).collect();
    assert!(matches!(movers[0], Action::Steer { mover: Mover::Whisker(0), speed: 1.0, .. }));
    assert!(matches!(movers[1], Action::Steer { mover: Mover::Whisker(1), speed: 2.0, .. }));
}

#[test]
fn laws_and_derived_values_use_the_values_they_are_given() {
    let text = "machine m whisker w initial A
        param base = 1 m/s
        let scaled(x: number, y: speed) = x * y
        let twice(x: number) = scaled(2 * x, base)
        law inner(s: speed) { let t = s + base steer body along vector(1, 0) at t turning 0 rad/s }
        law outer(s: speed) { let t = 2 * s do inner(t) }
        state A { let t = twice(3) do outer(t) }";
    assert_eq!(speed(run(text, &mut Script::touches(".")).1[0].1), 13.0);
}

#[test]
fn parameters_can_be_set_within_their_ranges() {
    let text = "machine m initial A
        param free = 1  param fast = 50 mm/s in 1 .. 200 mm/s
        state A { steer body along vector(1, 0) at fast turning 0 rad/s }";
    let mut program = program(text);
    assert_eq!(program.set("fast", 0.2, Dimension::SPEED), Ok(()));
    assert_eq!(program.set("free", -1e300, Dimension::NUMBER), Ok(()));
    let say = |error: Result<(), SetError>| error.unwrap_err().to_string();
    assert_eq!(
        say(program.set("fast", 0.3, Dimension::SPEED)),
        "`fast` must lie between 1 mm/s and 200 mm/s; 300 mm/s does not"
    );
    assert_eq!(say(program.set("fast", 0.1, Dimension::ANGLE)), "`fast` is a speed, not an angle");
    assert_eq!(say(program.set("fast", f64::NAN, Dimension::SPEED)), "`fast` must be a finite number");
    assert_eq!(say(program.set("free", f64::INFINITY, Dimension::NUMBER)), "`free` must be a finite number");
    assert_eq!(
        say(program.set("fats", 0.1, Dimension::SPEED)),
        "the policy has no parameter `fats`; it has `free`, `fast`"
    );
    let mut machine = vibrissa_runtime::machine::Machine::new(program.into());
    assert_eq!(speed(machine.tick(&mut Script::touches(".")).action), 0.2);
}

#[test]
fn the_same_text_gives_the_same_program() {
    let text = include_str!("../../../policies/thesis.fsm");
    assert_eq!(program(text), program(text));
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(500))]

    #[test]
    fn a_duration_passes_when_the_condition_held_at_every_tick_of_it(
        marks in "[x.]{1,40}|x{1,40}", ticks in 0_usize..12, rate in 1_u32..400,
    ) {
        let period = 1.0 / f64::from(rate);
        let lasting = ticks as f64 * period;
        let text = format!(
            "machine m whisker w initial A state A {{ when w.touching for {lasting:?} s -> B }} state B {{ stop }}"
        );
        let mut script = Script::touches(&marks);
        script.period = period;
        let passes = states(&text, &mut script).iter().position(|state| state == "B");
        let due = marks.as_bytes().windows(ticks + 1).position(|held| held.iter().all(|&mark| mark == b'x'));
        prop_assert_eq!(passes, due.map(|start| start + ticks));
    }
}

#[test]
fn laws_take_contours_and_quantities_of_any_dimension() {
    let text = "machine m whisker v, w initial S
        law follow(c: contour, gain: angular_speed / length, drift: vector of length / time) {
          steer body along c.point(5 mm) - position(0 m, 0 m) + 1 s * drift at dot(c.tangent(2 mm), drift) turning gain * |c.normal(3 mm)| * 1 m
        }
        let middle(a: contour, b: contour) = a.normal + b.normal
        state S { do follow(w.contour, 2 deg/s / 1 m * 1, |middle(v.contour, w.contour)| * vector(0 m/s, 1 m/s)) }";
    let text = text.replace("2 deg/s / 1 m * 1", "2 rad/s / 1 m");
    let (_, ticks) = run(&text, &mut Script::touches("x"));
    let Action::Steer { along_world, speed, turn: vibrissa_runtime::machine::Turn::Rate(rate), .. } = ticks[0].1 else {
        panic!()
    };
    // As the script has it: the point is (1, -back), the tangent (back, 1), the normal (-1, back) or at the end (0.6, -0.8).
    assert!((along_world - vibrissa_runtime::geometry::Vector2::new(1.0, 2.0 - 5e-3)).norm() < 1e-12, "{along_world}");
    assert!((speed - 2.0).abs() < 1e-12 && (rate - 2.0 * 1.0_f64.hypot(3e-3)).abs() < 1e-12, "{speed} {rate}");
}

#[test]
fn a_state_can_be_entered_with_a_contour() {
    let text = "machine m whisker v, w initial S state S { stop when true -> T(w.contour) }
        state T(c: contour) { steer body along c.point(1 mm) - position(0 m, 0 m) at 1 m/s turning 0 deg/s }";
    let (_, ticks) = run(text, &mut Script::touches("x"));
    let Action::Steer { along_world, .. } = ticks[0].1 else { panic!("{ticks:?}") };
    assert!((along_world.x - 1.0).abs() < 1e-12, "the whisker with the index 1");
}
