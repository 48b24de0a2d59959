//! The sensors that a board can have, on an I²C bus at the base of a whisker.
//!
//! A sensor is a module of this folder with the types `Config`, `Model` and `Driver`, which have the traits [`Section`],
//! [`Sensor`] and [`SensorDriver`]. It also has a line in `sensors!`. Nothing else names it.

mod provides;

use serde::{Deserialize, Serialize};
use vibrissa_runtime::units::Key;
use vibrissa_text::diagnostic::Source;
use vibrissa_yaml::{Entry, Node, Placed};

#[cfg(feature = "emulation")]
pub use provides::EmulatedBoard;
pub use provides::{Refused, Section, Sensor, SensorDriver};
pub use vibrissa_mlx90393::BusClock;
#[cfg(feature = "emulation")]
use vibrissa_mlx90393_emulator::{Emulated, SensorFault};

use crate::array::{BoardReading, Bus, ReadingState};
use crate::config::ConfigError;

/// Defines the types of the registry from its lines. The section of the first sensor is `sensor` itself, and that of
/// another one is an entry with its name in there. `each!` matches one of these types, whatever its sensor is.
macro_rules! sensors {
    ($d:tt $first:ident: $First:ident, $($name:ident: $Name:ident,)*) => {
        mod $first;
        $(mod $name;)*

        /// The section `sensor`: the settings that all boards share.
        #[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
        #[serde(rename_all = "snake_case")]
        #[allow(missing_docs, reason = "a variant is a sensor")]
        pub enum SensorConfig {
            $($Name($name::Config),)*
            #[serde(untagged)]
            $First($first::Config),
        }

        /// A sensor with checked settings.
        #[derive(Debug, Clone, Copy, PartialEq)]
        #[allow(missing_docs, reason = "a variant is a sensor")]
        pub enum SensorModel {
            $First($first::Model),
            $($Name($name::Model),)*
        }

        /// The driver of one board.
        #[derive(Debug)]
        #[allow(missing_docs, reason = "a variant is a sensor")]
        pub enum BoardDriver {
            $First($first::Driver),
            $($Name($name::Driver),)*
        }

        impl Default for SensorConfig {
            fn default() -> Self {
                Self::$First($first::Config::default())
            }
        }

        impl SensorConfig {
            /// Reads the section.
            pub(crate) fn read(source: &Source, section: &Placed<Node>) -> Result<Self, ConfigError> {
                match only_entry(section) {
                    $(Some(entry) if entry.key.value == stringify!($name) => {
                        crate::config::read(source, &entry.value).map(Self::$Name)
                    })*
                    _ => crate::config::read(source, section).map(Self::$First),
                }
            }

            /// Path of the keys of the sensor in the configuration.
            pub(crate) fn path(&self) -> &'static str {
                match self {
                    Self::$First(_) => "sensor",
                    $(Self::$Name(_) => concat!("sensor.", stringify!($name)),)*
                }
            }

            /// The sensor with these settings, for a sample rate (Hz).
            ///
            /// # Errors
            /// [`Refused`] if the sensor does not permit them, or if it may be slower than the sample rate.
            pub fn model(&self, sample_rate: f64) -> Result<SensorModel, Refused> {
                match self {
                    Self::$First(config) => config.model(sample_rate).map(SensorModel::$First),
                    $(Self::$Name(config) => config.model(sample_rate).map(SensorModel::$Name),)*
                }
            }
        }

        impl SensorModel {
            /// The driver of the board with this address.
            ///
            /// # Errors
            /// [`Refused`] if the sensor cannot have the address.
            pub fn driver(&self, address: u8) -> Result<BoardDriver, Refused> {
                match self {
                    Self::$First(model) => model.driver(address).map(BoardDriver::$First),
                    $(Self::$Name(model) => model.driver(address).map(BoardDriver::$Name),)*
                }
            }
        }

        macro_rules! each {
            ($d of:expr, $d inner:ident => $d result:expr) => {
                match $d of {
                    Self::$First($d inner) => $d result,
                    $(Self::$Name($d inner) => $d result,)*
                }
            };
        }
    };
}

sensors! { $
    mlx90393: Mlx90393,
}

/// The entry of a mapping that has no other.
fn only_entry(section: &Placed<Node>) -> Option<&Entry> {
    let Node::Mapping(entries) = &section.value else { return None };
    <&[Entry; 1]>::try_from(entries.as_slice()).ok().map(|[entry]| entry)
}

impl SensorConfig {
    /// The numbers of the section (SI) with their keys.
    pub(crate) fn numbers(&self) -> Vec<(f64, Key)> {
        each!(self, config => config.numbers())
    }

    /// Address of the first board on a bus. The addresses of the others follow.
    #[must_use]
    pub fn first_address(&self) -> u8 {
        each!(self, config => config.first_address())
    }
}

impl SensorModel {
    /// Field per count (µT).
    #[must_use]
    pub fn microtesla_per_count(&self) -> f64 {
        each!(self, model => model.microtesla_per_count())
    }

    /// Largest difference between two values (counts) of a whisker at rest.
    #[must_use]
    pub fn largest_rest_spread(&self) -> u32 {
        each!(self, model => model.largest_rest_spread())
    }

    /// Time of a conversion (µs).
    #[must_use]
    pub fn conversion_us(&self) -> u32 {
        each!(self, model => model.conversion_us())
    }

    /// Time (µs) of reading this many boards once, rounded up.
    #[must_use]
    pub fn round_us(&self, boards: u32, clock: BusClock) -> u32 {
        each!(self, model => model.round_us(boards, clock))
    }

    /// The result of a read with these bytes, if there are any.
    #[must_use]
    pub fn decode(&self, received: &[u8]) -> ReadingState {
        each!(self, model => model.decode(received))
    }

    /// Measures the clock of a bus with the board at an address, which has not been started. `now_ns` returns a time (ns).
    ///
    /// # Errors
    /// [`Refused`] if the bus reports an error, or if the times tell nothing.
    pub fn bus_clock<B: Bus>(
        &self,
        bus: &mut B,
        address: u8,
        now_ns: impl FnMut() -> u64,
    ) -> Result<BusClock, Refused> {
        each!(self, model => model.bus_clock(bus, address, now_ns))
    }

    /// An emulated board.
    #[cfg(feature = "emulation")]
    #[must_use]
    pub fn emulated(&self, board: &EmulatedBoard) -> Box<dyn Emulated> {
        each!(self, model => model.emulated(board))
    }

    /// The fault of a board whose answers are impossible.
    #[cfg(feature = "emulation")]
    #[must_use]
    pub fn garbled(&self) -> SensorFault {
        each!(self, model => model.garbled())
    }
}

impl SensorDriver for BoardDriver {
    fn start<B: Bus>(&mut self, bus: &mut B) -> Result<(), Refused> {
        each!(self, driver => driver.start(bus))
    }

    fn read<B: Bus>(&mut self, bus: &mut B) -> BoardReading {
        each!(self, driver => driver.read(bus))
    }
}
