//! The ranges of all numbers of a configuration but for those of the rig, whose reader checks them.

use vibrissa_runtime::units::{Dimension, Key, format_si};
use vibrissa_yaml::{Node, Placed, number_text, written};

use super::check::Inconsistency;
use super::{BoardConfig, BusConfig, Config, Limits, PoseConfig, Timeouts};
use crate::sensor::Section;

const SPEED: Key = Key::new("speed", Dimension::SPEED, (1e-3, 100.0), "0.1 m/s");
const YAW_RATE: Key = Key::new("yaw_rate", Dimension::ANGULAR_SPEED, (1e-3, 100.0), "60 deg/s");
const BASE_ANGLE: Key = Key::new("base_angle", Dimension::ANGLE, (1e-6, 1.0), "1050 urad");
/// A shorter time of silence is usual, and after a longer one it is too late to stop.
const SILENCE: (f64, f64) = (5e-3, 10.0);
const SETTLE: Key = Key::new("settle", Dimension::TIME, (0.0, 60.0), "200 ms");
const LATENCY: Key = Key::new("latency", Dimension::TIME, (0.0, 1.0), "10 ms");
/// A pose farther off than a metre tells nothing.
const POSE_NOISE: Key = Key::new("noise", Dimension::LENGTH, (0.0, 1.0), "20 mm");
const HEADING_NOISE: Key = Key::new("heading_noise", Dimension::ANGLE, (0.0, std::f64::consts::PI), "5 deg");
const CLOCK: Key = Key::new("clock", Dimension::FREQUENCY, (1e3, 1e6), "360 kHz");
const CUBIC: Key = Key::new("cubic", Dimension::NUMBER, (-1e12, 1e12), "0");
/// The magnitude of the field per moment. The sign is that of the board's mounting.
const FIELD_PER_MOMENT: Key = Key::new("field_per_moment", Dimension::NUMBER, (1e-6, 1e6), "4.38");
const LIMIT_MB: Key = Key::new("limit_mb", Dimension::NUMBER, (1.0, 1e9), "1000");
const BUFFER: Key = Key::new("buffer", Dimension::NUMBER, (1.0, 1e6), "20000");
const PORT: Key = Key::new("port", Dimension::NUMBER, (1.0, 65_535.0), "1883");

/// A number of a configuration: its path in the text, its value (SI) and its key.
type Number = (String, f64, Key);

/// Returns an error for the first number beyond the range of its key, with the number as `tree` has it.
pub(super) fn check(config: &Config, tree: &Placed<Node>) -> Result<(), Inconsistency> {
    let outside = numbers(config).into_iter().find(|(_, value, key)| !key.contains(*value));
    if let Some((path, value, key)) = outside {
        let Key { name, dimension, example, .. } = key;
        let found = match &tree.find(&path).value {
            // Only a default is not in the text.
            Node::Null | Node::List(_) | Node::Mapping(_) => format_si(value, dimension),
            scalar => written(scalar),
        };
        let range = key.range_text();
        let message = format!("`{name}` cannot be {found}; it must be {range}, for example `{name}: {example}`");
        return Err(Inconsistency { path, message });
    }
    config.buses.iter().enumerate().try_for_each(|(bus, entry)| {
        entry.boards.iter().enumerate().try_for_each(|(board, entry)| field_per_moment(bus, board, entry))
    })
}

/// A gain of 0 makes a whisker blind.
fn field_per_moment(bus: usize, board: usize, entry: &BoardConfig) -> Result<(), Inconsistency> {
    let (found, (least, greatest)) = (entry.field_per_moment, FIELD_PER_MOMENT.range);
    if FIELD_PER_MOMENT.contains(found.abs()) {
        return Ok(());
    }
    let message = format!(
        "`field_per_moment` cannot be {}; it must be from {least} to {greatest} T/(N m), or as much below 0 if the board \
         is turned around. The baseline's array has {}",
        number_text(found),
        FIELD_PER_MOMENT.example
    );
    Err(Inconsistency { path: format!("buses.{bus}.boards.{board}.field_per_moment"), message })
}

fn numbers(config: &Config) -> Vec<Number> {
    let mut numbers = Vec::new();
    let Limits { speed, yaw_rate, base_angle } = config.limits;
    add(&mut numbers, "limits", [(speed, SPEED), (yaw_rate, YAW_RATE), (base_angle, BASE_ANGLE)]);
    let silence = |name| Key::new(name, Dimension::TIME, SILENCE, "40 ms");
    let Timeouts { bus, sensor, pose, control, link, settle } = config.timeouts;
    let timeouts = [("bus", bus), ("sensor", sensor), ("pose", pose), ("control", control), ("link", link)];
    add(&mut numbers, "timeouts", timeouts.map(|(name, time)| (time, silence(name))));
    add(&mut numbers, "timeouts", [(settle, SETTLE)]);
    let PoseConfig { latency, noise, heading_noise, .. } = config.pose;
    add(&mut numbers, "pose", [(latency, LATENCY), (noise, POSE_NOISE), (heading_noise, HEADING_NOISE)]);
    add(&mut numbers, config.sensor.path(), config.sensor.numbers());
    for (index, BusConfig { clock, boards, .. }) in config.buses.iter().enumerate() {
        add(&mut numbers, &format!("buses.{index}"), [(*clock, CLOCK)]);
        for (board, entry) in boards.iter().enumerate() {
            add(&mut numbers, &format!("buses.{index}.boards.{board}"), [(entry.cubic, CUBIC)]);
        }
    }
    if let Some(mqtt) = &config.mqtt {
        add(&mut numbers, "mqtt", [(mqtt.port.into(), PORT), (mqtt.buffer as f64, BUFFER)]);
    }
    if let Some(record) = &config.record {
        add(&mut numbers, "record", [(record.limit_mb as f64, LIMIT_MB)]);
    }
    numbers
}

/// Adds the numbers of a section.
fn add(numbers: &mut Vec<Number>, section: &str, of: impl IntoIterator<Item = (f64, Key)>) {
    numbers.extend(of.into_iter().map(|(value, key)| (format!("{section}.{}", key.name), value, key)));
}
