//! A robot for tests.

use std::sync::Arc;

use vibrissa_robot::config::Config;
use vibrissa_robot::emulation::{Emulation, Settings, SwayingPlant};
use vibrissa_runtime::control::Control;
use vibrissa_runtime::machine::Artifact;
use vibrissa_runtime::rig::Rig;

/// The policy `bang`, compiled.
pub(crate) const MACHINE: &[u8] = include_bytes!("../../../runtime/fixtures/bang.machine");

/// The configuration of the reference rig.
pub(crate) fn config(settings: &Settings) -> Config {
    Config::emulated(Rig::default(), settings.noise_microtesla)
}

/// The reference rig under the policy `bang`, among swaying grass.
pub(crate) fn robot(settings: &Settings) -> Emulation<SwayingPlant> {
    let config = config(settings);
    let artifact = Artifact::from_bytes(MACHINE).unwrap();
    let control = Control::new(&config.rig, Arc::new(artifact.program)).unwrap();
    let plant = SwayingPlant::new(config.rig.sensing.sample_rate.recip());
    Emulation::new(&config, control, plant, settings).unwrap()
}

/// Milliseconds in nanoseconds.
pub(crate) const MS: u64 = 1_000_000;
