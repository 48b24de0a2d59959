//! A robot for tests.

use std::sync::Arc;

use vibrissa_robot::config::Config;
use vibrissa_robot::emulation::{Emulation, Settings, SwayingPlant};
use vibrissa_runtime::control::Control;
use vibrissa_runtime::machine::Artifact;
use vibrissa_runtime::rig::Rig;

/// The reference rig under the policy `bang`, among swaying grass.
pub(crate) fn robot(settings: &Settings) -> Emulation<SwayingPlant> {
    robot_under(include_bytes!("../../../runtime/fixtures/bang.machine"), settings)
}

/// The reference rig under a compiled policy, among swaying grass.
pub(crate) fn robot_under(machine: &[u8], settings: &Settings) -> Emulation<SwayingPlant> {
    let config = Config::emulated(Rig::default(), settings.noise_microtesla);
    let artifact = Artifact::from_bytes(machine).unwrap();
    let control = Control::new(&config.rig, Arc::new(artifact.program)).unwrap();
    let plant = SwayingPlant::new(config.rig.sensing.sample_rate.recip());
    Emulation::new(&config, control, plant, settings).unwrap()
}

/// Milliseconds in nanoseconds.
pub(crate) const MS: u64 = 1_000_000;
