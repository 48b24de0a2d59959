//! An actuator that does nothing.

use super::actuator::{Actuator, LinkError};
use super::command_packet::CommandPacket;

/// An actuator without a robot. It serves for tests of the array.
#[derive(Debug, Default, Clone, Copy)]
pub struct DryRun;

impl Actuator for DryRun {
    fn send(&mut self, _packet: &CommandPacket) -> Result<(), LinkError> {
        Ok(())
    }

    fn acknowledged_ns(&mut self, _now_ns: u64) -> Option<u64> {
        None
    }
}
