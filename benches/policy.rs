//! The policy language: the compilation of `thesis.fsm` and `vibrissa.fsm`, and a tick of `thesis.fsm` beside the same law written in Rust.
//!
//! To be reached: compiling within 2 ms, a tick within 1 µs and within three times the one by hand.

#![allow(missing_docs, reason = "criterion's macros write undocumented items")]

mod recorded;
mod stage;
mod thesis;

use std::error::Error;
use std::hint::black_box;

use criterion::{Criterion, Throughput};
use recorded::{Felt, Recorded};
use stage::{SETTLED, Stage};
use vibrissa::policy::{compile, compile_with_warnings};
use vibrissa::world::World;
use vibrissa_runtime::machine::{Action, Status, Turn};
use vibrissa_runtime::signal::Command;

/// Ticks in a row: enough that the clock costs nothing, and few enough that what they felt stays in the cache.
const TICKS: usize = 32;

fn main() -> Result<(), Box<dyn Error>> {
    let disk = Stage::disk()?;
    let mut criterion = Criterion::default().configure_from_args();

    let mut group = criterion.benchmark_group("compile");
    for (name, path) in [("", "policies/thesis.fsm"), ("vibrissa ", "policies/vibrissa.fsm")] {
        let source = stage::read(path)?;
        group.bench_function(format!("{name}program"), |bencher| bencher.iter(|| compile(black_box(&source))));
        group.bench_function(format!("{name}warnings too"), |bencher| {
            bencher.iter(|| compile_with_warnings(black_box(&source)));
        });
    }
    group.finish();

    let parameter = |name: &str| {
        let index = disk.program.parameters.iter().position(|parameter| parameter.name == name);
        index
            .map(|index| disk.program.initial_registers[index])
            .ok_or_else(|| format!("the policy has no parameter `{name}`"))
    };
    let mut by_hand = thesis::Following {
        speed: parameter("speed")?,
        target: parameter("target")?,
        limit: parameter("limit")?,
        lost_for: parameter("lost_for")?,
        spring: parameter("spring")?,
        light: parameter("light")?,
        whiskers: [0, 1],
        memory: thesis::Memory::default(),
    };
    // Side by side from the start of following, so that both remember the same.
    let (mut world, mut control, mut command) = (disk.world()?, disk.control()?, Command::STOP);
    let mut ticks = 0;
    while ticks < SETTLED {
        let tick;
        (command, tick) = control.tick(world.advance(&command)?);
        if tick.status != Status::Running {
            return Err("the policy does not follow the disk for long enough".into());
        }
        if control.machine().state_name() == "Following" {
            ticks += 1;
            agree(tick.action, by_hand.tick(&mut felt(&Recorded::after(&control, by_hand.target))));
        }
    }
    let (machine, start) = (control.machine().clone(), by_hand.clone());
    let mut run = Vec::with_capacity(TICKS);
    for _ in 0..TICKS {
        let tick;
        (command, tick) = control.tick(world.advance(&command)?);
        let recorded = Recorded::after(&control, by_hand.target);
        agree(tick.action, by_hand.tick(&mut felt(&recorded)));
        run.push(recorded);
    }

    // One tick after the other, as in a loop; and ticks that have nothing to do with each other, of which the processor does
    // several at a time. The first is what a tick takes.
    let zero = black_box(0.0);
    for (name, after) in [("policy_tick", Some(zero)), ("policy_tick_overlapping", None)] {
        let mut group = criterion.benchmark_group(name);
        group.throughput(Throughput::Elements(TICKS as u64));
        group.bench_function("machine", |bencher| {
            let mut machine = machine.clone();
            bencher.iter(|| in_turn(&run, after, |senses| machine.tick(senses).action));
        });
        group.bench_function("by hand", |bencher| {
            let mut by_hand = start.clone();
            bencher.iter(|| in_turn(&run, after, |senses| by_hand.tick(senses).unwrap_or(Action::Stop)));
        });
        group.finish();
    }

    // What a robot pays: the same, asking perception itself, which computes what it is asked for.
    let perception = control.perception();
    let mut group = criterion.benchmark_group("policy_tick_and_perception");
    group.bench_function("machine", |bencher| {
        let (mut machine, mut felt) = (machine.clone(), perception.clone());
        bencher.iter(|| black_box(machine.tick(black_box(&mut felt))));
    });
    group.bench_function("by hand", |bencher| {
        let (mut by_hand, mut felt) = (start.clone(), perception.clone());
        bencher.iter(|| black_box(by_hand.tick(black_box(&mut felt))));
    });
    group.finish();
    criterion.final_summary();
    Ok(())
}

/// Ticks, each with what was felt in its turn: after the command before it, for a `zero` that the compiler does not know, or
/// whenever the processor likes.
#[inline]
fn in_turn(run: &[Recorded], zero: Option<f64>, mut tick: impl FnMut(&mut Felt<'_>) -> Action) {
    let mut command = 0.0;
    for recorded in run {
        let action = tick(&mut black_box(Felt { recorded, command }));
        if let Some(zero) = zero
            && let Some((_, [x, _, _, rate])) = steering(action)
        {
            command = zero * (x + rate);
        }
        black_box(action);
    }
}

/// What was recorded, as it is felt.
fn felt(recorded: &Recorded) -> Felt<'_> {
    Felt { recorded, command: 0.0 }
}

/// Panics unless the compiled policy and the one by hand do the same.
fn agree(compiled: Action, by_hand: Option<Action>) {
    match (steering(compiled), by_hand.and_then(steering)) {
        (Some((mover, numbers)), Some((expected_mover, expected_numbers))) => {
            assert_eq!(mover, expected_mover);
            for (number, expected) in numbers.iter().zip(expected_numbers) {
                assert!((number - expected).abs() <= 1e-12, "{compiled:?} is not {by_hand:?}");
            }
        }
        _ => assert_eq!(Some(compiled), by_hand),
    }
}

/// What a steering action moves while it turns at a rate, and its numbers.
fn steering(action: Action) -> Option<(vibrissa_runtime::machine::Mover, [f64; 4])> {
    match action {
        Action::Steer { mover, along_world, speed, turn: Turn::Rate(rate) } => {
            Some((mover, [along_world.x, along_world.y, speed, rate]))
        }
        _ => None,
    }
}
