//! Tables of a page.

use maud::{Markup, html};

use crate::report::table::Table;

/// A table of a page. As in [`Table`], the first columns name a row. The others have figures and are in the order of their
/// importance.
pub(super) struct PageTable {
    /// The name of the table, which is also that of its exported files.
    pub(super) title: String,
    pub(super) headings: Vec<String>,
    /// Number of columns that name a row.
    pub(super) names: usize,
    pub(super) rows: Vec<Vec<PageCell>>,
}

/// A cell of a table.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub(super) struct PageCell {
    pub(super) text: String,
    /// The judgement of the figure.
    pub(super) judgement: Option<Judgement>,
    /// The address that the cell opens.
    pub(super) link: Option<String>,
}

/// The judgement of a figure. It determines the appearance of its cell.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Judgement {
    Better,
    Worse,
}

impl From<String> for PageCell {
    fn from(text: String) -> Self {
        Self { text, ..Self::default() }
    }
}

impl PageTable {
    /// A table of the terminal.
    pub(super) fn new(title: impl Into<String>, table: &Table) -> Self {
        let rows = table.rows.iter().map(|row| row.iter().cloned().map(PageCell::from).collect());
        Self { title: title.into(), headings: table.headings.clone(), names: table.names, rows: rows.collect() }
    }

    /// The same table in which the first cell of each row opens the address of its row.
    pub(super) fn linked(mut self, address: impl Fn(usize) -> Option<String>) -> Self {
        for (index, row) in self.rows.iter_mut().enumerate() {
            if let Some(cell) = row.first_mut() {
                cell.link = address(index);
            }
        }
        self
    }

    pub(super) fn markup(&self) -> Markup {
        let kind = |column: usize| (column < self.names).then_some("name");
        html! {
            div.table data-names=(self.names) {
                table {
                    caption { (self.title) }
                    thead {
                        tr {
                            @for (column, heading) in self.headings.iter().enumerate() {
                                th scope="col" class=[kind(column)] { (heading) }
                            }
                        }
                    }
                    tbody {
                        @for row in &self.rows {
                            tr {
                                @for (column, cell) in row.iter().enumerate() {
                                    td class=[class(kind(column), cell.judgement)] {
                                        @if let Some(link) = &cell.link { a href=(link) { (cell.text) } } @else { (cell.text) }
                                    }
                                }
                            }
                        }
                    }
                }
            }
        }
    }
}

fn class(kind: Option<&str>, judgement: Option<Judgement>) -> Option<String> {
    let judgement = judgement.map(|judgement| match judgement {
        Judgement::Better => "better",
        Judgement::Worse => "worse",
    });
    let classes: Vec<_> = [kind, judgement].into_iter().flatten().collect();
    (!classes.is_empty()).then(|| classes.join(" "))
}
