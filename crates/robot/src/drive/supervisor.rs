//! The supervisor: it limits and forwards commands, and stops the robot when a part fails.

use std::sync::atomic::{AtomicU64, Ordering};

use vibrissa_runtime::signal::{Command, MAX_WHISKERS};

use crate::config::{Config, FaultResponse, Limits, Responses, Timeouts};
use crate::fault::{Fault, FaultChange, FaultEvent, FaultKind};
use crate::link::{CommandPacket, StampedCommand};
use crate::vitals::Vitals;

/// Parts that one kind of fault can concern: whiskers or buses.
const PARTS: usize = MAX_WHISKERS;

/// The supervisor. It runs on its own thread, so that it can stop the robot when another thread hangs.
#[derive(Debug, Clone)]
pub struct Supervisor {
    limits: Limits,
    timeouts: TimeoutsNs,
    responses: Responses,
    buses: usize,
    whiskers: usize,
    active: [[Option<Active>; PARTS]; FaultKind::ALL.len()],
    /// The bus of each whisker.
    bus_of: [usize; MAX_WHISKERS],
    /// Readings of each whisker that were faults by themselves, until the last step.
    counts: [u64; MAX_WHISKERS],
    /// Occurrences of each kind of fault until the last step.
    occurrences: [u64; FaultKind::ALL.len()],
    sequence: u64,
    command: Command,
}

/// Timeouts in nanoseconds.
#[derive(Debug, Clone, Copy)]
struct TimeoutsNs {
    bus: u64,
    sensor: u64,
    pose: u64,
    control: u64,
    link: u64,
    settle: u64,
}

impl From<Timeouts> for TimeoutsNs {
    fn from(timeouts: Timeouts) -> Self {
        #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "`as` saturates")]
        let ns = |seconds: f64| (seconds * 1e9) as u64;
        Self {
            bus: ns(timeouts.bus),
            sensor: ns(timeouts.sensor),
            pose: ns(timeouts.pose),
            control: ns(timeouts.control),
            link: ns(timeouts.link),
            settle: ns(timeouts.settle),
        }
    }
}

/// A fault that lasts.
#[derive(Debug, Clone, Copy)]
struct Active {
    last_seen_ns: u64,
    has_reacted: bool,
}

impl Supervisor {
    /// The supervisor of a robot.
    #[must_use]
    pub fn new(config: &Config) -> Self {
        let mut bus_of = [0; MAX_WHISKERS];
        for (bus, _, whisker) in config.boards() {
            if let Some(entry) = bus_of.get_mut(whisker) {
                *entry = bus;
            }
        }
        Self {
            limits: config.limits,
            timeouts: config.timeouts.into(),
            responses: config.responses.clone(),
            buses: config.buses.len(),
            whiskers: config.rig.whiskers.len().min(MAX_WHISKERS),
            active: [[None; PARTS]; FaultKind::ALL.len()],
            bus_of,
            counts: [0; MAX_WHISKERS],
            occurrences: [0; FaultKind::ALL.len()],
            sequence: 0,
            command: Command::STOP,
        }
    }

    /// Looks for faults and returns the packet to send. `command` is the newest of the control loop since the last
    /// step, if there is one. `acknowledged_ns` is the time of the newest packet that
    /// the actuator has acknowledged. `log` receives every change
    /// of a fault. The function allocates no memory.
    pub fn step(
        &mut self,
        now_ns: u64,
        vitals: &Vitals,
        command: Option<StampedCommand>,
        acknowledged_ns: Option<u64>,
        mut log: impl FnMut(FaultEvent),
    ) -> CommandPacket {
        if let Some(stamped) = command {
            self.command = limited(stamped.command, &self.limits);
        }
        for kind in FaultKind::ALL {
            for part in 0..self.parts(kind) {
                let is_present = self.is_present(kind, part, now_ns, vitals, acknowledged_ns);
                self.update(kind, part, is_present, now_ns, &mut log);
            }
        }
        for (count, vital) in self.counts.iter_mut().zip(&vitals.sensor) {
            *count = vital.count();
        }
        for (count, kind) in self.occurrences.iter_mut().zip(FaultKind::ALL) {
            *count = vitals.occurrences(kind).unwrap_or(0);
        }
        let is_running = vitals.is_running.load(Ordering::Acquire);
        let is_stop = !is_running || self.is_stopped();
        if is_stop {
            // A command from before the stop must not move the robot after it.
            self.command = Command::STOP;
        }
        vitals.is_stopped.store(is_running && is_stop, Ordering::Release);
        self.sequence += 1;
        CommandPacket { sequence: self.sequence, time_ns: now_ns, command: self.command, is_stop }
    }

    /// Notes that the packet of the last step has been sent at `now_ns`.
    pub fn sent(&mut self, packet: &CommandPacket, now_ns: u64, mut log: impl FnMut(FaultEvent)) {
        if !packet.is_stop {
            return;
        }
        for (kind, parts) in FaultKind::ALL.into_iter().zip(&mut self.active) {
            if self.responses.to(kind) == FaultResponse::Log {
                continue;
            }
            for (part, active) in (0_u8..).zip(parts) {
                if let Some(active) = active
                    && !active.has_reacted
                {
                    active.has_reacted = true;
                    log(FaultEvent { time_ns: now_ns, fault: Fault { kind, part }, change: FaultChange::Reacted });
                }
            }
        }
    }

    /// True while a fault stops the robot.
    #[must_use]
    pub fn is_stopped(&self) -> bool {
        FaultKind::ALL
            .into_iter()
            .zip(&self.active)
            .any(|(kind, parts)| self.responses.to(kind) != FaultResponse::Log && parts.iter().any(Option::is_some))
    }

