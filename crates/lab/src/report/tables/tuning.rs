//! The result of a tuning as tables.

use super::super::number::millimetres;
use super::super::table::{Column, Table, known};
use crate::tune::{TunedFigures, TunedParameter, TunedValues, Tuning};

/// A table of the values, and one of the figures with a row for training and one for held-out scenes.
#[must_use]
pub fn tuning_tables(tuning: &Tuning) -> [Table; 2] {
    let cells = |TunedParameter { name, range, default, given, tuned }: &TunedParameter| {
        [name, default, given, tuned, range].map(Clone::clone).to_vec()
    };
    let headings = ["parameter", "policy", "given", "tuned", "range"];
    let values = Table::new(1, headings, tuning.parameters.iter().map(cells));
    let rows: Vec<_> = tuning
        .values
        .iter()
        .flat_map(|TunedValues { of, training, held_out, .. }| {
            [(*of, "training", training), (*of, "held-out", held_out)]
        })
        .collect();
    let columns: [Column<'_, (&str, &str, &TunedFigures)>; 8] = [
        ("values", &|(of, ..)| (*of).to_owned()),
        ("scenes", &|(_, scenes, _)| (*scenes).to_owned()),
        ("runs", &|(.., figures)| figures.runs.to_string()),
        ("passed", &|(.., figures)| figures.passed.to_string()),
        ("cost", &|(.., figures)| known(figures.cost, |cost| format!("{cost:.3}"))),
        ("sum", &|(.., figures)| known(figures.sum, |sum| format!("{sum:.3}"))),
        ("error mm", &|(.., figures)| known(figures.error_mean_mm, millimetres)),
        ("time s", &|(.., figures)| known(figures.time_s, |time| format!("{time:.1}"))),
    ];
    [values, Table::of(2, &rows, &columns).under(format!("sum: {}", tuning.objective))]
}
