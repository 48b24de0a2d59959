//! Messages as points in the line protocol of InfluxDB.

use std::fmt::Write;

use serde_json::Value;

use super::measurement::{FieldKind, MEASUREMENTS, Measurement};
use super::topic::Topic;

/// A message that is none of the telemetry.
#[derive(Debug, thiserror::Error)]
#[error("the message of the topic {topic} is no telemetry of this version: {cause}")]
pub struct LineError {
    topic: String,
    cause: String,
}

/// The points of a message, each as a line of the line protocol without its end. `arrived_unix_s` is the time of messages that
/// have none, such as the status. Messages of other topics have no points.
///
/// # Errors
/// [`LineError`] if the payload has not the form of its topic.
///
/// ```
/// use vibrissa_robot::telemetry::lines;
/// let event = br#"{"sequence": 7, "time_s": 2.5, "unix_s": 1795600802.5, "fault": "pose_old", "part": null, "change": "detected"}"#;
/// let lines = lines("vibrissa/array/events", event, 0.0)?;
/// assert_eq!(lines, ["vibrissa_event,robot=array,fault=pose_old change=\"detected\" 1795600802500000000"]);
/// # Ok::<(), vibrissa_robot::telemetry::LineError>(())
/// ```
pub fn lines(topic: &str, payload: &[u8], arrived_unix_s: f64) -> Result<Vec<String>, LineError> {
    let Some((robot, service, topic_kind)) = parts(topic) else { return Ok(Vec::new()) };
    let error = |cause: String| LineError { topic: topic.to_owned(), cause };
    let measurements = || MEASUREMENTS.iter().filter(|measurement| measurement.topic == topic_kind);
    if measurements().next().is_none() {
        return Ok(Vec::new());
    }
    let message = if topic_kind == Topic::Status {
        Value::String(String::from_utf8(payload.to_vec()).map_err(|cause| error(cause.to_string()))?)
    } else {
        serde_json::from_slice(payload).map_err(|cause| error(cause.to_string()))?
    };
    let unix_s = match (topic_kind, message.get("unix_s").and_then(Value::as_f64)) {
        (Topic::Status, _) => arrived_unix_s,
        (_, Some(unix_s)) => unix_s,
        (_, None) => return Err(error("it has no number `unix_s`".to_owned())),
    };
    let mut lines = Vec::new();
    for measurement in measurements() {
        for entry in select(&message, measurement.each) {
            lines.extend(line(measurement, entry, robot, service, unix_s));
        }
    }
    Ok(lines)
}

/// The robot, the service and the kind of a topic.
fn parts(topic: &str) -> Option<(&str, Option<&str>, Topic)> {
    let mut words = topic.strip_prefix("vibrissa/")?.split('/');
    let robot = words.next()?;
    let (service, word) = match (words.next()?, words.next()) {
        (word, None) => (None, word),
        (service, Some(word)) => (Some(service), word),
    };
    let kind = Topic::named(word)?;
    words.next().is_none().then_some((robot, service, kind))
}

/// All values at a path. `*` stands for all entries of a list, and a missing value for none.
fn select<'v>(value: &'v Value, path: &str) -> Vec<&'v Value> {
    let mut found = vec![value];
    for step in path.split('/').filter(|step| !step.is_empty()) {
        found = found.into_iter().flat_map(|value| below(value, step)).collect();
    }
    found
}

fn below<'v>(value: &'v Value, step: &str) -> Vec<&'v Value> {
    let list = value.as_array();
    let one = match step.strip_prefix('*') {
        None => value.get(step),
        Some("") => return list.into_iter().flatten().collect(),
        Some("[last()]") => list.and_then(|list| list.last()),
        Some(number) => {
            let number = number.trim_matches(['[', ']']).parse::<usize>().ok();
            number.and_then(|number| list?.get(number.checked_sub(1)?))
        }
    };
    one.into_iter().collect()
}

