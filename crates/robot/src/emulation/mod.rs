//! The loop in emulated time, with emulated sensors on emulated buses.
//!
//! Nothing here waits. A scheduler executes the step functions of all threads in the order of emulated time. A step that
//! takes time, such as a call on a blocked bus, shows its effects only after that time. So a run is deterministic.

mod bus_thread;
mod injection;
mod links;
mod pending_injection;
mod plant;
mod scheduler;
mod swaying_plant;
mod timeline;

pub use injection::{Injection, InjectionKind};
pub use plant::{Plant, PlantFault, PlantState};
pub use scheduler::{Emulation, EmulationError, Settings, Stopped};
pub use swaying_plant::SwayingPlant;
