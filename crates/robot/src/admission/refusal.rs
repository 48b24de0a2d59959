//! The reasons why a machine is not admitted, or runs slower.

use vibrissa_runtime::machine::UnmetRate;

/// A need that the device does not meet at a rate.
#[derive(Debug, Clone, Copy, PartialEq, thiserror::Error)]
pub enum Shortfall {
    /// A configured rate is not one that the policy allows.
    #[error("{0}")]
    Rate(#[from] UnmetRate),
    /// A tick takes too long.
    #[error(
        "a tick takes up to {:.1} ms on this device, more than half of the control period of {:.1} ms",
        tick * 1e3, period * 1e3
    )]
    Tick {
        /// Longest tick (s).
        tick: f64,
        /// Control period (s).
        period: f64,
    },
    /// A tick may end too late after the one before it.
    #[error(
        "a tick of {:.1} ms in a control period of {:.1} ms exceeds the timeout of `control`",
        tick * 1e3, period * 1e3
    )]
    Deadline {
        /// Longest tick (s).
        tick: f64,
        /// Control period (s).
        period: f64,
    },
    /// A bus is too slow for its boards.
    #[error(
        "a round on bus {bus} takes {} µs at its clock of {clock_khz} kHz, more than 40 % of the sample period of {:.0} µs",
        time_us, period * 1e6
    )]
    Bus {
        /// Index of the bus.
        bus: usize,
        /// Time of a round (µs).
        time_us: u32,
        /// Measured clock (kHz).
        clock_khz: u32,
        /// Sample period (s).
        period: f64,
    },
    /// Samples are too old.
    #[error("a sample is up to {:.1} ms old on this device, and the machine needs at most {:.1} ms", age * 1e3, most * 1e3)]
    Age {
        /// Largest age (s).
        age: f64,
        /// Age that the machine needs (s).
        most: f64,
    },
}

/// The reason why a machine is not admitted.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum Refusal {
    /// The rig lacks a whisker.
    #[error(
        "the machine needs the whisker `{0}`, which the array does not have; add a board, or compile another policy"
    )]
    Whisker(String),
    /// A bus has a lower clock than the configuration demands.
    #[error(
        "the clock of bus {bus} is {clock_khz} kHz, less than the {least_khz} kHz of the configuration; set its baud rate in \
         config.txt, and update a kernel from before December 2023"
    )]
    Clock {
        /// Index of the bus.
        bus: usize,
        /// Measured clock (kHz).
        clock_khz: u32,
        /// Lowest clock of the configuration (kHz).
        least_khz: u32,
    },
    /// The device meets a need at no rate that the policy allows.
    #[error("{shortfall}; {}", remedy(shortfall))]
    Shortfall {
        /// The need, at the rate at which the device comes closest to it.
        #[from]
        shortfall: Shortfall,
    },
    /// The sensors have settings that they do not permit.
    #[error(transparent)]
    Config(#[from] crate::config::ConfigError),
}

impl Refusal {
    /// True if the reason is a need of the machine, so that another machine may be admitted on the same device.
    #[must_use]
    pub fn concerns_machine(&self) -> bool {
        match self {
            Self::Whisker(_) => true,
            Self::Shortfall { shortfall } => {
                matches!(shortfall, Shortfall::Rate(_) | Shortfall::Tick { .. } | Shortfall::Age { .. })
            }
            Self::Clock { .. } | Self::Config(_) => false,
        }
    }
}

/// Advice for a need that the device does not meet.
fn remedy(shortfall: &Shortfall) -> &'static str {
    match shortfall {
        Shortfall::Rate(_) => "change the rate in the section `sensing` of the configuration",
        Shortfall::Tick { .. } => {
            "lower the control rate as far as the policy allows, allow lower rates in it by `needs`, or simplify it"
        }
        Shortfall::Deadline { .. } => "raise that timeout, or the control rate",
        Shortfall::Bus { .. } => {
            "set its baud rate to 400000 in config.txt, move boards to another bus, or allow lower sample rates in the policy \
             by `needs`"
        }
        Shortfall::Age { .. } => "raise the sample rate, or choose a weaker filter of the sensors",
    }
}
