//! The configuration of a robot: its rig, buses, limits and links. It is a YAML file such as `deploy/pi/array.yaml`.

mod bus;
mod check;
mod device;
mod json;
mod links;
mod mqtt;
mod quantity;
mod range;
mod rig;
mod safety;
mod sender;
#[cfg(test)]
mod tests;
pub(crate) mod whole_number;

use serde::de::{DeserializeOwned, IgnoredAny};
use serde::{Deserialize, Serialize};
use vibrissa_runtime::rig::Rig;
use vibrissa_text::diagnostic::{Diagnostic, Source, Span};
use vibrissa_yaml::{Files, Node, Placed};

use crate::sensor::{Section, SensorConfig, SensorModel};

pub use bus::{BoardConfig, BusConfig};
pub use links::{ActuatorConfig, PoseConfig, PoseSource, RecordConfig};
pub use mqtt::{MqttConfig, TlsConfig};
pub use safety::{FaultResponse, Limits, Responses, Timeouts};
pub use sender::{Sender, SenderError};

/// Reads a list, with a check of each item. It returns the key that is not possible, and the reason.
#[cfg(feature = "emulation")]
pub(crate) fn read_list<T: DeserializeOwned>(
    text: &str,
    check: impl Fn(&T) -> Result<(), (&'static str, String)>,
) -> Result<Vec<T>, ConfigError> {
    let (source, tree) = parse(text)?;
    let items: Vec<T> = read(&source, &tree)?;
    for (index, item) in items.iter().enumerate() {
        check(item).map_err(|(key, message)| {
            check::Inconsistency { path: format!("{index}.{key}"), message }.at(&source, &tree)
        })?;
    }
    Ok(items)
}

/// Parses a text, with a source for its positions.
fn parse(text: &str) -> Result<(Source, Placed<Node>), ConfigError> {
    if text.len() > CONFIG_LIMIT {
        return Err(ConfigError::TooLarge);
    }
    let source = Source::new("", text);
    match vibrissa_yaml::parse(&source, "configuration") {
        Ok((tree, faults)) if faults.is_empty() => Ok((source, tree)),
        Ok((_, faults)) | Err(faults) => Err(ConfigError::first(&source, &faults)),
    }
}

/// Reads a value from the tree of a text.
pub(crate) fn read<T: DeserializeOwned>(source: &Source, tree: &Placed<Node>) -> Result<T, ConfigError> {
    vibrissa_yaml::read_value(tree).map_err(|fault| ConfigError::at(source, fault.span(), fault.to_string()))
}

/// Maximum number of buses.
pub const MAX_BUSES: usize = 4;
/// Maximum number of boards on one bus. An order code of the sensor has four addresses.
pub const MAX_BOARDS: usize = 8;
/// Maximum size of a configuration in bytes.
pub const CONFIG_LIMIT: usize = 1 << 20;

/// The configuration of a robot.
///
/// Its file has the differences from the defaults. [`to_json`](Self::to_json) has every value.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Config {
    /// Name of the robot. It is part of every MQTT topic.
    pub name: String,
    /// The rig. Its whiskers are those of the boards, in the same order.
    pub rig: Rig,
    /// Settings that all sensors share.
    pub sensor: SensorConfig,
    /// The buses with their boards.
    pub buses: Vec<BusConfig>,
    /// Limits of every command, and of readings.
    pub limits: Limits,
    /// Times after which silence is a fault.
    pub timeouts: Timeouts,
    /// Responses to faults.
    pub responses: Responses,
    /// Receiver of the commands.
    pub actuator: ActuatorConfig,
    /// Source of the platform's pose.
    pub pose: PoseConfig,
    /// The MQTT broker, if there is one.
    pub mqtt: Option<MqttConfig>,
    /// The recording on the device, if there is one.
    pub record: Option<RecordConfig>,
}

/// An error of a configuration.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
pub enum ConfigError {
    /// The recorded values are not those of a configuration.
    #[error("the configuration cannot be read: {0}")]
    Text(String),
    /// The text is not YAML of this form, or a value is not possible. Line and column count from 1.
    #[error("line {line}, column {column}: {message}")]
    At {
        /// The line.
        line: u64,
        /// The column.
        column: u64,
        /// What is wrong, and what to do.
        message: String,
    },
    /// A value contradicts another one.
    #[error("the configuration is inconsistent: {0}")]
    Inconsistent(String),
    /// The text is too long.
    #[error("the text is larger than {CONFIG_LIMIT} bytes; it is probably another file")]
    TooLarge,
}

impl ConfigError {
    fn at(source: &Source, span: Span, message: String) -> Self {
        let place = source.line_column(span.start);
        Self::At { line: place.line as u64, column: place.column as u64, message }
    }

    /// The first of the diagnostics of a text.
    fn first(source: &Source, faults: &[Diagnostic]) -> Self {
        let Some(Diagnostic { message, primary, hints, .. }) = faults.first() else {
            return Self::Text("nothing can be read".to_owned());
        };
        let parts = [message, &primary.text].into_iter().chain(hints).map(String::as_str);
        Self::at(source, primary.span, parts.collect::<Vec<_>>().join("; "))
    }
}

/// The file as it is written.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
struct File {
    name: String,
    /// It has its own reader.
    #[serde(default, rename = "rig")]
    _rig: IgnoredAny,
    /// It has its own reader.
    #[serde(default, rename = "sensor")]
    _sensor: IgnoredAny,
    buses: Vec<BusConfig>,
    limits: Limits,
    #[serde(default)]
    timeouts: Timeouts,
    #[serde(default)]
    faults: Responses,
    #[serde(default)]
    actuator: ActuatorConfig,
    pose: PoseConfig,
    mqtt: Option<MqttConfig>,
    record: Option<RecordConfig>,
}

