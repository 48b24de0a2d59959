//! Points, vectors, angles and poses in the plane.

mod angle;
pub(crate) mod coordinates;
mod pose;

pub use angle::{turn_between, wrap};
pub(crate) use pose::Frame;
pub use pose::{Pose, perpendicular, rotate, unit};

/// A point in the plane (m).
pub type Point2 = nalgebra::Point2<f64>;

/// A vector in the plane.
pub type Vector2 = nalgebra::Vector2<f64>;

/// A 2×2 matrix, for instance a covariance.
pub type Matrix2 = nalgebra::Matrix2<f64>;
