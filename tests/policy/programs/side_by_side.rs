//! The machine does what the interpreter does, on random programs, whatever is felt and however late the ticks come.

use std::collections::{BTreeMap, BTreeSet};
use std::sync::Arc;

use proptest::prelude::*;
use proptest::strategy::ValueTree;
use proptest::test_runner::TestRunner;
use vibrissa_language::{compile, compile_with_warnings};
use vibrissa_runtime::geometry::Vector2;
use vibrissa_runtime::machine::{self, Action, LoggedMessage, Machine, Observer, ViolatedContract};
use vibrissa_text::diagnostic::Source;

use super::evaluate::numbers_text;
use super::generate::programs;
use super::interpreter::{Done, End, Interpreter, shown};
use super::tree::Program;
use crate::common::{Feel, Script};

/// A number that is felt: seldom none.
fn number(range: std::ops::Range<f64>) -> impl Strategy<Value = f64> {
    prop_oneof![30 => range, 2 => Just(0.0), 1 => Just(f64::NAN), 1 => Just(f64::INFINITY)]
}

prop_compose! {
    fn feel()(
        (touching, ready) in any::<(bool, bool)>(),
        base_angle in number(-0.01..0.01),
        (is_left, sense) in (any::<bool>(), prop::sample::select(vec![-1.0, 0.0, 1.0])),
        (x, y) in (number(-1.0..1.0), -1.0..1.0),
    ) -> Feel {
        Feel { touching, ready, base_angle, side: if is_left { 1.0 } else { -1.0 }, sense, tangent: Vector2::new(x, y) }
    }
}

prop_compose! {
    /// What a whisker feels if its readings are valid, and agree with one another.
    fn valid_feel()(
        (touching, ready, is_left, is_forward) in any::<(bool, bool, bool, bool)>(),
        (angle, towards) in (1e-6..0.01_f64, -3.0..3.0_f64),
    ) -> Feel {
        let (side, sense) = (if is_left { 1.0 } else { -1.0 }, if is_forward { 1.0 } else { -1.0 });
        Feel {
            touching,
            ready,
            base_angle: angle * side * sense,
            side,
            sense: if touching { sense } else { 0.0 },
            tangent: Vector2::new(towards.cos(), towards.sin()),
        }
    }
}

/// Some ticks of three whiskers with valid readings.
fn valid_scripts() -> impl Strategy<Value = Script> {
    prop::collection::vec(prop::collection::vec(valid_feel(), 3), 1..25).prop_map(Script::new)
}

/// Some ticks of three whiskers, most of which come late by some milliseconds.
pub(crate) fn scripts() -> impl Strategy<Value = Script> {
    let tick = (prop::collection::vec(feel(), 3), prop_oneof![Just(0), 0..30_u8]);
    prop::collection::vec(tick, 1..25).prop_map(|ticks| {
        let (feels, late): (Vec<_>, Vec<_>) = ticks.into_iter().unzip();
        Script { late: late.into_iter().map(|late| f64::from(late) * 1e-3).collect(), ..Script::new(feels) }
    })
}

/// The machine of a program; `None` if the compiler has found that a tick of it can go round.
pub(crate) fn machine(text: &str) -> Option<machine::Program> {
    match compile(&Source::new("program.fsm", text)) {
        Ok(program) => Some(program),
        Err(faults) => {
            assert!(faults.iter().all(|fault| fault.code == "P0405"), "{faults:?}\n{text}");
            None
        }
    }
}

/// The violated contracts of a tick.
#[derive(Default)]
struct Violations(Vec<(Option<usize>, String)>);

impl Observer for Violations {
    fn violated(&mut self, violated: &ViolatedContract<'_>) {
        self.0.push((violated.id.state, shown(&violated.contract.text)));
    }
}

/// What a machine does in a tick.
fn done(machine: &mut Machine, script: &mut Script) -> Done {
    let mut seen = Violations::default();
    let tick = machine.tick_observed(script, &mut seen);
    let name = |state: usize| machine.program().states[state].name.to_string();
    Done {
        action: Some(tick.action),
        state: machine.state_name().to_owned(),
        end: match (machine.failure(), machine.success()) {
            (Some(failure), _) => Some(End::Failure(failure.clone())),
            (None, success) => success.map(|reason| End::Success(reason.to_owned())),
        },
        failsafe: tick.fallback.map(|failsafe| (name(failsafe.left), failsafe.cause)),
        // The contracts of a state around all others are those of the machine.
        violated: seen
            .0
            .into_iter()
            .map(|(state, text)| (state.map_or_else(String::new, name).replace("Whole", ""), text))
            .collect(),
        plotted: (machine.plotted())
            .map(|(plot, value)| (machine.program().outputs.plots[plot].name.clone(), numbers_text(&[value])))
            .collect(),
        logged: (machine.logged())
            .map(|LoggedMessage { message, numbers }| {
                let message = &machine.program().outputs.messages[message];
                let width = message.values.iter().map(|value| value.kind.width()).sum();
                (message.text.to_string(), numbers_text(&numbers[..width]))
            })
            .collect(),
    }
}

