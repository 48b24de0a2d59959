//! The user unit of a document.

use roxmltree::Node;
use svgtypes::{Length, LengthUnit, ViewBox};

use super::super::transform::Transform;
use super::super::{OutlineError, OutlineFault};

/// The largest relative difference of the scales of width and height, because their digits are rounded.
const EVEN: f64 = 1e-4;

/// The transform of the document's coordinates, y up. A user unit is `unit` (m), or follows from width, height and view
/// box.
pub(super) fn transform(root: Node<'_, '_>, unit: Option<f64>) -> Result<Transform, OutlineError> {
    let unit = unit.or_else(|| unit_of(root)).ok_or(OutlineFault::NoUnit)?;
    // The y axis of the file points down.
    Ok(Transform::scaled(unit).inner([1.0, 0.0], [0.0, -1.0], [0.0, 0.0]))
}

/// The user unit (m), if width and height are physical lengths and the view box gives their number of units.
fn unit_of(root: Node<'_, '_>) -> Option<f64> {
    let view: ViewBox = root.attribute("viewBox")?.parse().ok()?;
    let paper = |name| metres(root.attribute(name)?.parse().ok()?);
    let (across, up) = (paper("width")? / view.w, paper("height")? / view.h);
    ((across - up).abs() <= EVEN * across).then_some(across)
}

/// A physical length (m).
fn metres(length: Length) -> Option<f64> {
    let unit = match length.unit {
        LengthUnit::Mm => 1e-3,
        LengthUnit::Cm => 1e-2,
        LengthUnit::In => 25.4e-3,
        LengthUnit::Pt => 25.4e-3 / 72.0,
        LengthUnit::Pc => 25.4e-3 / 6.0,
        LengthUnit::None | LengthUnit::Px | LengthUnit::Em | LengthUnit::Ex | LengthUnit::Percent => return None,
    };
    Some(length.number * unit)
}
