//! Trials with the robot's own loop: emulated sensors and buses around a simulated rig.

mod trial;
mod world_plant;

pub use trial::{EmulatedError, EmulatedResult, run};
pub use world_plant::WorldPlant;
