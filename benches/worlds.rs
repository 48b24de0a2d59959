//! The time of one control period in each world, swiping round the disk: world, perception, policy and steering.

#![allow(missing_docs, reason = "criterion's macros write undocumented items")]

mod stage;

use std::error::Error;

use criterion::{Criterion, Throughput};
use stage::{SETTLED, Stage};
use vibrissa::quasi_static::QuasiStaticWorld;
use vibrissa::world::World;
use vibrissa_runtime::signal::Command;

fn main() -> Result<(), Box<dyn Error>> {
    let disk = Stage::disk()?;
    let scene = &disk.scene;
    let quasi_static = QuasiStaticWorld::new(&scene.rig, &scene.physics, &scene.solids, scene.start, 0)?;
    let worlds: [(&str, Box<dyn World>); 2] =
        [("mujoco", Box::new(disk.world()?)), ("quasistatic", Box::new(quasi_static))];
    let mut criterion = Criterion::default().configure_from_args();
    let mut group = criterion.benchmark_group("worlds");
    // One element is a simulated millisecond: the rate over a thousand is simulated seconds a second.
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "a small positive number")]
    group.throughput(Throughput::Elements((1000.0 / scene.rig.sensing.control_rate) as u64));
    for (name, mut world) in worlds {
        let mut control = disk.control()?;
        let mut command = Command::STOP;
        let mut tick = || {
            let samples = world.advance(&command);
            assert!(samples.is_ok());
            (command, _) = control.tick(samples.unwrap_or_default());
        };
        (0..SETTLED).for_each(|_| tick());
        group.bench_function(name, |bencher| bencher.iter(&mut tick));
    }
    group.finish();
    criterion.final_summary();
    Ok(())
}
