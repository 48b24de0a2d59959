//! Measured quantities.

/// An axis of the magnetic field, in the frame of the sensor's package.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Axis {
    /// X, in the plane of the chip.
    X,
    /// Y, in the plane of the chip.
    Y,
    /// Z, normal to the chip.
    Z,
}

impl Axis {
    /// All axes, in the order of their conversion.
    pub const ALL: [Self; 3] = [Self::X, Self::Y, Self::Z];
}

/// The quantities that a sensor converts: temperature and axes of the field.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
#[allow(clippy::struct_excessive_bools, reason = "they are four independent bits of the commands")]
pub struct Axes {
    /// Temperature.
    pub t: bool,
    /// Field along X.
    pub x: bool,
    /// Field along Y.
    pub y: bool,
    /// Field along Z.
    pub z: bool,
}

impl Axes {
    /// Only Y.
    pub const Y: Self = Self { t: false, x: false, y: true, z: false };
    /// The three axes of the field, without temperature.
    pub const XYZ: Self = Self { t: false, x: true, y: true, z: true };
    /// Temperature and the three axes.
    pub const TXYZ: Self = Self { t: true, x: true, y: true, z: true };

    /// The low nibble of commands: bit 3 is Z, bit 2 Y, bit 1 X and bit 0 temperature.
    #[must_use]
    pub const fn nibble(self) -> u8 {
        (self.z as u8) << 3 | (self.y as u8) << 2 | (self.x as u8) << 1 | self.t as u8
    }

    /// The quantities of a nibble. Bits above the lowest four are ignored.
    #[must_use]
    pub const fn from_nibble(nibble: u8) -> Self {
        Self { t: nibble & 1 != 0, x: nibble & 2 != 0, y: nibble & 4 != 0, z: nibble & 8 != 0 }
    }

    /// Number of converted quantities.
    #[must_use]
    pub const fn count(self) -> u8 {
        self.t as u8 + self.magnetic_count()
    }

    /// Number of converted axes of the field.
    #[must_use]
    pub const fn magnetic_count(self) -> u8 {
        self.x as u8 + self.y as u8 + self.z as u8
    }

    /// True if the axis is converted.
    #[must_use]
    pub const fn has(self, axis: Axis) -> bool {
        match axis {
            Axis::X => self.x,
            Axis::Y => self.y,
            Axis::Z => self.z,
        }
    }

    /// Length of the answer to a read in bytes: the status and two bytes per quantity.
    #[must_use]
    pub const fn answer_length(self) -> u8 {
        1 + 2 * self.count()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_nibble_and_its_axes_are_the_same_thing() {
        for nibble in 0..16_u8 {
            let axes = Axes::from_nibble(nibble);
            assert_eq!(axes.nibble(), nibble);
            assert_eq!(u32::from(axes.count()), nibble.count_ones());
        }
        assert_eq!((Axes::Y.nibble(), Axes::XYZ.nibble(), Axes::TXYZ.nibble()), (0x4, 0xE, 0xF));
    }
}
