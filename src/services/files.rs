//! All files of the services.

use vibrissa_robot::config::Config;
use vibrissa_runtime::machine::Program;

use super::{alloy, dashboard, environment, provisioning, telegraf};

/// A file of the services.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct ServiceFile {
    /// Its path below the directory of the services.
    pub path: &'static str,
    /// Its text.
    pub text: String,
}

/// The files that are the same for every robot.
const COPIES: [(&str, &str); 5] = [
    ("compose.yaml", include_str!("../../deploy/compose.yaml")),
    ("services/mosquitto.conf", include_str!("../../deploy/services/mosquitto.conf")),
    ("services/loki.yaml", include_str!("../../deploy/services/loki.yaml")),
    ("services/traefik.yaml", include_str!("../../deploy/services/traefik.yaml")),
    ("services/robot.Dockerfile", include_str!("../../deploy/services/robot.Dockerfile")),
];

/// The files of the services for a robot with this configuration that runs this program.
#[must_use]
pub fn service_files(program: &Program, config: &Config) -> Vec<ServiceFile> {
    let file = |path, text| ServiceFile { path, text };
    let mut files: Vec<_> = COPIES.into_iter().map(|(path, text)| file(path, text.to_owned())).collect();
    files.extend([
        file("env.example", environment::example(&config.name)),
        file("services/telegraf.conf", telegraf::configuration()),
        file("services/alloy.alloy", alloy::configuration(program, &config.name)),
        file("services/grafana/dashboards/robot.json", dashboard::dashboard(program, config)),
        file("services/grafana/provisioning/datasources/services.yaml", provisioning::data_sources()),
        file("services/grafana/provisioning/dashboards/services.yaml", provisioning::dashboards()),
    ]);
    files
}
