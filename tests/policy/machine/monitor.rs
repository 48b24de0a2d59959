//! What monitors mean: they see each tick first, and never steer.
#![allow(clippy::float_cmp, reason = "what is exact is compared exactly")]

use std::sync::Arc;

use proptest::prelude::*;
use vibrissa_language::{compile, gather};
use vibrissa_runtime::machine::{Action, Machine};
use vibrissa_text::diagnostic::Source;

use crate::common::{Feel, Script, program, run, run_program};
use crate::programs::{machine, programs, scripts};

/// A command that tells a number.
fn tell(number: &str) -> String {
    format!("steer body along vector(1, 0) at ({number}) * 1 m/s turning 0 rad/s")
}

/// The numbers that a machine tells, tick by tick.
fn told(text: &str, marks: &str) -> Vec<f64> {
    speeds(run(text, &mut Script::touches(marks)).1)
}

fn speeds(ticks: Vec<(String, Action)>) -> Vec<f64> {
    let speed = |action| if let Action::Steer { speed, .. } = action { speed } else { f64::NAN };
    ticks.into_iter().map(|(_, action)| speed(action)).collect()
}

#[test]
fn a_transition_reads_the_monitors_of_its_own_tick() {
    let text = format!(
        "machine m whisker w initial A
        monitor felt {{ var count = 0  if w.touching {{ set count = count + 1 }} }}
        state A {{ {}  when felt.count == 2 -> B }}
        state B {{ {} }}",
        tell("felt.count"),
        tell("10 + felt.count")
    );
    assert_eq!(told(&text, ".x.x."), [0.0, 1.0, 1.0, 12.0, 12.0]);
}

#[test]
fn the_first_state_is_entered_after_the_monitors_have_run() {
    let text = format!(
        "machine m whisker w initial A
        monitor felt {{ var count = start + 2  set count = 10 * count + 3 }}
        param start = 1
        state A {{ var seen = felt.count  {}  when felt.count > 100 -> B }}
        state B {{ {} }}",
        tell("seen"),
        tell("-seen")
    )
    .replace("-seen", "felt.count");
    assert_eq!(told(&text, ".."), [33.0, 333.0]);
}

#[test]
fn arguments_are_computed_in_every_tick_from_what_stands_above() {
    let text = format!(
        "machine m whisker w initial A
        var n = 1
        monitor twice(x: number) {{ var value = 0  set value = 2 * x }}
        monitor first is twice(n)
        monitor second is twice(first.value + n)
        set n = n + 1
        state A {{ {} }}",
        tell("second.value")
    );
    // The machine's own statements run after the monitors.
    assert_eq!(told(&text, "..."), [6.0, 12.0, 18.0]);
}

#[test]
fn two_uses_remember_for_themselves() {
    let text = format!(
        "machine m whisker a, b initial A
        monitor felt(w: whisker) {{ var count = 0  if w.touching {{ set count = count + 1 }} }}
        monitor left is felt(a)
        monitor right is felt(b)
        state A {{ {} }}",
        tell("10 * left.count + right.count")
    );
    let feel = |touching| Feel { touching, ..Feel::default() };
    let ticks = [(true, false), (true, true), (false, true), (true, false)];
    let mut script = Script::new(ticks.iter().map(|&(a, b)| vec![feel(a), feel(b)]).collect());
    assert_eq!(speeds(run(&text, &mut script).1), [10.0, 21.0, 22.0, 32.0]);
}

#[test]
fn a_monitor_of_a_library_is_the_same_as_one_of_the_machine() {
    let monitor =
        "monitor felt(w: whisker, step: number) { var count = 0  if w.touching { set count = count + step } }";
    let rest = format!(
        "whisker r0 monitor right is felt(r0, 2) initial A state A {{ {}  when right.count > 3 -> A }}",
        tell("right.count")
    );
    let alone = compile(&Source::new("main.fsm", format!("machine m {monitor} {rest}"))).unwrap();
    for used in ["use \"felt.fsm\"", "use \"felt.fsm\" (felt)"] {
        let source = Source::new("main.fsm", format!("machine m {used} {rest}"));
        let source = gather(&source, &mut |_| Ok(format!("library felt {monitor}")));
        assert_eq!(compile(&source).unwrap(), alone);
    }
}

