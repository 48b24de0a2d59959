//! Faults that a schedule injects.

use serde::{Deserialize, Serialize};

use crate::config::{Config, ConfigError, read_list};
use crate::fault::{FaultChange, FaultEvent, FaultKind};

/// The longest time of an injection (ms): a day.
const LONGEST_MS: u64 = 86_400_000;
/// Time (ns) after the end of an injected fault in which it still counts as detected. A reading arrives after some periods.
const LATE_NS: u64 = 100_000_000;

/// One injected fault.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Injection {
    /// Time since the machine has begun (ms).
    pub at_ms: u64,
    /// Duration (ms).
    pub for_ms: u64,
    /// The fault.
    pub kind: InjectionKind,
    /// Index of the whisker or of the bus that it concerns.
    #[serde(default)]
    pub part: u8,
}

impl Injection {
    /// Reads a list of faults for a robot.
    ///
    /// # Errors
    /// [`ConfigError::At`] with the place of the first fault that cannot happen to this robot.
    pub fn list(text: &str, config: &Config) -> Result<Vec<Self>, ConfigError> {
        read_list(text, |injection: &Self| injection.check(config))
    }

    /// Returns the key that cannot be so, and the reason.
    fn check(&self, config: &Config) -> Result<(), (&'static str, String)> {
        let Self { at_ms, for_ms, kind, part } = *self;
        if at_ms > LONGEST_MS {
            return Err(("at_ms", format!("`at_ms` cannot be {at_ms}; it must be from 0 to {LONGEST_MS}")));
        }
        let shortest = u64::from(!kind.is_momentary());
        if !(shortest..=LONGEST_MS).contains(&for_ms) {
            return Err(("for_ms", format!("`for_ms` cannot be {for_ms}; it must be from {shortest} to {LONGEST_MS}")));
        }
        let (what, count) = match kind {
            InjectionKind::StuckBus => ("bus", config.buses.len()),
            _ if kind.concerns_a_whisker() => ("whisker", config.rig.whiskers.len()),
            _ if part == 0 => return Ok(()),
            _ => return Err(("part", "this kind of fault concerns no single part; leave out `part`".to_owned())),
        };
        if usize::from(part) < count {
            return Ok(());
        }
        let last = count.saturating_sub(1);
        Err(("part", format!("`part` cannot be {part}; it is the index of a {what} of this robot, from 0 to {last}")))
    }

    /// The time in which the fault can be noticed (ns), from its beginning.
    fn noticeable(&self, begun_ns: u64) -> (u64, u64) {
        let from_ns = begun_ns.saturating_add(self.at_ms.saturating_mul(1_000_000));
        (from_ns, from_ns.saturating_add(self.for_ms.saturating_mul(1_000_000)).saturating_add(LATE_NS))
    }

    /// True if something that happened at `time_ns` may be the effect of this fault. The machine has begun at `begun_ns`.
    #[must_use]
    pub fn may_cause(&self, time_ns: u64, begun_ns: u64) -> bool {
        let (from_ns, until_ns) = self.noticeable(begun_ns);
        (from_ns..=until_ns).contains(&time_ns)
    }

    /// True if the supervisor has noticed this fault. The machine has begun at `begun_ns`, and `events` has all changes of
    /// faults.
    #[must_use]
    pub fn was_detected(&self, events: &[FaultEvent], begun_ns: u64) -> bool {
        let has_part = self.kind.concerns_a_whisker() || self.kind == InjectionKind::StuckBus;
        let part = if has_part { self.part } else { 0 };
        let (from_ns, until_ns) = self.noticeable(begun_ns);
        let mut present_since = None;
        // A fault that the robot must bear leaves nothing to detect.
        let Some(expected) = self.kind.expected() else { return true };
        for event in events.iter().filter(|event| event.fault.kind == expected && event.fault.part == part) {
            match event.change {
                FaultChange::Detected => present_since = Some(event.time_ns),
                FaultChange::Recovered => {
                    let since = present_since.take();
                    if since.is_some_and(|since| since <= until_ns) && event.time_ns >= from_ns {
                        return true;
                    }
                }
                FaultChange::Reacted => {}
            }
        }
        present_since.is_some_and(|since| since <= until_ns)
    }
}

