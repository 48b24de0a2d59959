//! Conversion of actions to commands: motion of a body or a whisker, rotation to a heading, pose hold.

mod pi_controller;
mod pose_hold;
mod servo_lead;
mod steering;

pub use pi_controller::PiController;
pub use servo_lead::ServoLead;
pub use steering::Steering;