    /// True if the robot remains stopped until the program is started again.
    #[must_use]
    pub fn has_ended(&self) -> bool {
        FaultKind::ALL
            .into_iter()
            .zip(&self.active)
            .any(|(kind, parts)| self.responses.to(kind) == FaultResponse::Stop && parts.iter().any(Option::is_some))
    }

    /// Number of parts that can have a fault of this kind.
    fn parts(&self, kind: FaultKind) -> u8 {
        let parts = match kind {
            FaultKind::SensorStale
            | FaultKind::SensorLost
            | FaultKind::InvalidReading
            | FaultKind::Saturated
            | FaultKind::AngleLimit => self.whiskers,
            FaultKind::BusBlocked => self.buses,
            _ => 1,
        };
        u8::try_from(parts).unwrap_or(u8::MAX)
    }

    fn is_present(
        &self,
        kind: FaultKind,
        part: u8,
        now_ns: u64,
        vitals: &Vitals,
        acknowledged_ns: Option<u64>,
    ) -> bool {
        let flag = |flag: &std::sync::atomic::AtomicBool| flag.load(Ordering::Acquire);
        match kind {
            FaultKind::Panic => return flag(&vitals.has_panicked),
            FaultKind::Terminated => return flag(&vitals.is_terminated),
            FaultKind::MachineFailed => return flag(&vitals.has_machine_failed),
            FaultKind::BrokerGone => return flag(&vitals.is_broker_gone),
            _ => {}
        }
        if !flag(&vitals.is_running) {
            return false;
        }
        let part = usize::from(part);
        let is_silent = |last: Option<&AtomicU64>, timeout_ns: u64| {
            last.is_some_and(|last| now_ns.saturating_sub(last.load(Ordering::Acquire)) > timeout_ns)
        };
        match kind {
            FaultKind::SensorStale | FaultKind::SensorLost | FaultKind::Saturated => {
                self.has_sensor_fault(kind, part, vitals, &is_silent)
            }
            FaultKind::InvalidReading => {
                let is_without_angle = vitals.without_angle.load(Ordering::Acquire) & (1 << part) != 0;
                (part == 0 && flag(&vitals.is_invalid))
                    || is_without_angle
                    || self.has_sensor_fault(kind, part, vitals, &is_silent)
            }
            FaultKind::AngleLimit => vitals.beyond_limit.load(Ordering::Acquire) & (1 << part) != 0,
            FaultKind::BusBlocked => is_silent(vitals.round_ns.get(part), self.timeouts.bus),
            FaultKind::PoseOld => is_silent(Some(&vitals.pose_ns), self.timeouts.pose),
            FaultKind::PoseJump | FaultKind::PoseRestarted | FaultKind::ForeignSender => {
                vitals.occurrences(kind) > self.occurrences.get(kind.index()).copied()
            }
            FaultKind::ControlLate => is_silent(Some(&vitals.tick_ns), self.timeouts.control),
            FaultKind::LinkLost => acknowledged_ns.is_some_and(|last| now_ns.saturating_sub(last) > self.timeouts.link),
            FaultKind::Panic | FaultKind::Terminated | FaultKind::MachineFailed | FaultKind::BrokerGone => false,
        }
    }

    /// True if a sensor has a fault of this kind: one that is a fault at once, or one that lasts. While its bus is
    /// blocked, the fault is that of the bus.
    fn has_sensor_fault(
        &self,
        kind: FaultKind,
        whisker: usize,
        vitals: &Vitals,
        is_silent: &impl Fn(Option<&AtomicU64>, u64) -> bool,
    ) -> bool {
        let bus = self.bus_of.get(whisker).and_then(|&bus| vitals.round_ns.get(bus));
        let (Some(vital), Some(&count)) = (vitals.sensor.get(whisker), self.counts.get(whisker)) else { return false };
        let lasts = is_silent(vitals.fresh_ns.get(whisker), self.timeouts.sensor) && !is_silent(bus, self.timeouts.bus);
        vital.kind() == Some(kind) && (lasts || vital.count() > count)
    }

    fn update(&mut self, kind: FaultKind, part: u8, is_present: bool, now_ns: u64, log: &mut impl FnMut(FaultEvent)) {
        let response = self.responses.to(kind);
        let Some(active) = self.active.get_mut(kind.index()).and_then(|parts| parts.get_mut(usize::from(part))) else {
            return;
        };
        let fault = Fault { kind, part };
        match active {
            None if is_present => {
                *active = Some(Active { last_seen_ns: now_ns, has_reacted: false });
                log(FaultEvent { time_ns: now_ns, fault, change: FaultChange::Detected });
            }
            Some(active) if is_present => active.last_seen_ns = now_ns,
            Some(last)
                if response != FaultResponse::Stop
                    && now_ns.saturating_sub(last.last_seen_ns) >= self.timeouts.settle =>
            {
                *active = None;
                log(FaultEvent { time_ns: now_ns, fault, change: FaultChange::Recovered });
            }
            _ => {}
        }
    }
}

/// A command within the limits, in the same direction. One that is not finite becomes a stop.
fn limited(command: Command, limits: &Limits) -> Command {
    if !command.is_finite() {
        return Command::STOP;
    }
    let speed = command.velocity_world.norm();
    let scale = if speed > limits.speed { limits.speed / speed } else { 1.0 };
    Command {
        velocity_world: command.velocity_world * scale,
        yaw_rate: command.yaw_rate.clamp(-limits.yaw_rate, limits.yaw_rate),
    }
}