/// The name of a state of a machine; empty for the machine itself.
fn state_name(machine: &Machine, state: Option<usize>) -> String {
    state.map_or_else(String::new, |state| machine.program().states[state].name.to_string())
}

/// Runs a machine and the program that it was compiled from side by side. What was executed, and as part of what.
fn run_both(
    program: &Program,
    compiled: machine::Program,
    mut script: Script,
) -> Result<BTreeSet<(&'static str, &'static str)>, TestCaseError> {
    let mut machine = Machine::new(Arc::new(compiled));
    let mut interpreter = Interpreter::new(program, script.clone());
    // Proofs are about valid readings, and the others may violate a contract that is not watched.
    let watched: BTreeSet<(String, String)> =
        machine.contracts().map(|one| (state_name(&machine, one.state), shown(&one.contract.text))).collect();
    let (mut steers, mut lasted) = (0, 0);
    for now in 0..script.ticks.len() {
        (script.now, interpreter.senses.now) = (now, now);
        let found = done(&mut machine, &mut script);
        steers += usize::from(matches!(found.action, Some(Action::Steer { .. })));
        lasted += usize::from(found.end.is_none());
        let mut expected = interpreter.tick();
        expected.violated.retain(|violated| watched.contains(violated));
        prop_assert_eq!(&found, &expected, "tick {} of\n{}", now, program.text());
        prop_assert_eq!(&script.recorded, &interpreter.senses.recorded, "tick {} of\n{}", now, program.text());
        prop_assert_eq!(&script.positions, &interpreter.senses.positions, "tick {} of\n{}", now, program.text());
        prop_assert_eq!(&script.marked, &interpreter.senses.marked, "tick {} of\n{}", now, program.text());
        prop_assert_eq!(&script.told, &interpreter.senses.told, "tick {} of\n{}", now, program.text());
    }
    interpreter.seen("five ticks that steer", (steers >= 5).then_some("a run"));
    interpreter.seen("ten ticks without a failure", (lasted >= 10).then_some("a run"));
    Ok(interpreter.executed)
}

/// How many programs are compared, unless `PROPTEST_CASES` asks for more.
pub(super) fn cases() -> u32 {
    ProptestConfig::default().cases.max(2000)
}

proptest! {
    #![proptest_config(ProptestConfig { cases: cases(), max_global_rejects: 100_000, ..ProptestConfig::default() })]

    #[test]
    fn a_machine_does_what_the_interpreter_of_its_program_does(program in programs(), script in scripts()) {
        let Some(compiled) = machine(&program.text()) else { return Err(TestCaseError::reject("goes round")) };
        run_both(&program, compiled, script)?;
    }

    #[test]
    fn no_run_with_valid_readings_violates_a_proved_contract(program in programs(), script in valid_scripts()) {
        let source = Source::new("program.fsm", program.text());
        let Ok(compiled) = compile_with_warnings(&source) else { return Err(TestCaseError::reject("goes round")) };
        let proved: BTreeSet<(String, String)> =
            compiled.proved.iter().map(|one| (one.state.clone().unwrap_or_default(), shown(&one.text))).collect();
        let mut interpreter = Interpreter::new(&program, script.clone());
        for now in 0..script.ticks.len() {
            interpreter.senses.now = now;
            let violated = interpreter.tick().violated;
            prop_assert!(violated.iter().all(|one| !proved.contains(one)), "tick {} of\n{}", now, source.text);
        }
    }

    #[test]
    fn what_the_machine_remembers_and_does_is_what_a_state_around_all_others_would(
        program in programs(), script in scripts(),
    ) {
        // Rules that hold always would leave that state.
        let program = Program { always: Vec::new(), ..program };
        let (text, wrapped) = (program.text(), program.wrapped());
        let (Some(plain), Some(around)) = (machine(&text), machine(&wrapped)) else {
            return Err(TestCaseError::reject("goes round"));
        };
        let mut pair = [plain, around].map(|program| (Machine::new(Arc::new(program)), script.clone()));
        for now in 0..script.ticks.len() {
            let [plain, around] = pair.each_mut().map(|(machine, script)| {
                script.now = now;
                (done(machine, script), script.recorded.clone(), script.marked.clone())
            });
            prop_assert_eq!(plain, around, "tick {} of\n{}and of\n{}", now, text, wrapped);
        }
    }
}

