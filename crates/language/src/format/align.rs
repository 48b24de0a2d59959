//! Alignment of columns in consecutive lines.

use super::line::{Kind, Line, WIDTH};

/// Aligns `=` and `in` of statements of one kind, and comments at the ends of lines.
pub(super) fn align(lines: &mut [Line<'_>]) {
    for mark in ["=", "in"] {
        let column = |line: &Line<'_>, below: Option<&Line<'_>>| assigned(line, below, mark);
        align_column(lines, column, |line, below| line.pieces[0].text == below.pieces[0].text, Line::width);
    }
    let comment = |line: &Line<'_>, _: Option<&Line<'_>>| line.has_comment.then(|| line.pieces.len() - 1);
    align_column(lines, comment, |line, below| line.indent == below.indent, Line::full_width);
}

/// Index of the piece `mark` in a statement on one line that assigns to a plain name. `below` is the next line.
fn assigned(line: &Line<'_>, below: Option<&Line<'_>>, mark: &str) -> Option<usize> {
    if line.kind != Kind::Begin || below.is_some_and(|below| below.kind == Kind::Continuation) {
        return None;
    }
    let equals = line.pieces.iter().position(|piece| ["=", "(", "{"].contains(&piece.text))?;
    let behind = &line.pieces[equals..];
    behind.iter().position(|piece| piece.text == mark && behind[0].text == "=").map(|index| equals + index)
}

/// Aligns the pieces that `column` returns, in every run of consecutive similar lines without a blank line. A run is
/// not aligned if a line would become too wide.
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
