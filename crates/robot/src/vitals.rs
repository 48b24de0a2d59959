//! Signs of life that the threads of the loop share without locks.

use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};

use vibrissa_runtime::geometry::Pose;
use vibrissa_runtime::signal::MAX_WHISKERS;

use crate::array::{Round, is_plausible_pose};
use crate::config::MAX_BUSES;
use crate::fault::FaultKind;
use crate::histogram::Histogram;

/// Signs of life. Every field is written by one thread and read by the supervisor. Times are in nanoseconds since the
/// start of the program.
#[derive(Debug, Default)]
pub struct Vitals {
    /// End of the last round of each bus.
    pub round_ns: [AtomicU64; MAX_BUSES],
    /// Last time at which each whisker had a new, valid value.
    pub fresh_ns: [AtomicU64; MAX_WHISKERS],
    /// The kind of fault that each whisker has now, and when it began.
    pub sensor: [SensorVital; MAX_WHISKERS],
    /// One bit for each whisker whose base angle has exceeded its limit.
    pub beyond_limit: AtomicU64,
    /// One bit for each whisker whose newest reading has no base angle, because its magnet has no such field.
    pub without_angle: AtomicU64,
    /// Arrival of the last valid pose.
    pub pose_ns: AtomicU64,
    /// End of the last control tick.
    pub tick_ns: AtomicU64,
    /// True once the control loop has begun. Before that, no tick is late.
    pub is_running: AtomicBool,
    /// True while the supervisor stops the robot. The machine waits.
    pub is_stopped: AtomicBool,
    /// True if the machine has failed.
    pub has_machine_failed: AtomicBool,
    /// True if a thread has panicked.
    pub has_panicked: AtomicBool,
    /// True if the program must end.
    pub is_terminated: AtomicBool,
    /// True if the last pose was not a number, or none of a robot.
    pub is_invalid: AtomicBool,
    /// Poses that the platform cannot have reached.
    pub pose_jumps: AtomicU64,
    /// Sequences of poses after the first one.
    pub pose_restarts: AtomicU64,
    /// Packets of other senders than the one of the poses.
    pub foreign_packets: AtomicU64,
    /// True while the telemetry has no broker.
    pub is_broker_gone: AtomicBool,
    /// End of the last step of the supervisor.
    pub supervised_ns: AtomicU64,
    /// Time from the scheduled start to the end of a round, for each bus.
    pub round_time: [Histogram; MAX_BUSES],
    /// Duration of a control tick.
    pub tick_time: Histogram,
    /// Time from the scheduled start of a control tick to its start.
    pub tick_lateness: Histogram,
    /// Age of the newest sample at the start of a control tick.
    pub sample_age: Histogram,
    /// Missed periods of acquisition on each bus, of control and of supervision.
    pub missed: [AtomicU64; Phase::ALL.len()],
}

/// The newest fault of a whisker's sensor.
#[derive(Debug, Default)]
pub struct SensorVital {
    /// Its kind, by its index plus one. 0 is none.
    kind: AtomicU64,
    /// Number of readings that were faults by themselves.
    count: AtomicU64,
}

vibrissa_runtime::kinds! {
    /// The phases of the loop, for counts of missed periods.
    #[derive(Debug, Clone, Copy, PartialEq, Eq)]
    pub enum Phase,
    /// The name of the phase in messages.
    fn name {
        /// Reading of the sensors.
        Acquisition = "acquisition",
        /// The control tick.
        Control = "control",
        /// Supervision and sending of commands.
        Supervision = "supervision",
    }
}

impl SensorVital {
    /// Sets the fault of a reading. One that is a fault by itself is counted.
    fn set(&self, kind: FaultKind, is_fault_at_once: bool) {
        self.kind.store(kind.index() as u64 + 1, Ordering::Release);
        if is_fault_at_once {
            self.count.fetch_add(1, Ordering::AcqRel);
        }
    }

