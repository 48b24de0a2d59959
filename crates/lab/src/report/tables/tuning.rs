//! The result of a tuning as tables.

use super::super::number::millimetres;
use super::super::table::{NONE, Table};
use crate::tune::{TunedFigures, TunedParameter, TunedValues, Tuning};

/// A table of the values, and one of the figures with a row for training and one for held-out scenes.
#[must_use]
pub fn tuning_tables(tuning: &Tuning) -> [Table; 2] {
    let cells = |TunedParameter { name, range, default, given, tuned }: &TunedParameter| {
        [name, default, given, tuned, range].map(Clone::clone).to_vec()
    };
    let headings = ["parameter", "policy", "given", "tuned", "range"];
    let values = Table::new(1, headings, tuning.parameters.iter().map(cells));
    let headings = ["values", "scenes", "runs", "passed", "cost", "sum", "error mm", "time s"];
    let rows = tuning.values.iter().flat_map(|TunedValues { of, training, held_out, .. }| {
        [("training", training), ("held-out", held_out)].map(|(scenes, figures)| figure_cells(of, scenes, figures))
    });
    let caption = format!("sum: {}", tuning.objective);
    [values, Table::new(2, headings, rows).under(caption)]
}

fn figure_cells(of: &str, scenes: &str, figures: &TunedFigures) -> Vec<String> {
    let cell = |value: Option<f64>, format: fn(f64) -> String| value.map_or_else(|| NONE.to_owned(), format);
    vec![
        of.to_owned(),
        scenes.to_owned(),
        figures.runs.to_string(),
        figures.passed.to_string(),
        cell(figures.cost, |cost| format!("{cost:.3}")),
        cell(figures.sum, |sum| format!("{sum:.3}")),
        cell(figures.error_mean_mm, millimetres),
        cell(figures.time_s, |time| format!("{time:.1}")),
    ]
}
