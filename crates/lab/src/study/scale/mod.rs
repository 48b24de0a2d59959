//! Cost against size: processor time along several axes, and what a sweep of a million runs costs.
//!
//! `axis` has the table of the axes. A new axis is one entry there, with a function that makes its cases.

mod axis;
mod case;
mod error;
mod exponent;
mod job;
mod measure;
mod policy;
mod result_lines;
mod row;
mod scene;
mod sweep_cost;

pub use axis::{Axis, axes};
pub use error::ScaleError;
pub use measure::{measure, steps};
pub use row::{Scale, ScaleRow, SizeTime};
pub use sweep_cost::SweepCost;
