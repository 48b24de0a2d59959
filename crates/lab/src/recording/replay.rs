//! Replay of a recording.

use std::sync::Arc;

use vibrissa_runtime::control::Control;
use vibrissa_runtime::signal::Command;

use super::error::ReadRecordingError;
use super::read::{RecordedTick, RecordedWhisker, RunRecording};
use crate::inspect::{Breakpoints, PolicyDifference, PolicyPair};
use crate::results::{DifferenceRecord, ReplayResult};

/// Runs the recorded machine over the recorded samples. Every state, command, base angle and tip must be that of the recording, bit
/// by bit.
///
/// # Errors
/// [`ReadRecordingError`] if the recorded rig does not have what the machine needs.
pub fn replay(recording: &RunRecording) -> Result<ReplayResult, ReadRecordingError> {
    let program = Arc::new(recording.artifact.program.clone());
    let mut control = Control::simulated(&recording.setup.rig, program)?;
    let (mut ticks, mut end_s, mut difference) = (0, 0.0, None);
    for (samples, recorded) in recording.samples.iter().zip(&recording.ticks) {
        let (command, _) = control.tick(samples);
        end_s = recorded.time_s;
        difference = first_difference(&control, command, recorded).map(|(field, recorded, replayed)| {
            DifferenceRecord { step: ticks, time_s: end_s, field, recorded, replayed }
        });
        ticks += 1;
        if difference.is_some() {
            break;
        }
    }
    let recording = recording.identity().clone();
    Ok(ReplayResult { recording, steps: ticks, ticks, end_s, is_cut: false, faults: Vec::new(), difference })
}

/// Gives the recorded samples to the recorded policy and to another one, until their commands differ. `own` and `other` are the
/// explained policies.
///
/// # Errors
/// [`ReadRecordingError`] if the rig does not have what a policy needs.
pub fn compare_policies(
    recording: &RunRecording,
    [own, other]: [&Breakpoints; 2],
) -> Result<PolicyDifference, ReadRecordingError> {
    let rig = &recording.setup.rig;
    let program = own.explained.with_parameters_of(&recording.artifact.program);
    let first = Control::simulated(rig, Arc::new(program))?;
    let second = Control::simulated(rig, Arc::new(other.explained.program.clone()))?;
    let scenario = recording.identity().get("scenario").map_or("", String::as_str);
    let mut pair = PolicyPair::new([(first, own), (second, other)], scenario);
    let mut all = recording.samples.iter();
    while all.next().is_some_and(|samples| pair.tick(samples).is_some()) {}
    Ok(pair.difference)
}

