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

/// Declares the measurements: the name and the topic, what is a point of each entry, and the tags. Then the fields, each with its path.
macro_rules! measurements {
    ($($name:literal $topic:ident $each:literal [$(($tag:literal, $of:literal)),*]
        { $($kind:ident $field:literal = $path:literal;)* })*) => {
        /// All measurements.
        pub const MEASUREMENTS: [Measurement; [$($name),*].len()] = [$(Measurement {
            name: $name,
            topic: Topic::$topic,
            each: $each,
            tags: &[$(($tag, $of)),*],
            fields: &[$(Field { name: $field, path: $path, kind: FieldKind::$kind }),*],
        }),*];
    };
}

measurements! {
    // The message is plain text. Its field has the name that Telegraf gives such messages.
    "vibrissa_status" Status "" [] {
        Text "value" = "";
    }
    "vibrissa_state" State "" [("policy", "policy")] {
        Text "state" = "state";
        Truth "has_failed" = "has_failed";
        Truth "is_paused" = "is_paused";
    }
    "vibrissa_health" Health "" [] {
        Truth "is_running" = "is_running";
        Count "faults" = "faults/*";
        Integer "missed_acquisition" = "missed_periods/acquisition";
        Integer "missed_control" = "missed_periods/control";
        Integer "missed_supervision" = "missed_periods/supervision";
        Integer "lost_records" = "lost_records";
        Integer "buffered_messages" = "buffered_messages";
        Integer "dropped_messages" = "dropped_messages";
    }
    "vibrissa_event" Events "" [("fault", "fault"), ("part", "part")] {
        Text "change" = "change";
    }
    // The last round of the message. A database of every round would be ten times larger.
    "vibrissa_sample" Samples "/buses/*/whiskers/*" [("whisker", "whisker")] {
        Number "field_t" = "field_t/*[last()]";
        Number "base_angle_rad" = "base_angle_rad/*[last()]";
    }
    "vibrissa_pose" Perception "" [] {
        Number "x_m" = "pose/position_m/*[1]";
        Number "y_m" = "pose/position_m/*[2]";
        Number "heading_rad" = "pose/heading_rad";
        Number "sample_age_s" = "sample_age_s";
    }
    "vibrissa_whisker" Perception "/whiskers/*" [("whisker", "whisker")] {
        Number "base_angle_rad" = "base_angle_rad";
        Number "tip_x_m" = "tip_m/*[1]";
        Number "tip_y_m" = "tip_m/*[2]";
    }
    "vibrissa_command" CommandLog "" [] {
        Number "velocity_x_m_per_s" = "machine/velocity_m_per_s/*[1]";
        Number "velocity_y_m_per_s" = "machine/velocity_m_per_s/*[2]";
        Number "yaw_rate_rad_per_s" = "machine/yaw_rate_rad_per_s";
        Count "packets" = "packets/*";
    }
    "vibrissa_latency" Latency "" [] {
        Number "tick_largest_s" = "tick/largest_s";
        Number "tick_lateness_largest_s" = "tick_lateness/largest_s";
        Number "sample_age_largest_s" = "sample_age/largest_s";
        Number "round_largest_s" = "rounds/*[1]/largest_s";
    }
}
