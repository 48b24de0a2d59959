//! `vibrissa bench --timing N`

use crate::scene::Outcome;
use crate::study::bench::{Conditions, Timing, TimingRow, timing_table};

use super::arguments::Columns;
use super::exit::{Exit, Failure};
use super::job::Job;
use super::output;
use super::progress::Progress;

/// Does every job so many times, one run at a time. One round has every job once, so that what else the machine does falls on all of them.
pub(super) fn timing(
    jobs: &[(Conditions, Job)],
    repeats: usize,
    json: bool,
    columns: Columns,
) -> Result<Exit, Failure> {
    let mut progress = Progress::new(jobs.len() * repeats);
    let mut times: Vec<Vec<Timing>> = vec![Vec::with_capacity(repeats); jobs.len()];
    for _ in 0..repeats {
        for ((_, job), times) in jobs.iter().zip(&mut times) {
            progress.doing(&job.scene.name);
            let timing = Timing::take(&job.scene, &job.program, job.world, job.seed);
            times.push(timing.map_err(|cause| Failure::Execute { scenario: job.path.clone(), cause })?);
            progress.done(&job.scene.name);
        }
    }
    progress.finish();
    let row = |((conditions, job), times): (&(Conditions, Job), &Vec<Timing>)| {
        TimingRow::new(conditions.named(&job.scene.name), job.program.name.clone(), job.world.kind.to_string(), times)
    };
    let rows: Vec<TimingRow> = jobs.iter().zip(&times).filter_map(row).collect();
    if json {
        output::json_list(&rows)?;
    } else {
        output::tables(&[timing_table(&rows)], columns.wide)?;
    }
    Ok(if rows.iter().all(|row| row.outcome == Outcome::Completed) { Exit::Done } else { Exit::Unexpected })
}
