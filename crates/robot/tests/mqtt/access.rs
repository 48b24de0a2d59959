//! A broker that asks for a user and a password, with and without encryption.

use std::os::unix::fs::PermissionsExt;
use std::path::{Path, PathBuf};
use std::sync::{Arc, Mutex};

use vibrissa_robot::config::{MqttConfig, TlsConfig};
use vibrissa_robot::mqtt::Message;
use vibrissa_robot::telemetry::Publisher;

use crate::mosquitto::Mosquitto;
use crate::wait_until;

fn fixture(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/fixtures/mqtt").join(name)
}

/// A broker for the user `robot`, with these further lines.
fn broker(lines: &str) -> Option<Mosquitto> {
    let users = fixture("users");
    Mosquitto::closed(&format!("password_file {}\nlog_dest stderr\nlog_type error\n{lines}", users.display()))
}

fn encrypted() -> String {
    let [certificate, key] = ["broker.pem", "broker.key"].map(fixture);
    format!("certfile {}\nkeyfile {}\n", certificate.display(), key.display())
}

/// The first news of a connection: `None` if the broker has a message, otherwise why it does not.
fn refusal(broker: &Mosquitto, user: Option<&str>, password: &str, ca: Option<&str>) -> Option<String> {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("password");
    std::fs::write(&file, format!("{password}\n")).unwrap();
    std::fs::set_permissions(&file, PermissionsExt::from_mode(0o600)).unwrap();
    let config = MqttConfig {
        user: user.map(str::to_owned),
        password_file: user.map(|_| file),
        tls: ca.map(|ca| TlsConfig { ca: Some(fixture(ca)) }),
        ..MqttConfig::open(broker.address.ip().to_string(), broker.address.port(), 10)
    };
    let lines = Arc::<Mutex<Vec<String>>>::default();
    let own = Arc::clone(&lines);
    let publisher = Publisher::start("test", &config, move |line| own.lock().unwrap().push(line.to_owned())).unwrap();
    publisher.push(Message { topic: "vibrissa/test/health".into(), payload: b"{}".to_vec(), is_retained: false });
    wait_until("news of the connection", || publisher.counts().0 == 0 || !lines.lock().unwrap().is_empty());
    lines.lock().unwrap().first().cloned()
}

#[test]
fn the_right_user_is_let_in_and_a_wrong_one_is_told_what_to_check() {
    let Some(broker) = broker("") else { return };
    assert_eq!(refusal(&broker, Some("robot"), "secret", None), None);
    for (user, password) in [(Some("robot"), "other"), (Some("somebody"), "secret"), (None, "")] {
        let reason = refusal(&broker, user, password, None).unwrap();
        assert!(reason.contains("`user` and `password_file`"), "{user:?}: {reason}");
        assert!(!reason.contains("secret"), "{reason}");
    }
}

#[test]
fn an_encrypted_connection_needs_the_authority_of_the_broker() {
    let Some(broker) = broker(&encrypted()) else { return };
    assert_eq!(refusal(&broker, Some("robot"), "secret", Some("ca.pem")), None);
    let reason = refusal(&broker, Some("robot"), "secret", Some("other-ca.pem")).unwrap();
    assert!(reason.contains("check `tls` of `mqtt`"), "{reason}");
    let reason = refusal(&broker, Some("robot"), "other", Some("ca.pem")).unwrap();
    assert!(reason.contains("`user` and `password_file`"), "{reason}");
    // Without encryption the password never leaves in a form that this broker answers.
    assert!(refusal(&broker, Some("robot"), "secret", None).is_some());
}
