//! Groups of figures in the document of a run.

use super::figure::sentence;

/// Figures under one key of the document of a run.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Group {
    /// The key, with a dot before each nested key.
    pub key: &'static str,
    /// The meaning: lower-case, without a full stop.
    pub meaning: &'static str,
    /// True if the key is null for a run that has none of the figures.
    pub may_be_null: bool,
}

const fn group(key: &'static str, meaning: &'static str) -> Group {
    Group { key, meaning, may_be_null: false }
}

const fn or_null(key: &'static str, meaning: &'static str) -> Group {
    Group { may_be_null: true, ..group(key, meaning) }
}

/// All groups. A key of a figure with a dot belongs to the group before the dot.
pub static GROUPS: [Group; 21] = [
    group("error_mm", "distance of the tip estimates from the nearest surface"),
    or_null("tip_error_mm", "distance of the tip estimates from the true tips. `null` if the run recorded no tip"),
    group("tip_error_mm.along", "along the contour"),
    group("tip_error_mm.across", "perpendicular to the contour"),
    or_null("passage", "passage of the platform through a tunnel. `null` outside of tunnels"),
    or_null("map", "the map by touch. `null` if the policy uses none"),
    or_null(
        "retrieval",
        "retrievals of whiskers that had lost the object, by the baseline's definitions (section 5.2 of its report). `null` if the policy made no marks",
    ),
    group(
        "retrieval.radius_mm",
        "distance between the edge point, the last recorded tip before contact was lost, and the point at which contact was found again",
    ),
    group("retrieval.distance_mm", "length of the path of the platform's centre of mass between the two"),
    group("retrieval.time_s", "time between the two"),
    or_null("axis_mm", "distance of the estimated midpoints from the axis of a tunnel. `null` outside of tunnels"),
    or_null(
        "corners",
        "accuracy and cost of the sharp corners, which turn by more than 20\u{b0}. `null` if the reference has none",
    ),
    group(
        "corners.place_mm",
        "distance of the estimated corner from the exact one. The estimated corner is the intersection of lines through the tips of its two sides",
    ),
    group(
        "corners.angle_rad",
        "magnitude of the difference between the turning angles of the estimated and the exact corner",
    ),
    group(
        "corners.edge_mm",
        "distance between the corner and the last tip before the whisker left the contour. `null` if it never left it",
    ),
    group(
        "corners.time_s",
        "time from that tip to the first tip after the whisker was back on the contour. 0 if it did not leave it",
    ),
    group("corners.path_m", "path of the platform's centre of mass in that time"),
    group("collisions", "contacts of the platform's body"),
    or_null("out_of_plane", "motion of tips out of the plane. `null` for planar whiskers"),
    or_null(
        "inclination",
        "angle between a shaft at its base and the surface that it follows, as perceived. `null` if no whisker recorded a contour",
    ),
    group("tick_us", "wall time of a control tick"),
];

impl Group {
    /// The group with this key.
    #[must_use]
    pub fn of(key: &str) -> Option<&'static Self> {
        GROUPS.iter().find(|group| group.key == key)
    }

    /// The meaning as a sentence.
    #[must_use]
    pub fn sentence(&self) -> String {
        sentence(self.meaning)
    }
}