impl Config {
    /// Reads a configuration that names no other file.
    ///
    /// # Errors
    /// [`ConfigError`] with the first problem found.
    pub fn from_text(text: &str) -> Result<Self, ConfigError> {
        Self::from_text_with(text, &mut |_| Err("write the values of the calibration here".to_owned()))
    }

    /// Reads a configuration, with the calibrations from `files` to which it refers.
    ///
    /// # Errors
    /// [`ConfigError`] with the first problem found.
    pub fn from_text_with(text: &str, files: &mut Files<'_>) -> Result<Self, ConfigError> {
        let (source, tree) = parse(text)?;
        let file: File = read(&source, &tree)?;
        let sensor = tree.entry("sensor").map(|entry| SensorConfig::read(&source, &entry.value)).transpose()?;
        let rig = rig::read(&source, &tree, files).map_err(|faults| ConfigError::first(&source, &faults))?;
        let mut config = Self {
            name: file.name,
            rig,
            sensor: sensor.unwrap_or_default(),
            buses: file.buses,
            limits: file.limits,
            timeouts: file.timeouts,
            responses: file.faults,
            actuator: file.actuator,
            pose: file.pose,
            mqtt: file.mqtt,
            record: file.record,
        };
        let checked = range::check(&config, &tree).and_then(|()| check::text(&config));
        checked.map_err(|inconsistency| inconsistency.at(&source, &tree))?;
        let platform = &mut config.rig.platform;
        platform.speed_limit = platform.speed_limit.min(config.limits.speed);
        platform.yaw_rate_limit = platform.yaw_rate_limit.min(config.limits.yaw_rate);
        Ok(config)
    }

    /// The configuration of a robot with another name.
    ///
    /// # Errors
    /// [`ConfigError::Inconsistent`] if the name cannot be a part of a topic.
    pub fn named(self, name: &str) -> Result<Self, ConfigError> {
        let config = Self { name: name.to_owned(), ..self };
        check::check(&config)?;
        Ok(config)
    }

    /// The whiskers with a board: index of the bus, index of the board on it, index of the whisker in the rig.
    pub fn boards(&self) -> impl Iterator<Item = (usize, usize, usize)> {
        self.buses.iter().enumerate().flat_map(move |(bus, config)| {
            config.boards.iter().enumerate().filter_map(move |(board, config)| {
                let whisker = self.rig.whiskers.iter().position(|whisker| whisker.name == config.whisker)?;
                Some((bus, board, whisker))
            })
        })
    }

    /// The sensor with its settings.
    ///
    /// # Errors
    /// [`ConfigError::Inconsistent`] if the sensor does not permit them. A configuration from text has valid ones.
    pub fn sensor(&self) -> Result<SensorModel, ConfigError> {
        let model = self.sensor.model(self.rig.sensing.sample_rate);
        model.map_err(|error| ConfigError::Inconsistent(error.to_string()))
    }

    /// Number of acquisition rounds in a control period.
    #[must_use]
    pub fn rounds_per_tick(&self) -> u64 {
        let ratio = self.rig.sensing.sample_rate / self.rig.sensing.control_rate;
        #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "a validated ratio")]
        let count = ratio.round() as u64;
        count.max(1)
    }

    /// The whiskers of a bus, in the order of its boards.
    #[must_use]
    pub fn whiskers_on(&self, bus: usize) -> Vec<usize> {
        self.boards().filter(|board| board.0 == bus).map(|(_, _, whisker)| whisker).collect()
    }
}

/// Maximum number of acquisition rounds in a control period.
pub const MAX_ROUNDS: u32 = 64;

impl Config {
    /// A configuration for emulated sensors on this rig: two buses of boards, and the limits of the rig's platform.
    /// Perception knows the standard deviation of the sensors' noise (µT).
    #[must_use]
    pub fn emulated(mut rig: Rig, noise_microtesla: f64) -> Self {
        let stiffness = rig.whiskers.first().map_or(1.0, |whisker| whisker.hinge.stiffness);
        rig.sensing.angle_noise = noise_microtesla * 1e-6 / (bus::array_magnet() * stiffness);
        let first_address = SensorConfig::default().first_address();
        let board = |(index, whisker): (usize, &vibrissa_runtime::rig::Whisker)| {
            let address = u8::try_from(index / 2).map_or(first_address, |place| first_address.saturating_add(place));
            BoardConfig::array(whisker.name.clone(), address)
        };
        let boards: Vec<BoardConfig> = rig.whiskers.iter().enumerate().map(board).collect();
        let bus = |parity: usize| BusConfig {
            device: format!("/dev/i2c-{}", 2 * parity + 1).into(),
            clock: 360e3,
            boards: boards.iter().skip(parity).step_by(2).cloned().collect(),
        };
        let buses = [bus(0), bus(1)].into_iter().filter(|bus| !bus.boards.is_empty()).collect();
        Self {
            name: "emulated".to_owned(),
            limits: Limits::new(rig.platform.speed_limit, rig.platform.yaw_rate_limit),
            rig,
            sensor: SensorConfig::default(),
            buses,
            timeouts: Timeouts::default(),
            responses: Responses::default(),
            actuator: ActuatorConfig::DryRun,
            // Nobody listens there. The emulation has the poses.
            pose: PoseConfig::new(PoseSource::Udp { listen: ([127, 0, 0, 1], 9751).into(), from: None }),
            mqtt: None,
            record: None,
        }
    }
}
