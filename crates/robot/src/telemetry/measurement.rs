//! The measurements of a time-series database: which parts of a message become tags and fields.
//!
//! The line protocol of [`lines`](super::lines) and the configuration of Telegraf are made from this one table.

use super::topic::Topic;

/// A measurement of a time-series database.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Measurement {
    /// Its name.
    pub name: &'static str,
    /// The topic of its messages.
    pub topic: Topic,
    /// The path of the entries of which each is a point, such as `/whiskers/*`. It is empty if the whole message is one point.
    pub each: &'static str,
    /// Names and paths of the tags. All points also have the tag `robot`, and those of a sensor IO the tag `service`.
    pub tags: &'static [(&'static str, &'static str)],
    /// The fields.
    pub fields: &'static [Field],
}

/// A field of a point.
///
/// Its path is a small part of XPath over JSON: keys, `*[K]` for the entry K of a list from 1, and `*[last()]` for the last one.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Field {
    /// Its name. That of a quantity ends in the unit.
    pub name: &'static str,
    /// Its path below the message, or below the entry of [`Measurement::each`].
    pub path: &'static str,
    /// The kind of its values.
    pub kind: FieldKind,
}

/// The kind of a field.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum FieldKind {
    /// A number with decimals.
    Number,
    /// A whole number.
    Integer,
    /// A text.
    Text,
    /// True or false.
    Truth,
    /// The number of entries of a list. The path ends in `*`.
    Count,
}

const fn field(name: &'static str, path: &'static str, kind: FieldKind) -> Field {
    Field { name, path, kind }
}

use FieldKind::{Count, Integer, Number, Text, Truth};

/// All measurements.
pub const MEASUREMENTS: [Measurement; 9] = [
    Measurement {
        name: "vibrissa_status",
        topic: Topic::Status,
        each: "",
        tags: &[],
        // The message is plain text. Its field has the name that Telegraf gives such messages.
        fields: &[field("value", "", Text)],
    },
    Measurement {
        name: "vibrissa_state",
        topic: Topic::State,
        each: "",
        tags: &[("policy", "policy")],
        fields: &[
            field("state", "state", Text),
            field("has_failed", "has_failed", Truth),
            field("is_paused", "is_paused", Truth),
        ],
    },
    Measurement {
        name: "vibrissa_health",
        topic: Topic::Health,
        each: "",
        tags: &[],
        fields: &[
            field("is_running", "is_running", Truth),
            field("faults", "faults/*", Count),
            field("missed_acquisition", "missed_periods/acquisition", Integer),
            field("missed_control", "missed_periods/control", Integer),
            field("missed_supervision", "missed_periods/supervision", Integer),
            field("lost_records", "lost_records", Integer),
            field("buffered_messages", "buffered_messages", Integer),
            field("dropped_messages", "dropped_messages", Integer),
        ],
    },
    Measurement {
        name: "vibrissa_event",
        topic: Topic::Events,
        each: "",
        tags: &[("fault", "fault"), ("part", "part")],
        fields: &[field("change", "change", Text)],
    },
    Measurement {
        name: "vibrissa_sample",
        topic: Topic::Samples,
        each: "/buses/*/whiskers/*",
        tags: &[("whisker", "whisker")],
        // The last round of the message. A database of every round would be ten times larger.
        fields: &[
            field("field_t", "field_t/*[last()]", Number),
            field("base_angle_rad", "base_angle_rad/*[last()]", Number),
        ],
    },
    Measurement {
        name: "vibrissa_pose",
        topic: Topic::Perception,
        each: "",
        tags: &[],
        fields: &[
            field("x_m", "pose/position_m/*[1]", Number),
            field("y_m", "pose/position_m/*[2]", Number),
            field("heading_rad", "pose/heading_rad", Number),
            field("sample_age_s", "sample_age_s", Number),
        ],
    },
    Measurement {
        name: "vibrissa_whisker",
        topic: Topic::Perception,
        each: "/whiskers/*",
        tags: &[("whisker", "whisker")],
        fields: &[
            field("base_angle_rad", "base_angle_rad", Number),
            field("tip_x_m", "tip_m/*[1]", Number),
            field("tip_y_m", "tip_m/*[2]", Number),
        ],
    },
    Measurement {
        name: "vibrissa_command",
        topic: Topic::CommandLog,
        each: "",
        tags: &[],
        fields: &[
            field("velocity_x_m_per_s", "machine/velocity_m_per_s/*[1]", Number),
            field("velocity_y_m_per_s", "machine/velocity_m_per_s/*[2]", Number),
            field("yaw_rate_rad_per_s", "machine/yaw_rate_rad_per_s", Number),
            field("packets", "packets/*", Count),
        ],
    },
    Measurement {
        name: "vibrissa_latency",
        topic: Topic::Latency,
        each: "",
        tags: &[],
        fields: &[
            field("tick_largest_s", "tick/largest_s", Number),
            field("tick_lateness_largest_s", "tick_lateness/largest_s", Number),
            field("sample_age_largest_s", "sample_age/largest_s", Number),
            field("round_largest_s", "rounds/*[1]/largest_s", Number),
        ],
    },
];