/// What programs do, and as part of what.
const DONE: [(&str, &[&str]); 55] = [
    ("a parameter", &["a body", "a law", "a derived value", "an entry", "an exit", "a guard", "a target", "a memory"]),
    (
        "a unit with a factor",
        &["a parameter", "a body", "a law", "a derived value", "a guard", "a target", "an initial"],
    ),
    ("a derived value", &["a body", "an if", "an entry", "a guard", "a memory"]),
    ("one with arguments", &["a body", "a law", "an if", "an entry", "an exit", "a guard", "a target", "a memory"]),
    (
        "a choice",
        &[
            "a body",
            "a law",
            "a derived value",
            "an if",
            "an entry",
            "an exit",
            "a guard",
            "a target",
            "a memory",
            "the machine",
        ],
    ),
    (
        "a value of an enumeration",
        &["a parameter", "a body", "a law", "a derived value", "an if", "an entry", "a guard", "a target", "a memory"],
    ),
    ("a named value", &["a body", "a law", "an if", "an entry", "a guard", "a target", "a memory"]),
    ("a default", &["a body", "a law", "an if", "an entry", "a target"]),
    ("let", &["a body", "a law", "an if", "an entry", "an exit"]),
    (
        "what a monitor remembers",
        &["a body", "an if", "an entry", "an exit", "a guard", "a target", "a memory", "a monitor"],
    ),
    ("set", &["a body", "an if", "an entry", "an exit", "the machine"]),
    ("set of the machine's memory", &["a body", "an if", "an entry", "an exit", "the machine"]),
    ("set of what was named before", &["a body", "an if", "an entry", "an exit"]),
    ("set of an outer state's memory", &["a body", "an if", "an entry", "an exit"]),
    ("what hides another", &["a body", "an if", "an entry", "an exit", "a guard", "a target", "a memory"]),
    ("if", &["a body", "a law", "an if", "an entry", "an exit", "the machine"]),
    ("do", &["a body", "a law", "an if", "an entry", "an exit", "the machine"]),
    ("tell", &["a body", "an if", "an entry", "an exit"]),
    ("record", &["a body", "a law", "an if", "an entry", "an exit", "the machine"]),
    ("record in a contour", &["a body", "a law", "an if", "an entry", "an exit", "the machine"]),
    ("mark", &["a body", "a law", "an if", "an entry", "an exit", "the machine"]),
    ("plot", &["a body", "a law", "an if", "an entry", "an exit", "the machine"]),
    ("log", &["a body", "a law", "an if", "an entry", "an exit", "an event", "a monitor", "the machine"]),
    (
        "lowpass",
        &[
            "a body",
            "a law",
            "a derived value",
            "an if",
            "an entry",
            "an exit",
            "a guard",
            "a target",
            "a memory",
            "the machine",
        ],
    ),
    ("pid", &["a body", "a law", "a derived value", "an if", "an entry", "an exit", "a guard", "a target", "a memory"]),
    ("previous", &["a body", "a law", "a derived value", "an if", "an entry", "an exit", "a guard", "a contract"]),
    ("peak", &["a body", "a law", "an if", "an entry", "an exit", "a guard"]),
    ("settled", &["a body", "an if", "a guard", "a contract"]),
    ("path_length", &["a body", "an if"]),
    ("time in a state", &["a body", "an if", "an entry", "an exit", "a guard", "a target", "a contract"]),
    ("a component", &["a body", "an if"]),
    ("steer body turning", &["a body", "a law", "an if"]),
    ("steer body facing", &["a body", "a law", "an if"]),
    ("steer w turning", &["a body", "a law", "an if"]),
    ("steer w facing", &["a body", "a law", "an if"]),
    ("hold", &["a body", "a law", "an if"]),
    ("stop", &["a body", "a law", "an if"]),
    ("when", &["a guard"]),
    ("for", &["a guard"]),
    ("after", &["a guard"]),
    ("what is there already", &["a guard"]),
    ("a transition", &["a state", "the machine"]),
    ("a chain", &["a tick"]),
    ("arguments", &["a target"]),
    ("resume", &["a target"]),
    ("a failure", &["a target", "a command"]),
    ("a success", &["a target"]),
    ("a closed loop", &["a body", "an if", "a guard"]),
    ("failsafe", &["the state", "a state around", "the machine"]),
    ("assume", &["a state", "the machine"]),
    ("never", &["a state", "the machine"]),
    ("never for", &["a state", "the machine"]),
    ("always", &["a state", "the machine"]),
    ("five ticks that steer", &["a run"]),
    ("ten ticks without a failure", &["a run"]),
];

#[test]
fn what_is_compared_does_all_that_programs_can_do() {
    let mut runner = TestRunner::deterministic();
    let (mut counts, mut compiled, mut refused) = (BTreeMap::new(), 0, 0);
    while compiled < 2000 {
        let (program, script) = (programs(), scripts()).new_tree(&mut runner).unwrap().current();
        let Some(machine) = machine(&program.text()) else {
            refused += 1;
            continue;
        };
        compiled += 1;
        for what in run_both(&program, machine, script).unwrap() {
            *counts.entry(what).or_insert(0) += 1;
        }
    }
    let pairs = DONE.iter().flat_map(|(what, parts)| parts.iter().map(move |part| (*what, *part)));
    let seldom: Vec<_> = pairs.filter(|pair| counts.get(pair).is_none_or(|&count| count < 8)).collect();
    assert!(seldom.is_empty() && refused < 750, "{seldom:#?} in {refused} refused {counts:#?}");
}
