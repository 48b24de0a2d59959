//! The emulated localisation and the emulated actuator.

use std::collections::VecDeque;
use std::net::{Ipv4Addr, SocketAddr};

use vibrissa_runtime::geometry::{Pose, Vector2};

use super::injection::InjectionKind;
use super::scheduler::Present;
use crate::config::{Config, Sender};
use crate::link::{Acknowledgements, CommandPacket, PoseGate, PosePacket, ReceivedPose};
use crate::vitals::Vitals;

/// Distance (m) of displaced poses.
const DISPLACEMENT: f64 = 10.0;
/// Delay (ns) of late acknowledgements.
const LATE_NS: u64 = 200_000_000;
/// Numbers by which a packet is ahead that has not been sent.
const AHEAD: u64 = 1000;
/// Acknowledgements that have not arrived: more than those of a delay.
const ANSWERS: usize = 64;
/// Addresses of the localisation, and of somebody else.
const LOCALISATION: SocketAddr = SocketAddr::new(std::net::IpAddr::V4(Ipv4Addr::new(192, 168, 1, 20)), 9752);
const STRANGER: SocketAddr = SocketAddr::new(std::net::IpAddr::V4(Ipv4Addr::new(192, 168, 1, 66)), 9752);

/// The emulated links, with the code of the real ones behind the network.
#[derive(Debug)]
pub(super) struct Links {
    from: Sender,
    gate: PoseGate,
    /// Sequence number of the last pose.
    pose_number: u64,
    acknowledgements: Acknowledgements,
    /// Acknowledgements that have not arrived: time of arrival (ns) and number.
    answers: VecDeque<(u64, u64)>,
    /// The first of the two packets that the actuator acknowledges in turn.
    repeated: Option<u64>,
}

impl Links {
    pub(super) fn new(config: &Config) -> Self {
        Self {
            from: Sender::from(LOCALISATION),
            gate: PoseGate::new(config),
            pose_number: 0,
            acknowledgements: Acknowledgements::default(),
            answers: VecDeque::with_capacity(ANSWERS),
            repeated: None,
        }
    }

    /// The pose that the loop takes, if the platform is at `pose`.
    pub(super) fn pose(&mut self, pose: Pose, now_ns: u64, present: &Present, vitals: &Vitals) -> Option<Pose> {
        if present.has(InjectionKind::ForeignPoses) {
            let pose = Pose { position: pose.position + Vector2::new(0.01, 0.0), ..pose };
            let _ = self.receive(&PosePacket { sequence: self.pose_number + AHEAD, pose }, STRANGER, now_ns, vitals);
        }
        if present.has(InjectionKind::NoPose) {
            return None;
        }
        let mut sent = pose;
        if present.has(InjectionKind::DisplacedPose) {
            sent.position.x += DISPLACEMENT;
        }
        if present.has(InjectionKind::WrappedHeadings) {
            sent.heading -= std::f64::consts::TAU;
        }
        if present.has(InjectionKind::PoseNotANumber) {
            sent = Pose::UNKNOWN;
        }
        self.pose_number += 1;
        self.receive(&PosePacket { sequence: self.pose_number, pose: sent }, LOCALISATION, now_ns, vitals)
    }

    fn receive(&mut self, packet: &PosePacket, sender: SocketAddr, now_ns: u64, vitals: &Vitals) -> Option<Pose> {
        match ReceivedPose::read(&packet.to_bytes(), sender, Some(self.from))? {
            ReceivedPose::Packet(packet) => self.gate.take(&packet, now_ns, vitals),
            ReceivedPose::Foreign => {
                vitals.foreign_packet();
                None
            }
        }
    }

    /// Numbers the poses from 1 again.
    pub(super) fn restart_localisation(&mut self) {
        self.pose_number = 0;
    }

    /// Time (ns) at which the newest acknowledged packet was sent.
    pub(super) fn acknowledged_ns(&mut self, now_ns: u64) -> u64 {
        while let Some((_, number)) = self.answers.pop_front_if(|(arrival_ns, _)| *arrival_ns <= now_ns) {
            self.acknowledgements.received(number);
        }
        self.acknowledgements.last_ns(now_ns)
    }

    /// Sends a packet. The actuator answers.
    pub(super) fn send(&mut self, packet: &CommandPacket, now_ns: u64, present: &Present) {
        let sequence = packet.sequence;
        self.acknowledgements.sent(sequence, now_ns);
        if !present.has(InjectionKind::RepeatedAcknowledgements) {
            self.repeated = None;
        }
        let answer = if present.has(InjectionKind::SilentActuator) {
            return;
        } else if present.has(InjectionKind::RepeatedAcknowledgements) {
            let first = *self.repeated.get_or_insert(sequence.saturating_sub(2));
            (now_ns, first + sequence % 2)
        } else if present.has(InjectionKind::FutureAcknowledgements) {
            (now_ns, sequence + AHEAD)
        } else if present.has(InjectionKind::LateAcknowledgements) {
            (now_ns + LATE_NS, sequence)
        } else {
            // What is still on its way is older.
            self.answers.clear();
            (now_ns, sequence)
        };
        if self.answers.len() < ANSWERS {
            self.answers.push_back(answer);
        }
    }
}
