//! Scenarios, benchmarks and a policy language for whisker-based active touch.

pub mod diagnostic;
pub mod geometry;
pub mod scene;
pub mod units;
