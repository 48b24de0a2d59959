//! Motion: actions to commands.

mod pose_hold;
mod steering;
