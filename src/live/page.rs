//! The page as one text: script and style are parts of it, so that a browser needs no other file.

use maud::{DOCTYPE, PreEscaped, html};

/// The script, from `web/src/live`.
const SCRIPT: &str = include_str!(concat!(env!("CARGO_MANIFEST_DIR"), "/web/dist/live.js"));
/// The style sheet.
const STYLE: &str = include_str!(concat!(env!("CARGO_MANIFEST_DIR"), "/web/dist/live.css"));

/// What the page may do: run its own script and style, and open its own WebSocket. It loads nothing.
pub(super) const POLICY: &str = "default-src 'none'; script-src 'unsafe-inline'; style-src 'unsafe-inline'; connect-src 'self'; \
                                 img-src data: blob:; base-uri 'none'; form-action 'none'; frame-ancestors 'none'";

/// The page.
pub(super) fn page() -> String {
    let page = html! {
        (DOCTYPE)
        html lang="en" {
            head {
                meta charset="utf-8";
                meta name="viewport" content="width=device-width, initial-scale=1";
                meta name="color-scheme" content="light dark";
                link rel="icon" href="data:,";
                title { "vibrissa" }
                style { (PreEscaped(STYLE)) }
            }
            body {
                main id="live" {}
                noscript { "This page needs JavaScript." }
                script { (PreEscaped(SCRIPT)) }
            }
        }
    };
    page.into_string()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_page_is_whole_and_small() {
        assert!(!SCRIPT.to_lowercase().contains("</script") && !SCRIPT.contains("<!--"));
        assert!(!STYLE.contains("</"));
        assert!(page().len() <= 500_000, "{} bytes", page().len());
    }
}
