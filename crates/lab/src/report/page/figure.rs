//! Figures of a page.

use maud::{Markup, PreEscaped, html};

/// A figure: an SVG by this crate within a page. `name` is that of its exported files. Identifiers within the SVG get the
/// `prefix`, which differs for every figure of a page.
pub(super) fn figure(name: &str, prefix: &str, svg: &str, caption: &Markup, data: Option<&str>) -> Markup {
    html! {
        figure data-name=(name) {
            div.drawing { (PreEscaped(namespaced(svg, prefix))) }
            figcaption { (caption) }
            @if let Some(data) = data { script type="application/json" { (PreEscaped(script_safe(data))) } }
        }
    }
}

/// An SVG whose identifiers begin with a prefix. The writer of this crate's pictures writes them in exactly two forms.
pub(super) fn namespaced(svg: &str, prefix: &str) -> String {
    svg.replace(" id=\"", &format!(" id=\"{prefix}")).replace("url(#", &format!("url(#{prefix}"))
}

/// JSON without the characters that could end the element around it.
fn script_safe(json: &str) -> String {
    json.replace('<', "\\u003c")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn references_within_a_figure_stay_together_and_data_cannot_end_their_element() {
        let svg = "<svg><clipPath id=\"map\"/><g clip-path=\"url(#map)\"/></svg>";
        let figure = figure("a", "r1-", svg, &html! { "b" }, Some("[\"</script>\"]")).into_string();
        assert!(figure.contains("id=\"r1-map\"") && figure.contains("url(#r1-map)"), "{figure}");
        assert!(figure.contains(r#"["\u003c/script>"]"#), "{figure}");
    }
}
