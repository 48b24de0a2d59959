//! `vibrissa study worlds`

use std::sync::Arc;

use clap::{Args, ValueEnum};
use vibrissa_runtime::machine::Program;

use super::exit::Exit;
use super::failure::Failure;
use super::options::{Format, Jobs, Policies};
use super::output;
use super::progress::Progress;
use super::provenance::{provenance, simulator};
use vibrissa_lab::built_in::{SCENARIOS, TextFile};
use vibrissa_lab::load;
use vibrissa_lab::report::worlds_table;
use vibrissa_lab::study::worlds::{Simulation, compare_worlds};
use vibrissa_lab::trial::{check_world, in_parallel};
use vibrissa_text::file::CommandFiles;
use vibrissa_world::scene::{Scene, WorldKind};

const EXAMPLE: &str = "Example:\n  vibrissa study worlds --against quasistatic,peer_cable\n\nExit status: 0 done, however far the simulators differ; 2 unusable input; 3 internal error; 130 interrupted.";

/// The arguments of `vibrissa study worlds`.
#[derive(Debug, Args)]
#[command(after_help = EXAMPLE)]
pub(super) struct WorldsArguments {
    #[command(flatten)]
    policies: Policies,
    /// Simulations that are compared with chains of links in MuJoCo
    #[arg(long, value_enum, value_name = "SIMULATION", value_delimiter = ',', default_value = "quasistatic")]
    against: Vec<SimulationName>,
    #[command(flatten)]
    format: Format,
    #[command(flatten)]
    jobs: Jobs,
}

/// The simulations, as the command line names them.
#[derive(Debug, Clone, Copy, ValueEnum)]
enum SimulationName {
    /// The same chains in static equilibrium
    #[value(name = "quasistatic")]
    QuasiStatic,
    /// Cables of 40 links in MuJoCo, tens of times slower
    #[value(name = "peer_cable")]
    PeerCable,
}

impl SimulationName {
    fn of(self, scene: &Scene) -> Simulation {
        match self {
            Self::QuasiStatic => Simulation::quasi_static(scene),
            Self::PeerCable => Simulation::peer_cable(scene),
        }
    }
}

pub(super) fn worlds(arguments: &WorldsArguments) -> Result<Exit, Failure> {
    let programs = arguments.policies.load(&mut CommandFiles::new())?.into_iter();
    let programs: Vec<_> = programs.map(|policy| Arc::new(policy.value.artifact.program)).collect();
    let pairs: Vec<_> = SCENARIOS.iter().flat_map(|file| programs.iter().map(move |program| (file, program))).collect();
    let mut progress = Progress::new(pairs.len());
    let work = |(file, program): &(&TextFile, &Arc<Program>)| {
        let scene = load::built_in_scenario(file)?.value;
        let failed = |cause| Failure::Execute { scenario: file.path.into(), cause };
        check_world(WorldKind::Mujoco).map_err(failed)?;
        let others: Vec<_> = arguments.against.iter().map(|simulation| simulation.of(&scene)).collect();
        compare_worlds(&scene, program, &Simulation::chain(&scene), &others).map_err(failed)
    };
    let rows = in_parallel(&pairs, arguments.jobs.threads(), work, |rows| {
        if let Some(row) = rows.as_ref().ok().and_then(|rows| rows.first()) {
            progress.done(&row.scenario);
        }
    });
    progress.finish();
    let rows = rows.into_iter().collect::<Result<Vec<_>, Failure>>()?.concat();
    for row in rows.iter().filter(|row| !row.outcome.met_its_stop() || row.stopped.is_some()) {
        for reason in [&row.reason, &row.stopped].into_iter().flatten() {
            output::message(format_args!("{}, {}, {}: {reason}", row.scenario, row.policy, row.simulation));
        }
    }
    let mut provenance = provenance();
    for row in &rows {
        provenance.add_scene(&row.scenario);
        provenance.add_policy(&row.policy);
    }
    for kind in [WorldKind::Mujoco, WorldKind::QuasiStatic] {
        let is_used = |against: &SimulationName| matches!(against, SimulationName::QuasiStatic);
        if kind == WorldKind::Mujoco || arguments.against.iter().any(is_used) {
            provenance.add_simulator(simulator(kind.name()));
        }
    }
    output::documents(arguments.format, &provenance, &rows, || [worlds_table(&rows)])?;
    Ok(Exit::Done)
}
