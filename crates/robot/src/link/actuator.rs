//! The receiver of commands.

use vibrissa_runtime::signal::Command;
use vibrissa_text::system::in_words;

use super::command_packet::CommandPacket;

/// A command with its time.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct StampedCommand {
    /// End of the control tick that has computed it (ns).
    pub time_ns: u64,
    /// The command.
    pub command: Command,
}

/// A receiver of commands. The supervisor sends every command through it, so no call may block.
pub trait Actuator: Send {
    /// Sends a command.
    ///
    /// # Errors
    /// [`LinkError`] if it cannot be sent. The supervisor tries again with the next one.
    fn send(&mut self, packet: &CommandPacket) -> Result<(), LinkError>;

    /// Time (ns) at which the newest packet was sent that the receiver has acknowledged. Before the first acknowledgement, it is that
    /// of the first call. `None` if the receiver acknowledges nothing.
    fn acknowledged_ns(&mut self, now_ns: u64) -> Option<u64>;
}

/// A command that could not be sent.
#[derive(Debug, thiserror::Error)]
pub enum LinkError {
    /// The socket has refused it.
    #[error("the command cannot be sent: {words}", words = in_words(.0))]
    Io(#[from] std::io::Error),
    /// The client accepts no more messages.
    #[error("the command cannot be sent: the MQTT client accepts no message")]
    Full,
}
