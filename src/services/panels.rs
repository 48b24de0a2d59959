//! The panels of the dashboard.

use serde_json::{Value, json};
use vibrissa_robot::config::Config;
use vibrissa_runtime::machine::Program;

use super::panel::Panel;
use super::query::Query;

const GREEN: &str = "green";
const YELLOW: &str = "yellow";
const RED: &str = "red";
/// Colours of states. They differ for neighbours in the order of the policy.
const COLOURS: [&str; 12] = [
    "#7EB26D", "#EAB839", "#6ED0E0", "#EF843C", "#1F78C1", "#BA43A9", "#705DA0", "#508642", "#CCA300", "#447EBC",
    "#C15C17", "#0A437C",
];

/// All panels, in the order of the page.
pub(super) fn panels(program: &Program, config: &Config) -> Vec<Panel> {
    let mut panels = states(program);
    panels.extend(whiskers(config));
    panels.extend(motion(config));
    panels.extend(health(config));
    panels
}

fn states(program: &Program) -> Vec<Panel> {
    let status = Panel::of_kind(
        "stat",
        "Programs",
        "Whether the programs of the robot are connected to the broker.",
        vec![Query::last("value", "vibrissa_status", "$tag_service")],
    );
    let timeline = Panel::of_kind(
        "state-timeline",
        "State",
        "State of the machine, and whether a fault makes it wait.",
        vec![
            Query::points("state", "vibrissa_state", "state"),
            Query::points("is_paused", "vibrissa_state", "stopped by a fault"),
            Query::points("has_failed", "vibrissa_state", "failed"),
        ],
    );
    let colours = program.states.iter().zip(COLOURS.iter().cycle());
    let mut mappings = value_mappings(colours.map(|(state, colour)| (state.name.to_string(), *colour)));
    mappings.extend(value_mappings([("true".to_owned(), RED), ("false".to_owned(), GREEN)]));
    vec![
        status
            .sized(4, 5)
            .with_mappings(value_mappings([("online".to_owned(), GREEN), ("offline".to_owned(), RED)]))
            .with_options(json!({
                "colorMode": "background", "graphMode": "none",
                "reduceOptions": {"calcs": ["lastNotNull"], "fields": "/.*/", "values": false},
            })),
        timeline.sized(20, 5).with_mappings(mappings).with_options(json!({"mergeValues": true, "showValue": "auto"})),
    ]
}

/// One mapping of Grafana, from texts to colours. The text stays as it is.
fn value_mappings<'c>(values: impl IntoIterator<Item = (String, &'c str)>) -> Vec<Value> {
    let options: serde_json::Map<String, Value> = values
        .into_iter()
        .enumerate()
        .map(|(index, (text, colour))| (text.clone(), json!({"text": text, "color": colour, "index": index})))
        .collect();
    vec![json!({"type": "value", "options": options})]
}

fn whiskers(config: &Config) -> Vec<Panel> {
    let limit = config.limits.base_angle;
    let angles = Panel::curves(
        "Base angles",
        "Filtered base angles of the whiskers of the policy. Beyond the limit of the configuration, the robot stops.",
        "si:rad",
        vec![Query::series("mean", "base_angle_rad", "vibrissa_whisker", Some("whisker"), "$tag_whisker")],
    );
    let field = Panel::curves(
        "Magnetic field",
        "Field at each sensor, along its measured axis.",
        "si:T",
        vec![Query::series("mean", "field_t", "vibrissa_sample", Some("whisker"), "$tag_whisker")],
    );
    vec![angles.with_thresholds(&[(None, RED), (Some(-limit), GREEN), (Some(limit), RED)]), field]
}

