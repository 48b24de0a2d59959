//! Perception of two whiskers that swipe the walls of a tunnel, by each tip model: one tick of samples, and what a policy records of it.

#![allow(missing_docs, reason = "criterion's macros write undocumented items")]

mod stage;

use std::error::Error;
use std::hint::black_box;

use criterion::{BatchSize, Criterion, Throughput};
use stage::Stage;
use vibrissa_runtime::machine::{ContactEstimatorKind, Senses};
use vibrissa_runtime::percept::Perception;

/// Ticks after which the platform goes along the middle of the tunnel.
const IN_TUNNEL: usize = 600;

fn main() -> Result<(), Box<dyn Error>> {
    let mut tunnel = Stage::tunnel()?;
    // For the model of two channels.
    tunnel.scene.rig.sensing.forces = true;
    let ticks = tunnel.swiping(IN_TUNNEL)?.recorded()?.ticks;
    // By the first of them the touches become known.
    let (before, ticks) = ticks.split_at(ticks.len() / 2);
    let mut criterion = Criterion::default().configure_from_args();
    let mut group = criterion.benchmark_group("perception");
    group.throughput(Throughput::Elements(ticks.len() as u64));
    for kind in ContactEstimatorKind::ALL {
        let mut perception = Perception::new(&tunnel.scene.rig, &[Some(0), Some(1)], &[kind; 2])?;
        for samples in before {
            perception.update(samples);
        }
        group.bench_function(kind.name(), |bencher| {
            bencher.iter_batched_ref(
                || perception.clone(),
                |perception| {
                    for samples in ticks {
                        perception.update(black_box(samples));
                        (0..2).for_each(|whisker| perception.record(whisker));
                        black_box(&perception);
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
