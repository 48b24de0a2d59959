//! The statechart of a policy, and its three renderings.

mod behaviours;
mod charts;
mod machine;
mod picture;
mod text;
mod view;
