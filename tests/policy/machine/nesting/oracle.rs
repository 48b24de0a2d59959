//! The machine does what the interpreter does, on random trees and whatever is felt.

use std::sync::Arc;

use proptest::prelude::*;
use vibrissa_language::{compile, compile_with_warnings, format};
use vibrissa_runtime::machine::{Action, Artifact, Machine, Program};
use vibrissa_text::diagnostic::Source;

use super::interpreter::{Done, Interpreter};
use super::tree::{Features, RATE, Tree, trees};
use crate::common::{Feel, Script};

/// Which of eight whiskers touch, tick by tick: seldom many at once.
pub(crate) fn touches() -> impl Strategy<Value = Vec<[bool; 8]>> {
    prop::collection::vec(prop::array::uniform8(prop::bool::weighted(0.25)), 1..25)
}

/// What a machine does in a tick, read from what it records.
fn done(machine: &mut Machine, script: &mut Script) -> Done {
    script.recorded.clear();
    let action = machine.tick(script).action;
    let events = script.recorded.chunks(4).map(|event| (event[0], 8 * event[1] + event[2], event[3]));
    let commander = match action {
        #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "a state's index")]
        Action::Steer { speed, .. } => Some(speed as usize),
        Action::Hold | Action::Stop => None,
    };
    let state = machine.state_name().rsplit('.').next().unwrap().strip_prefix('S').map(|state| state.parse().unwrap());
    Done { events: events.collect(), state, commander }
}

/// Runs a program and its tree side by side.
pub(crate) fn run_both<'t>(
    tree: &'t Tree,
    program: Program,
    touches: &[[bool; 8]],
) -> Result<(Machine, Interpreter<'t>, Vec<Done>), TestCaseError> {
    let mut machine = Machine::new(Arc::new(program));
    let mut interpreter = Interpreter::new(tree);
    let mut all = Vec::new();
    let feel = |&touching: &bool| Feel { touching, ..Feel::default() };
    let mut script = Script::new(touches.iter().map(|tick| tick.iter().map(feel).collect()).collect());
    script.period = 1.0 / RATE;
    for (now, &touching) in touches.iter().enumerate() {
        script.now = now;
        let found = done(&mut machine, &mut script);
        prop_assert_eq!(&found, &interpreter.tick(now, touching), "tick {} of\n{}", now, tree.text());
        all.push(found);
    }
    Ok((machine, interpreter, all))
}

const ALL: Features = Features { states: 14, rules: 24, times: true, resume: true, always: true };

/// The program of a tree; `None` if the compiler has found that a tick of it can go round.
fn program(text: &str) -> Option<Program> {
    match compile(&Source::new("tree.fsm", text)) {
        Ok(program) => Some(program),
        Err(faults) => {
            assert!(faults.iter().all(|fault| fault.code == "P0405"), "{faults:?}\n{text}");
            None
        }
    }
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 1000, max_global_rejects: 100_000, ..ProptestConfig::default() })]

    #[test]
    fn a_machine_enters_leaves_waits_and_resumes_as_the_interpreter_does(tree in trees(ALL), touches in touches()) {
        let Some(program) = program(&tree.text()) else { return Err(TestCaseError::reject("goes round")) };
        run_both(&tree, program, &touches)?;
    }
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 500, max_global_rejects: 100_000, ..ProptestConfig::default() })]

    #[test]
    fn no_run_gainsays_what_is_said_of_states_and_transitions(
        tree in trees(ALL), touches in prop::collection::vec(touches(), 5),
    ) {
        let source = Source::new("tree.fsm", tree.text());
        let Ok(compiled) = compile_with_warnings(&source) else { return Err(TestCaseError::reject("goes round")) };
        let places = &compiled.artifact.positions;
        let said = |code: &str| -> Vec<usize> {
            let warnings = compiled.warnings.iter().filter(|warning| warning.code == code);
            warnings.map(|warning| source.line_column(warning.primary.span.start).line).collect()
        };
        let (never_taken, never_reached, never_left) = (said("P0511"), said("P0501"), said("P0502"));
        for touches in &touches {
            let (_, interpreter, done) = run_both(&tree, compiled.artifact.program.clone(), touches)?;
            for (from, index) in interpreter.taken {
                let place = match from { None => places.always[index], Some(from) => places.states[from].transitions[index] };
                prop_assert!(!never_taken.contains(&place.line), "line {} of\n{}", place.line, source.text);
            }
            let events = || done.iter().flat_map(|done| &done.events);
            let entered = |state: usize| events().filter(|&&(event, of, _)| event == 0 && of == state).count();
            for (index, place) in places.states.iter().enumerate() {
                prop_assert!(entered(index) == 0 || !never_reached.contains(&place.name.line), "S{} of\n{}", index, source.text);
                let is_left = |done: &Done| done.state.is_some_and(|active| !tree.way(active).contains(&index));
                let is_in = |done: &Done| done.state.is_some_and(|active| tree.way(active).contains(&index));
                let leaves = done.windows(2).any(|pair| is_in(&pair[0]) && is_left(&pair[1]));
                prop_assert!(!leaves || !never_left.contains(&place.name.line), "S{} of\n{}", index, source.text);
            }
        }
    }
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 200, max_global_rejects: 100_000, ..ProptestConfig::default() })]

    #[test]
    fn any_tree_is_laid_out_stored_and_read_again_unchanged(tree in trees(ALL)) {
        let text = tree.text();
        let Some(program) = program(&text) else { return Err(TestCaseError::reject("goes round")) };
        let neat = format(&Source::new("tree.fsm", &text)).unwrap();
        prop_assert_eq!(&format(&Source::new("tree.fsm", &neat)).unwrap(), &neat);
        prop_assert!(compile(&Source::new("tree.fsm", &neat)).unwrap() == program, "{}", neat);
        let artifact = compile_with_warnings(&Source::new("tree.fsm", &text)).unwrap().artifact;
        prop_assert_eq!(Artifact::from_bytes(&artifact.to_bytes().unwrap()).unwrap(), artifact);
    }
}
