//! `vibrissa bench --estimators`

use std::num::NonZeroUsize;
use std::sync::Arc;

use crate::study::bench::{DEFAULT_POLICY, SCENARIOS, TextFile};
use crate::study::estimators::{estimators_tables, judge_all};
use crate::study::in_parallel;

use super::arguments::{BenchArguments, World};
use super::batch::threads;
use super::exit::{Exit, Failure};
use super::progress::Progress;
use super::{input, output};

/// Compares tip models. Whichever is better, that is done.
pub(super) fn estimators(arguments: &BenchArguments) -> Result<Exit, Failure> {
    let program = Arc::new(input::built_in_policy(&DEFAULT_POLICY)?.value.artifact.program);
    let work = |file: &TextFile| {
        let scene = input::built_in_scenario(file)?.value;
        let failed = |cause| Failure::Execute { scenario: file.path.into(), cause };
        let world = World::of(arguments.world, &scene);
        judge_all(&scene, Arc::clone(&program), world).map_err(failed)
    };
    // One at a time unless told otherwise: their times are compared, too.
    let jobs = arguments.jobs.or(Some(NonZeroUsize::MIN));
    let mut progress = Progress::new(SCENARIOS.len());
    let rows = in_parallel(SCENARIOS, threads(jobs), work, |rows| {
        if let Some(row) = rows.as_ref().ok().and_then(|rows| rows.first()) {
            progress.done(&row.scenario);
        }
    });
    progress.finish();
    let rows = rows.into_iter().collect::<Result<Vec<_>, _>>()?.concat();
    if arguments.json {
        output::json_list(&rows)?;
    } else {
        output::tables(&estimators_tables(&rows), arguments.columns.wide)?;
    }
    Ok(Exit::Done)
}
