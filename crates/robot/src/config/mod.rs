//! The configuration of a robot: its rig, buses, limits and links. It is a YAML file such as `deploy/pi/array.yaml`.

mod bus;
mod json;
mod links;
mod mqtt;
mod quantity;
mod rig;
mod safety;
mod sender;
mod sensor;

use serde::{Deserialize, Serialize};
use vibrissa_mlx90393::CheckedSettings;
use vibrissa_runtime::calibration::Calibration;
use vibrissa_runtime::rig::Rig;
use vibrissa_runtime::signal::MAX_WHISKERS;

pub use bus::{BoardConfig, BusConfig};
pub use links::{ActuatorConfig, PoseConfig, PoseSource, RecordConfig};
pub use mqtt::{MqttConfig, TlsConfig};
pub use safety::{FaultResponse, Limits, Responses, Timeouts};
pub use sender::{Sender, SenderError};
pub use sensor::{SensorConfig, SensorConfigError};

use rig::RigSection;

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
    /// The text is not YAML of this form. The message has the line and the column.
    #[error("the configuration cannot be read: {0}")]
    Text(String),
    /// A value contradicts another one.
    #[error("the configuration is inconsistent: {0}")]
    Inconsistent(String),
    /// The text is too long.
    #[error("the configuration is larger than {CONFIG_LIMIT} bytes; it is probably another file")]
    TooLarge,
}

/// The file as it is written.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
struct File {
    name: String,
    #[serde(default)]
    rig: RigSection,
    #[serde(default)]
    sensor: SensorConfig,
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
    /// Reads a configuration.
    ///
    /// # Errors
    /// [`ConfigError`] with the first problem found.
    pub fn from_text(text: &str) -> Result<Self, ConfigError> {
        if text.len() > CONFIG_LIMIT {
            return Err(ConfigError::TooLarge);
        }
        let file: File = serde_yaml::from_str(text).map_err(|error| ConfigError::Text(error.to_string()))?;
        let mut rig = file.rig.rig();
        rig.platform.speed_limit = rig.platform.speed_limit.min(file.limits.speed);
        rig.platform.yaw_rate_limit = rig.platform.yaw_rate_limit.min(file.limits.yaw_rate);
        let config = Self {
            name: file.name,
            rig,
            sensor: file.sensor,
            buses: file.buses,
            limits: file.limits,
            timeouts: file.timeouts,
            responses: file.faults,
            actuator: file.actuator,
            pose: file.pose,
            mqtt: file.mqtt,
            record: file.record,
        };
        if let Some(fault) = config.pose.noise_fault() {
            return Err(ConfigError::Inconsistent(fault.to_owned()));
        }
        config.check()?;
        Ok(config)
    }

    /// The configuration of a robot with another name.
    ///
    /// # Errors
    /// [`ConfigError::Inconsistent`] if the name cannot be a part of a topic.
    pub fn named(self, name: &str) -> Result<Self, ConfigError> {
        let config = Self { name: name.to_owned(), ..self };
        config.check()?;
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

    /// The settings of the sensors.
    ///
    /// # Errors
    /// [`ConfigError::Inconsistent`] if the sensor does not permit them. A configuration from text has valid ones.
    pub fn settings(&self) -> Result<CheckedSettings, ConfigError> {
        let settings = self.sensor.settings(self.rig.sensing.sample_rate);
        settings.map_err(|error| ConfigError::Inconsistent(error.to_string()))
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

    fn check(&self) -> Result<(), ConfigError> {
        let fault = |message: String| Err(ConfigError::Inconsistent(message));
        let is_topic =
            !self.name.is_empty() && self.name.chars().all(|c| c.is_ascii_alphanumeric() || "_-".contains(c));
        if !is_topic {
            return fault(format!("`{}` is not a name for a robot; use letters, digits, `_` and `-`", self.name));
        }
        if self.rig.whiskers.is_empty() || self.rig.whiskers.len() > MAX_WHISKERS {
            let count = self.rig.whiskers.len();
            return fault(format!("the rig has {count} whiskers; give it 1 to {MAX_WHISKERS}"));
        }
        for whisker in &self.rig.whiskers {
            if let Some(Err(error)) = whisker.calibration.as_ref().map(Calibration::check) {
                return fault(format!("the calibration of the whisker `{}`: {error}", whisker.name));
            }
        }
        if self.buses.is_empty() || self.buses.len() > MAX_BUSES {
            return fault(format!("there are {} buses; give 1 to {MAX_BUSES}", self.buses.len()));
        }
        for bus in &self.buses {
            if bus.boards.is_empty() || bus.boards.len() > MAX_BOARDS {
                let (device, count) = (bus.device.display(), bus.boards.len());
                return fault(format!("{device} has {count} boards; give it 1 to {MAX_BOARDS}"));
            }
            for (index, board) in bus.boards.iter().enumerate() {
                if bus.boards[..index].iter().any(|other| other.address == board.address) {
                    let (device, address) = (bus.device.display(), board.address);
                    return fault(format!("two boards on {device} have the address {address:#04x}; change a jumper"));
                }
            }
        }
        for board in self.buses.iter().flat_map(|bus| &bus.boards) {
            if !self.rig.whiskers.iter().any(|whisker| whisker.name == board.whisker) {
                return fault(format!(
                    "a board is assigned to the whisker `{}`, which the rig does not have",
                    board.whisker
                ));
            }
        }
        for whisker in &self.rig.whiskers {
            let count = self.buses.iter().flat_map(|bus| &bus.boards).filter(|b| b.whisker == whisker.name).count();
            if count != 1 {
                return fault(format!("the whisker `{}` has {count} boards; give it one", whisker.name));
            }
        }
        let sensing = &self.rig.sensing;
        let rounds = sensing.sample_rate / sensing.control_rate;
        if !(1.0..=f64::from(MAX_ROUNDS)).contains(&rounds) || (rounds - rounds.round()).abs() > 1e-6 {
            return fault(format!(
                "a control period has {rounds} samples; choose a sample rate that is 1 to {MAX_ROUNDS} times the control rate, as a whole number"
            ));
        }
        let needs_broker =
            matches!(self.actuator, ActuatorConfig::Mqtt { .. }) || matches!(self.pose.source, PoseSource::Mqtt { .. });
        if needs_broker && self.mqtt.is_none() {
            return fault("the actuator or the pose uses MQTT; add `mqtt: {host: ...}`".to_owned());
        }
        self.settings()?;
        Ok(())
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
        let board = |(index, whisker): (usize, &vibrissa_runtime::rig::Whisker)| {
            // An order code of the sensor has four addresses.
            let address = u8::try_from(0x0C + index / 2).unwrap_or(0x0C);
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
