//! The times of the stop and of the return of the motion when a link fails, in emulated time.

use vibrissa_robot::emulation::{Injection, InjectionKind, Settings};
use vibrissa_robot::fault::{FaultChange, FaultKind};
use vibrissa_runtime::geometry::Pose;

use super::robot::{MS, config, robot};

/// The longest time (ns) from a fault to the stop, and from its end to the motion.
const LONGEST_NS: u64 = 200 * MS;

/// A packet: its time (ns) since the machine has begun, and whether it moves the platform.
type Packets = Vec<(u64, bool)>;

/// The packets of a run with one fault, and the kinds of faults that were detected.
fn packets(kind: InjectionKind, at_ms: u64, for_ms: u64) -> (Packets, Vec<FaultKind>) {
    let injections = vec![Injection { at_ms, for_ms, kind, part: 0 }];
    let mut robot = robot(&Settings { seed: at_ms, injections, ..Settings::default() });
    let (mut packets, mut kinds) = (Vec::new(), Vec::new());
    while robot.begun_ns().is_none_or(|begun_ns| robot.now_ns() < begun_ns + (at_ms + for_ms + 1500) * MS) {
        robot.run(robot.now_ns() + 10 * MS, |_, _, _, _| true).unwrap();
        while robot.next_record().is_some() {}
        if let (Some(packet), Some(begun_ns)) = (robot.last_packet(), robot.begun_ns()) {
            let moves = packet.command.velocity_world.norm() > 0.0 || packet.command.yaw_rate != 0.0;
            packets.push((packet.time_ns.saturating_sub(begun_ns), moves));
        }
        let events = robot.take_events().into_iter();
        kinds.extend(events.filter(|event| event.change == FaultChange::Detected).map(|event| event.fault.kind));
    }
    (packets, kinds)
}

/// Asserts that the platform stands still from 200 ms after a fault until it ends, and moves from 200 ms after that.
#[track_caller]
fn stops_and_goes_on(kind: InjectionKind, at_ms: u64, for_ms: u64, sound_ms: u64, expected: FaultKind) {
    let (packets, kinds) = packets(kind, at_ms, for_ms);
    let (begin, sound) = (at_ms * MS, sound_ms * MS);
    assert!(kinds.contains(&expected), "{kind:?} at {at_ms} ms: {kinds:?}");
    let moves = |from: u64, to: u64| packets.iter().filter(move |(time, _)| (from..to).contains(time));
    assert!(moves(begin - 300 * MS, begin).any(|(_, moves)| *moves), "it moves before {kind:?}");
    let mut stopped = moves(begin, sound + 100 * MS).filter(|(_, moves)| !*moves);
    assert!(stopped.next().is_some_and(|(time, _)| *time <= begin + LONGEST_NS), "{kind:?} at {at_ms} ms");
    if begin + LONGEST_NS < sound {
        assert!(moves(begin + LONGEST_NS, sound).all(|(_, moves)| !*moves), "{kind:?} at {at_ms} ms");
    }
    let next = moves(sound, u64::MAX).find(|(_, moves)| *moves);
    assert!(next.is_some_and(|(time, _)| *time <= sound + LONGEST_NS), "{kind:?} at {at_ms} ms: {next:?}");
}

#[test]
fn acknowledgements_that_are_late_repeated_or_of_the_future_stop_the_robot_within_200_ms_and_it_goes_on_within_200_ms()
{
    for kind in [
        InjectionKind::LateAcknowledgements,
        InjectionKind::RepeatedAcknowledgements,
        InjectionKind::FutureAcknowledgements,
        InjectionKind::SilentActuator,
    ] {
        for at_ms in [1000, 1003, 1337, 2409] {
            stops_and_goes_on(kind, at_ms, 900, at_ms + 900, FaultKind::LinkLost);
        }
    }
}

#[test]
fn a_localisation_that_restarts_stops_the_robot_within_200_ms_and_it_goes_on_200_ms_after_the_timeout_of_poses() {
    let timeout_ms = config(&Settings::default()).timeouts.pose_ns() / MS;
    for at_ms in [1000, 1001, 1003, 1337, 2409, 5000] {
        // The first pose after the timeout, at 300 Hz.
        let sound_ms = at_ms + timeout_ms + 7;
        stops_and_goes_on(InjectionKind::LocalisationRestarts, at_ms, 0, sound_ms, FaultKind::PoseRestarted);
    }
}

#[test]
fn displaced_poses_stop_the_robot_and_never_reach_the_machine() {
    for at_ms in [1000, 1337] {
        stops_and_goes_on(InjectionKind::DisplacedPose, at_ms, 900, at_ms + 900, FaultKind::PoseJump);
    }
}

/// The poses that the machine has at its ticks, and the kinds of faults that were detected.
fn poses(injections: Vec<Injection>) -> (Vec<Pose>, Vec<FaultKind>) {
    let mut robot = robot(&Settings { injections, ..Settings::default() });
    let (mut poses, mut kinds) = (Vec::new(), Vec::new());
    while robot.now_ns() < 6000 * MS {
        let observe = |control: &vibrissa_runtime::control::Control, _, _: &_, _: &mut _| {
            poses.push(control.perception().pose());
            true
        };
        robot.run(robot.now_ns() + 100 * MS, observe).unwrap();
        while robot.next_record().is_some() {}
        kinds.extend(robot.take_events().into_iter().map(|event| event.fault.kind));
    }
    (poses, kinds)
}

#[test]
fn wrapped_headings_and_the_poses_of_a_stranger_change_no_pose_of_the_machine() {
    let (without, kinds) = poses(Vec::new());
    assert!(without.len() > 140 && kinds.is_empty(), "{kinds:?}");
    for (kind, faults) in
        [(InjectionKind::WrappedHeadings, vec![]), (InjectionKind::ForeignPoses, vec![FaultKind::ForeignSender; 2])]
    {
        let (with, kinds) = poses(vec![Injection { at_ms: 1500, for_ms: 1203, kind, part: 0 }]);
        assert_eq!(kinds, faults, "{kind:?}");
        assert_eq!(with.len(), without.len());
        let apart =
            with.iter().zip(&without).map(|(a, b)| (a.position - b.position).norm() + (a.heading - b.heading).abs());
        // A turn that is added and taken off costs the last digits.
        assert!(apart.fold(0.0, f64::max) < 1e-9, "{kind:?}");
    }
}
