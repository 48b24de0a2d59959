//! The latency of a control tick: perception, machine and steering, on the samples of real runs.

#![allow(missing_docs, reason = "criterion's macros write undocumented items")]

mod stage;

use std::error::Error;
use std::hint::black_box;

use criterion::{BatchSize, Criterion, Throughput};
use stage::{SETTLED, Stage, Tape};

/// Ticks after which the platform goes along the middle of the tunnel.
const IN_TUNNEL: usize = 600;

fn main() -> Result<(), Box<dyn Error>> {
    let (disk, tunnel) = (Stage::disk()?, Stage::tunnel()?);
    let mut criterion = Criterion::default().configure_from_args();
    let mut group = criterion.benchmark_group("control_tick");
    for (name, stage, settled) in [("exploring", &disk, 0), ("swiping", &disk, SETTLED), ("tunnel", &tunnel, IN_TUNNEL)]
    {
        let Tape { control, ticks } = stage.swiping(settled)?.recorded()?;
        group.throughput(Throughput::Elements(ticks.len() as u64));
        group.bench_function(name, |bencher| {
            bencher.iter_batched_ref(
                || control.clone(),
                |control| {
                    for samples in &ticks {
                        black_box(control.tick(black_box(samples)));
                    }
                },
                BatchSize::SmallInput,
            );
        });
    }
    group.finish();
    criterion.final_summary();
    Ok(())
}