/// The kinds of injected faults.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum InjectionKind {
    /// The sensor's clock stops, so that it has no new data.
    StaleSensor,
    /// The supply of a sensor breaks down for a moment, and its settings are lost.
    BrownOut,
    /// A sensor does not acknowledge its address.
    NoAcknowledge,
    /// The bytes of a sensor are wrong, so that its status is impossible.
    GarbledBytes,
    /// The field at a sensor is beyond its range.
    SaturatedField,
    /// The base moment of a whisker exceeds its limit.
    OverbentWhisker,
    /// A device holds the bus, and every call blocks for 1.024 s.
    StuckBus,
    /// No pose arrives.
    NoPose,
    /// Poses arrive that are not numbers.
    PoseNotANumber,
    /// Poses arrive that are 10 m from the platform.
    DisplacedPose,
    /// The localisation starts again, and numbers its poses from 1.
    LocalisationRestarts,
    /// Another sender sends poses, with larger numbers.
    ForeignPoses,
    /// Headings arrive that are less by a whole turn.
    WrappedHeadings,
    /// The actuator acknowledges nothing.
    SilentActuator,
    /// The actuator acknowledges each packet after 0.2 s.
    LateAcknowledgements,
    /// The actuator acknowledges the last two packets before the fault in turn.
    RepeatedAcknowledgements,
    /// The actuator acknowledges packets that have not been sent.
    FutureAcknowledgements,
    /// The MQTT broker is gone.
    NoBroker,
    /// The control thread does not run.
    ControlStalls,
    /// The control thread panics.
    ControlPanics,
    /// The machine fails.
    MachineFails,
    /// The system asks the program to end.
    Terminate,
}

impl InjectionKind {
    /// All kinds.
    pub const ALL: [Self; 22] = [
        Self::StaleSensor,
        Self::BrownOut,
        Self::NoAcknowledge,
        Self::GarbledBytes,
        Self::SaturatedField,
        Self::OverbentWhisker,
        Self::StuckBus,
        Self::NoPose,
        Self::PoseNotANumber,
        Self::DisplacedPose,
        Self::LocalisationRestarts,
        Self::ForeignPoses,
        Self::WrappedHeadings,
        Self::SilentActuator,
        Self::LateAcknowledgements,
        Self::RepeatedAcknowledgements,
        Self::FutureAcknowledgements,
        Self::NoBroker,
        Self::ControlStalls,
        Self::ControlPanics,
        Self::MachineFails,
        Self::Terminate,
    ];

    /// The fault that the supervisor must detect. `None` if the loop must go on as without it.
    #[must_use]
    pub fn expected(self) -> Option<FaultKind> {
        Some(match self {
            Self::StaleSensor => FaultKind::SensorStale,
            Self::BrownOut | Self::NoAcknowledge => FaultKind::SensorLost,
            Self::GarbledBytes | Self::PoseNotANumber => FaultKind::InvalidReading,
            Self::SaturatedField => FaultKind::Saturated,
            Self::OverbentWhisker => FaultKind::AngleLimit,
            Self::StuckBus => FaultKind::BusBlocked,
            Self::NoPose => FaultKind::PoseOld,
            Self::DisplacedPose => FaultKind::PoseJump,
            Self::LocalisationRestarts => FaultKind::PoseRestarted,
            Self::ForeignPoses => FaultKind::ForeignSender,
            Self::WrappedHeadings => return None,
            Self::SilentActuator
            | Self::LateAcknowledgements
            | Self::RepeatedAcknowledgements
            | Self::FutureAcknowledgements => FaultKind::LinkLost,
            Self::NoBroker => FaultKind::BrokerGone,
            Self::ControlStalls => FaultKind::ControlLate,
            Self::ControlPanics => FaultKind::Panic,
            Self::MachineFails => FaultKind::MachineFailed,
            Self::Terminate => FaultKind::Terminated,
        })
    }

    /// The number of the kind, from 0.
    #[must_use]
    pub fn index(self) -> usize {
        self as usize
    }

