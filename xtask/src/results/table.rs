//! Tables in Markdown, of values of JSON.

use std::fmt::Write as _;

use crate::json::Json;

/// A key that the output of the program does not have.
#[derive(Debug, PartialEq, Eq, thiserror::Error)]
#[error("there is no key `{0}`")]
pub(crate) struct NoKey(pub(super) String);

/// The form of a column's values.
#[derive(Debug, Clone, Copy)]
pub(super) enum Show {
    /// As it is: a text, a whole number, yes or no.
    Plain,
    /// A name in code.
    Code,
    /// A number with so many decimals, and with more of them if fewer than two significant digits were left.
    Fixed(usize),
    /// A share in per cent, with so many decimals.
    Percent(usize),
}

/// A column: its heading with the unit, the path of its values, and how it shows them.
#[derive(Debug, Clone, Copy)]
pub(super) struct Column(pub(super) &'static str, pub(super) &'static str, pub(super) Show);

/// The text of a figure that a row does not have.
const NONE: &str = "–";

impl Show {
    pub(super) fn text(self, value: &Json) -> String {
        match (self, value) {
            (_, Json::Text(text)) if text.is_empty() => NONE.to_owned(),
            (Self::Code, Json::Text(text)) => format!("`{text}`"),
            // One cell has one quantity, and `|` would end the cell.
            (_, Json::Text(text)) => text.replace(';', ",").replace('|', "/").replace('\n', " "),
            (Self::Fixed(decimals), Json::Number(number)) => fixed(*number, decimals),
            (Self::Percent(decimals), Json::Number(share)) => format!("{:.decimals$}", share * 100.0),
            (_, Json::Number(number)) => number.to_string(),
            (_, Json::Bool(is)) => if *is { "yes" } else { "no" }.to_owned(),
            (_, Json::Null | Json::List(_) | Json::Object(_)) => NONE.to_owned(),
        }
    }
}

/// A number with so many decimals. A small one has as many as two significant digits need, because errors in a
/// simulator without noise are not zero. A number that these decimals show exactly, such as one that somebody else reports, gets no more.
fn fixed(number: f64, decimals: usize) -> String {
    let (size, short) = (number.abs(), format!("{number:.decimals$}"));
    let is_exact = short.parse() == Ok(number);
    if is_exact || decimals == 0 || size >= 9.5 * 0.1_f64.powi(i32::try_from(decimals).unwrap_or(i32::MAX)) {
        return short;
    }
    let needed =
        (0..=9_usize).find(|&decimals| size >= 9.95 * 0.1_f64.powi(i32::try_from(decimals).unwrap_or(i32::MAX)));
    needed.map_or_else(|| format!("{number:.1e}"), |needed| format!("{number:.needed$}"))
}

/// The value behind a path. What is behind null is null, but a key that an object lacks is an error.
pub(crate) fn value<'a>(row: &'a Json, path: &str) -> Result<&'a Json, NoKey> {
    path.split('.').try_fold(row, |value, key| match value {
        Json::Null => Ok(value),
        value => value.get(key).ok_or_else(|| NoKey(path.to_owned())),
    })
}

/// The number behind a path; zero if it is null.
pub(crate) fn number(row: &Json, path: &str) -> Result<f64, NoKey> {
    Ok(if let Json::Number(number) = value(row, path)? { *number } else { 0.0 })
}

/// The text behind a path; empty if it is null.
pub(super) fn text<'a>(row: &'a Json, path: &str) -> Result<&'a str, NoKey> {
    Ok(if let Json::Text(text) = value(row, path)? { text } else { "" })
}

/// A table with a row for each of `rows`.
pub(super) fn table<'a>(rows: impl IntoIterator<Item = &'a Json>, columns: &[Column]) -> Result<String, NoKey> {
    let headings: Vec<_> = columns.iter().map(|column| column.0.to_owned()).collect();
    let mut lines = Vec::new();
    for row in rows {
        let cells = columns.iter().map(|Column(_, path, show)| Ok(show.text(value(row, path)?)));
        lines.push(cells.collect::<Result<Vec<_>, NoKey>>()?);
    }
    Ok(markdown(&headings, &lines))
}

