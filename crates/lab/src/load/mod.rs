//! Reading the files that a command names: scenarios, policies, contact sets, recordings.

mod error;
mod mismatch;
mod policy;
#[cfg(feature = "robot")]
mod recording;
mod scenario;
mod seed;
mod sought;
mod text;

pub use error::LoadError;
pub use mismatch::GivenMismatch;
pub use mismatch::UNCALIBRATED;
pub use policy::library_for_editor;
pub use policy::{
    Policy, PolicyFile, PolicyText, built_in_policy, chart, named_by_built_in, policy, policy_file, policy_for,
    policy_in, policy_text, program, set, tested_policy, with_libraries, with_settings,
};
#[cfg(feature = "robot")]
pub use recording::recording;
pub use scenario::{
    beside, built_in_scenario, contact_sets, count_sets, drawn_scenes, family, outline_file, rig_in, scenario,
    scenario_in, scenario_text, timed_readings, touch_file, touches,
};
pub use seed::{WithoutEffect, check_noise_seed};
pub use sought::{Sought, is_scenario};
pub use text::{read, read_standard};

use sha2::Sha256;

/// A value that was read from a file, with a hash of the file.
pub struct Loaded<T> {
    /// The value.
    pub value: T,
    /// The hash of the text.
    pub hash: Sha256,
}
