//! Checks of several values of a configuration.

use std::path::{Path, PathBuf};

use vibrissa_runtime::calibration::Calibration;
use vibrissa_runtime::signal::MAX_WHISKERS;
use vibrissa_text::diagnostic::Source;
use vibrissa_yaml::{Node, Placed};

use super::{ActuatorConfig, Config, ConfigError, MAX_BOARDS, MAX_BUSES, MAX_ROUNDS, MqttConfig, PoseSource, device};
use crate::array::Transducer;
use crate::sensor::{Section, Sensor};

/// Values that contradict each other, or one that is not possible.
#[derive(Debug)]
pub(super) struct Inconsistency {
    /// Path of the value in the text, such as `buses.0.device`.
    pub(super) path: String,
    pub(super) message: String,
}

impl Inconsistency {
    /// The error at its place in the text.
    pub(super) fn at(self, source: &Source, tree: &Placed<Node>) -> ConfigError {
        ConfigError::at(source, tree.find(&self.path).span, self.message)
    }
}

impl From<Inconsistency> for ConfigError {
    fn from(inconsistency: Inconsistency) -> Self {
        Self::Inconsistent(inconsistency.message)
    }
}

fn fault(path: impl Into<String>, message: impl Into<String>) -> Result<(), Inconsistency> {
    Err(Inconsistency { path: path.into(), message: message.into() })
}

/// Checks what every configuration must have, whatever its numbers are.
pub(super) fn check(config: &Config) -> Result<(), Inconsistency> {
    let name = &config.name;
    if name.is_empty() || !name.chars().all(|c| c.is_ascii_alphanumeric() || "_-".contains(c)) {
        return fault("name", format!("`{name}` is not a name for a robot; use letters, digits, `_` and `-`"));
    }
    let whiskers = &config.rig.whiskers;
    if whiskers.is_empty() || whiskers.len() > MAX_WHISKERS {
        let count = whiskers.len();
        return fault("rig.whiskers", format!("the rig has {count} whiskers; give it 1 to {MAX_WHISKERS}"));
    }
    for whisker in whiskers {
        if let Some(Err(error)) = whisker.calibration.as_ref().map(Calibration::check) {
            let (path, name) = (format!("rig.whiskers.{}.calibration", whisker.name), &whisker.name);
            return fault(path, format!("the calibration of the whisker `{name}`: {error}"));
        }
    }
    if config.buses.is_empty() || config.buses.len() > MAX_BUSES {
        return fault("buses", format!("there are {} buses; give 1 to {MAX_BUSES}", config.buses.len()));
    }
    boards(config)?;
    let sensing = &config.rig.sensing;
    let rounds = sensing.sample_rate / sensing.control_rate;
    if !(1.0..=f64::from(MAX_ROUNDS)).contains(&rounds) || (rounds - rounds.round()).abs() > 1e-6 {
        return fault(
            "rig.sensing",
            format!(
                "a control period has {rounds} samples; choose a sample rate that is 1 to {MAX_ROUNDS} times the control \
                 rate, as a whole number"
            ),
        );
    }
    let by_broker = [
        ("actuator", matches!(config.actuator, ActuatorConfig::Mqtt { .. })),
        ("pose", matches!(config.pose.source, PoseSource::Mqtt { .. })),
    ];
    if let Some((section, _)) = by_broker.into_iter().find(|(_, uses)| *uses && config.mqtt.is_none()) {
        return fault(section, format!("`{section}` uses MQTT; add `mqtt: {{host: ...}}`"));
    }
    config.sensor.model(sensing.sample_rate).map(|_| ()).or_else(|error| fault("sensor", error.to_string()))
}

/// Checks the assignment of boards to whiskers.
fn boards(config: &Config) -> Result<(), Inconsistency> {
    for (index, bus) in config.buses.iter().enumerate() {
        if bus.boards.is_empty() || bus.boards.len() > MAX_BOARDS {
            let (device, count) = (bus.device.display(), bus.boards.len());
            let message = format!("{device} has {count} boards; give it 1 to {MAX_BOARDS}");
            return fault(format!("buses.{index}.boards"), message);
        }
        for (number, board) in bus.boards.iter().enumerate() {
            let path = format!("buses.{index}.boards.{number}");
            if bus.boards.iter().take(number).any(|other| other.address == board.address) {
                let (device, address) = (bus.device.display(), board.address);
                let message = format!("two boards on {device} have the address {address:#04x}; change a jumper");
                return fault(format!("{path}.address"), message);
            }
            if !config.rig.whiskers.iter().any(|whisker| whisker.name == board.whisker) {
                let name = &board.whisker;
                let message = format!("a board is assigned to the whisker `{name}`, which the rig does not have");
                return fault(format!("{path}.whisker"), message);
            }
        }
    }
    for whisker in &config.rig.whiskers {
        let boards = config.buses.iter().flat_map(|bus| &bus.boards);
        let count = boards.filter(|board| board.whisker == whisker.name).count();
        if count != 1 {
            return fault("buses", format!("the whisker `{}` has {count} boards; give it one", whisker.name));
        }
    }
    Ok(())
}

