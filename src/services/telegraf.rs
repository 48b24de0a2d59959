//! The configuration of Telegraf: from messages to points.

use std::fmt::Write;

use vibrissa_robot::telemetry::{Field, FieldKind, MEASUREMENTS, Measurement, Topic};

const HEAD: &str = "\
# Telegraf reads the telemetry from the broker and writes it to InfluxDB. `vibrissa setup services generate` has made this file.
# A point has the time of its message, also if the message had to wait for the broker.

[agent]
  interval = \"10s\"
  flush_interval = \"1s\"
  metric_batch_size = 5000
  metric_buffer_limit = 200000
  omit_hostname = true

[[outputs.influxdb]]
  urls = [\"http://influxdb:8086\"]
  database = \"vibrissa\"
  skip_database_creation = true
  username = \"telegraf\"
  password = \"${INFLUXDB_WRITE_PASSWORD}\"
";

/// The configuration.
pub(super) fn configuration() -> String {
    let mut text = HEAD.to_owned();
    for topic in Topic::ALL {
        let measurements: Vec<_> = MEASUREMENTS.iter().filter(|measurement| measurement.topic == topic).collect();
        if !measurements.is_empty() {
            input(&mut text, topic, &measurements);
        }
    }
    text
}

/// Appends formatted text. Writing to a string does not fail.
macro_rules! add {
    ($text:expr, $($arguments:tt)*) => { let _ = writeln!($text, $($arguments)*); };
}

/// The subscription of a topic, with its measurements.
fn input(text: &mut String, topic: Topic, measurements: &[&Measurement]) {
    let word = topic.word();
    let topics = [format!("vibrissa/+/{word}"), format!("vibrissa/+/sensor_io/{word}")];
    add!(text, "\n[[inputs.mqtt_consumer]]");
    add!(text, "  servers = [\"tcp://mosquitto:1883\"]");
    add!(text, "  topics = [\"{}\", \"{}\"]", topics[0], topics[1]);
    // With a session, the broker keeps messages while Telegraf is away.
    add!(text, "  client_id = \"vibrissa-telegraf-{word}\"");
    add!(text, "  persistent_session = true");
    add!(text, "  qos = 1");
    add!(text, "  topic_tag = \"\"");
    if topic == Topic::Status {
        add!(text, "  name_override = \"{}\"", measurements.first().map_or("", |measurement| measurement.name));
        add!(text, "  data_format = \"value\"");
        add!(text, "  data_type = \"string\"");
    } else {
        add!(text, "  data_format = \"xpath_json\"");
        // A message without entries, such as one without whiskers, has no points.
        add!(text, "  xpath_allow_empty_selection = true");
        for measurement in measurements {
            parser(text, measurement);
        }
    }
    for (topic, tags) in topics.iter().zip(["_/robot/_", "_/robot/service/_"]) {
        add!(text, "  [[inputs.mqtt_consumer.topic_parsing]]");
        add!(text, "    topic = \"{topic}\"");
        add!(text, "    tags = \"{tags}\"");
    }
}

fn parser(text: &mut String, measurement: &Measurement) {
    add!(text, "  [[inputs.mqtt_consumer.xpath]]");
    add!(text, "    metric_name = \"'{}'\"", measurement.name);
    if !measurement.each.is_empty() {
        add!(text, "    metric_selection = \"{}\"", measurement.each);
    }
    add!(text, "    timestamp = \"/unix_s\"");
    add!(text, "    timestamp_format = \"unix\"");
    if !measurement.tags.is_empty() {
        add!(text, "    [inputs.mqtt_consumer.xpath.tags]");
        for (name, path) in measurement.tags {
            add!(text, "      {name} = \"{path}{NOT_NULL}\"");
        }
    }
    let (integers, others): (Vec<&Field>, Vec<&Field>) =
        measurement.fields.iter().partition(|field| field.kind == FieldKind::Integer);
    for (section, fields) in [("fields_int", integers), ("fields", others)] {
        if !fields.is_empty() {
            add!(text, "    [inputs.mqtt_consumer.xpath.{section}]");
        }
        for field in fields {
            add!(text, "      {} = \"{}\"", field.name, query(field));
        }
    }
}

/// Selects what is not `null`. Telegraf reads `null` as a text, and leaves out what a query does not select.
const NOT_NULL: &str = "[. != 'null']";

/// The XPath query of a field. Without a conversion, Telegraf makes every value a text. The number of a `null` is not a
/// number, and Telegraf leaves it out.
fn query(field: &Field) -> String {
    let path = field.path;
    match field.kind {
        FieldKind::Number | FieldKind::Integer => format!("number({path})"),
        FieldKind::Text => format!("{path}{NOT_NULL}"),
        FieldKind::Truth => format!("{path} = 'true'"),
        FieldKind::Count => format!("count({path})"),
    }
}
