//! The keys of a rig: in scenarios, in the configuration of a robot, in a mismatch and in the documentation.

mod key;
mod keys;
mod table;

pub use key::{Access, Choice, Part, Place, Refusal, RigKey};
pub use keys::KEYS;
pub use table::{differences_table, keys_table};

/// The beginning of the paths of a whisker's keys.
pub const OF_A_WHISKER: &str = "whiskers.*.";

/// The mappings of a rig, each with its description in messages.
pub const GROUPS: [(&str, &str); 7] = [
    ("platform", "a platform"),
    ("platform.yaw", "the yaw controller"),
    ("whiskers.*", "a whisker"),
    ("whiskers.*.hinge", "a hinge"),
    ("physics", "the physics"),
    ("sensing", "the sensing"),
    ("sensing.estimation", "the estimation"),
];

/// The description of the mapping at a path, with its article.
#[must_use]
pub fn group(path: &str) -> &'static str {
    GROUPS.iter().find(|(group, _)| *group == path).map_or("this part of a rig", |(_, what)| what)
}

/// The key with this path.
#[must_use]
pub fn key(path: &str) -> Option<&'static RigKey> {
    KEYS.iter().find(|key| key.path == path)
}