/// The first result of a tick that is not the recorded one: its name, the recorded value and the replayed one.
fn first_difference(control: &Control, command: Command, recorded: &RecordedTick) -> Option<(String, String, String)> {
    let machine = control.machine();
    // A tick keeps the state in which a success was found.
    let state = machine.failure().is_none().then(|| machine.program().states[machine.state()].name.to_string());
    if state != recorded.state {
        let shown = |state: Option<String>| state.unwrap_or_else(|| "none".to_owned());
        return Some(("state".to_owned(), shown(recorded.state.clone()), shown(state)));
    }
    let [x, y] = recorded.velocity_m_s;
    let commands = [
        ("velocity_m_s.0".to_owned(), x, command.velocity_world.x),
        ("velocity_m_s.1".to_owned(), y, command.velocity_world.y),
        ("yaw_rate_rad_s".to_owned(), recorded.yaw_rate_rad_s, command.yaw_rate),
    ];
    let perception = control.perception();
    let of_whiskers = perception.fitted().zip(&recorded.whiskers).flat_map(|((bound, _), recorded)| {
        let RecordedWhisker { whisker, deflection_rad, tip_m, recorded } = recorded;
        let tip = perception.recorded_tip(bound);
        let [x, y] = tip_m.filter(|_| *recorded).map_or([None; 2], |tip| tip.map(Some));
        let coordinate = |axis: usize| tip.map_or(f64::NAN, |tip| tip[axis]);
        [
            (format!("{whisker}.deflection_rad"), *deflection_rad, perception.base_angle(bound)),
            (format!("{whisker}.tip_m.0"), x, coordinate(0)),
            (format!("{whisker}.tip_m.1"), y, coordinate(1)),
        ]
    });
    let differs = |recorded: Option<f64>, replayed: f64| {
        recorded.map(f64::to_bits) != Some(replayed).filter(|replayed| replayed.is_finite()).map(f64::to_bits)
    };
    let found = commands.into_iter().chain(of_whiskers).find(|&(_, recorded, replayed)| differs(recorded, replayed));
    found.map(|(field, recorded, replayed)| {
        let recorded = recorded.map_or_else(|| "null".to_owned(), |recorded| recorded.to_string());
        (field, recorded, replayed.to_string())
    })
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "a test may panic")]
    use super::*;
    use crate::recording::{RecordError, Recorder, record_samples};
    use crate::trial::Trial;
    use vibrissa_language as policy;
    use vibrissa_world::scenario;

    use crate::built_in;
    use vibrissa_text::diagnostic::Source;
    use vibrissa_world::scene::WorldKind;

    type Change = fn(&mut RecordedTick);

    /// A recorded run of at most three seconds. Its state has this transition.
    fn recording_with(transition: &str) -> RunRecording {
        let disk = built_in::SCENARIOS[0];
        let mut scene = scenario::read(&Source::new(disk.path, disk.text)).unwrap();
        (scene.stop.time, scene.stop.loop_closed) = (3.0, None);
        let text = format!(
            "machine m  whisker r0  initial Along  state Along {{ record r0  steer body along direction(body.yaw) at 50 mm/s \
             turning 0 deg/s  {transition} }}"
        );
        let source = Source::new("m.fsm", &text);
        let compiled = policy::compile_with_warnings(&source).unwrap();
        let mut trial = Trial::new(scene, Arc::new(compiled.artifact.program.clone()));
        trial.world = WorldKind::QuasiStatic.into();
        let mut recorder = Recorder::new(&trial, &compiled.artifact, Some(source)).unwrap();
        let result = trial.run_watched(&mut recorder).unwrap();
        RunRecording::read(recorder.finish(result.ending().to_string(), &result.run).unwrap().as_slice()).unwrap()
    }

    fn recording() -> RunRecording {
        recording_with("")
    }

    #[test]
    fn a_run_that_ends_by_success_or_failure_is_repeated() {
        for end in ["Success", "Failure"] {
            let run = recording_with(&format!("after 1 s -> {end}(\"done\")"));
            assert!(run.ticks.len() < recording().ticks.len(), "it ended early: {}", run.ticks.len());
            assert_eq!(replay(&run).unwrap().difference, None, "{end}");
        }
    }

    #[test]
    fn the_samples_of_a_run_alone_give_the_recording_of_its_ticks() {
        let run = recording();
        let content = record_samples(&run.artifact, &run.setup.rig, run.samples.clone()).unwrap();
        let again = RunRecording::read(content.as_slice()).unwrap();
        assert_eq!((&again.samples, &again.ticks), (&run.samples, &run.ticks));
        assert_eq!(replay(&again).unwrap().difference, None);
        let none = record_samples(&run.artifact, &run.setup.rig, Vec::new());
        assert!(matches!(none, Err(RecordError::NoTick)), "{none:?}");
    }

    #[test]
    fn a_result_that_is_not_the_recorded_one_is_named_with_its_tick() {
        let recording = recording();
        assert_eq!(replay(&recording).unwrap().difference, None);
        let changes: [(Change, &str); 5] = [
            (|tick| tick.state = Some("Elsewhere".to_owned()), "state"),
            (|tick| tick.velocity_m_s[1] = tick.velocity_m_s[1].map(f64::next_up), "velocity_m_s.1"),
            (|tick| tick.yaw_rate_rad_s = None, "yaw_rate_rad_s"),
            (|tick| tick.whiskers[0].deflection_rad = Some(1e-9), "r0.deflection_rad"),
            (|tick| tick.whiskers[0].recorded = !tick.whiskers[0].recorded, "r0.tip_m.0"),
        ];
        for (change, field) in changes {
            let mut changed = RunRecording { ticks: recording.ticks.clone(), ..self::recording() };
            // The whisker touches after two seconds.
            change(&mut changed.ticks[80]);
            let difference = replay(&changed).unwrap().difference.unwrap();
            assert_eq!((difference.step, difference.field.as_str()), (80, field));
        }
    }
}
