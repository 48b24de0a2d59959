//! The bench as a page for a browser.

use std::fmt::Write;
use std::ops::Range;

use crate::scene::Outcome;

use crate::study::bench::{BenchRow, Verdict};

use super::tables::bench::{HEADINGS, NAMES, cells};

const HEAD: &str = "<!DOCTYPE html>
<html lang=\"en\">
<meta charset=\"utf-8\">
<title>Vibrissa bench</title>
<style>
body { font: 15px/1.5 system-ui, sans-serif; color: #1f2933; max-width: 1240px; margin: 2em auto; padding: 0 1em }
table { border-collapse: collapse; margin-bottom: 2em; font-variant-numeric: tabular-nums }
th, td { padding: .2em .6em; text-align: right; border-bottom: 1px solid #e4e7eb } td { white-space: nowrap }
.name { text-align: left }
.better { color: #00734f } .worse { color: #c2410c; font-weight: 600 }
img { width: 100%; border: 1px solid #e4e7eb }
</style>
";

/// The columns of the two tables: the figures that the baseline reports too with outliers and coverage, and the rest.
/// Both fit on a screen of 1300 pixels.
const TABLES: [[Range<usize>; 2]; 2] = [[0..NAMES, NAMES..12], [0..OUTCOME, 12..HEADINGS.len()]];
/// The column of the outcome.
const OUTCOME: usize = 2;

/// A page with the table of the bench and a picture (SVG) of every run. It needs no other file.
#[must_use]
pub fn bench_page(rows: &[BenchRow], pictures: &[String]) -> String {
    let passed = rows.iter().filter(|row| row.passed).count();
    let mut page = format!(
        "{HEAD}<h1>Vibrissa bench</h1>\n<p>{passed} of {} runs completed with no figure worse than the baseline's. Figures are \
         mean ± sample standard deviation. The baseline has neither friction nor noise. A run with friction or noise only has to \
         complete; its contact estimator knows the coefficient.</p>\n",
        rows.len()
    );
    for columns in TABLES {
        page += &table(rows, &columns);
    }
    for (index, (row, picture)) in rows.iter().zip(pictures).enumerate() {
        let title = escaped(&format!("{}, {}", row.scene(), row.result.policy_label()));
        let _ = write!(
            page,
            "<h2 id=\"run{index}\">{title}</h2>\n{}<img alt=\"{title}\" src=\"data:image/svg+xml,{}\">\n",
            row.result.reason.as_ref().map_or_else(String::new, |reason| format!("<p>{}</p>\n", escaped(reason))),
            percent_encoded(picture)
        );
    }
    page
}

/// A table with some columns of the bench.
fn table(rows: &[BenchRow], columns: &[Range<usize>]) -> String {
    let mut table = "<table>\n<tr>".to_owned();
    let chosen = || columns.iter().cloned().flatten();
    // Writing to a string cannot fail.
    for column in chosen() {
        let class = if column < NAMES { " class=\"name\"" } else { "" };
        let _ = write!(table, "<th{class}>{}</th>", HEADINGS[column]);
    }
    table.push_str("</tr>\n");
    for (index, row) in rows.iter().enumerate() {
        table.push_str("<tr>");
        let cells = cells(row);
        for column in chosen() {
            let (text, verdict) = &cells[column];
            let mut classes = if column < NAMES { vec!["name"] } else { vec![] };
            match verdict {
                Some(Verdict::Better) => classes.push("better"),
                Some(Verdict::Worse) => classes.push("worse"),
                None if column == OUTCOME && row.result.outcome != Outcome::Completed => classes.push("worse"),
                None => {}
            }
            let text = escaped(text);
            // The name of the scene is a link to its picture.
            let text = if column == 0 { format!("<a href=\"#run{index}\">{text}</a>") } else { text };
            let _ = write!(table, "<td class=\"{}\">{text}</td>", classes.join(" "));
        }
        table.push_str("</tr>\n");
    }
    table + "</table>\n"
}

fn escaped(text: &str) -> String {
    text.replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;").replace('"', "&quot;")
}

/// A text as part of an address. Pictures are embedded as addresses because their inner names would otherwise collide.
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
