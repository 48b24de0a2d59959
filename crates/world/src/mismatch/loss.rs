//! The loss of readings.

/// The consequence of a lost reading.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Loss {
    /// The reading is not a number, as on the robot.
    #[default]
    NotANumber,
    /// The last reading of the whisker is repeated.
    Stale,
    /// The whole sample is missing.
    Missing,
}

impl Loss {
    /// All kinds.
    pub const ALL: [Self; 3] = [Self::NotANumber, Self::Stale, Self::Missing];

    /// The name in scenarios.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::NotANumber => "nan",
            Self::Stale => "stale",
            Self::Missing => "missing",
        }
    }
}
