//! Constructors of common contours.

mod circle;
mod concave_corner;
mod convex_corner;
mod error;
mod path;
mod polar_curve;
mod polygon;
mod regular_polygon;
mod rounded_rectangle;
mod tunnel;
mod tunnel_axis;

pub use circle::circle;
pub use concave_corner::concave_corner;
pub use convex_corner::convex_corner;
pub use error::ShapeError;
pub use path::Path;
pub(crate) use polar_curve::polar_curve_pieces;
pub use polar_curve::{Harmonic, polar_curve};
pub use polygon::polygon;
pub use regular_polygon::regular_polygon;
pub use rounded_rectangle::rounded_rectangle;
pub use tunnel::{CentreLine, Corners, Opening, Tunnel};
pub use tunnel_axis::TunnelAxis;
