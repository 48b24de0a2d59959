//! The policy language: compiling the thesis's policy, and a tick of it beside the same law written in Rust by hand.
//!
//! To be reached: compiling within 2 ms, a tick within 1 µs and within three times the one by hand.

#![allow(missing_docs, reason = "criterion's macros write undocumented items")]

mod disk;
mod recorded;
mod thesis;

use std::error::Error;
use std::hint::black_box;

use criterion::{Criterion, Throughput};
use disk::Disk;
use recorded::{Felt, Recorded};
use thesis::{State, Thesis};
use vibrissa::machine::{Action, Machine, Turn};
use vibrissa::policy::{compile, compile_with_warnings};
use vibrissa::world::World;

/// Ticks in a row: enough that the clock costs nothing, and few enough that what they felt stays in the cache.
const TICKS: usize = 32;

fn main() -> Result<(), Box<dyn Error>> {
    let disk = Disk::load()?;
    let mut criterion = Criterion::default().configure_from_args();

    let source = Disk::policy()?;
    let mut group = criterion.benchmark_group("compile");
    group.bench_function("program", |bencher| bencher.iter(|| compile(black_box(&source))));
    group.bench_function("warnings too", |bencher| bencher.iter(|| compile_with_warnings(black_box(&source))));
    group.finish();

    let parameter = |name: &str| {
        let index = disk.program.parameters.iter().position(|parameter| parameter.name == name);
        index.map(|index| disk.program.image[index]).ok_or_else(|| format!("the policy has no parameter `{name}`"))
    };
    let target = parameter("target")?;
    let disk::Swiping { mut world, mut control, samples } = disk.swiping()?;
    let by_hand = Thesis {
        speed: parameter("speed")?,
        target,
        limit: parameter("limit")?,
        lost: parameter("lost")?,
        state: State::Swiping { whisker: 0, untouched_since: None },
    };
    let machine = control.machine().clone();
    let (mut command, _) = control.tick(&samples);
    let mut run = Vec::with_capacity(TICKS);
    for _ in 0..TICKS {
        (command, _) = control.tick(world.advance(&command)?);
        run.push(Recorded::after(&control, target));
    }
    agree(&machine, &by_hand, &run);

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
            let mut by_hand = by_hand.clone();
            bencher.iter(|| in_turn(&run, after, |senses| by_hand.tick(senses)));
        });
        group.finish();
    }

    // What a robot pays: the same, asking perception itself, which computes what it is asked for.
    let felt = control.perception();
    let mut group = criterion.benchmark_group("policy_tick_and_perception");
    group.bench_function("machine", |bencher| {
        let (mut machine, mut felt) = (machine.clone(), felt.clone());
        bencher.iter(|| black_box(machine.tick(black_box(&mut felt))));
    });
    group.bench_function("by hand", |bencher| {
        let (mut by_hand, mut felt) = (by_hand.clone(), felt.clone());
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
            && let Some((_, [x, _, _, heading])) = steering(action)
        {
            command = zero * (x + heading);
        }
        black_box(action);
    }
}

/// Panics unless the compiled policy and the one by hand do the same, and swipe throughout.
fn agree(machine: &Machine, by_hand: &Thesis, run: &[Recorded]) {
    let (mut machine, mut by_hand) = (machine.clone(), by_hand.clone());
    for recorded in run {
        let mut senses = Felt { recorded, command: 0.0 };
        let compiled = machine.tick(&mut senses).action;
        let expected = by_hand.tick(&mut senses);
        assert_eq!(machine.state_name(), "Swiping");
        let (Some((mover, numbers)), Some((expected_mover, expected_numbers))) =
            (steering(compiled), steering(expected))
        else {
            panic!("not a steering: {compiled:?} or {expected:?}")
        };
        assert_eq!(mover, expected_mover);
        for (number, expected) in numbers.iter().zip(expected_numbers) {
            assert!((number - expected).abs() <= 1e-12, "{compiled:?} is not {expected:?}");
        }
    }
}

/// What a steering action that faces a heading moves, and its numbers.
fn steering(action: Action) -> Option<(vibrissa::machine::Mover, [f64; 4])> {
    match action {
        Action::Steer { mover, along_world, speed, turn: Turn::Facing(heading) } => {
            Some((mover, [along_world.x, along_world.y, speed, heading]))
        }
        _ => None,
    }
}
