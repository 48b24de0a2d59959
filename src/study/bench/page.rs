//! The bench as a page for a browser.

use std::fmt::Write;

use crate::scene::Outcome;

use super::row::{BenchRow, Verdict};
use super::table::{HEADINGS, cells};

const HEAD: &str = "<!DOCTYPE html>
<html lang=\"en\">
<meta charset=\"utf-8\">
<title>Vibrissa bench</title>
<style>
body { font: 15px/1.5 system-ui, sans-serif; color: #1f2933; max-width: 1240px; margin: 2em auto; padding: 0 1em }
table { border-collapse: collapse; font-variant-numeric: tabular-nums }
th, td { padding: .2em .7em; text-align: right; white-space: nowrap; border-bottom: 1px solid #e4e7eb }
th:nth-child(-n+3), td:nth-child(-n+3) { text-align: left }
.better { color: #00734f } .worse { color: #c2410c; font-weight: 600 }
.wide { overflow-x: auto } img { width: 100%; border: 1px solid #e4e7eb }
</style>
";

/// A page with the table of the bench and a picture (SVG) of every run: one file that needs no other.
#[must_use]
pub fn bench_page(rows: &[BenchRow], pictures: &[String]) -> String {
    let passed = rows.iter().filter(|row| row.passed).count();
    let mut page = format!(
        "{HEAD}<h1>Vibrissa bench</h1>\n<p>{passed} of {} runs completed with no figure worse than the thesis's. Figures are \
         mean ± sample standard deviation; those of the thesis, which has neither friction nor noise, stand beside. A run under \
         friction or noise only has to complete; its tip model knows the coefficient.</p>\n<div class=\"wide\"><table>\n<tr>",
        rows.len()
    );
    // Writing to a string cannot fail.
    for heading in HEADINGS {
        let _ = write!(page, "<th>{heading}</th>");
    }
    page.push_str("</tr>\n");
    for (index, row) in rows.iter().enumerate() {
        page.push_str("<tr>");
        for (column, (text, verdict)) in cells(row).into_iter().enumerate() {
            let class = match verdict {
                Some(Verdict::Better) => " class=\"better\"",
                Some(Verdict::Worse) => " class=\"worse\"",
                None if column == 2 && row.result.outcome != Outcome::Completed => " class=\"worse\"",
                None => "",
            };
            let text = escaped(&text);
            // The name of the scene leads to its picture.
            let text = if column == 0 { format!("<a href=\"#run{index}\">{text}</a>") } else { text };
            let _ = write!(page, "<td{class}>{text}</td>");
        }
        page.push_str("</tr>\n");
    }
    page.push_str("</table></div>\n");
    for (index, (row, picture)) in rows.iter().zip(pictures).enumerate() {
        let title = escaped(&format!("{}, {}", row.scene(), row.result.policy));
        let _ = write!(
            page,
            "<h2 id=\"run{index}\">{title}</h2>\n{}<img alt=\"{title}\" src=\"data:image/svg+xml,{}\">\n",
            row.result.reason.as_ref().map_or_else(String::new, |reason| format!("<p>{}</p>\n", escaped(reason))),
            percent_encoded(picture)
        );
    }
    page
}

fn escaped(text: &str) -> String {
    text.replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;").replace('"', "&quot;")
}

/// A text as part of an address. Pictures are embedded so, and not as they are, because their names would be the same.
fn percent_encoded(text: &str) -> String {
    let mut encoded = String::with_capacity(text.len() + text.len() / 2);
    for byte in text.bytes() {
        match byte {
            b'a'..=b'z' | b'A'..=b'Z' | b'0'..=b'9' | b'-' | b'.' | b'_' | b'~' | b' ' | b'=' | b'/' | b':' | b',' => {
                encoded.push(char::from(byte));
            }
            _ => {
                let _ = write!(encoded, "%{byte:02X}");
            }
        }
    }
    encoded
}
