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
pub use vibrissa_mlx90393::{BusClock, RawRead};
#[cfg(feature = "emulation")]
use vibrissa_mlx90393_emulator::{Emulated, SensorFault};

use crate::array::{BoardReading, Bus, ReadingState};
use crate::config::ConfigError;

/// Defines the types of the registry from its lines. The section of the first sensor is `sensor` itself, and that of
/// another one is an entry with its name in there. `each!` passes a call on to the sensor of one of these types.
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
        }

        macro_rules! each {
            ($d of:expr, $d inner:ident => $d result:expr) => {
                match $d of {
                    Self::$First($d inner) => $d result,
                    $(Self::$Name($d inner) => $d result,)*
                }
            };
            ($d of:expr, $d inner:ident => $d to:ident in $d result:expr) => {
                match $d of {
                    Self::$First($d inner) => $d result.map($d to::$First),
                    $(Self::$Name($d inner) => $d result.map($d to::$Name),)*
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

impl Section for SensorConfig {
    type Model = SensorModel;

    fn numbers(&self) -> Vec<(f64, Key)> {
        each!(self, config => config.numbers())
    }

    fn first_address(&self) -> u8 {
        each!(self, config => config.first_address())
    }

    fn model(&self, sample_rate: f64) -> Result<SensorModel, Refused> {
        each!(self, config => SensorModel in config.model(sample_rate))
    }
}

impl Sensor for SensorModel {
    type Driver = BoardDriver;

    fn microtesla_per_count(&self) -> f64 {
        each!(self, model => model.microtesla_per_count())
    }

    fn largest_rest_spread(&self) -> u32 {
        each!(self, model => model.largest_rest_spread())
    }

    fn conversion_us(&self) -> u32 {
        each!(self, model => model.conversion_us())
    }

    fn round_us(&self, boards: u32, clock: BusClock) -> u32 {
        each!(self, model => model.round_us(boards, clock))
    }

    fn decode(&self, received: &[u8]) -> ReadingState {
        each!(self, model => model.decode(received))
    }

    fn bus_clock<B: Bus>(&self, bus: &mut B, address: u8, now_ns: impl FnMut() -> u64) -> Result<BusClock, Refused> {
        each!(self, model => model.bus_clock(bus, address, now_ns))
    }

    fn driver(&self, address: u8) -> Result<BoardDriver, Refused> {
        each!(self, model => BoardDriver in model.driver(address))
    }

    #[cfg(feature = "emulation")]
    fn emulated(&self, board: &EmulatedBoard) -> Box<dyn Emulated> {
        each!(self, model => model.emulated(board))
    }

    #[cfg(feature = "emulation")]
    fn garbled(&self) -> SensorFault {
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
