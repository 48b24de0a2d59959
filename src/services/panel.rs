//! A panel of the dashboard.

use serde_json::{Value, json};

use super::provisioning::DATABASE;
use super::query::Query;

/// A panel of the dashboard. The grid is 24 units wide.
#[derive(Debug, Clone)]
pub(super) struct Panel {
    pub(super) title: &'static str,
    pub(super) kind: &'static str,
    pub(super) description: &'static str,
    pub(super) width: u32,
    pub(super) height: u32,
    pub(super) queries: Vec<Query>,
    /// Unit of Grafana, such as `si:rad`.
    pub(super) unit: &'static str,
    pub(super) mappings: Vec<Value>,
    pub(super) thresholds: Vec<Threshold>,
    pub(super) options: Value,
}

/// The colour of values from a limit on. The first one has no limit.
pub(super) type Threshold = (Option<f64>, &'static str);

impl Panel {
    /// A panel of curves over time.
    pub(super) fn curves(
        title: &'static str,
        description: &'static str,
        unit: &'static str,
        queries: Vec<Query>,
    ) -> Self {
        Self {
            title,
            kind: "timeseries",
            description,
            width: 12,
            height: 8,
            queries,
            unit,
            mappings: Vec::new(),
            thresholds: Vec::new(),
            options: json!({"tooltip": {"mode": "multi"}, "legend": {"displayMode": "list", "placement": "bottom"}}),
        }
    }

    /// A panel of another kind.
    pub(super) fn of_kind(
        kind: &'static str,
        title: &'static str,
        description: &'static str,
        queries: Vec<Query>,
    ) -> Self {
        Self { kind, options: json!({}), ..Self::curves(title, description, "", queries) }
    }

    pub(super) fn sized(self, width: u32, height: u32) -> Self {
        Self { width, height, ..self }
    }

    pub(super) fn with_mappings(self, mappings: Vec<Value>) -> Self {
        Self { mappings, ..self }
    }

    pub(super) fn with_thresholds(self, thresholds: &[Threshold]) -> Self {
        Self { thresholds: thresholds.to_vec(), ..self }
    }

    pub(super) fn with_options(self, options: Value) -> Self {
        Self { options, ..self }
    }

    /// The panel as JSON, at a place of the grid.
    pub(super) fn json(&self, id: usize, x: u32, y: u32) -> Value {
        let source = json!({"type": "influxdb", "uid": DATABASE});
        let letters = 'A'..='Z';
        let targets: Vec<Value> = letters
            .zip(&self.queries)
            .map(|(letter, query)| {
                let format = if query.is_table { "table" } else { "time_series" };
                let mut target = json!({
                    "refId": letter.to_string(), "datasource": source, "rawQuery": true, "query": query.text,
                    "resultFormat": format,
                });
                if !query.alias.is_empty() {
                    target["alias"] = query.alias.as_str().into();
                }
                target
            })
            .collect();
        let mut defaults = json!({"mappings": self.mappings});
        if !self.unit.is_empty() {
            defaults["unit"] = self.unit.into();
        }
        if !self.thresholds.is_empty() {
            let steps: Vec<Value> =
                self.thresholds.iter().map(|(value, color)| json!({"value": value, "color": color})).collect();
            defaults["thresholds"] = json!({"mode": "absolute", "steps": steps});
            defaults["custom"] = json!({"thresholdsStyle": {"mode": "dashed"}});
        }
        json!({
            "id": id, "type": self.kind, "title": self.title, "description": self.description,
            "gridPos": {"x": x, "y": y, "w": self.width, "h": self.height},
            "datasource": source, "targets": targets,
            "fieldConfig": {"defaults": defaults, "overrides": []},
            "options": self.options,
        })
    }
}
