//! What the machine itself remembers and does, outside of states.
#![allow(clippy::float_cmp, reason = "what is exact is compared exactly")]

use vibrissa_language::{chart, compile_with_warnings};
use vibrissa_runtime::machine::{Action, Cause, Failure, Fallback};
use vibrissa_text::diagnostic::{Diagnostic, Source};

use crate::common::{Script, program, run, states};

/// A command that tells a number.
fn tell(number: &str) -> String {
    format!("steer body along vector(1, 0) at ({number}) * 1 m/s turning 0 rad/s")
}

/// The numbers that a machine tells, tick by tick.
fn told(text: &str, marks: &str) -> Vec<f64> {
    let speed = |action| if let Action::Steer { speed, .. } = action { speed } else { f64::NAN };
    run(text, &mut Script::touches(marks)).1.into_iter().map(|(_, action)| speed(action)).collect()
}

#[test]
fn it_is_set_once_and_kept_from_state_to_state() {
    let text = format!(
        "machine m whisker w initial A
        var n = start + 1  param start = 1
        state A {{ entry {{ set n = 10 * n + 1 }}  {}  when w.touching -> B  exit {{ set n = 10 * n + 2 }} }}
        state B {{ {}  when not w.touching -> A }}",
        tell("n"),
        tell("-n")
    );
    // Before the first entry, and never again.
    assert_eq!(told(&text, ".x."), [21.0, -212.0, 2121.0]);
}

#[test]
fn the_machine_acts_once_a_tick_before_the_states_and_behind_the_transitions() {
    let text = format!(
        "machine m whisker w initial A
        state A {{ set n = 10 * n + 3  {}  when w.touching -> B(n) }}
        state B(before: number) {{ initial I  set n = 10 * n + 4  state I {{ {} }} }}
        if w.touching {{ let two = 2  set n = 10 * n + two }}
        var n = 0
        set n = 10 * n + 1",
        tell("n"),
        tell("n + 1e6 * before")
    );
    assert_eq!(told(&text, "."), [13.0]);
    assert_eq!(told(&text, ".x"), [13.0, 13_013_214.0]);
    // The first tick's transitions see what it was set to, not what it does.
    assert_eq!(told(&text, "x"), [214.0]);
}

#[test]
fn rules_that_hold_always_and_failsafes_read_it() {
    let text = format!(
        "machine m whisker w initial A  var n = 0  set n = n + 1
        always when n == 2 -> B(n)
        failsafe -> B(100 * n)
        state A {{ {} }}  state B(x: number) {{ {}  when w.touching -> C }}  state C {{ {} }}",
        tell("n"),
        tell("10 * n + x"),
        tell("1 / 0")
    );
    // The third tick enters B; the fourth goes to C, which cannot go on.
    assert_eq!(told(&text, "...x"), [1.0, 2.0, 32.0, 440.0]);
}

#[test]
fn a_failsafe_lets_the_machine_act_once_in_the_tick() {
    let text = format!(
        "machine m initial A  var n = 0  set n = n + 1  failsafe -> Rest
        state A {{ after 30 ms -> B }}  state B {{ {} }}  state Rest {{ {} }}",
        tell("1 / 0"),
        tell("n")
    );
    let seen = told(&text, "...");
    assert!(seen[0].is_nan() && seen[1..] == [2.0, 3.0], "{seen:?}");
    // Where a tick goes round nothing has acted yet.
    let text = format!(
        "machine m whisker w initial A  var n = 0  set n = n + 1  failsafe -> Rest
        state A {{ when lowpass(w.sense, 1 Hz) >= 0 -> B }}  state B {{ when lowpass(w.sense, 2 Hz) >= 0 -> A }}
        state Rest {{ {} }}",
        tell("n")
    );
    let mut machine = vibrissa_runtime::machine::Machine::new(std::sync::Arc::new(program(&text)));
    let tick = machine.tick(&mut Script::touches("."));
    assert_eq!(tick.fallback, Some(Fallback { left: 0, cause: Cause::MicrostepLimit }));
    assert!(matches!(tick.action, Action::Steer { speed: 1.0, .. }), "{tick:?}");
}

#[test]
fn its_filters_never_begin_anew() {
    let text = format!(
        "machine m initial A  var seen = 0  set seen = lowpass(time / 1 s, 1 Hz)
        state A {{ {}  after 0.1 s -> B }}  state B {{ {}  after 0.1 s -> A }}",
        tell("seen"),
        tell("seen")
    );
    let alone = format!(
        "machine m initial A  state A {{ let seen = lowpass(time / 1 s, 1 Hz)  {}  after 100 s -> A }}",
        tell("seen")
    );
    assert_eq!(told(&text, "............"), told(&alone, "............"));
}

#[test]
fn a_resumed_state_finds_it_as_it_is() {
    let text = format!(
        "machine m whisker w initial Idle  var n = 0
        state Idle {{ set n = n + 1  stop  when w.touching -> resume O }}
        state O {{ initial P  when not w.touching -> Idle  state P {{ var own = 0  set own = own + 1  {} }} }}",
        tell("10 * n + own")
    );
    let seen = told(&text, ".xx.x");
    assert_eq!([seen[1], seen[2], seen[4]], [11.0, 12.0, 21.0]);
}

