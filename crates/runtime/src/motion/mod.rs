//! From what a policy asks for to velocities: steering a body or a whisker, turning to a heading.

mod pi_controller;
mod pose_hold;
mod steering;

pub use pi_controller::PiController;
pub use steering::Steering;
