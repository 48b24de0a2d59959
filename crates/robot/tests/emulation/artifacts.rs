//! The loop under each of the compiled policies.

use std::collections::BTreeSet;

use vibrissa_robot::emulation::{Settings, Stopped};
use vibrissa_robot::vitals::Phase;
use vibrissa_runtime::control::Control;
use vibrissa_runtime::machine::Status;
use vibrissa_runtime::signal::Command;

use super::robot::{MS, robot_under};

/// The compiled policies, and the least number of states that each visits among swaying grass.
const ARTIFACTS: [(&str, &[u8], usize); 3] = [
    ("bang", include_bytes!("../../../runtime/fixtures/bang.machine"), 2),
    ("thesis", include_bytes!("../../../runtime/fixtures/thesis.machine"), 4),
    ("vibrissa", include_bytes!("../../../runtime/fixtures/vibrissa.machine"), 8),
];

/// The bits of the commands of a run, and the states of the machine.
fn run(machine: &[u8], seed: u64) -> (Vec<[u64; 3]>, BTreeSet<String>) {
    let mut robot = robot_under(machine, &Settings { seed, ..Settings::default() });
    let (mut commands, mut states) = (Vec::new(), BTreeSet::new());
    let observe = |control: &Control, command: Command, tick: &vibrissa_runtime::machine::Tick, _: &mut _| {
        assert_eq!(tick.status, Status::Running, "{:?}", control.machine().failure());
        let speed = command.velocity_world.norm();
        assert!(speed <= 1.0 + 1e-12 && command.yaw_rate.abs() <= 3.2, "{command:?} is beyond the limits");
        commands.push([command.velocity_world.x, command.velocity_world.y, command.yaw_rate].map(f64::to_bits));
        states.insert(control.machine().state_name().to_owned());
        true
    };
    assert_eq!(robot.run(20_000 * MS, observe).unwrap(), Stopped::Time);
    assert!(robot.take_events().is_empty());
    assert_eq!(Phase::ALL.map(|phase| robot.vitals().missed(phase)), [0; Phase::ALL.len()]);
    (commands, states)
}

#[test]
fn every_compiled_policy_feels_the_grass_through_registers_and_repeats_its_commands_bit_for_bit() {
    for (name, machine, least_states) in ARTIFACTS {
        let (commands, states) = run(machine, 5);
        // The first second goes to the neutral values.
        assert!((565..=570).contains(&commands.len()), "{name}: {} commands", commands.len());
        assert!(states.len() >= least_states, "{name}: {states:?}");
        let moving = commands.iter().filter(|command| **command != [0; 3]).count();
        assert!(2 * moving > commands.len(), "{name} commands {moving} motions");
        assert!(run(machine, 5).0 == commands, "{name} gives other commands for the same seed");
    }
}
