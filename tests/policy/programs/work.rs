//! No tick executes more operations than the program states.

use std::sync::Arc;

use proptest::prelude::*;
use vibrissa_runtime::machine::{self, Block, Guard, Machine, Op, Target, Transition};

use super::generate::programs;
use super::side_by_side::{cases, machine, scripts};
use crate::common::{Feel, Script, program};

/// A whisker that no program has. Its recording counts an operation.
const PROBE: u8 = 200;

/// The program with a probe before every operation.
fn probed(program: &machine::Program) -> machine::Program {
    let mut probed = program.clone();
    let whisker = u16::try_from(probed.initial_registers.len()).unwrap();
    probed.initial_registers.push(PROBE.into());
    let with_probe = |&op: &Op| {
        let mut op = op;
        if let Some(target) = op.target_mut() {
            *target *= 2;
        }
        [Op::Record { whisker }, op]
    };
    probed.code = program.code.iter().flat_map(with_probe).collect();
    let double = |block: &mut Block| *block = block.start * 2..block.end * 2;
    let target = |target: &mut Target| {
        if let Target::State { arguments, .. } = target {
            double(arguments);
        }
    };
    let transition = |one: &mut Transition| {
        let (Guard::When { code, .. } | Guard::After { code, .. }) = &mut one.guard;
        double(code);
        target(&mut one.target);
    };
    [&mut probed.start, &mut probed.entry, &mut probed.monitors, &mut probed.body].into_iter().for_each(double);
    probed.always.iter_mut().for_each(transition);
    probed.fallback.iter_mut().for_each(target);
    probed.contracts.iter_mut().for_each(|contract| double(&mut contract.code));
    for state in &mut probed.states {
        [&mut state.entry, &mut state.body, &mut state.exit].into_iter().for_each(double);
        state.initial.iter_mut().for_each(|(_, values)| double(values));
        state.transitions.iter_mut().for_each(transition);
        state.fallback.iter_mut().for_each(target);
        state.contracts.iter_mut().for_each(|contract| double(&mut contract.code));
    }
    probed
}

/// Executes a tick, and returns the number of its operations and what it gave.
fn count(machine: &mut Machine, script: &mut Script) -> (usize, machine::Tick) {
    script.recorded.clear();
    let tick = machine.tick(script);
    (script.recorded.iter().filter(|&&whisker| whisker == usize::from(PROBE)).count(), tick)
}

proptest! {
    #![proptest_config(ProptestConfig { cases: cases(), max_global_rejects: 100_000, ..ProptestConfig::default() })]

    #[test]
    fn no_tick_executes_more_operations_than_its_program_states(program in programs(), script in scripts()) {
        let text = program.text();
        let Some(compiled) = machine(&text) else { return Err(TestCaseError::reject("goes round")) };
        let most = compiled.most_operations();
        let mut counted = Machine::new(Arc::new(probed(&compiled)));
        let mut plain = Machine::new(Arc::new(compiled));
        let mut scripts = [script.clone(), script];
        for now in 0..scripts[0].ticks.len() {
            for script in &mut scripts {
                script.now = now;
            }
            let (operations, tick) = count(&mut counted, &mut scripts[0]);
            prop_assert!(operations <= most, "{} of {} operations in tick {} of\n{}", operations, most, now, text);
            // The probes change nothing.
            let (none, other) = count(&mut plain, &mut scripts[1]);
            prop_assert_eq!(none, 0);
            prop_assert_eq!(format!("{tick:?}"), format!("{other:?}"));
            prop_assert_eq!(counted.state_name(), plain.state_name());
        }
    }
}

#[test]
fn a_first_tick_with_all_transitions_and_the_fallback_transition_lacks_only_the_second_bodies() {
    let state = |index| {
        let next = if index < 9 { format!("when true -> S{}", index + 1) } else { String::new() };
        format!("state S{index} {{ entry {{ set n = n + time / 1 s }} {next} }}")
    };
    let states = (0..10).map(state).collect::<Vec<_>>().join("\n");
    let rest = "state Rest { entry { set n = n + time / 1 s }  stop }  failsafe -> Rest";
    let program = program(&format!("machine m  var n = 0  initial S0  {states} {rest}"));
    let mut machine = Machine::new(Arc::new(probed(&program)));
    let (operations, tick) = count(&mut machine, &mut Script::new(vec![vec![Feel::default()]]));
    assert!(tick.fallback.is_some() && !program.states[0].entry.is_empty());
    // Bodies run twice if the first action is not finite.
    assert_eq!(operations + program.states[10].body.len(), program.most_operations());
}
