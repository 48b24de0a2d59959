//! Poses, and exact planar contours of segments and circular arcs: lengths, areas, nearest points, signed distances,
//! parallel contours, unions, constructors of shapes.
//!
//! Lengths are in metres, angles in radians. x is to the right, y up. Angles and turns are positive counter-clockwise.
//! All results are computed on the pieces themselves, never on an approximating polyline.

mod arc;
mod arrangement;
mod b_spline;
mod bezier;
mod bounding_box;
mod contour;
mod contour_set;
mod corner;
mod difference;
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
mod texture;
mod tree_point;
mod union;

pub use arc::Arc;
pub use b_spline::BSpline;
pub use bezier::Bezier;
pub use bounding_box::BoundingBox;
pub(crate) use contour::MIN_PIECE_LENGTH;
pub use contour::{Contour, JOIN_TOLERANCE};
pub use contour_set::ContourSet;
pub use corner::Corner;
pub use distance::Nearest;
pub use elliptic_arc::EllipticArc;
pub use error::ContourError;
pub use min_distance::{min_distance, min_distance_down_to};
pub use offset::OffsetError;
pub use piece::Piece;
pub use sample::ContourPoint;
pub use segment::Segment;
pub(crate) use shapes::polar_curve_pieces;
pub use shapes::{
    CentreLine, Corners, Harmonic, Opening, Path, ShapeError, Tunnel, TunnelAxis, circle, concave_corner,
    convex_corner, polar_curve, polygon, regular_polygon, rounded_rectangle,
};
pub use strip::{Side, Strip, StripError};
pub use texture::{Texture, TextureError, TextureKind};
pub use tree_point::{TreePoint, plane_point, tree_point};
pub use union::{TOUCHING, UnionError, United, unite};
pub use vibrissa_runtime::geometry::{Point2, Pose, Vector2, perpendicular, rotate, turn_between, unit, wrap};