#[test]
fn it_is_no_state_and_shows_as_none() {
    let text = |memory: &str, of_machine: &str| {
        format!(
            "machine m\ninitial A\n{of_machine}\nstate A {{\n  {memory}\n  stop\n  when n > 3 -> Failure(\"four\")\n}}"
        )
    };
    let memory = "var n = 0  set n = n + 1";
    let (own, inner) = (text("", memory), text(memory, ""));
    let [own, inner] = [own, inner].map(|text| Source::new("m.fsm", text));
    let [compiled, other] = [&own, &inner].map(|source| compile_with_warnings(source).unwrap());
    assert_eq!(compiled.artifact.positions, other.artifact.positions);
    assert_eq!(compiled.warnings, []);
    assert_eq!(compiled.artifact.program.states.len(), 1);
    assert_eq!(chart(&own).unwrap(), chart(&inner).unwrap());
    assert_eq!(states(&own.text, &mut Script::touches(".....")), ["A", "A", "A", "A", "Failure"]);
    let (machine, _) = run(&own.text, &mut Script::touches("....."));
    assert_eq!(machine.failure(), Some(&Failure::Policy("four".into())));
    // What it does counts where a tick's work is bounded.
    let [compiled, other] = [compiled, other].map(|compiled| compiled.artifact.program);
    assert_eq!(compiled.operations(0), other.operations(0));
}

#[test]
fn an_if_behind_whiskers_is_a_statement_unless_it_says_that_a_rig_may_lack_them() {
    let text = "machine m whisker v if fitted whisker w
        if fitted or w.touching { set n = 1 }
        let fitted = false  var n = 0  initial A
        state A { stop  when n > 0 -> B }  state B { hold }";
    assert_eq!(program(text).optional, [true, false]);
    assert_eq!(states(text, &mut Script::new(vec![vec![], vec![]])), ["A", "A"]);
    for condition in ["fitted", "fitted and true", "fitted == true"] {
        let text = format!(
            "machine m whisker w if {condition} {{ set n = 1 }} let fitted = true var n = 0 initial A state A {{ stop when n > 0 -> A }}"
        );
        assert_eq!(program(&text).optional, [false], "{condition}");
    }
}

#[test]
fn what_stands_in_the_place_of_fitted_is_told_and_nothing_else_is_taken_for_it() {
    let told = |text: &str| {
        let faults = compile_with_warnings(&Source::new("m.fsm", text)).unwrap_err();
        let told = |fault: &Diagnostic| (fault.code, text[fault.primary.span.start..fault.primary.span.end].to_owned());
        faults.iter().map(told).collect::<Vec<_>>()
    };
    let rest = "initial A\nstate A { stop }\n";
    for slip in ["if fited", "if  fited", "if\n  fited", "\nif # fitted\n  fited", ", v by sliding if fited # near {"] {
        for text in [
            format!("machine m\nwhisker w {slip}\n{rest}"),
            format!("machine m\nwhisker w {slip}\nvar n = 0\n{rest}"),
            format!("machine m\n{rest}whisker w {slip}"),
        ] {
            assert_eq!(told(&text), [("P0101", "fited".to_owned())], "{text}");
        }
    }
    for other in [
        "whisker w\nif w.touching  # what it feels if near\nrecord w",
        "whisker v\nlaw f(w: whisker ) { if w.touching\nrecord w }",
        "whisker w\nif near()\nrecord w",
    ] {
        assert_eq!(told(&format!("machine m\n{rest}{other}"))[0], ("P0101", "record".to_owned()), "{other}");
    }
}

#[test]
fn it_is_told_what_of_it_grows_too_large() {
    let sum = |name: &str, count| vec![name; count].join(" + ");
    let (little, much) = (sum("w.base_angle", 120), sum("little", 100));
    let told = |own: &str| {
        let text = format!(
            "machine m whisker w initial A  let little = {little}  let much = {much}
            law think() {{ let x = much }}  {own}  state A {{ stop }}"
        );
        let fault = compile_with_warnings(&Source::new("m.fsm", text.as_str())).unwrap_err().remove(0);
        (fault.code, text[fault.primary.span.start..fault.primary.span.end].to_owned())
    };
    assert_eq!(told("var a = much  var b = much + much"), ("P0402", "b".to_owned()));
    assert_eq!(told("var a = 1  do think() do think() do think()"), ("P0402", "do think()".to_owned()));
}

#[test]
fn a_guard_is_judged_by_all_that_it_can_be() {
    let warned = |set: &str| {
        let text = format!(
            "machine m whisker w initial A var n = 0 {set}
            state A {{ stop when n > 0 -> Failure(\"never?\") when w.touching -> Failure(\"touched\") }}"
        );
        let warnings = compile_with_warnings(&Source::new("m.fsm", text)).unwrap().warnings;
        warnings.into_iter().map(|warning| warning.code).collect::<Vec<_>>()
    };
    assert_eq!(warned(""), ["P0508"]);
    assert_eq!(warned("set n = n + 1"), [""; 0]);
}