    /// The kind of the newest fault, if there was one.
    #[must_use]
    pub fn kind(&self) -> Option<FaultKind> {
        let index = usize::try_from(self.kind.load(Ordering::Acquire)).ok()?.checked_sub(1)?;
        FaultKind::ALL.get(index).copied()
    }

    /// Number of readings that were faults by themselves.
    #[must_use]
    pub fn count(&self) -> u64 {
        self.count.load(Ordering::Acquire)
    }
}

impl Vitals {
    /// Executes the work of a thread. If it panics, the supervisor stops the robot, and the result is `None`.
    pub fn guard<T>(&self, work: impl FnOnce() -> T) -> Option<T> {
        // After a panic, the thread ends, and nobody uses what the work has left behind.
        let result = catch_unwind(AssertUnwindSafe(work));
        if result.is_err() {
            self.has_panicked.store(true, Ordering::Release);
        }
        result.ok()
    }

    /// Notes the arrival of a pose. True if it is valid.
    pub fn pose_arrived(&self, pose: &Pose, now_ns: u64) -> bool {
        let is_valid = is_plausible_pose(pose);
        self.is_invalid.store(!is_valid, Ordering::Release);
        if is_valid {
            self.pose_ns.store(now_ns, Ordering::Release);
        }
        is_valid
    }

    /// Notes a pose that the platform cannot have reached.
    pub fn pose_jumped(&self) {
        self.pose_jumps.fetch_add(1, Ordering::AcqRel);
    }

    /// Notes that the localisation has begun a new sequence.
    pub fn pose_restarted(&self) {
        self.pose_restarts.fetch_add(1, Ordering::AcqRel);
    }

    /// Notes a packet of another sender than the one of the poses.
    pub fn foreign_packet(&self) {
        self.foreign_packets.fetch_add(1, Ordering::AcqRel);
    }

    /// Number of times that a fault of this kind has occurred, if the kind has occurrences and does not last.
    #[must_use]
    pub fn occurrences(&self, kind: FaultKind) -> Option<u64> {
        let count = match kind {
            FaultKind::PoseJump => &self.pose_jumps,
            FaultKind::PoseRestarted => &self.pose_restarts,
            FaultKind::ForeignSender => &self.foreign_packets,
            _ => return None,
        };
        Some(count.load(Ordering::Acquire))
    }

    /// Notes a round on a bus whose boards belong to these whiskers.
    pub fn round_ended(&self, round: &Round, whiskers: &[usize]) {
        for (&whisker, reading) in whiskers.iter().zip(&round.readings) {
            let (Some(vital), Some(fresh)) = (self.sensor.get(whisker), self.fresh_ns.get(whisker)) else { continue };
            match reading.state.fault() {
                None => fresh.store(round.ended_ns, Ordering::Release),
                Some(kind) => vital.set(kind, reading.state.is_fault_at_once()),
            }
        }
        if let Some(last) = self.round_ns.get(usize::from(round.bus)) {
            last.store(round.ended_ns, Ordering::Release);
        }
    }

    /// Notes whether the newest reading of a whisker has a base angle.
    pub fn angle_taken(&self, whisker: usize, is_finite: bool) {
        let bit = 1_u64.checked_shl(u32::try_from(whisker).unwrap_or(u32::MAX)).unwrap_or(0);
        if is_finite {
            self.without_angle.fetch_and(!bit, Ordering::AcqRel);
        } else {
            self.without_angle.fetch_or(bit, Ordering::AcqRel);
        }
    }

    /// Counts missed periods of a phase.
    pub fn miss(&self, phase: Phase, periods: u64) {
        if let Some(count) = self.missed.get(phase as usize) {
            count.fetch_add(periods, Ordering::Relaxed);
        }
    }

    /// Missed periods of a phase.
    #[must_use]
    pub fn missed(&self, phase: Phase) -> u64 {
        self.missed.get(phase as usize).map_or(0, |count| count.load(Ordering::Relaxed))
    }
}
