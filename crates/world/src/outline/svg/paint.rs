//! Whether a shape can be seen: its visibility, its fill and its stroke.

use std::collections::HashMap;

use roxmltree::Node;
use svgtypes::{Length, Paint, PaintFallback};

use super::styles::Styles;

/// The properties that an element inherits.
#[derive(Copy, Clone, Debug)]
pub(super) struct Look {
    is_visible: bool,
    fill: Coat,
    stroke: Coat,
    has_width: bool,
    /// True if everything is read, whatever its properties are.
    is_forced: bool,
}

/// A fill or a stroke.
#[derive(Copy, Clone, Debug)]
struct Coat {
    has_colour: bool,
    is_opaque: bool,
}

impl Look {
    /// The initial values of the standard: a shape is filled and has no stroke.
    pub(super) fn initial() -> Self {
        Self {
            is_visible: true,
            fill: Coat { has_colour: true, is_opaque: true },
            stroke: Coat { has_colour: false, is_opaque: true },
            has_width: true,
            is_forced: false,
        }
    }

    /// The look of an element with this one outside. `named` are the elements with an id.
    pub(super) fn inner(self, node: Node<'_, '_>, named: &HashMap<&str, Node<'_, '_>>, styles: &Styles) -> Self {
        Self {
            is_visible: visibility(node, styles).unwrap_or(self.is_visible),
            fill: Coat {
                has_colour: has_colour(node, "fill", true, self.fill.has_colour, (named, styles)),
                is_opaque: is_opaque(node, "fill-opacity", styles).unwrap_or(self.fill.is_opaque),
            },
            stroke: Coat {
                has_colour: has_colour(node, "stroke", false, self.stroke.has_colour, (named, styles)),
                is_opaque: is_opaque(node, "stroke-opacity", styles).unwrap_or(self.stroke.is_opaque),
            },
            has_width: has_width(node, styles).unwrap_or(self.has_width),
            ..self
        }
    }

    /// The same look, but visible.
    pub(super) fn shown(self) -> Self {
        Self { is_visible: true, ..self }
    }

    /// The same look, but everything is read.
    pub(super) fn forced(self) -> Self {
        Self { is_forced: true, ..self }
    }

    /// True if a shape with this look can be seen. A line encloses nothing that could be filled.
    pub(super) fn shows(self, shape: Node<'_, '_>) -> bool {
        let is_painted = |coat: Coat| coat.has_colour && coat.is_opaque;
        let is_filled = is_painted(self.fill) && shape.tag_name().name() != "line";
        self.is_forced || (self.is_visible && (is_filled || (is_painted(self.stroke) && self.has_width)))
    }
}

/// True if an element is not drawn with all its content, whatever the properties of the content are.
pub(super) fn is_undrawn(node: Node<'_, '_>, styles: &Styles) -> bool {
    styles.property(node, "display").is_some_and(|value| value.eq_ignore_ascii_case("none"))
}

/// True if an element is fully transparent with all its content.
pub(super) fn is_transparent(node: Node<'_, '_>, styles: &Styles) -> bool {
    is_opaque(node, "opacity", styles) == Some(false)
}

/// The visibility that an element states itself.
fn visibility(node: Node<'_, '_>, styles: &Styles) -> Option<bool> {
    match styles.property(node, "visibility")?.to_ascii_lowercase().as_str() {
        "hidden" | "collapse" => Some(false),
        "visible" | "initial" => Some(true),
        _ => None,
    }
}

/// True if a fill or a stroke has a colour that is not transparent, or a pattern that exists.
fn has_colour(
    node: Node<'_, '_>,
    name: &str,
    initial: bool,
    inherited: bool,
    (named, styles): (&HashMap<&str, Node<'_, '_>>, &Styles),
) -> bool {
    let Some(value) = styles.property(node, name) else { return inherited };
    let lower = value.to_ascii_lowercase();
    let paint = match lower.as_str() {
        "none" | "transparent" => return false,
        "initial" => return initial,
        "currentcolor" => return true,
        // The name of an element has its case.
        _ if lower.starts_with("url") => Paint::from_str(value),
        _ => Paint::from_str(&lower),
    };
    match paint {
        Ok(Paint::None) => false,
        Ok(Paint::Inherit) => inherited,
        Ok(Paint::CurrentColor | Paint::ContextFill | Paint::ContextStroke) => true,
        Ok(Paint::Color(colour)) => colour.alpha > 0,
        Ok(Paint::FuncIRI(id, fallback)) => {
            named.contains_key(id)
                || match fallback {
                    None | Some(PaintFallback::None) => false,
                    Some(PaintFallback::CurrentColor) => true,
                    Some(PaintFallback::Color(colour)) => colour.alpha > 0,
                }
        }
        // A function of a newer standard is a colour. Any other value is invalid, and so it does not hold.
        Err(_) => inherited || lower.contains('('),
    }
}

/// True if an opacity is positive. `None` if the element does not state it.
fn is_opaque(node: Node<'_, '_>, name: &str, styles: &Styles) -> Option<bool> {
    let value = styles.property(node, name)?;
    if value.eq_ignore_ascii_case("initial") {
        return Some(true);
    }
    let number: f64 = value.strip_suffix('%').unwrap_or(value).trim().parse().ok()?;
    Some(number > 0.0)
}

/// True if the width of a stroke is positive. `None` if the element does not state it.
fn has_width(node: Node<'_, '_>, styles: &Styles) -> Option<bool> {
    let value = styles.property(node, "stroke-width")?.to_ascii_lowercase();
    if value == "initial" {
        return Some(true);
    }
    let Length { number, .. } = value.parse().ok()?;
    // A negative width is invalid.
    (number >= 0.0).then_some(number > 0.0)
}
