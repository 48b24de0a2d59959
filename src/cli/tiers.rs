//! `vibrissa bench --worlds`

use std::sync::Arc;

use crate::file::CommandFiles;
use crate::scene::WorldKind;
use crate::study::bench::{SCENARIOS, TextFile};
use crate::study::tiers::{Tier, compare_tiers, tiers_table};
use crate::study::{Ending, check_world, in_parallel};
use vibrissa_runtime::machine::Program;

use super::arguments::BenchArguments;
use super::batch::threads;
use super::bench::policies;
use super::exit::{Exit, Failure};
use super::progress::Progress;
use super::{input, output};

/// Compares worlds. However far apart they are, that is done.
pub(super) fn tiers(arguments: &BenchArguments) -> Result<Exit, Failure> {
    let programs = policies(arguments, &mut CommandFiles::new())?.into_iter();
    let programs: Vec<_> = programs.map(|(_, policy)| Arc::new(policy.value.artifact.program)).collect();
    let pairs: Vec<_> = SCENARIOS.iter().flat_map(|file| programs.iter().map(move |program| (file, program))).collect();
    let mut progress = Progress::new(pairs.len());
    let work = |(file, program): &(&TextFile, &Arc<Program>)| {
        let scene = input::built_in_scenario(file)?.value;
        let failed = |cause| Failure::Execute { scenario: file.path.into(), cause };
        check_world(WorldKind::Mujoco).map_err(failed)?;
        let others: Vec<_> = arguments.worlds.iter().map(|tier| tier.of(&scene)).collect();
        compare_tiers(&scene, program, &Tier::chain(&scene), &others).map_err(failed)
    };
    let rows = in_parallel(&pairs, threads(arguments.jobs), work, |rows| {
        if let Some(row) = rows.as_ref().ok().and_then(|rows| rows.first()) {
            progress.done(&row.scenario);
        }
    });
    progress.finish();
    let rows = rows.into_iter().collect::<Result<Vec<_>, _>>()?.concat();
    for row in rows.iter().filter(|row| row.outcome != Ending::Completed || row.stopped.is_some()) {
        for reason in [&row.reason, &row.stopped].into_iter().flatten() {
            output::message(format_args!("{}, {}, {}: {reason}", row.scenario, row.policy, row.tier));
        }
    }
    if arguments.json {
        output::json_list(&rows)?;
    } else {
        output::tables(&[tiers_table(&rows)], arguments.columns.wide)?;
    }
    Ok(Exit::Done)
}
