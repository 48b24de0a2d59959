//! The files of the services that store and show the telemetry of a robot: broker, database, dashboard, logs.
//!
//! Some files depend on the policy and on the robot, such as the dashboard. The others are copies of those in `deploy`.

mod alloy;
mod dashboard;
mod describe;
mod environment;
mod files;
mod messages;
mod panel;
mod panels;
mod provisioning;
mod query;
mod telegraf;

pub use files::{ServiceFile, service_files};
pub use messages::{MessagesError, lines_of_messages};
