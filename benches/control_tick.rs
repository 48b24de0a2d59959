//! The latency of one control tick: perception, machine and steering, on the samples of a real run.

#![allow(missing_docs, reason = "criterion's macros write undocumented items")]

mod disk;

use std::error::Error;
use std::hint::black_box;

use criterion::{BatchSize, Criterion};
use disk::Disk;
use vibrissa::signal::Command;
use vibrissa::world::World;

fn main() -> Result<(), Box<dyn Error>> {
    let disk = Disk::load()?;
    let swiping = disk.swiping()?;

    let mut criterion = Criterion::default().configure_from_args();
    let mut group = criterion.benchmark_group("control_tick");
    group.bench_function("swiping", |bencher| {
        bencher.iter_batched_ref(
            || swiping.control.clone(),
            |control| black_box(control.tick(black_box(&swiping.samples))),
            BatchSize::SmallInput,
        );
    });
    let (exploring, mut world) = (disk.control()?, disk.world()?);
    let samples = world.advance(&Command::STOP)?;
    group.bench_function("exploring", |bencher| {
        bencher.iter_batched_ref(
            || exploring.clone(),
            |control| black_box(control.tick(black_box(samples))),
            BatchSize::SmallInput,
        );
    });
    group.finish();
    criterion.final_summary();
    Ok(())
}
