//! Settings of a sensor.

use crate::axes::{Axes, Axis};
use crate::code::{BurstInterval, DigitalFilter, Gain, Oversampling};

/// Choice of 16 of the 19 bits of a conversion (`RES_X`, `RES_Y`, `RES_Z`). Each step doubles the field per count.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Resolution {
    /// The finest counts.
    R0,
    /// Twice the field per count.
    R1,
    /// Four times the field per count. The output range is ±22 000 counts.
    R2,
    /// Eight times the field per count. The output range is ±11 000 counts.
    R3,
}

impl Resolution {
    /// The code in the register.
    #[must_use]
    pub const fn code(self) -> u8 {
        match self {
            Self::R0 => 0,
            Self::R1 => 1,
            Self::R2 => 2,
            Self::R3 => 3,
        }
    }
}

/// The resolution of each axis.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub struct Resolutions {
    /// Resolution of X.
    pub x: Resolution,
    /// Resolution of Y.
    pub y: Resolution,
    /// Resolution of Z.
    pub z: Resolution,
}

impl Resolutions {
    /// The same resolution for all axes.
    #[must_use]
    pub const fn all(resolution: Resolution) -> Self {
        Self { x: resolution, y: resolution, z: resolution }
    }

    /// The resolution of an axis.
    #[must_use]
    pub const fn of(self, axis: Axis) -> Resolution {
        match axis {
            Axis::X => self.x,
            Axis::Y => self.y,
            Axis::Z => self.z,
        }
    }
}

/// Spinning of the Hall plates (`HALLCONF`).
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Hall {
    /// `HALLCONF` 0xC, the factory setting. It forbids the three shortest filters.
    FourPhase,
    /// `HALLCONF` 0x0. It permits all filters, and a count is 98/75 of the field.
    TwoPhase,
}

impl Hall {
    /// The code in the register.
    #[must_use]
    pub const fn code(self) -> u8 {
        match self {
            Self::FourPhase => 0xC,
            Self::TwoPhase => 0x0,
        }
    }
}

/// Direction of the pin INT/TRG (`TRIG_INT_SEL`).
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum TriggerPin {
    /// The pin is an input that can start a conversion.
    Input,
    /// The pin is an output that is high while new data waits.
    DataReady,
}

/// Settings of a sensor. [`Settings::check`] refuses combinations that the data sheet forbids.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub struct Settings {
    /// Gain of the analog path.
    pub gain: Gain,
    /// Resolution of each axis.
    pub resolution: Resolutions,
    /// Oversampling of the field.
    pub oversampling: Oversampling,
    /// Oversampling of the temperature (`OSR2`).
    pub temperature_oversampling: Oversampling,
    /// Digital filter of the field.
    pub filter: DigitalFilter,
    /// Spinning of the Hall plates.
    pub hall: Hall,
    /// The converted quantities.
    pub axes: Axes,
    /// Pause between conversions.
    pub burst_interval: BurstInterval,
    /// True if the sensor compensates the drift of its sensitivity (`TCMP_EN`). Counts then have an offset code.
    pub temperature_compensation: bool,
    /// Direction of the pin INT/TRG.
    pub trigger_pin: TriggerPin,
    /// True if a pulse at the pin starts a conversion (`EXT_TRIG`). The pin must be an input.
    pub external_trigger: bool,
}

impl Settings {
    /// The settings of the whisker array: only Y, 0.15 µT per count, and at least 300 conversions per second.
    ///
    /// The filter is the strongest one that guarantees this rate with this oversampling. The pin is an input, because an
    /// output would drive against a pin that is tied to ground.
    #[must_use]
    pub const fn array() -> Self {
        Self {
            gain: Gain::MOST_SENSITIVE,
            resolution: Resolutions::all(Resolution::R0),
            oversampling: Oversampling::OSR_2,
            temperature_oversampling: Oversampling::OSR_0,
            filter: DigitalFilter::FILTER_3,
            hall: Hall::FourPhase,
            axes: Axes::Y,
            burst_interval: BurstInterval::CONTINUOUS,
            temperature_compensation: false,
            trigger_pin: TriggerPin::Input,
            external_trigger: false,
        }
    }

    /// The settings of the array for all three axes: a weaker filter keeps 300 conversions per second.
    #[must_use]
    pub const fn array_xyz() -> Self {
        Self { oversampling: Oversampling::OSR_1, filter: DigitalFilter::FILTER_2, axes: Axes::XYZ, ..Self::array() }
    }
}
