//! Attributes of elements.

use roxmltree::Node;
use svgtypes::{Length, LengthUnit, Transform};

use super::super::OutlineFault;
use super::super::plane::Plane;

/// User units to the inch, by the standard.
const PER_INCH: f64 = 96.0;

/// A length in user units; `None` if there is no such attribute.
pub(super) fn length(node: Node<'_, '_>, name: &str) -> Result<Option<f64>, OutlineFault> {
    let Some(text) = node.attribute(name) else { return Ok(None) };
    let Length { number, unit } = text.trim().parse().map_err(|_| unreadable(node, name, text))?;
    let scale = match unit {
        LengthUnit::None | LengthUnit::Px => 1.0,
        LengthUnit::In => PER_INCH,
        LengthUnit::Cm => PER_INCH / 2.54,
        LengthUnit::Mm => PER_INCH / 25.4,
        LengthUnit::Pt => PER_INCH / 72.0,
        LengthUnit::Pc => PER_INCH / 6.0,
        LengthUnit::Em | LengthUnit::Ex | LengthUnit::Percent => {
            let what = format!("`{name}=\"{text}\"`, a length that depends on others,");
            return Err(OutlineFault::Unsupported { what, advice: "write it as a number" });
        }
    };
    Ok(Some(number * scale))
}

/// A length in user units, 0 if it is left out.
pub(super) fn length_or_zero(node: Node<'_, '_>, name: &str) -> Result<f64, OutlineFault> {
    Ok(length(node, name)?.unwrap_or(0.0))
}

/// The plane within an element.
pub(super) fn inner(node: Node<'_, '_>, outer: &Plane) -> Result<Plane, OutlineFault> {
    let moved = |style: &str| style.split(';').any(|rule| rule.trim_start().starts_with("transform"));
    if node.attribute("transform-origin").is_some() || node.attribute("style").is_some_and(moved) {
        let what = "a transformation by style or about an origin of its own".to_owned();
        return Err(OutlineFault::Unsupported { what, advice: "write it as a `transform` attribute" });
    }
    let Some(text) = node.attribute("transform") else { return Ok(*outer) };
    let Transform { a, b, c, d, e, f } = text.parse().map_err(|_| unreadable(node, "transform", text))?;
    Ok(outer.inner([a, b], [c, d], [e, f]))
}

/// The report of an attribute's value.
pub(super) fn unreadable(node: Node<'_, '_>, name: &str, text: &str) -> OutlineFault {
    let text: String = text.chars().take(40).collect();
    OutlineFault::Syntax { reason: format!("`{}` has an unreadable `{name}`: `{text}`", node.tag_name().name()) }
}
