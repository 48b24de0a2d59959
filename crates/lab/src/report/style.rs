//! Colours and type of the pictures.

use svg::node::element::{Line, Rectangle, Text, Title};

/// A font stack that is available on every system.
const FONT: &str = "system-ui, -apple-system, 'Segoe UI', Roboto, 'Helvetica Neue', Arial, sans-serif";

/// A monospaced font stack that is available on every system.
pub(super) const CODE_FONT: &str = "ui-monospace, SFMono-Regular, Menlo, Consolas, 'DejaVu Sans Mono', monospace";

/// Text and outlines.
pub(super) const INK: &str = "#1f2933";
/// Secondary text and frames.
pub(super) const GREY: &str = "#616e7c";
/// Grid lines.
pub(super) const GRID: &str = "#e4e7eb";
/// The inside of the object.
pub(super) const SOLID: &str = "#f1f3f5";
/// The platform and its path.
pub(super) const PLATFORM: &str = "#52606d";
/// The inside of the platform.
pub(super) const PLATFORM_FILL: &str = "#cbd2d9";
/// The untraced parts of the object.
pub(super) const UNTRACED: &str = "#f8c4ae";
/// Ground that a map has proved free.
pub(super) const FREE_GROUND: &str = "#d8efdf";
/// Ground that a map has blocked.
pub(super) const BLOCKED_GROUND: &str = "#a99bc9";
/// The route and the next target of a map.
pub(super) const ROUTE: &str = "#1864ab";
/// The state of failure.
pub(super) const FAILURE: &str = "#f0846a";
/// The axis of a tunnel.
pub(super) const AXIS: &str = "#c2185b";
/// Errors and failures.
pub(super) const ALARM: &str = "#c2410c";

/// One colour for each whisker (Okabe and Ito's, for colour-blind people too).
pub const WHISKERS: [&str; 8] =
    ["#0072b2", "#e69f00", "#cc79a7", "#56b4e9", "#009e73", "#8c510a", "#d55e00", "#666666"];

/// Alignment of a text relative to its position.
#[derive(Clone, Copy)]
pub(super) enum Anchor {
    Start,
    Middle,
    End,
}

/// A line of text in `colour` and `size` (px), its baseline at (`x`, `y`).
pub(super) fn text(x: f64, y: f64, anchor: Anchor, size: f64, colour: &str, content: &str) -> Text {
    let anchor = match anchor {
        Anchor::Start => "start",
        Anchor::Middle => "middle",
        Anchor::End => "end",
    };
    Text::new(printable(content))
        .set("x", px(x))
        .set("y", px(y))
        .set("text-anchor", anchor)
        .set("font-size", px(size))
        .set("fill", colour)
}

/// A straight line.
pub(super) fn line(from: (f64, f64), to: (f64, f64), colour: &str, width: f64) -> Line {
    Line::new()
        .set("x1", px(from.0))
        .set("y1", px(from.1))
        .set("x2", px(to.0))
        .set("y2", px(to.1))
        .set("stroke", colour)
        .set("stroke-width", px(width))
}

/// The approximate width (px) of a text. It is an upper estimate because no font is available.
pub(super) fn width_of(content: &str, size: f64) -> f64 {
    0.6 * size * content.chars().count() as f64
}

/// A white sheet of a width and a height (px), with a title for screen readers.
pub(super) fn sheet((width, height): (f64, f64), title: &str) -> svg::Document {
    svg::Document::new()
        .set("width", px(width))
        .set("height", px(height))
        .set("viewBox", format!("0 0 {} {}", px(width), px(height)))
        .set("font-family", FONT)
        .set("role", "img")
        .add(Title::new(printable(title)))
        .add(Rectangle::new().set("width", "100%").set("height", "100%").set("fill", "#ffffff"))
}

/// The text without the characters that XML does not permit.
pub(super) fn printable(content: &str) -> String {
    let allowed = |c: char| !c.is_control() && c != '\u{fffe}' && c != '\u{ffff}';
    content.chars().map(|c| if allowed(c) { c } else { ' ' }).collect()
}

/// A length (px) to a hundredth, in the shortest form.
pub(super) fn px(length: f64) -> String {
    let text = format!("{length:.2}");
    let text = text.trim_end_matches('0').trim_end_matches('.');
    if text == "-0" { "0".to_owned() } else { text.to_owned() }
}
