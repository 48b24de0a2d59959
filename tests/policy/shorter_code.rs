//! What compiled code does not do twice, and what it does once a run.

use vibrissa_language::compile;
use vibrissa_runtime::machine::{Op, Program};
use vibrissa_text::diagnostic::Source;

/// A program with one state that does this every tick.
fn doing(body: &str) -> Program {
    let text = format!("machine a  whisker r0  param speed = 5 cm/s in 1 .. 9 cm/s  initial A  state A {{ {body} }}");
    compile(&Source::new("a.fsm", text)).unwrap_or_else(|faults| panic!("{faults:?}"))
}

/// What the state does every tick.
fn body(program: &Program) -> &[Op] {
    let body = &program.states[0].body;
    &program.code[body.start as usize..body.end as usize]
}

fn count(ops: &[Op], is_counted: fn(&Op) -> bool) -> usize {
    ops.iter().filter(|op| is_counted(op)).count()
}

#[test]
fn what_is_felt_is_asked_for_once_until_a_tip_is_recorded() {
    let steer = "steer body along r0.tip - r0.base at speed turning 0 deg/s";
    let is_tip = |op: &Op| matches!(op, Op::WhiskerVector { .. });
    let twice = doing(&format!("{steer}  {steer}"));
    assert_eq!(count(body(&twice), is_tip), 2);
    let recorded = doing(&format!("{steer}  record r0  {steer}"));
    assert_eq!(count(body(&recorded), is_tip), 4);
}

#[test]
fn what_may_have_been_left_out_is_not_relied_on() {
    let steer = "steer body along r0.tip_base at speed turning 0 deg/s";
    let is_tip = |op: &Op| matches!(op, Op::WhiskerVector { .. });
    let program = doing(&format!("if r0.touching {{ {steer} }}  {steer}"));
    assert_eq!(count(body(&program), is_tip), 2);
}

#[test]
fn what_the_machine_itself_does_is_shortened_too() {
    let text = "machine a  param speed = 5 cm/s in 1 .. 9 cm/s  var far = 2 * speed  var n = 0 cm/s  set n = n + 3 * speed - far
        initial A  state A { steer body along vector(1, 0) at n turning 0 deg/s }";
    let program = compile(&Source::new("a.fsm", text)).unwrap();
    let ops = |block: &std::ops::Range<u32>| &program.code[block.start as usize..block.end as usize];
    assert!(matches!(ops(&program.entry), [Op::Copy { .. }]), "{:?}", ops(&program.entry));
    assert!(
        matches!(ops(&program.body), [Op::Add { .. }, Op::Subtract { .. }, Op::Copy { .. }]),
        "{:?}",
        ops(&program.body)
    );
}

#[test]
fn what_parameters_fix_is_computed_when_a_run_begins() {
    let program = doing("steer body along vector(1, 0) at min(speed * speed / 3 cm/s, speed) turning 0 deg/s");
    assert!(matches!(body(&program), [Op::SteerBodyTurning { .. }]), "{:?}", body(&program));
    let start = &program.code[program.start.start as usize..program.start.end as usize];
    assert_eq!(count(start, |op| matches!(op, Op::Multiply { .. } | Op::Divide { .. } | Op::Minimum { .. })), 3);
}
