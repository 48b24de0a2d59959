//! What behaviours mean, by example. Random ones are compared with an interpreter in `nesting`.
#![allow(clippy::float_cmp, reason = "what is exact is compared exactly")]

use vibrissa_language::{compile, compile_with_warnings, gather};
use vibrissa_runtime::machine::Action;
use vibrissa_text::diagnostic::Source;

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

/// Counts touches up to a number, and hands the count on.
fn counting() -> String {
    format!(
        "behaviour count(w: whisker, most: number) {{
          exit full(counted: number)
          var n = 0
          initial Waiting
          state Waiting {{ {}  when w.touching -> Touched }}
          state Touched {{ entry {{ set n = n + 1 }}  {}  when n == most -> exit full(10 * n)  when not w.touching -> Waiting }}
        }}",
        tell("n"),
        tell("-n")
    )
}

#[test]
fn a_state_is_what_its_behaviour_does_until_an_exit() {
    let text = format!(
        "machine m whisker r0 initial A {}
        state A is count(r0, 2) {{ on full(number) -> B(number) }}
        state B(x: number) {{ {} }}",
        counting(),
        tell("x")
    );
    assert_eq!(told(&text, ".x.x."), [0.0, -1.0, 1.0, 20.0, 20.0]);
    assert_eq!(states(&text, &mut Script::touches(".x.x.")), ["A.Waiting", "A.Touched", "A.Waiting", "B", "B"]);
}

#[test]
fn two_uses_have_separate_memory_and_begin_anew() {
    let text = format!(
        "machine m whisker r0 initial A {}
        state A is count(r0, 2) {{ on full(x) -> B }}
        state B is count(r0, 3) {{ on full(x) -> A }}",
        counting()
    );
    let seen = states(&text, &mut Script::touches("x.x.x.x"));
    let counted = ["A.Touched", "A.Waiting", "B.Touched", "B.Waiting", "B.Touched", "B.Waiting", "A.Touched"];
    assert_eq!(seen, counted);
}

#[test]
fn the_transitions_of_the_state_come_before_those_of_the_behaviour() {
    let text = format!(
        "machine m whisker r0 initial A {}
        state A is count(r0, 1) {{ on full(x) -> B  when r0.touching -> C }}
        state B {{ stop }}  state C {{ stop }}",
        counting()
    );
    assert_eq!(states(&text, &mut Script::touches(".x")), ["A.Waiting", "C"]);
}

#[test]
fn the_values_of_an_exit_are_computed_when_the_states_have_been_left() {
    let text = format!(
        "machine m whisker r0 initial A
        behaviour go(w: whisker) {{
          exit done(a: number, b: number)
          initial I
          state I {{ var n = 1  stop  exit {{ set n = 5 }}  when w.touching -> exit done(n, 2 * n) }}
        }}
        state A is go(r0) {{ var own = 3  exit {{ set own = 7 }}  on done(p, q) -> B(own, q, p) }}
        state B(x: number, y: number, z: number) {{ {} }}",
        tell("100 * x + 10 * y + z")
    );
    assert_eq!(told(&text, ".x")[1], 805.0);
}

#[test]
fn a_behaviour_of_a_library_is_the_same_as_one_of_the_machine() {
    let rest = "whisker r0 initial A state A is count(r0, 2) { on full(x) -> B } state B { stop }";
    let alone = compile(&Source::new("main.fsm", format!("machine m {} {rest}", counting()))).unwrap();
    for used in ["use \"count.fsm\"", "use \"count.fsm\" (count)"] {
        let source = Source::new("main.fsm", format!("machine m {used} {rest}"));
        let source = gather(&source, &mut |_| Ok(format!("library l {}", counting())));
        assert_eq!(compile(&source).unwrap(), alone);
    }
}

#[test]
fn behaviours_in_behaviours_have_names_with_the_way_to_them() {
    let program = program(
        "machine m initial A
        behaviour outer { exit done  initial Run  state Run is inner { on far -> exit done } }
        behaviour inner { exit far  initial Go  state Go { stop  after 1 s -> exit far } }
        state A is outer { on done -> Failure(\"done\") }",
    );
    let names: Vec<&str> = program.states.iter().map(|state| &*state.name).collect();
    assert_eq!(names, ["A", "A.outer", "A.Run", "A.Run.inner", "A.Run.Go"]);
}

#[test]
fn a_behaviour_that_is_used_too_often_is_refused() {
    let levels = (0..3).map(|level| {
        let uses = (0..40).map(|index| format!("state S{index} is b{} {{ on done -> exit done }}", level + 1));
        format!("behaviour b{level} {{ exit done  initial S0 {} }}", uses.collect::<Vec<_>>().join(" "))
    });
    let text = format!(
        "machine m initial A {} behaviour b3 {{ exit done  stop }} state A is b0 {{ on done -> A }}",
        levels.collect::<Vec<_>>().join(" ")
    );
    let faults = compile(&Source::new("m.fsm", text)).unwrap_err();
    assert!(faults.iter().all(|fault| fault.code == "P0402"), "{faults:?}");
}

#[test]
fn a_warning_about_a_behaviour_holds_for_every_use() {
    let text = |values: [&str; 2]| {
        format!(
            "machine m whisker r0 initial A
            behaviour go(limit: angle) {{ exit done  stop  when r0.base_angle > limit -> exit done }}
            state A is go({}) {{ on done -> B }}
            state B is go({}) {{ on done -> Failure(\"end\") }}",
            values[0], values[1]
        )
    };
    let codes = |values| {
        let compiled = compile_with_warnings(&Source::new("m.fsm", text(values))).unwrap();
        compiled.warnings.iter().map(|warning| warning.code).collect::<Vec<_>>()
    };
    assert_eq!(codes(["1 mrad", "2 mrad"]), [] as [&str; 0]);
    assert_eq!(codes(["1 mrad", "9000 deg"]), [] as [&str; 0]);
    assert_eq!(codes(["9000 deg", "9000 deg"])[0], "P0508");
}
