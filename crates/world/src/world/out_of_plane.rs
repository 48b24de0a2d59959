//! The motion of a tip out of the plane of motion.

/// The motion of a tip out of the plane of motion during a control period.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct OutOfPlane {
    /// The largest distance from the plane (m).
    pub distance: f64,
    /// True if the tip was above the top or below the bottom of the objects.
    pub slips: bool,
}

impl OutOfPlane {
    /// Adds the motion of another period.
    pub fn include(&mut self, other: Self) {
        self.distance = self.distance.max(other.distance);
        self.slips |= other.slips;
    }
}
