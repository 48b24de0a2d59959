//! Scenarios, benchmarks and a policy language for whisker-based active touch.

pub mod geometry;
