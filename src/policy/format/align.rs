//! Columns: what stands under one another in lines that follow one another.

use super::line::{Kind, Line, WIDTH};

/// Aligns the `=` and the `in` of statements of one kind, and the comments at the ends of lines.
pub(super) fn align(lines: &mut [Line<'_>]) {
    for mark in ["=", "in"] {
        let column = |line: &Line<'_>, below: Option<&Line<'_>>| assigned(line, below, mark);
        align_column(lines, column, |line, below| line.pieces[0].text == below.pieces[0].text, Line::width);
    }
    let comment = |line: &Line<'_>, _: Option<&Line<'_>>| line.has_comment.then(|| line.pieces.len() - 1);
    align_column(lines, comment, |line, below| line.indent == below.indent, Line::full_width);
}

/// The piece `mark` of a statement on one line that gives a plain name a value; `below` is the line below.
fn assigned(line: &Line<'_>, below: Option<&Line<'_>>, mark: &str) -> Option<usize> {
    if line.kind != Kind::Begin || below.is_some_and(|below| below.kind == Kind::Continuation) {
        return None;
    }
    let equals = line.pieces.iter().position(|piece| ["=", "(", "{"].contains(&piece.text))?;
    let behind = &line.pieces[equals..];
    behind.iter().position(|piece| piece.text == mark && behind[0].text == "=").map(|index| equals + index)
}

/// Moves the pieces that `column` gives to one column, in every run of lines that have one, are alike to the next and have no
/// blank line between them. A run of which a line would become too wide is left as it is.
fn align_column<'t>(
    lines: &mut [Line<'t>],
    column: impl Fn(&Line<'t>, Option<&Line<'t>>) -> Option<usize>,
    alike: impl Fn(&Line<'t>, &Line<'t>) -> bool,
    width: impl Fn(&Line<'t>) -> usize,
) {
    let columns: Vec<Option<usize>> =
        lines.iter().enumerate().map(|(index, line)| column(line, lines.get(index + 1))).collect();
    let mut lines: Vec<_> = lines.iter_mut().zip(columns).collect();
    let runs = lines.chunk_by_mut(|(line, column), (below, column_below)| {
        let neighbours = !below.blank_before && below.level == line.level;
        column.is_some() && column_below.is_some() && neighbours && alike(line, below)
    });
    for run in runs {
        let places: Vec<usize> =
            run.iter().filter_map(|(line, column)| column.map(|column| line.start(column))).collect();
        let farthest = places.iter().copied().max().unwrap_or_default();
        if run.iter().zip(&places).any(|((line, _), place)| width(line) + farthest - place > WIDTH) {
            continue;
        }
        for ((line, column), place) in run.iter_mut().zip(places) {
            if let Some(column) = *column {
                line.pieces[column].blanks += farthest - place;
            }
        }
    }
}
