//! Admission: a device compares its own speed with the needs of a machine before the loop starts.
//!
//! The needs are the whiskers, the rates of the loop, the age of samples and the work of a tick. If the device cannot hold
//! the configured rates, the loop runs at the highest rates that the device holds and the policy allows.

mod admit;
mod demands;
mod device;
mod rates;
mod refusal;
mod slower;

pub use admit::{Admission, admit};
pub use device::Device;
pub use refusal::{Refusal, Shortfall};
pub use slower::Slower;

#[cfg(test)]
mod tests;
