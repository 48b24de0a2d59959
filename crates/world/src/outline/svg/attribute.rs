//! Attributes of elements.

use roxmltree::Node;
use svgtypes::{Length, LengthUnit};

use super::super::OutlineFault;
use super::super::transform::Transform;
use super::styles::Styles;

/// User units per inch, by the standard.
const PER_INCH: f64 = 96.0;

/// Attributes that newer drawings may set in a style. Width and height are those of a rectangle. In another style they describe the page
/// layout.
const SIZES: [&str; 8] = ["d", "x", "y", "cx", "cy", "r", "rx", "ry"];

/// A length in user units. `None` without the attribute.
pub(super) fn length(node: Node<'_, '_>, name: &str) -> Result<Option<f64>, OutlineFault> {
    let Some(text) = node.attribute(name) else { return Ok(None) };
    let Length { number, unit } = text.trim().to_ascii_lowercase().parse().map_err(|_| unreadable(node, name, text))?;
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

/// A length in user units, 0 by default.
pub(super) fn length_or_zero(node: Node<'_, '_>, name: &str) -> Result<f64, OutlineFault> {
    Ok(length(node, name)?.unwrap_or(0.0))
}

/// True if a style has syntax that [`Styles`] does not support.
pub(super) fn is_intricate(node: Node<'_, '_>) -> bool {
    node.attribute("style").is_some_and(|style| style.contains("/*") || style.contains('\\'))
}

/// The transform within an element.
pub(super) fn inner(node: Node<'_, '_>, outer: &Transform, styles: &Styles) -> Result<Transform, OutlineFault> {
    for name in ["clip-path", "mask"] {
        if styles.property(node, name).is_some_and(|value| !value.eq_ignore_ascii_case("none")) {
            let what = format!("`{}` with a `{name}`", node.tag_name().name());
            return Err(OutlineFault::Unsupported { what, advice: "cut the shape itself, and take that out" });
        }
    }
    let is_rectangle = node.tag_name().name() == "rect";
    let sizes = || SIZES.iter().chain(if is_rectangle { ["width", "height"].iter() } else { [].iter() });
    let mut declarations = styles.declarations(node);
    if let Some((name, _)) = declarations.find(|(name, _)| sizes().any(|size| name.eq_ignore_ascii_case(size))) {
        let what = format!("`{name}` in a `style`");
        return Err(OutlineFault::Unsupported { what, advice: "write it as an attribute" });
    }
    let moves = |name: &str| {
        let name = name.to_ascii_lowercase();
        name.starts_with("transform") || ["translate", "rotate", "scale"].contains(&name.as_str())
    };
    if node.attribute("transform-origin").is_some() || styles.declarations(node).any(|(name, _)| moves(name)) {
        let what = "a transformation by style or about an origin of its own".to_owned();
        return Err(OutlineFault::Unsupported { what, advice: "write it as a `transform` attribute" });
    }
    let Some(text) = node.attribute("transform") else { return Ok(*outer) };
    let svgtypes::Transform { a, b, c, d, e, f } = text.parse().map_err(|_| unreadable(node, "transform", text))?;
    Ok(outer.inner([a, b], [c, d], [e, f]))
}

/// The error for the value of an attribute.
pub(super) fn unreadable(node: Node<'_, '_>, name: &str, text: &str) -> OutlineFault {
    let text: String = text.chars().take(40).collect();
    OutlineFault::Syntax { reason: format!("`{}` has an unreadable `{name}`: `{text}`", node.tag_name().name()) }
}