    /// True if the fault happens at one moment. Its duration means nothing.
    #[must_use]
    pub fn is_momentary(self) -> bool {
        matches!(
            self,
            Self::BrownOut | Self::ControlPanics | Self::LocalisationRestarts | Self::MachineFails | Self::Terminate
        )
    }

    /// True if the fault concerns the sensor of one whisker.
    #[must_use]
    pub fn concerns_a_whisker(self) -> bool {
        matches!(
            self,
            Self::StaleSensor
                | Self::BrownOut
                | Self::NoAcknowledge
                | Self::GarbledBytes
                | Self::SaturatedField
                | Self::OverbentWhisker
        )
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "a test may panic")]

    use super::*;
    use vibrissa_runtime::rig::Rig;

    fn refusal(text: &str) -> String {
        Injection::list(text, &Config::emulated(Rig::default(), 1.5)).unwrap_err().to_string()
    }

    #[test]
    fn a_fault_that_cannot_happen_is_refused_at_its_place() {
        for (text, line, words) in [
            ("- {at_ms: 2000, for_ms: 300, kind: stale_sensor, part: 99}", 1, "`part` cannot be 99"),
            (
                "- {at_ms: 2, for_ms: 300, kind: no_pose}\n- {at_ms: 2, for_ms: 300, kind: stuck_bus, part: 2}",
                2,
                "from 0 to 1",
            ),
            ("- {at_ms: 2000, for_ms: 18446744073709551615, kind: no_pose}", 1, "from 1 to 86400000"),
            ("- {at_ms: 18446744073709551615, for_ms: 1, kind: no_pose}", 1, "`at_ms` cannot be"),
            ("- {at_ms: 2000, for_ms: 0, kind: silent_actuator}", 1, "`for_ms` cannot be 0"),
            ("- {at_ms: -1, for_ms: 3, kind: no_pose}", 1, "`at_ms`: must be a whole number that is not negative"),
            ("- {at_ms: 1, for_ms: 3, kind: no_poses}", 1, "did you mean `no_pose`?"),
            ("- {at_ms: 1, for_ms: 3, kind: no_pose, part: 300}", 1, "`part`: must be a whole number from 0 to 255"),
            ("- {at_ms: 1, for_ms: 3, kind: no_pose, part: 1}", 1, "leave out `part`"),
            ("- {at: 1, for_ms: 3, kind: no_pose}", 1, "there is no key `at`"),
            ("- {for_ms: 3, kind: no_pose}", 1, "the key `at_ms` is missing"),
            ("kind: no_pose", 1, "must be a list"),
        ] {
            let found = refusal(text);
            assert!(found.starts_with(&format!("line {line}, column ")) && found.contains(words), "{text}: {found}");
        }
    }

    #[test]
    fn a_fault_counts_as_detected_while_it_lasts() {
        let injection = Injection { at_ms: 1000, for_ms: 200, kind: InjectionKind::NoPose, part: 0 };
        let event = |time_ms: u64, change| FaultEvent {
            time_ns: time_ms * 1_000_000,
            fault: crate::fault::Fault { kind: FaultKind::PoseOld, part: 0 },
            change,
        };
        // The machine has begun at 500 ms.
        let is_detected = |events: &[FaultEvent]| injection.was_detected(events, 500_000_000);
        let (detected, recovered) = (FaultChange::Detected, FaultChange::Recovered);
        assert!(!is_detected(&[]));
        assert!(is_detected(&[event(1560, detected)]));
        assert!(is_detected(&[event(1560, detected), event(2000, recovered)]));
        assert!(is_detected(&[event(900, detected), event(1600, recovered)]), "it was present before");
        assert!(!is_detected(&[event(900, detected), event(1400, recovered)]));
        assert!(!is_detected(&[event(1900, detected)]));
        let may_cause = |time_ms: u64| injection.may_cause(time_ms * 1_000_000, 500_000_000);
        assert!(!may_cause(1499) && may_cause(1500) && may_cause(1700) && !may_cause(1801));
        let other = Injection { part: 1, kind: InjectionKind::StaleSensor, ..injection };
        assert!(!other.was_detected(&[event(1560, detected)], 500_000_000));
    }
}
