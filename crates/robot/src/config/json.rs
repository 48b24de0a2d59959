//! Every value of a configuration as JSON, for recordings.

use super::{Config, ConfigError};

impl Config {
    /// Every value of the configuration. [`from_json`](Self::from_json) gives exactly this configuration again.
    ///
    /// # Errors
    /// [`ConfigError::Text`] if a path is not UTF-8 text.
    pub fn to_json(&self) -> Result<Vec<u8>, ConfigError> {
        serde_json::to_vec_pretty(self).map_err(|error| ConfigError::Text(error.to_string()))
    }

    /// Reads the values of a configuration.
    ///
    /// # Errors
    /// [`ConfigError`] with the first problem found.
    pub fn from_json(bytes: &[u8]) -> Result<Self, ConfigError> {
        let config: Self = serde_json::from_slice(bytes).map_err(|error| ConfigError::Text(error.to_string()))?;
        super::check::check(&config)?;
        Ok(config)
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "a test may panic")]

    use super::*;
    use crate::config::{ActuatorConfig, FaultResponse, MqttConfig, PoseSource, RecordConfig, TlsConfig};
    use crate::fault::FaultKind;
    use proptest::prelude::*;
    use vibrissa_runtime::calibration::Calibration;
    use vibrissa_runtime::geometry::Point2;
    use vibrissa_runtime::rig::Rig;

    fn number() -> impl Strategy<Value = f64> {
        proptest::num::f64::NORMAL | proptest::num::f64::SUBNORMAL | proptest::num::f64::ZERO
    }

    /// Any finite numbers in a configuration that has every section.
    fn config() -> impl Strategy<Value = Config> {
        (proptest::array::uniform32(number()), any::<u16>()).prop_map(|(numbers, seed)| {
            let mut numbers = numbers.into_iter();
            let mut next = || numbers.next().unwrap();
            let mut config = Config::emulated(Rig::default(), 1.5);
            let whisker = &mut config.rig.whiskers[0];
            whisker.base_body = Point2::new(next(), next());
            (whisker.direction_body, whisker.shaft.length, whisker.hinge.damping) = (next(), next(), next());
            whisker.shaft.tip_radius = Some(next());
            whisker.calibration = Some(Calibration::new("measured".to_owned()));
            (config.rig.platform.mass, config.rig.platform.yaw.integral) = (next(), next());
            (config.rig.sensing.filter_cutoff, config.rig.sensing.angle_noise) = (next(), next());
            config.rig.sensing.forces = seed % 2 == 0;
            let board = &mut config.buses[0].boards[0];
            (board.field_per_moment, board.cubic) = (next(), next());
            config.buses[0].clock = next();
            (config.limits.speed, config.limits.yaw_rate, config.limits.base_angle) = (next(), next(), next());
            let timeouts = &mut config.timeouts;
            (timeouts.bus, timeouts.sensor, timeouts.pose) = (next(), next(), next());
            (timeouts.control, timeouts.link, timeouts.settle) = (next(), next(), next());
            config.responses.set(FaultKind::Saturated, FaultResponse::Log);
            config.actuator = ActuatorConfig::Udp { address: ([127, 0, 0, 1], seed).into(), acknowledged: false };
            config.pose.source = PoseSource::Udp { listen: ([0; 4], seed).into(), from: "10.0.0.1:7".parse().ok() };
            (config.pose.latency, config.pose.noise, config.pose.heading_noise) = (next(), next(), next());
            config.mqtt = Some(MqttConfig {
                user: Some("robot".to_owned()),
                password_file: Some("/etc/vibrissa/password".into()),
                tls: Some(TlsConfig { ca: Some("/etc/vibrissa/ca.pem".into()) }),
                ..MqttConfig::open("broker".to_owned(), seed, 7)
            });
            config.record = Some(RecordConfig { directory: "/var/lib/vibrissa".into(), limit_mb: 9 });
            config
        })
    }

    proptest! {
        #[test]
        fn a_configuration_is_read_bit_for_bit_as_it_was_written(config in config()) {
            let read = Config::from_json(&config.to_json().unwrap()).unwrap();
            prop_assert_eq!(&read, &config);
            // Equality does not see the sign of zero.
            prop_assert_eq!(format!("{read:?}"), format!("{config:?}"));
        }
    }

    #[test]
    fn a_configuration_without_a_valid_array_is_refused() {
        let mut config = Config::emulated(Rig::default(), 1.5);
        config.buses.clear();
        assert!(matches!(Config::from_json(&config.to_json().unwrap()), Err(ConfigError::Inconsistent(_))));
        assert!(matches!(Config::from_json(b"{}"), Err(ConfigError::Text(_))));
    }
}
