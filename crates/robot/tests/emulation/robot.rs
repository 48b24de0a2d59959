//! A robot for tests.

use std::sync::Arc;

use vibrissa_robot::admission::{Device, admit};
use vibrissa_robot::config::Config;
use vibrissa_robot::emulation::{Emulation, Settings, SwayingPlant};
use vibrissa_runtime::control::Control;
use vibrissa_runtime::machine::Artifact;
use vibrissa_runtime::rig::Rig;

/// The artifact of the policy `bang`.
pub(crate) const MACHINE: &[u8] = include_bytes!("../../../runtime/fixtures/bang.machine");

/// The configuration of the reference rig.
pub(crate) fn config(settings: &Settings) -> Config {
    Config::emulated(Rig::default(), settings.noise_microtesla)
}

/// The reference rig under the policy `bang`, among swaying grass.
pub(crate) fn robot(settings: &Settings) -> Emulation<SwayingPlant> {
    robot_under(MACHINE, settings)
}

/// The reference rig under a compiled policy, among swaying grass.
pub(crate) fn robot_under(machine: &[u8], settings: &Settings) -> Emulation<SwayingPlant> {
    admitted(Artifact::from_bytes(machine).unwrap(), settings, |_| 0.0)
}

/// The robot with a machine that a device admits, which has this longest tick (s) for a number of rounds.
pub(crate) fn admitted(
    artifact: Artifact,
    settings: &Settings,
    tick: impl FnMut(u32) -> f64 + 'static,
) -> Emulation<SwayingPlant> {
    let mut device = Device { tick: Box::new(tick), ..Device::instant() };
    let config = admit(&artifact, &config(settings), &mut device).unwrap().config;
    let control = Control::new(&config.rig, Arc::new(artifact.program)).unwrap();
    let plant = SwayingPlant::new(config.rig.sensing.sample_rate.recip());
    Emulation::new(&config, control, plant, settings).unwrap()
}

/// Milliseconds in nanoseconds.
pub(crate) const MS: u64 = 1_000_000;
