//! Points in files: `[x, y]`.

use serde::{Deserialize, Deserializer, Serialize, Serializer};

use super::Point2;

/// Writes the coordinates of a point.
pub(crate) fn serialize<S: Serializer>(point: &Point2, serializer: S) -> Result<S::Ok, S::Error> {
    [point.x, point.y].serialize(serializer)
}

/// Reads the coordinates of a point.
pub(crate) fn deserialize<'de, D: Deserializer<'de>>(deserializer: D) -> Result<Point2, D::Error> {
    <[f64; 2]>::deserialize(deserializer).map(Point2::from)
}