/// A library with a monitor, and a behaviour and a law that take it.
const LIBRARY: &str = "library seen
    monitor seen(w: whisker) {
        var count = 0
        var place = 0
        if w.touching { set count = count + 1 }
        on moved(there: number, step: number = 1) { set place = there * step  set count = 0 }
    }
    law move(to: seen, there: number) { tell to.moved(there, step: 2) }
    behaviour wait(memory: seen, most: number) {
        exit over
        initial Waiting
        state Waiting {
            steer body along vector(1, 0) at (100 * memory.place + memory.count) * 1 m/s turning 0 rad/s
            when memory.count > most -> exit over
            exit { do move(memory, memory.count) }
        }
    }";

/// Commands of a machine that uses the library.
fn told_with_library(machine: &str, marks: &str) -> Vec<f64> {
    let source = Source::new("main.fsm", format!("machine m use \"seen.fsm\" whisker w {machine}"));
    let source = gather(&source, &mut |_| Ok(LIBRARY.to_owned()));
    let compiled = compile(&source).unwrap_or_else(|faults| panic!("{faults:?}"));
    speeds(run_program(compiled, &mut Script::touches(marks)).1)
}

#[test]
fn an_event_sets_the_memory_of_a_monitor_at_once() {
    let text = format!(
        "machine m whisker w initial A
        monitor felt {{ var count = 0  set count = count + 1  on lost(step: number) {{ set count = count - step }} }}
        state A {{ let before = felt.count  tell felt.lost(10 * before)  {} }}",
        tell("felt.count")
    );
    assert_eq!(told(&text, "..."), [-9.0, 72.0, -657.0]);
}

#[test]
fn a_behaviour_knows_the_monitors_that_it_is_given() {
    let machine = "monitor right is seen(w)
        initial A
        state A is wait(right, 1) { on over -> B }
        state B is wait(most: 2, memory: right) { on over -> A }";
    // Leaving the behaviour tells the monitor its own count, twice.
    assert_eq!(told_with_library(machine, "x.xxx.xx"), [1.0, 1.0, 400.0, 401.0, 402.0, 402.0, 600.0, 601.0]);
}

#[test]
fn what_is_told_to_one_monitor_does_not_concern_another() {
    let machine = format!(
        "monitor one is seen(w)
        monitor other is seen(w)
        initial A
        state A {{ do move(one, 7)  {} }}",
        tell("10000 * one.place + 100 * one.count + other.count")
    );
    assert_eq!(told_with_library(&machine, "x.x"), [140_001.0, 140_001.0, 140_002.0]);
}

#[test]
fn the_bound_of_a_tick_counts_monitors_once() {
    let rest = "machine m whisker w initial A state A { stop }";
    let plain = program(rest);
    let watched = program(&format!("{rest} monitor felt {{ var x = 0 rad  set x = max(x, w.base_angle) }}"));
    let monitors = watched.monitors.len();
    assert!(monitors > 0);
    assert_eq!(watched.operations(0), plain.operations(0) + monitors);
    assert_eq!(
        watched.most_operations(),
        plain.most_operations() + monitors + watched.entry.len() + watched.start.len()
    );
}

/// A monitor that computes much, remembers, and is read by nothing.
const WATCHER: &str = "monitor watcher_of_all {
    var seen_by_it = w0.base_angle  var count_of_it = 0  var where_it_was = body.position
    if w0.touching { set count_of_it = count_of_it + lowpass(1, 2 Hz) }
    set seen_by_it = w0.base_angle - seen_by_it  set where_it_was = blend(w0.tip, where_it_was, 0.5)
}";

proptest! {
    #![proptest_config(ProptestConfig { cases: 300, max_global_rejects: 100_000, ..ProptestConfig::default() })]

    #[test]
    fn a_monitor_that_nothing_reads_changes_nothing(program in programs(), script in scripts()) {
        let text = program.text();
        let (Some(plain), Some(watched)) = (machine(&text), machine(&format!("{text}\n{WATCHER}"))) else {
            return Err(TestCaseError::reject("goes round"));
        };
        let mut pair = [plain, watched].map(|program| (Machine::new(Arc::new(program)), script.clone()));
        for now in 0..script.ticks.len() {
            let [plain, watched] = pair.each_mut().map(|(machine, script)| {
                script.now = now;
                let tick = machine.tick(script);
                (tick.action, machine.state_name().to_owned(), script.recorded.clone(), script.marked.clone())
            });
            prop_assert_eq!(plain, watched, "tick {} of\n{}", now, text);
        }
    }
}
