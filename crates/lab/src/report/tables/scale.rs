//! Cost against size as tables.

use super::super::table::{Table, known};
use crate::study::scale::Scale;

/// Three tables: the exponent of every axis, the time of every size, and the cost of a large sweep in each simulator.
#[must_use]
pub fn scale_tables(scale: &Scale) -> [Table; 3] {
    let simulator = |simulator: &Option<String>| simulator.clone().unwrap_or_default();
    let times: Vec<_> = scale.axes.iter().flat_map(|axis| axis.times.iter().map(move |time| (axis, time))).collect();
    [
        Table::of(
            2,
            &scale.axes,
            &[
                ("axis", &|row| row.axis.clone()),
                ("simulator", &|row| simulator(&row.simulator)),
                ("exponent", &|row| known(row.exponent, |exponent| format!("{exponent:.2}"))),
                ("work", &|row| row.work.clone()),
            ],
        ),
        Table::of(
            3,
            &times,
            &[
                ("axis", &|(row, _)| row.axis.clone()),
                ("simulator", &|(row, _)| simulator(&row.simulator)),
                ("unit", &|(row, _)| row.unit.clone()),
                ("size", &|(_, time)| time.size.to_string()),
                ("time s", &|(_, time)| format!("{:.4}", time.time_s)),
            ],
        ),
        Table::of(
            2,
            &scale.sweeps,
            &[
                ("runs", &|cost| cost.runs.to_string()),
                ("simulator", &|cost| cost.simulator.clone()),
                ("processor h", &|cost| format!("{:.1}", cost.processor_hours)),
                ("machine h", &|cost| format!("{:.1}", cost.machine_hours)),
                ("jobs", &|cost| cost.jobs.to_string()),
                ("array min", &|cost| format!("{:.2}", cost.array_minutes)),
                ("merge min", &|cost| format!("{:.2}", cost.merge_minutes)),
                ("results GB", &|cost| format!("{:.1}", cost.results_gb)),
                ("run ms", &|cost| format!("{:.1}", cost.run_ms)),
                ("start of a job s", &|cost| format!("{:.2}", cost.job_start_s)),
                ("line bytes", &|cost| cost.line_bytes.to_string()),
            ],
        ),
    ]
}
