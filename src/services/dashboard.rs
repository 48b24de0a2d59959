//! The dashboard of Grafana.

use serde_json::{Value, json};
use vibrissa_robot::config::Config;
use vibrissa_runtime::machine::Program;

use super::describe::describe;
use super::panels::panels;
use super::provisioning::{DATABASE, LOGS};

/// Width of the grid.
const WIDTH: u32 = 24;
/// Version of Grafana's format.
const SCHEMA: u32 = 39;

/// The dashboard of a robot that runs this program, as JSON.
pub(super) fn dashboard(program: &Program, config: &Config) -> String {
    let mut placed = Vec::new();
    let (mut x, mut y, mut row) = (0, 0, 0);
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
        "schemaVersion": SCHEMA, "version": 1, "editable": false, "refresh": "1s", "timezone": "browser",
        "time": {"from": "now-5m", "to": "now"}, "templating": {"list": [robot]}, "annotations": {"list": []},
        "panels": placed,
    });
    // A value of JSON has only keys that are text.
    serde_json::to_string_pretty(&dashboard).unwrap_or_default() + "\n"
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
