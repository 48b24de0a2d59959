//! What Grafana loads at its start.

/// Identifier of the database in the dashboard.
pub(super) const DATABASE: &str = "vibrissa-influxdb";
/// Identifier of the logs in the dashboard.
pub(super) const LOGS: &str = "vibrissa-loki";

/// Identifier of the broker in the dashboard.
pub(super) const BROKER: &str = "vibrissa-mqtt";

/// The data sources.
pub(super) fn data_sources() -> String {
    format!(
        "\
apiVersion: 1
datasources:
  - name: InfluxDB
    uid: {DATABASE}
    type: influxdb
    access: proxy
    url: http://influxdb:8086
    user: grafana
    isDefault: true
    jsonData: {{version: InfluxQL, dbName: vibrissa, httpMode: POST}}
    secureJsonData: {{password: $INFLUXDB_READ_PASSWORD}}
  - name: Loki
    uid: {LOGS}
    type: loki
    access: proxy
    url: http://loki:3100
  - name: MQTT
    uid: {BROKER}
    type: grafana-mqtt-datasource
    access: proxy
    jsonData: {{uri: 'tcp://mosquitto:1883'}}
"
    )
}

/// The folder of the dashboards.
pub(super) fn dashboards() -> String {
    "\
apiVersion: 1
providers:
  - name: vibrissa
    folder: Vibrissa
    type: file
    disableDeletion: true
    allowUiUpdates: false
    options: {path: /etc/grafana/dashboards}
"
    .to_owned()
}
