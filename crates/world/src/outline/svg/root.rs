//! The user unit of a document.

use roxmltree::Node;
use svgtypes::{Align, AspectRatio, Length, LengthUnit, ViewBox};

use super::super::transform::Transform;
use super::super::{OutlineError, OutlineFault};
use super::styles::Styles;

/// The largest relative difference of the scales of width and height that comes from rounding of their digits.
const EVEN: f64 = 1e-4;

/// The transform of the document's coordinates, y up. A user unit is `unit` (m), or follows from width, height and view
/// box.
pub(super) fn transform(root: Node<'_, '_>, unit: Option<f64>, styles: &Styles) -> Result<Transform, OutlineError> {
    let [across, up] = match unit {
        Some(unit) => [unit, unit],
        None => units_of(root, styles)?,
    };
    // The y axis of the file points down.
    Ok(Transform::scaled(1.0).inner([across, 0.0], [0.0, -up], [0.0, 0.0]))
}

/// The lengths (m) of a user unit along x and y, if width and height are physical lengths and the view box gives their number of units.
/// If they give different scales, the drawing is fitted into the frame with one of them, or stretched.
fn units_of(root: Node<'_, '_>, styles: &Styles) -> Result<[f64; 2], OutlineFault> {
    let paper = |attribute| {
        let found = styles.property(root, attribute);
        found.and_then(metres).ok_or_else(|| OutlineFault::NoLength { attribute, found: found.map(shortened) })
    };
    let (width, height) = (paper("width")?, paper("height")?);
    let view: Option<ViewBox> = root.attribute("viewBox").and_then(|text| text.parse().ok());
    let view = view.ok_or(OutlineFault::NoViewBox)?;
    let (across, up) = (width / view.w, height / view.h);
    if (across - up).abs() <= EVEN * across {
        return Ok([across, across]);
    }
    // The standard ignores an invalid value.
    let ratio = root.attribute("preserveAspectRatio").and_then(|text| text.trim().parse::<AspectRatio>().ok());
    Ok(match ratio {
        Some(AspectRatio { align: Align::None, .. }) => [across, up],
        Some(AspectRatio { slice: true, .. }) => [across.max(up); 2],
        _ => [across.min(up); 2],
    })
}

/// A value in a message. Nobody reads a long one.
fn shortened(text: &str) -> String {
    const MOST: usize = 40;
    let mut letters = text.trim().chars();
    let start: String = letters.by_ref().take(MOST).collect();
    if letters.next().is_some() { start + "..." } else { start }
}

/// A physical length (m). Units have any case, and there may be a blank before them.
fn metres(text: &str) -> Option<f64> {
    let text: String = text.chars().filter(|letter| !letter.is_whitespace()).collect::<String>().to_ascii_lowercase();
    // The parser does not know quarter-millimetres.
    if let Some(quarters) = text.strip_suffix('q') {
        return quarters.parse::<f64>().ok().map(|quarters| quarters * 0.25e-3).filter(|length| *length > 0.0);
    }
    let length: Length = text.parse().ok()?;
    let unit = match length.unit {
        LengthUnit::Mm => 1e-3,
        LengthUnit::Cm => 1e-2,
        LengthUnit::In => 25.4e-3,
        LengthUnit::Pt => 25.4e-3 / 72.0,
        LengthUnit::Pc => 25.4e-3 / 6.0,
        LengthUnit::None | LengthUnit::Px | LengthUnit::Em | LengthUnit::Ex | LengthUnit::Percent => return None,
    };
    Some(length.number * unit).filter(|length| *length > 0.0)
}
