//! The loop as two services, which exchange messages over a broker.
//!
//! The sensor IO reads the buses and the poses, and forwards commands to the actuator. The controller executes the machine. Each
//! of them has the supervisor of the loop, so each stops the platform when the other one is silent.
//!
//! | message | from | content |
//! |---|---|---|
//! | `inputs` | sensor IO | everything that a step of the control task takes: rounds with the raw bytes, and poses |
//! | `command` | controller | the packets of its supervisor |
//! | `acknowledged` | sensor IO | the number of the packet that it has forwarded |

mod input_reader;
mod input_task;
mod inputs;
mod remote_commands;

pub use input_reader::{InputReader, InputsError, controller_config};
pub use input_task::InputTask;
pub use inputs::{Inputs, Session};
pub use remote_commands::RemoteCommands;