/// The line of a point. `None` if it has no field.
fn line(measurement: &Measurement, entry: &Value, robot: &str, service: Option<&str>, unix_s: f64) -> Option<String> {
    let mut line = measurement.name.to_owned();
    let mut tag = |name: &str, value: &str| {
        // A tag cannot be empty.
        if !value.is_empty() {
            let _ = write!(line, ",{name}={}", escaped(value, &[',', '=', ' ']));
        }
    };
    tag("robot", robot);
    tag("service", service.unwrap_or_default());
    for (name, path) in measurement.tags {
        tag(name, select(entry, path).first().and_then(|value| value.as_str()).unwrap_or_default());
    }
    let mut separator = ' ';
    for field in measurement.fields {
        let values = select(entry, field.path);
        let value = match field.kind {
            FieldKind::Count => Some(values.len().to_string()),
            FieldKind::Number => values.first().and_then(|value| value.as_f64()).map(|number| number.to_string()),
            FieldKind::Integer => values.first().and_then(|value| value.as_i64()).map(|number| format!("{number}i")),
            FieldKind::Truth => values.first().and_then(|value| value.as_bool()).map(|truth| truth.to_string()),
            FieldKind::Text => {
                let text = values.first().and_then(|value| value.as_str());
                text.map(|text| format!("\"{}\"", escaped(text, &['"', '\\'])))
            }
        };
        if let Some(value) = value {
            let _ = write!(line, "{separator}{}={value}", field.name);
            separator = ',';
        }
    }
    // Such a number has no more digits.
    #[expect(clippy::cast_possible_truncation, reason = "`as` saturates")]
    let time_us = (unix_s * 1e6).round() as i64;
    let _ = write!(line, " {}", time_us.saturating_mul(1000));
    (separator == ',').then_some(line)
}

/// A text with a backslash before each of some characters. Line ends, which the protocol cannot represent, become spaces.
fn escaped(text: &str, special: &[char]) -> String {
    let mut escaped = String::with_capacity(text.len());
    for character in text.chars() {
        let character = if character.is_control() { ' ' } else { character };
        if special.contains(&character) {
            escaped.push('\\');
        }
        escaped.push(character);
    }
    escaped
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "a test may panic")]

    use super::*;

    const PAGE: &str = include_str!("../../../../docs/telemetry.md");

    /// The example of a topic on the page.
    fn example(topic: Topic) -> &'static str {
        if topic == Topic::Status {
            return "online";
        }
        let (_, section) = PAGE.split_once(&format!("### `{}`", topic.word())).unwrap();
        section.split_once("```json").unwrap().1.split_once("```").unwrap().0
    }

    #[test]
    fn every_field_of_every_measurement_is_in_the_example_of_its_topic() {
        for measurement in MEASUREMENTS {
            let topic = measurement.topic.of("array");
            let lines = lines(&topic, example(measurement.topic).as_bytes(), 7.0).unwrap();
            let own: Vec<_> = lines.iter().filter(|line| line.starts_with(&format!("{},", measurement.name))).collect();
            for field in measurement.fields {
                let has = |line: &&&String| line.contains(&format!("{}=", field.name));
                // The last round of the example has no value, so it has no point.
                let is_null = measurement.topic == Topic::Samples;
                assert!(is_null || own.iter().any(|line| has(&line)), "{} in {own:?}", field.name);
            }
            for (tag, _) in measurement.tags {
                assert!(
                    measurement.topic == Topic::Samples || own.iter().any(|line| line.contains(&format!(",{tag}="))),
                    "{tag} in {own:?}"
                );
            }
        }
    }

    #[test]
    fn points_have_the_robot_the_service_and_one_line_for_each_entry() {
        let found = lines("vibrissa/array/perception", example(Topic::Perception).as_bytes(), 0.0).unwrap();
        assert_eq!(
            found,
            [
                "vibrissa_pose,robot=array x_m=0.25,y_m=-0.5,heading_rad=1.25,sample_age_s=0.0015 1795600812285000000",
                "vibrissa_whisker,robot=array,whisker=r0 base_angle_rad=0.00021,tip_x_m=0.2,tip_y_m=-0.4 1795600812285000000",
                "vibrissa_whisker,robot=array,whisker=l0 base_angle_rad=0.000001 1795600812285000000",
            ]
        );
        let found = lines("vibrissa/array/sensor_io/status", b"online", 1.5).unwrap();
        assert_eq!(found, ["vibrissa_status,robot=array,service=sensor_io value=\"online\" 1500000000"]);
    }

    #[test]
    fn special_characters_are_escaped_and_other_messages_are_refused_or_have_no_points() {
        let state =
            r#"{"unix_s": 1.0, "policy": "a b,c=d", "state": "say \"\\\"", "has_failed": false, "is_paused": true}"#;
        let found = lines("vibrissa/array/state", state.as_bytes(), 0.0).unwrap();
        let text = r#"vibrissa_state,robot=array,policy=a\ b\,c\=d state="say \"\\\"",has_failed=false,is_paused=true 1000000000"#;
        assert_eq!(found, [text]);
        for other in ["vibrissa/array/command", "vibrissa/array/none", "elsewhere/array/state", "vibrissa/a/b/c/state"]
        {
            assert!(lines(other, b"\x00", 0.0).unwrap().is_empty(), "{other}");
        }
        assert!(lines("vibrissa/array/state", b"{}", 0.0).unwrap_err().to_string().contains("unix_s"));
        assert!(lines("vibrissa/array/state", b"\x00", 0.0).is_err());
    }
}