fn motion(config: &Config) -> Vec<Panel> {
    let trace = Panel::of_kind(
        "xychart",
        "Pose and tips",
        "Path of the centre of mass, and tips of the whiskers in contact, in the world frame (m).",
        vec![
            Query::table(
                "mean(\"x_m\") AS \"x\", mean(\"y_m\") AS \"y\"",
                "vibrissa_pose",
                "GROUP BY time($__interval) fill(none)",
            ),
            Query::table(
                "\"tip_x_m\" AS \"x\", \"tip_y_m\" AS \"y\"",
                "vibrissa_whisker",
                "ORDER BY time DESC LIMIT 5000",
            ),
        ],
    );
    let series = |frame: u32, name: &str| {
        let matcher = |field: &str| json!({"matcher": {"id": "byName", "options": field}});
        json!({
            "frame": {"matcher": {"id": "byIndex", "options": frame}}, "name": {"fixed": name}, "x": matcher("x"), "y": matcher("y"),
        })
    };
    let speed = Panel::curves(
        "Velocity",
        "Velocity that the machine commands, in the world frame. No command exceeds the limit of the configuration.",
        "velocityms",
        vec![
            Query::series("mean", "velocity_x_m_per_s", "vibrissa_command", None, "x"),
            Query::series("mean", "velocity_y_m_per_s", "vibrissa_command", None, "y"),
        ],
    );
    let yaw_rate = Panel::curves(
        "Yaw rate",
        "Yaw rate that the machine commands (rad/s).",
        "si:rad/s",
        vec![Query::series("mean", "yaw_rate_rad_per_s", "vibrissa_command", None, "yaw rate")],
    );
    let within = |limit: f64| [(None, RED), (Some(-limit), GREEN), (Some(limit), RED)];
    vec![
        trace
            .sized(12, 10)
            .with_options(json!({"mapping": "manual", "series": [series(0, "platform"), series(1, "tips")]})),
        speed.sized(6, 10).with_thresholds(&within(config.limits.speed)),
        yaw_rate.sized(6, 10).with_thresholds(&within(config.limits.yaw_rate)),
    ]
}

fn health(config: &Config) -> Vec<Panel> {
    let period = config.rig.sensing.control_rate.recip();
    let service = Some("service");
    let latency = |function, field, name| Query::series(function, field, "vibrissa_latency", service, name);
    let loop_latency = Panel::curves(
        "Latency of the loop",
        "Largest durations since the start of the program. A tick must end within half of a control period.",
        "s",
        vec![
            latency("max", "tick_largest_s", "tick $tag_service"),
            latency("max", "tick_lateness_largest_s", "lateness of ticks $tag_service"),
            latency("max", "round_largest_s", "round on the first bus $tag_service"),
        ],
    );
    let age = Panel::curves(
        "Age of samples",
        "Age of the newest sample at the start of a tick.",
        "s",
        vec![Query::series("max", "sample_age_s", "vibrissa_pose", None, "age")],
    );
    let count = |field, name| Query::series("max", field, "vibrissa_health", service, name);
    let faults =
        Panel::curves("Faults", "Number of faults that are present.", "", vec![count("faults", "faults $tag_service")]);
    let events = Panel::of_kind(
        "table",
        "Changes of faults",
        "Faults that have been detected, have stopped the robot, or are over.",
        vec![Query::table(
            "\"fault\", \"part\", \"change\", \"service\"",
            "vibrissa_event",
            "ORDER BY time DESC LIMIT 200",
        )],
    );
    let missed = Panel::curves(
        "Missed periods",
        "Periods that a thread has missed since the start of the program.",
        "",
        vec![
            count("missed_acquisition", "acquisition $tag_service"),
            count("missed_control", "control $tag_service"),
            count("missed_supervision", "supervision $tag_service"),
        ],
    );
    let messages = Panel::curves(
        "Messages",
        "Messages that wait for the broker, messages that have been dropped, and records that the telemetry has lost.",
        "",
        vec![
            count("buffered_messages", "waiting $tag_service"),
            count("dropped_messages", "dropped $tag_service"),
            count("lost_records", "lost $tag_service"),
        ],
    );
    let some = [(None, GREEN), (Some(1.0), RED)];
    vec![
        loop_latency.with_thresholds(&[(None, GREEN), (Some(0.4 * period), YELLOW), (Some(0.5 * period), RED)]),
        age.with_thresholds(&[(None, GREEN), (Some(period), YELLOW)]),
        faults.with_thresholds(&some),
        events,
        missed,
        messages,
    ]
}