/// A table of one figure: a row for each value of `row`, a column for each name that `of` gives a value of `rows`.
pub(super) fn pivot<'a>(
    rows: impl IntoIterator<Item = &'a Json>,
    row: Column,
    of: impl Fn(&Json) -> Result<String, NoKey>,
    figure: (&str, Show),
) -> Result<String, NoKey> {
    let mut headings = vec![row.0.to_owned()];
    let mut lines: Vec<Vec<String>> = Vec::new();
    for run in rows {
        let (name, heading) = (row.2.text(value(run, row.1)?), of(run)?);
        let column = headings.iter().skip(1).position(|other| *other == heading).map_or(headings.len(), |at| at + 1);
        if column == headings.len() {
            headings.push(heading);
        }
        let line = lines.iter().position(|line| line[0] == name).unwrap_or(lines.len());
        if line == lines.len() {
            lines.push(vec![name]);
        }
        let line = &mut lines[line];
        line.resize(line.len().max(column + 1), NONE.to_owned());
        line[column] = figure.1.text(value(run, figure.0)?);
    }
    for line in &mut lines {
        line.resize(headings.len(), NONE.to_owned());
    }
    Ok(markdown(&headings, &lines))
}

/// A table of cells. Without lines, a sentence that there are none.
pub(super) fn markdown(headings: &[String], lines: &[Vec<String>]) -> String {
    if lines.is_empty() {
        return "There are none.\n".to_owned();
    }
    let mut text = format!("| {} |\n|{}\n", headings.join(" | "), "---|".repeat(headings.len()));
    for line in lines {
        let _ = writeln!(text, "| {} |", line.join(" | "));
    }
    text
}

#[cfg(test)]
mod tests {
    use super::Show::{Code, Fixed, Percent, Plain};
    use super::*;

    fn rows(text: &str) -> Vec<Json> {
        Json::read(text).map(|json| json.items().to_vec()).unwrap_or_default()
    }

    #[test]
    fn a_column_has_its_unit_in_the_heading_and_one_figure_in_a_cell() {
        let rows = rows(r#"[{"p": "a", "e": {"mean": 0.03155}, "c": 0.99871, "n": 3, "ok": true, "why": "a; b|c"}]"#);
        let columns = [
            Column("policy", "p", Code),
            Column("error, mm", "e.mean", Fixed(3)),
            Column("coverage, %", "c", Percent(1)),
            Column("runs", "n", Plain),
            Column("ok", "ok", Plain),
            Column("why", "why", Plain),
        ];
        assert_eq!(
            table(&rows, &columns).as_deref(),
            Ok("| policy | error, mm | coverage, % | runs | ok | why |\n|---|---|---|---|---|---|\n\
                | `a` | 0.032 | 99.9 | 3 | yes | a, b/c |\n")
        );
    }

    #[test]
    fn a_small_number_keeps_two_digits_and_a_larger_one_its_decimals() {
        let shown = [0.000_312, 0.001_24, 0.0316, 0.5, 12.0, 0.0, -0.000_312, 3.21e-12].map(|number| fixed(number, 3));
        assert_eq!(shown, ["0.00031", "0.0012", "0.032", "0.500", "12.000", "0.000", "-0.00031", "3.2e-12"]);
        assert_eq!(fixed(0.4, 0), "0");
    }

    #[test]
    fn a_figure_that_is_null_is_a_dash_but_a_key_that_is_not_there_is_an_error() {
        let rows = rows(r#"[{"e": null}]"#);
        assert!(table(&rows, &[Column("e", "e.mean", Fixed(1))]).is_ok_and(|text| text.ends_with("| – |\n")));
        assert_eq!(table(&rows, &[Column("f", "f.mean", Fixed(1))]), Err(NoKey("f.mean".to_owned())));
    }

    #[test]
    fn a_pivot_has_a_column_for_each_condition_and_a_dash_for_none() {
        let rows = rows(
            r#"[{"s": "disk", "w": "a", "e": 1}, {"s": "disk", "w": "b", "e": 2}, {"s": "box", "w": "b", "e": 3}]"#,
        );
        let of = |row: &Json| Ok(format!("{}, mm", text(row, "w")?));
        assert_eq!(
            pivot(&rows, Column("scene", "s", Plain), of, ("e", Fixed(1))).as_deref(),
            Ok("| scene | a, mm | b, mm |\n|---|---|---|\n| disk | 1.0 | 2.0 |\n| box | – | 3.0 |\n")
        );
    }

    #[test]
    fn a_table_without_rows_says_so() {
        assert_eq!(table(&[], &[Column("e", "e", Plain)]).as_deref(), Ok("There are none.\n"));
    }
}
