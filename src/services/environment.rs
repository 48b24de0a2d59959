//! The settings of the user, as variables of the environment.

/// The example of `.env`. Its passwords are empty, and nothing starts until they are set.
pub(super) fn example(robot: &str) -> String {
    format!(
        "\
# Settings of the services of the robot {robot}. Copy this file to `.env` and set every password.
# docs/services.md explains the settings.

# Passwords: of Grafana's user `admin`, and of the users of InfluxDB that write and read.
GRAFANA_PASSWORD=
INFLUXDB_ADMIN_PASSWORD=
INFLUXDB_WRITE_PASSWORD=
INFLUXDB_READ_PASSWORD=

# Addresses of this computer on which the services listen. The broker has neither password nor encryption, so let it
# listen on another address only in a closed network.
MQTT_BIND=127.0.0.1
HTTP_BIND=127.0.0.1
HTTP_PORT=8080

# For the services of the robot itself (profiles `sensor-io` and `control`).
# The folder with the program `vibrissa-robot` for their image, and that of the configuration.
VIBRISSA_PROGRAM=/usr/bin
VIBRISSA_CONFIG=/etc/vibrissa
"
    )
}