/// Checks a configuration of a text, whose numbers are within their ranges.
pub(super) fn text(config: &Config) -> Result<(), Inconsistency> {
    for (index, bus) in config.buses.iter().enumerate() {
        let (device, path) = (bus.device.display(), format!("buses.{index}.device"));
        if is_blank(&bus.device) {
            return fault(path, "`device` is empty; give the device file of the bus, such as `/dev/i2c-1`");
        }
        if let Some(other) = config.buses.iter().take(index).find(|other| device::are_one(&other.device, &bus.device)) {
            let other = other.device.display();
            return fault(
                path,
                format!("{device} and {other} are one bus; give each bus its own device, or list all boards under one"),
            );
        }
        let Ok(sensor) = config.sensor() else { continue };
        for (number, board) in bus.boards.iter().enumerate() {
            if let Err(error) = sensor.driver(board.address) {
                return fault(format!("buses.{index}.boards.{number}.address"), format!("`address`: {error}"));
            }
        }
    }
    sockets(config)?;
    if let Some(mqtt) = &config.mqtt {
        broker(mqtt)?;
    }
    if config.record.as_ref().is_some_and(|record| is_blank(&record.directory)) {
        return fault("record.directory", "`directory` is empty; give a directory, such as `/var/lib/vibrissa`");
    }
    check(config)?;
    magnets(config)
}

/// True for a path without a name.
fn is_blank(path: &Path) -> bool {
    path.as_os_str().to_string_lossy().trim().is_empty()
}

/// Checks the addresses of packets.
fn sockets(config: &Config) -> Result<(), Inconsistency> {
    if let ActuatorConfig::Udp { address, .. } = &config.actuator {
        if address.port() == 0 {
            return fault("actuator.udp.address", format!("`address` has the port 0, {PORT_ZERO}"));
        }
        if address.ip().is_unspecified() {
            let ip = address.ip();
            return fault(
                "actuator.udp.address",
                format!("`address` is {ip}, which names no computer; write the address of the actuator"),
            );
        }
    }
    if let PoseSource::Udp { listen, .. } = &config.pose.source
        && listen.port() == 0
    {
        return fault("pose.udp.listen", format!("`listen` has the port 0, {PORT_ZERO}"));
    }
    Ok(())
}

const PORT_ZERO: &str = "which no packet can have; write the port of the other program, from 1 to 65535";

/// Checks the access to a broker.
fn broker(mqtt: &MqttConfig) -> Result<(), Inconsistency> {
    if mqtt.host.trim().is_empty() {
        return fault("mqtt.host", "`host` is empty; give the name or the address of the broker, such as `127.0.0.1`");
    }
    let is_empty = |path: &Option<PathBuf>| path.as_ref().is_some_and(|path| is_blank(path));
    if is_empty(&mqtt.password_file) {
        return fault("mqtt.password_file", "`password_file` is empty; give the path of the file with the password");
    }
    if mqtt.user.is_some() && mqtt.password_file.is_none() {
        return fault(
            "mqtt.user",
            "`mqtt` has a `user` and no `password_file`; give the path of the file with the password, or leave out `user`",
        );
    }
    if mqtt.tls.as_ref().is_some_and(|tls| is_empty(&tls.ca)) {
        return fault(
            "mqtt.tls.ca",
            "`ca` is empty; give a file with certificates, or write `tls: {}` for the authorities of the system",
        );
    }
    Ok(())
}

/// Least change of a reading (counts) between a whisker at rest and one at the limit of its base angle. A whisker with a
/// smaller one is blind.
const LEAST_COUNTS: f64 = 20.0;

/// Checks that every sensor sees the whole range of base angles of its whisker.
fn magnets(config: &Config) -> Result<(), Inconsistency> {
    let Ok(sensor) = config.sensor() else { return Ok(()) };
    let microtesla_per_count = sensor.microtesla_per_count();
    for (bus, number, whisker) in config.boards() {
        let Some(board) = config.buses.get(bus).and_then(|bus| bus.boards.get(number)) else { continue };
        let Some(whisker) = config.rig.whiskers.get(whisker) else { continue };
        let Transducer { magnet, hinge_stiffness, .. } = Transducer::new(board, whisker, &sensor);
        let moment = config.limits.base_angle * hinge_stiffness;
        let path = format!("buses.{bus}.boards.{number}");
        let name = &whisker.name;
        // The slope of the field over the moment.
        if 1.0 + 3.0 * magnet.cubic * moment * moment <= 0.0 {
            let message = format!(
                "with this `cubic`, the field at the whisker `{name}` turns back before the limit of the base angle, so a \
                 reading has no base angle; calibrate the whisker, or lower `limits.base_angle`"
            );
            return fault(format!("{path}.cubic"), message);
        }
        let counts = (magnet.field_microtesla(moment) / microtesla_per_count).abs();
        if counts < LEAST_COUNTS {
            let message = format!(
                "with this `field_per_moment`, the reading of the whisker `{name}` changes by {counts:.3} counts up to the limit \
                 of the base angle, so it is blind; it must be at least {LEAST_COUNTS}. Calibrate the whisker"
            );
            return fault(format!("{path}.field_per_moment"), message);
        }
    }
    Ok(())
}
