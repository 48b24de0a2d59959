//! A trial with an emulated array.

use std::sync::Arc;

use vibrissa_robot::config::{Config, ConfigError};
use vibrissa_robot::drive::LoopRecord;
use vibrissa_robot::emulation::{Emulation, EmulationError, Settings, Stopped};
use vibrissa_robot::fault::FaultEvent;
use vibrissa_robot::vitals::Phase;
use vibrissa_runtime::control::{BindError, Control};
use vibrissa_runtime::machine::Tick;
use vibrissa_runtime::signal::Command;

use super::world_plant::WorldPlant;
use crate::run::{Ending, Monitor, Watcher};
use crate::trial::{ExecuteError, Trial, TrialResult};
use vibrissa_world::scene::Outcome;

/// Time (ns) of a run between two looks at its records. Their queue holds some seconds.
const RECORDING_NS: u64 = 1_000_000_000;

/// The result of a trial with an emulated array.
#[derive(Debug, Clone)]
pub struct EmulatedResult {
    /// The run and its score.
    pub result: TrialResult,
    /// The changes of faults, in the order of time.
    pub events: Vec<FaultEvent>,
    /// Time at which the machine has begun (ns), after the start of the sensors and the measurement of neutral values.
    pub begun_ns: u64,
    /// Time at which the run has ended (ns).
    pub ended_ns: u64,
    /// Missed periods of each phase.
    pub missed: [u64; Phase::ALL.len()],
}

/// A trial that cannot be emulated.
#[derive(Debug, thiserror::Error)]
pub enum EmulatedError {
    /// The world refuses the scene.
    #[error(transparent)]
    Execute(#[from] ExecuteError),
    /// The rig does not have what the policy needs.
    #[error(transparent)]
    Bind(#[from] BindError),
    /// The rig has no valid array.
    #[error(transparent)]
    Config(#[from] ConfigError),
    /// The array cannot be started.
    #[error(transparent)]
    Emulation(#[from] EmulationError),
}

/// Runs a trial with the robot's own loop under `config`. Control assumes the rig of the configuration. `record` receives
/// the records of the loop. `watcher` receives the samples and the trace after every tick of the machine, and may stop the run.
///
/// # Errors
/// [`EmulatedError`] if the run cannot begin, or if `watcher` stopped it. The outcome of a run is part of the result.
pub fn run(
    trial: &Trial,
    config: &Config,
    settings: &Settings,
    mut record: impl FnMut(&LoopRecord),
    watcher: &mut impl Watcher,
) -> Result<EmulatedResult, EmulatedError> {
    let mut plant_trial = trial.clone();
    let sensing = &mut plant_trial.scene.rig.sensing;
    // The emulated sensors have the noise, and commands take effect at every sample.
    (sensing.angle_noise, sensing.angle_resolution) = (0.0, 0.0);
    sensing.sample_rate = config.rig.sensing.sample_rate;
    sensing.control_rate = sensing.sample_rate;
    // A device may need other rates than those for which the scenario has its step.
    plant_trial.scene.physics.fit_step(config.rig.sensing.sample_rate);
    let plant = WorldPlant::new(plant_trial.world()?, &trial.scene.rig, trial.scene.start);
    trial.check_map()?;
    let control = Control::new(&config.rig, Arc::clone(&trial.program))?;
    let mut monitor = Monitor::new(&control, trial.scene.goal(), config.rig.sensing.control_rate.recip());
    let mut emulation = Emulation::new(config, control, plant, settings)?;
    let (mut ending, mut crash, mut is_interrupted) = (None, None, false);
    // The robot may be stopped for good, so the time is limited beside the ticks. Neutral values take a second.
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "the time of a run")]
    let limit_ns = ((trial.scene.stop.time * 2.0 + 10.0) * 1e9) as u64;
    let mut observe = |control: &Control, command: Command, tick: &Tick, plant: &mut WorldPlant| {
        ending = monitor.observe(control, command, tick, plant);
        plant.next_tick();
        crash = plant.fault().cloned();
        watcher.before_tick(plant.samples());
        is_interrupted = watcher.after_tick(monitor.trace()).is_break();
        ending.is_none() && !is_interrupted
    };
    let stopped = loop {
        // The queue of records must not become full.
        let until_ns = limit_ns.min(emulation.now_ns() + RECORDING_NS);
        let stopped = emulation.run(until_ns, &mut observe)?;
        while let Some(entry) = emulation.next_record() {
            record(&entry);
        }
        if stopped != Stopped::Time || until_ns == limit_ns {
            break stopped;
        }
    };
    if is_interrupted {
        return Err(ExecuteError::Interrupted.into());
    }
    let ending = match (ending, stopped) {
        (Some(ending), _) => ending,
        (None, Stopped::Plant(fault)) => match crash {
            Some(fault) => monitor.crashed(&fault),
            None => Ending { outcome: Outcome::Diverged, reason: Some(fault.0) },
        },
        (None, _) => {
            let reason = "the robot remained stopped by a fault".to_owned();
            Ending { outcome: Outcome::Failed, reason: Some(reason) }
        }
    };
    let run = monitor.finish(emulation.control(), ending);
    let missed = Phase::ALL.map(|phase| emulation.vitals().missed(phase));
    let begun_ns = emulation.begun_ns().unwrap_or_default();
    let ended_ns = emulation.now_ns();
    Ok(EmulatedResult { result: trial.scored(run), events: emulation.take_events(), begun_ns, ended_ns, missed })
}
