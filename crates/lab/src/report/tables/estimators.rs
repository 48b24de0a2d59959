//! The comparison of contact estimators as tables.

use vibrissa_runtime::machine::ContactEstimatorKind;

use super::super::number::millimetres;
use super::super::table::{NONE, Table, known};
use crate::results::TipShares;
use crate::study::estimators::EstimatorRow;

/// Two tables. The first has a row for every scene and noise, with the mean error (mm) of every contact estimator. The
/// second has a row for every estimator and noise, with its figures over all scenes.
#[must_use]
pub fn estimators_tables(rows: &[EstimatorRow]) -> [Table; 2] {
    let of = |row: &EstimatorRow| (row.scenario.clone(), row.noise.to_bits());
    let mut groups: Vec<(String, u64)> = Vec::new();
    for row in rows {
        if !groups.contains(&of(row)) {
            groups.push(of(row));
        }
    }
    let noise = |bits: u64| match f64::from_bits(bits) {
        0.0 => "none".to_owned(),
        factor => format!("{factor} ×"),
    };
    let estimators = ContactEstimatorKind::ALL.map(ContactEstimatorKind::name);
    let lines = groups.iter().map(|group| {
        let cells = estimators.map(|estimator| {
            rows.iter().find(|row| of(row) == *group && row.model == estimator).map_or(NONE.to_owned(), cell)
        });
        [vec![group.0.clone(), noise(group.1)], cells.to_vec()].concat()
    });
    let scenes = Table::new(2, ["scene", "noise"].into_iter().chain(estimators), lines)
        .under("Mean error (mm) of every contact estimator; the second table has the shares of reported positions");

    let mut noises: Vec<u64> = Vec::new();
    for (_, noise) in &groups {
        if !noises.contains(noise) {
            noises.push(*noise);
        }
    }
    let lines = estimators.iter().flat_map(|estimator| noises.iter().map(move |noise| (*estimator, *noise))).map(
        |(estimator, bits)| {
            let mine: Vec<_> =
                rows.iter().filter(|row| row.model == estimator && row.noise.to_bits() == bits).collect();
            let mean = |figure: &dyn Fn(&EstimatorRow) -> Option<f64>| {
                let found: Vec<f64> = mine.iter().filter_map(|row| figure(row)).collect();
                (!found.is_empty()).then(|| found.iter().sum::<f64>() / found.len() as f64)
            };
            let tips: TipShares =
                mine.iter().map(|row| TipShares::of_run(row.tips as f64, row.outliers, row.within_band)).sum();
            let percent = |share: f64| format!("{:.1} %", 100.0 * share);
            vec![
                estimator.to_owned(),
                noise(bits),
                known(mean(&|row| row.mean_mm), millimetres),
                known(mean(&|row| row.p95_mm), millimetres),
                known(tips.within_band_share(), percent),
                known(tips.outlier_share(), |share| format!("{:.2} %", 100.0 * share)),
                known(mean(&|row| Some(row.reported)), percent),
                known(mean(&|row| Some(row.on_shaft)), percent),
                known(mean(&|row| Some(row.tick_us)), |time| format!("{time:.1}")),
            ]
        },
    );
    let headings = [
        "contact estimator",
        "noise",
        "mean mm",
        "p95 mm",
        "in 95 % interval",
        "outliers",
        "reported",
        "on the shaft",
        "tick µs",
    ];
    let means = Table::new(2, headings, lines)
        .under("Means over the scenes; shares within the 95 % interval and of outliers are of all tips together");
    [scenes, means]
}

fn cell(row: &EstimatorRow) -> String {
    known(row.mean_mm, millimetres)
}
