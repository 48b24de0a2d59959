//! The frame of a page.

use maud::{DOCTYPE, Markup, PreEscaped, html};

use super::provenance::{origin, subject};
use crate::results::Provenance;

/// The style sheet of every page, from `web/src/report`.
const STYLE: &str = include_str!(concat!(env!("CARGO_MANIFEST_DIR"), "/web/dist/report.css"));
/// The script of every page, from `web/src/report`.
const SCRIPT: &str = include_str!(concat!(env!("CARGO_MANIFEST_DIR"), "/web/dist/report.js"));

/// A page with its title, the origin of its figures, an introduction and its sections. It needs no other file.
pub(super) fn page(kind: &str, provenance: &Provenance, introduction: &Markup, sections: &Markup) -> String {
    let subject = subject(provenance);
    let title = if subject.is_empty() { kind.to_owned() } else { format!("{kind}: {subject}") };
    let page = html! {
        (DOCTYPE)
        html lang="en" {
            head {
                meta charset="utf-8";
                meta name="viewport" content="width=device-width, initial-scale=1";
                meta name="color-scheme" content="light dark";
                title { (title) ", " (provenance.date) }
                style { (PreEscaped(STYLE)) }
            }
            body {
                main {
                    h1 { (title) }
                    (introduction)
                    (sections)
                    (origin(provenance))
                }
                footer { "Written by vibrissa " (provenance.version) ", " (provenance.date) "." }
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
    fn neither_the_script_nor_the_style_sheet_ends_its_element() {
        assert!(!SCRIPT.to_lowercase().contains("</script") && !SCRIPT.contains("<!--"));
        assert!(!STYLE.contains("</"));
    }

    #[test]
    fn a_title_is_escaped() {
        let page = page("a <b> & \"c\"", &Provenance::default(), &html! {}, &html! {});
        assert!(page.contains("<h1>a &lt;b&gt; &amp; &quot;c&quot;</h1>"), "{page}");
    }
}
