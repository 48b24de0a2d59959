//! Poses, and exact planar contours made of segments and circular arcs: lengths, areas, nearest points, signed
//! distances, parallel contours, unions, shape makers.
//!
//! Lengths are metres, angles radians; x is to the right, y up, angles and turns are positive counter-clockwise.
//! Everything is computed on the pieces themselves, never on a polyline that stands in for them.

mod arc;
mod arrangement;
mod bezier;
mod bounding_box;
mod contour;
mod contour_set;
mod corner;
mod distance;
mod elliptic_arc;
mod error;
mod fit;
mod min_distance;
mod offset;
mod overlap;
mod piece;
mod sample;
mod segment;
mod shapes;
mod simple;
mod strip;
mod union;

pub use arc::Arc;
pub use bezier::Bezier;
pub use bounding_box::BoundingBox;
pub use contour::{Contour, JOIN_TOLERANCE, SHORTEST_PIECE};
pub use contour_set::ContourSet;
pub use corner::Corner;
pub use distance::Nearest;
pub use elliptic_arc::EllipticArc;
pub use error::ContourError;
pub(crate) use min_distance::min_distance;
pub use offset::OffsetError;
pub use piece::Piece;
pub use sample::ContourPoint;
pub use segment::Segment;
pub use shapes::{
    CentreLine, Corners, Harmonic, Opening, Path, ShapeError, Tunnel, TunnelAxis, circle, polar_curve,
    polar_curve_pieces, polygon, regular_polygon, rounded_rectangle,
};
pub use strip::{Side, Strip, StripError};
pub use union::{TOUCHING, UnionError, United, unite};
pub use vibrissa_runtime::geometry::{Point2, Pose, Vector2, perpendicular, rotate, turn_between, unit, wrap};
