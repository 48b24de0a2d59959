//! Tables for the terminal.

use comfy_table::{Cell, CellAlignment, ContentArrangement, LineStyle, TableStyle};

/// The text of a missing figure.
pub(crate) const NONE: &str = "–";

/// The number of characters that fit on a line of a terminal.
const LINE: usize = 100;
/// The number of blanks between the texts of neighbouring columns.
const GAP: usize = 3;

/// A table of texts with a heading above every column.
///
/// The first columns name a row. They are left-aligned and always shown. The other columns have one figure each and are
/// right-aligned. They are in the order of their importance: columns that do not fit on a line are omitted from the
/// right.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Table {
    caption: Option<String>,
    /// The headings from left to right.
    pub headings: Vec<String>,
    /// The number of columns that name a row.
    pub names: usize,
    /// The cells of every row, from left to right.
    pub rows: Vec<Vec<String>>,
}

/// A column: its heading, and the text of a row in it.
pub(crate) type Column<'c, R> = (&'static str, &'c dyn Fn(&R) -> String);

impl Table {
    /// A table with a row for each of `rows`, whose first `names` columns name it.
    pub(crate) fn of<'r, R: 'r>(
        names: usize,
        rows: impl IntoIterator<Item = &'r R>,
        columns: &[Column<'_, R>],
    ) -> Self {
        let cells = |row: &R| columns.iter().map(|(_, text)| text(row)).collect();
        Self::new(names, columns.iter().map(|(heading, _)| *heading), rows.into_iter().map(cells))
    }

    /// A table whose first `names` columns name a row.
    pub fn new<H: Into<String>>(
        names: usize,
        headings: impl IntoIterator<Item = H>,
        rows: impl IntoIterator<Item = Vec<String>>,
    ) -> Self {
        let headings = headings.into_iter().map(Into::into).collect();
        Self { caption: None, headings, names, rows: rows.into_iter().collect() }
    }

    /// The same table with a caption above it.
    #[must_use]
    pub(crate) fn under(self, caption: impl Into<String>) -> Self {
        Self { caption: Some(caption.into()), ..self }
    }

    /// The table as text of at most 100 characters in width. The last line states the number of omitted columns, if
    /// there are any. Names that are too long together are wrapped.
    #[must_use]
    pub fn fitted(&self) -> String {
        let ends = self.widths().into_iter().scan(0, |end, width| {
            *end += width + GAP;
            Some(*end)
        });
        let shown = ends.take_while(|end| *end <= LINE).count().max(self.names).min(self.headings.len());
        let text = self.text(shown, Some(LINE));
        match self.headings.len() - shown {
            0 => text,
            1 => format!("{text}\n1 more column with --wide"),
            left_out => format!("{text}\n{left_out} more columns with --wide"),
        }
    }

    /// The table as text with all its columns, without a limit of its width.
    #[must_use]
    pub fn wide(&self) -> String {
        self.text(self.headings.len(), None)
    }

    /// The first columns as text with rules above, below and under the headings. Texts are wrapped if the table would
    /// be wider than `width`.
    fn text(&self, columns: usize, width: Option<usize>) -> String {
        let mut table = self.ruled(columns);
        let headings = self.headings.iter().zip(self.widths()).take(columns);
        table.set_header(headings.map(|(heading, width)| wrapped(heading, width)));
        for column in table.column_iter_mut().skip(self.names) {
            column.set_cell_alignment(CellAlignment::Right);
        }
        let caption = self.caption.as_ref().map(|caption| match width {
            Some(width) => wrapped(caption, width) + "\n",
            None => format!("{caption}\n"),
        });
        if let Some(width) = width.and_then(|width| u16::try_from(width).ok()) {
            table.set_content_arrangement(ContentArrangement::Dynamic).set_width(width);
        }
        caption.unwrap_or_default() + &table.trim_fmt()
    }

    /// The widths of the columns: of their widest cells, and of the longest words of their headings.
    fn widths(&self) -> Vec<usize> {
        let cells = self.ruled(self.headings.len()).column_max_content_widths();
        let cells = cells.into_iter().map(usize::from).chain(std::iter::repeat(0));
        let word = |heading: &String| heading.split(' ').map(length).max().unwrap_or(0);
        self.headings.iter().zip(cells).map(|(heading, cells)| word(heading).max(cells)).collect()
    }

    /// The rows' first columns, without headings.
    fn ruled(&self, columns: usize) -> comfy_table::Table {
        let mut table = comfy_table::Table::new();
        let rule = LineStyle::none().fill('─').junction('─');
        let style = TableStyle::new().top_border(rule).header_separator(rule).bottom_border(rule);
        table.load_style(style);
        for row in &self.rows {
            table.add_row(row.iter().take(columns).map(Cell::new));
        }
        table
    }
}

/// A text with its words on as many lines as a width needs.
fn wrapped(text: &str, width: usize) -> String {
    let mut lines: Vec<String> = Vec::new();
    for word in text.split(' ') {
        match lines.last_mut() {
            Some(line) if length(line) + 1 + length(word) <= width => *line = format!("{line} {word}"),
            _ => lines.push(word.to_owned()),
        }
    }
    lines.join("\n")
}

/// The number of characters of a text.
fn length(text: &str) -> usize {
    text.chars().count()
}

/// The text of a figure, if there is one.
pub(crate) fn known<T>(figure: Option<T>, text: impl FnOnce(T) -> String) -> String {
    figure.map_or_else(|| NONE.to_owned(), text)
}

/// A share (0 to 1) in percent.
pub(crate) fn percent(share: f64, digits: usize) -> String {
    format!("{:.digits$} %", 100.0 * share)
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "a test may panic")]

    use super::*;
    use proptest::prelude::*;

    fn table(names: usize, figures: usize, rows: usize) -> impl Strategy<Value = Table> {
        let headings = prop::collection::vec("[a-z]{1,9}( [a-z]{1,9}){0,2}", names + figures);
        let name = "[a-z0-9]{1,30}([ -][a-z0-9]{1,30}){0,3}";
        let names_of_rows = prop::collection::vec(prop::collection::vec(name, names), rows);
        let figures_of_rows = prop::collection::vec(prop::collection::vec("[0-9.]{1,12}", figures), rows);
        (headings, names_of_rows, figures_of_rows).prop_map(move |(headings, names_of_rows, figures_of_rows)| {
            let rows = names_of_rows.into_iter().zip(figures_of_rows).map(|(names, figures)| [names, figures].concat());
            Table::new(names, headings, rows)
        })
    }

    fn tables() -> impl Strategy<Value = Table> {
        (1..4_usize, 0..20_usize, 0..5_usize).prop_flat_map(|(names, figures, rows)| table(names, figures, rows))
    }

    /// A text without the effects of wrapping.
    fn letters(text: &str) -> String {
        text.chars().filter(|letter| !letter.is_whitespace() && *letter != '─').collect()
    }

    proptest! {
        #[test]
        fn a_fitted_table_is_at_most_a_hundred_characters_wide_and_counts_what_it_leaves_out(table in tables()) {
            let fitted = table.fitted();
            prop_assert!(fitted.lines().all(|line| length(line) <= LINE), "{fitted}");
            let said = fitted.lines().last().and_then(|line| line.split_once(" more column"));
            let left_out = said.map_or(0, |(count, _)| count.parse().unwrap());
            prop_assert!(left_out <= table.headings.len() - table.names);
            // The shown cells of a row are complete, wrapped or not.
            let shown = table.headings.len() - left_out;
            let all = |text: &str| { let mut all: Vec<char> = letters(text).chars().collect(); all.sort_unstable(); all };
            let cells = table.headings[..shown].iter().chain(table.rows.iter().flat_map(|row| &row[..shown]));
            let names: usize = table.widths()[..table.names].iter().map(|width| width + GAP).sum();
            if names <= LINE {
                let lines = table.rows.len() + 1 + usize::from(left_out > 0);
                let rest: Vec<&str> = fitted.lines().rev().take(lines).collect();
                prop_assert_eq!(rest.iter().filter(|line| line.contains('─')).count(), 1, "a row is wrapped:\n{}", fitted);
            }
            let body = if left_out > 0 { fitted.rsplit_once('\n').unwrap().0 } else { &fitted };
            prop_assert_eq!(all(body), all(&cells.cloned().collect::<String>()), "{}", fitted);
        }

        #[test]
        fn a_wide_table_shows_every_cell_on_the_line_of_its_row(table in tables()) {
            let wide = table.wide();
            let lines: Vec<&str> = wide.lines().collect();
            let first = lines.len() - 1 - table.rows.len();
            for (line, row) in lines[first..].iter().zip(&table.rows) {
                prop_assert_eq!(letters(line), letters(&row.concat()));
            }
        }
    }

    #[test]
    fn a_caption_is_wrapped_only_in_a_fitted_table() {
        let caption = "a caption of many words ".repeat(8);
        let table = Table::new(1, ["scene"], [vec!["disk".to_owned()]]).under(caption.trim());
        assert!(table.fitted().lines().all(|line| length(line) <= LINE), "{}", table.fitted());
        assert!(letters(&table.fitted()).starts_with(&letters(&caption)));
        assert_eq!(table.wide().lines().next(), Some(caption.trim()));
    }

    #[test]
    fn a_table_that_fits_leaves_nothing_out_and_one_column_too_many_is_left_out_and_counted() {
        let table = |figures: usize| {
            let headings =
                std::iter::once("scene".to_owned()).chain((0..figures).map(|index| format!("figure {index}")));
            Table::new(1, headings, [[vec!["disk".to_owned()], vec!["123456".to_owned(); figures]].concat()])
        };
        // 8 characters for the scene, 9 for every figure.
        assert_eq!(table(10).fitted(), table(10).wide());
        assert!(table(11).fitted().ends_with("\n1 more column with --wide"), "{}", table(11).fitted());
        assert!(table(12).fitted().ends_with("\n2 more columns with --wide"), "{}", table(12).fitted());
    }
}
