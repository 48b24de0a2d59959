//! The time of one control period of simulation, in free air and swiping.

#![allow(missing_docs, reason = "criterion's macros write undocumented items")]

mod stage;

use std::error::Error;
use std::hint::black_box;

use criterion::{Criterion, Throughput};
use stage::{SETTLED, Stage};
use vibrissa::world::World;
use vibrissa_runtime::signal::Command;

fn main() -> Result<(), Box<dyn Error>> {
    let disk = Stage::disk()?;
    let sensing = &disk.scene.rig.sensing;
    let mut criterion = Criterion::default().configure_from_args();
    let mut group = criterion.benchmark_group("sim_step");
    // One element is a simulated millisecond: the rate over a thousand is simulated seconds a second.
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "a small positive number")]
    group.throughput(Throughput::Elements((1000.0 / sensing.control_rate) as u64));

    let mut free = disk.world()?;
    group.bench_function("free", |bencher| {
        bencher.iter(|| assert!(black_box(free.advance(&Command::STOP)).is_ok()));
    });
    // Round and round the disk: the control tick between is a thousandth of the time.
    let stage::Swiping { mut world, mut control, mut command } = disk.swiping(SETTLED)?;
    group.bench_function("swiping", |bencher| {
        bencher.iter(|| {
            let samples = world.advance(&command);
            assert!(samples.is_ok());
            (command, _) = control.tick(samples.unwrap_or_default());
        });
    });
    group.finish();
    criterion.final_summary();
    Ok(())
}
