//! The settings of a map.

use crate::geometry::Point2;
use crate::math;
use crate::rig::Rig;

use super::route_search::Pace;

/// Largest memory of the cells, as their number on a side. Two bits for each are then 16 MB.
const MOST_CELLS: f64 = 8192.0;

/// Size and resolution of a map, and the bounds that a caller knows.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct MapSettings {
    /// Side (m) of the square that the map covers. Its centre is at the first known pose.
    pub extent: f64,
    /// Side (m) of a cell.
    pub cell: f64,
    /// Bound (m) of the error of every measured position. Measured errors are added.
    pub position_bound: f64,
    /// Bound (rad) of the error of every measured heading and of the direction in which a whisker is mounted. Measured
    /// errors are added.
    pub heading_bound: f64,
    /// Speeds by which routes and targets are compared.
    pub pace: Pace,
}

/// Settings that give no map.
#[derive(Debug, Clone, Copy, PartialEq, thiserror::Error)]
pub enum MapError {
    /// A number is not finite, or out of its range.
    #[error("{name} of the map is {value}; it must be finite and {range}")]
    OutOfRange {
        /// The setting.
        name: &'static str,
        /// Its value.
        value: f64,
        /// What is allowed.
        range: &'static str,
    },
    /// The map has too many cells.
    #[error("the map of {extent} m in cells of {cell} m has more than {MOST_CELLS} cells a side; choose larger cells")]
    TooLarge {
        /// Side (m) of the square.
        extent: f64,
        /// Side (m) of a cell.
        cell: f64,
    },
}

impl MapSettings {
    /// Checks the settings.
    ///
    /// # Errors
    /// [`MapError`] if a setting is out of its range.
    pub fn check(&self) -> Result<(), MapError> {
        let rows = [
            ("extent", self.extent, self.extent > 0.0, "positive"),
            ("cell", self.cell, self.cell > 0.0, "positive"),
            ("position_bound", self.position_bound, self.position_bound >= 0.0, "not negative"),
            ("heading_bound", self.heading_bound, self.heading_bound >= 0.0, "not negative"),
            ("pace in proved ground (speed)", self.pace.proved.0, self.pace.proved.0 > 0.0, "positive"),
            ("pace in proved ground (yaw rate)", self.pace.proved.1, self.pace.proved.1 > 0.0, "positive"),
        ];
        for (name, value, is_in_range, range) in rows {
            if !value.is_finite() || !is_in_range {
                return Err(MapError::OutOfRange { name, value, range });
            }
        }
        if self.extent > MOST_CELLS * self.cell {
            return Err(MapError::TooLarge { extent: self.extent, cell: self.cell });
        }
        Ok(())
    }
}

impl MapSettings {
    /// The settings for a rig: the default ones, with routes near surfaces only if whiskers guard the nose.
    ///
    /// The shafts ahead of the nose must extend over its width. Then a surface ahead bends one of them before the nose
    /// reaches it.
    #[must_use]
    pub fn for_rig(rig: &Rig) -> Self {
        let platform = &rig.platform;
        let nose = platform.length - platform.centre_of_mass;
        let tips = rig
            .whiskers
            .iter()
            .map(|whisker| whisker.perceived().base_pose().point_to_world(Point2::new(whisker.shaft.length, 0.0)));
        let ahead = tips.filter(|tip| tip.x > nose);
        let (right, left) =
            ahead.fold((0.0, 0.0), |(right, left), tip| (math::min(right, tip.y), math::max(left, tip.y)));
        let pace = Pace::default();
        let is_guarded = math::min(left, -right) >= 0.5 * platform.nose_width;
        // Whiskers on both sides of the nose also feel what it turns to.
        let guarded = (pace.unknown.0, 2.0 * pace.unknown.1);
        let pace = if is_guarded {
            Pace { unknown: guarded, near_surface: guarded, has_guarded_nose: true, ..pace }
        } else {
            pace
        };
        Self { pace, ..Self::default() }
    }
}

impl Default for MapSettings {
    /// 5 m × 5 m in cells of 2 mm, with exact poses and the default pace.
    fn default() -> Self {
        Self { extent: 5.0, cell: 2e-3, position_bound: 0.0, heading_bound: 0.0, pace: Pace::default() }
    }
}
