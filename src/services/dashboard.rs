//! The dashboard of Grafana.

use serde_json::{Value, json};
use vibrissa_robot::config::Config;
use vibrissa_runtime::machine::Program;

use super::describe::describe;
use super::panels::panels;
use super::provisioning::{BROKER, DATABASE, LOGS};

/// Width of the grid.
const WIDTH: u32 = 24;
/// Version of Grafana's format.
const SCHEMA: u32 = 39;

/// The dashboard of a robot that runs this program, as JSON.
pub(super) fn dashboard(program: &Program, config: &Config) -> String {
    let mut placed = vec![live(1, program, config)];
    let (mut x, mut y, mut row) = (0, LIVE_HEIGHT, 0);
    for panel in panels(program, config) {
        if x + panel.width > WIDTH {
            (x, y, row) = (0, y + row, 0);
        }
        placed.push(panel.json(placed.len() + 1, x, y));
        (x, row) = (x + panel.width, row.max(panel.height));
    }
    y += row;
    placed.push(logs(placed.len() + 1, y));
    placed.push(text(placed.len() + 1, y + 8, &describe(program)));
    let robot = json!({
        "name": "robot", "label": "Robot", "type": "query", "datasource": {"type": "influxdb", "uid": DATABASE},
        "query": "SHOW TAG VALUES FROM \"vibrissa_health\" WITH KEY = \"robot\"", "refresh": 1,
        "current": {"text": config.name, "value": config.name},
    });
    let dashboard = json!({
        "uid": format!("vibrissa-{}", config.name), "title": format!("{} by {}", config.name, program.name), "tags": ["vibrissa"],
        "schemaVersion": SCHEMA, "version": 1, "editable": false, "refresh": "5s", "timezone": "browser",
        "time": {"from": "now-5m", "to": "now"}, "templating": {"list": [robot]}, "annotations": {"list": []},
        "panels": placed,
    });
    // A value of JSON has only keys that are text.
    serde_json::to_string_pretty(&dashboard).unwrap_or_default() + "\n"
}

/// Height of the panel that is a stream.
const LIVE_HEIGHT: u32 = 8;

/// The base angles as a stream from the broker, without the database.
fn live(id: usize, program: &Program, config: &Config) -> Value {
    let source = json!({"type": "grafana-mqtt-datasource", "uid": BROKER});
    // A message has the whiskers in the order of the policy, without those that the rig lacks.
    let is_fitted = |name: &&String| config.rig.whiskers.iter().any(|whisker| whisker.name == **name);
    let angles = program.whiskers.iter().filter(is_fitted).enumerate();
    let angles: Vec<Value> =
        angles.map(|(index, name)| json!({"path": format!("[{index}].base_angle_rad"), "alias": name})).collect();
    json!({
        "id": id, "type": "timeseries", "title": "Base angles, live",
        "description": "Filtered base angles of the whiskers of the policy as they arrive at the broker. It begins empty.",
        "gridPos": {"x": 0, "y": 0, "w": WIDTH, "h": LIVE_HEIGHT}, "datasource": source,
        "targets": [{"refId": "A", "datasource": source, "topic": "vibrissa/${robot}/perception"}],
        "transformations": [{
            "id": "extractFields",
            "options": {"source": "whiskers", "format": "json", "jsonPaths": angles, "keepTime": true, "replace": true},
        }],
        "fieldConfig": {"defaults": {"unit": "si:rad"}, "overrides": []},
        "options": {"tooltip": {"mode": "multi"}, "legend": {"displayMode": "list", "placement": "bottom"}},
    })
}

fn logs(id: usize, y: u32) -> Value {
    let source = json!({"type": "loki", "uid": LOGS});
    json!({
        "id": id, "type": "logs", "title": "Log", "gridPos": {"x": 0, "y": y, "w": WIDTH, "h": 8}, "datasource": source,
        "targets": [{"refId": "A", "datasource": source, "expr": "{robot=\"$robot\"}"}],
        "options": {"showTime": true, "sortOrder": "Descending", "enableLogDetails": true},
    })
}

fn text(id: usize, y: u32, content: &str) -> Value {
    json!({
        "id": id, "type": "text", "title": "Policy", "gridPos": {"x": 0, "y": y, "w": WIDTH, "h": 12},
        "options": {"mode": "markdown", "content": content},
    })
}
