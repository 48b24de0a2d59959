//! Faults that a schedule injects.

use serde::{Deserialize, Serialize};

use crate::fault::FaultKind;

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
