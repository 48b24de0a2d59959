//! The note that set-up leaves beside library and plugin.

use std::fmt;
use std::str::FromStr;

/// What was set up, and from what: by this the next set-up sees that there is nothing to do.
#[derive(Debug, PartialEq, Eq)]
pub(crate) struct Stamp {
    pub(crate) mujoco_version: String,
    /// SHA-256 of the wheel that both came from.
    pub(crate) wheel_sha256: String,
    /// SHA-256 of the library.
    pub(crate) library_sha256: String,
    /// SHA-256 of the plugin.
    pub(crate) plugin_sha256: String,
}

/// A stamp's text cannot be read, so what it stands for is not known.
#[derive(Debug, PartialEq, Eq)]
pub(crate) struct UnreadableStamp;

impl fmt::Display for Stamp {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        writeln!(f, "mujoco {}", self.mujoco_version)?;
        writeln!(f, "wheel-sha256 {}", self.wheel_sha256)?;
        writeln!(f, "library-sha256 {}", self.library_sha256)?;
        writeln!(f, "plugin-sha256 {}", self.plugin_sha256)
    }
}

impl FromStr for Stamp {
    type Err = UnreadableStamp;

    fn from_str(text: &str) -> Result<Self, UnreadableStamp> {
        let mut lines = text.lines();
        let mut value_of = |key: &str| {
            let (found, value) = lines.next().and_then(|line| line.split_once(' ')).ok_or(UnreadableStamp)?;
            if found == key { Ok(value.to_owned()) } else { Err(UnreadableStamp) }
        };
        Ok(Self {
            mujoco_version: value_of("mujoco")?,
            wheel_sha256: value_of("wheel-sha256")?,
            library_sha256: value_of("library-sha256")?,
            plugin_sha256: value_of("plugin-sha256")?,
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn stamp() -> Stamp {
        let [mujoco_version, wheel_sha256, library_sha256, plugin_sha256] =
            ["3.17.0", "aa", "bb", "cc"].map(str::to_owned);
        Stamp { mujoco_version, wheel_sha256, library_sha256, plugin_sha256 }
    }

    #[test]
    fn a_stamp_is_read_back_as_it_was_written() {
        assert_eq!(stamp().to_string().parse(), Ok(stamp()));
    }

    #[test]
    fn a_stamp_cut_short_anywhere_is_never_read_as_the_whole() {
        let text = stamp().to_string();
        for length in 0..text.trim_end().len() {
            assert_ne!(text[..length].parse(), Ok(stamp()), "the first {length} bytes");
        }
    }

    #[test]
    fn a_stamp_with_its_lines_exchanged_is_unreadable() {
        let text = "wheel-sha256 aa\nmujoco 3.17.0\nlibrary-sha256 bb\nplugin-sha256 cc\n";
        assert_eq!(text.parse::<Stamp>(), Err(UnreadableStamp));
    }

    #[test]
    fn the_stamp_of_a_library_without_the_plugin_is_unreadable_so_that_both_are_fetched() {
        assert_eq!("mujoco 3.17.0\nwheel-sha256 aa\nlibrary-sha256 bb\n".parse::<Stamp>(), Err(UnreadableStamp));
    }
}
