//! A real database, which gets the telemetry of an emulated robot and answers every query of the dashboard.

use std::collections::BTreeSet;
use std::fmt::Write as _;
use std::io::{Read, Write};
use std::net::{SocketAddr, TcpStream};
use std::path::PathBuf;
use std::process::{Child, Command, Stdio};

use serde_json::Value;
use vibrissa_robot::emulation::{Injection, InjectionKind, Settings};
use vibrissa_robot::telemetry::{OFFLINE, lines};

use crate::emulated::EmulatedRobot;
use crate::listener::Listener;
use crate::mosquitto::{Mosquitto, find, free_port};
use crate::{PATIENCE, wait_until};

/// The dashboard of the services. It is as `vibrissa setup services generate` makes it, which a test of that command ensures.
const DASHBOARD: &str = include_str!("../../../../deploy/services/grafana/dashboards/robot.json");

/// A running InfluxDB on the loopback interface. It ends with the test.
struct InfluxDb {
    child: Child,
    address: SocketAddr,
    _directory: tempfile::TempDir,
}

impl InfluxDb {
    /// Starts a database. `None` if there is none on this machine, which CI does not accept.
    fn start() -> Option<Self> {
        let program = find("influxd", "influxdb")?;
        let directory = tempfile::tempdir().unwrap();
        loop {
            let (address, other) = (free_port(), free_port());
            let config = directory.path().join("influxdb.conf");
            std::fs::write(&config, configuration(directory.path().display(), address, other)).unwrap();
            let mut child = start(&program, &config);
            let before = std::time::Instant::now();
            while TcpStream::connect(address).is_err() {
                // Another program may have taken the port meanwhile.
                if child.try_wait().unwrap().is_some() {
                    break;
                }
                assert!(before.elapsed() < PATIENCE, "InfluxDB accepts no connection");
                std::thread::sleep(std::time::Duration::from_millis(20));
            }
            if child.try_wait().unwrap().is_none() {
                return Some(Self { child, address, _directory: directory });
            }
        }
    }

    /// Sends a request. The result is the body of the answer.
    fn request(&self, method: &str, path: &str, body: &str) -> String {
        let mut stream = TcpStream::connect(self.address).unwrap();
        stream.set_read_timeout(Some(PATIENCE)).unwrap();
        let head = format!(
            "{method} {path} HTTP/1.0\r\nHost: {}\r\nContent-Length: {}\r\nConnection: close\r\n\r\n",
            self.address,
            body.len()
        );
        stream.write_all(head.as_bytes()).unwrap();
        stream.write_all(body.as_bytes()).unwrap();
        let mut answer = String::new();
        stream.read_to_string(&mut answer).unwrap();
        let (head, body) = answer.split_once("\r\n\r\n").unwrap();
        let is_good = head.split(' ').nth(1).is_some_and(|status| status.starts_with('2'));
        assert!(is_good, "{path}: {answer}");
        body.to_owned()
    }

    /// The rows of all series of a query.
    fn rows(&self, query: &str) -> Vec<Vec<Value>> {
        let mut encoded = String::new();
        for byte in query.bytes() {
            write!(encoded, "%{byte:02X}").unwrap();
        }
        let answer = self.request("POST", &format!("/query?db=vibrissa&q={encoded}"), "");
        let answer: Value = serde_json::from_str(&answer).unwrap();
        let result = &answer["results"][0];
        assert!(result["error"].is_null(), "{query}: {result}");
        let series = result["series"].as_array().cloned().unwrap_or_default();
        let rows = series.iter().flat_map(|series| series["values"].as_array().cloned().unwrap_or_default());
        rows.map(|row| row.as_array().unwrap().clone()).collect()
    }
}

impl Drop for InfluxDb {
    fn drop(&mut self) {
        let _ = self.child.kill();
        let _ = self.child.wait();
    }
}

fn start(program: &PathBuf, config: &PathBuf) -> Child {
    let mut command = Command::new(program);
    command.arg("-config").arg(config).stdin(Stdio::null()).stdout(Stdio::null()).stderr(Stdio::null());
    command.spawn().unwrap()
}

fn configuration(directory: impl std::fmt::Display, address: SocketAddr, other: SocketAddr) -> String {
    format!(
        "reporting-disabled = true\nbind-address = \"{other}\"\n\
         [meta]\ndir = \"{directory}/meta\"\n\
         [data]\ndir = \"{directory}/data\"\nwal-dir = \"{directory}/wal\"\nquery-log-enabled = false\n\
         [monitor]\nstore-enabled = false\n\
         [http]\nbind-address = \"{address}\"\nlog-enabled = false\n"
    )
}

/// The configuration of the broker of the services, without its listener, and with another directory.
fn broker_lines(data: &tempfile::TempDir) -> String {
    let text = include_str!("../../../../deploy/services/mosquitto.conf");
    assert!(text.contains("\nlistener 1883\nallow_anonymous true\n") && text.contains("/mosquitto/data/"));
    let text = text.replace("listener 1883\nallow_anonymous true\n", "");
    // Mosquitto gives its privileges up if it has any, so the directory is for everyone.
    std::fs::set_permissions(data, std::os::unix::fs::PermissionsExt::from_mode(0o777)).unwrap();
    text.replace("/mosquitto/data/", &format!("{}/", data.path().display()))
}

/// All queries of the dashboard to the database, each with the title of its panel.
fn queries(dashboard: &Value) -> Vec<(String, String)> {
    let panels = dashboard["panels"].as_array().unwrap();
    let of_panel = |panel: &Value| {
        let title = panel["title"].as_str().unwrap().to_owned();
        let targets = panel["targets"].as_array().cloned().unwrap_or_default();
        let texts = targets.into_iter().filter_map(|target| Some(target["query"].as_str()?.to_owned()));
        texts.map(move |text| (title.clone(), text)).collect::<Vec<_>>()
    };
    let variables = dashboard["templating"]["list"].as_array().unwrap().iter();
    let variables = variables.map(|variable| ("a variable".to_owned(), variable["query"].as_str().unwrap().to_owned()));
    panels.iter().flat_map(of_panel).chain(variables).collect()
}

#[test]
fn a_database_answers_every_query_of_the_dashboard_with_the_telemetry_of_a_robot() {
    let data = tempfile::tempdir().unwrap();
    let (Some(broker), Some(database)) = (Mosquitto::with(&broker_lines(&data)), InfluxDb::start()) else { return };
    let listener = Listener::of_all(broker.address);
    let no_pose = Injection { at_ms: 3000, for_ms: 1500, kind: InjectionKind::NoPose, part: 0 };
    let settings = Settings { injections: vec![no_pose], ..Settings::default() };
    let mut robot = EmulatedRobot::with_telemetry(&settings, broker.address, 100_000);
    robot.run(12_000);
    wait_until("the transmission", || robot.counts().0 == 0);
    robot.finish();
    listener.wait_for_status(OFFLINE);

    let now = std::time::SystemTime::now().duration_since(std::time::UNIX_EPOCH).unwrap().as_secs_f64();
    let arrivals = listener.all();
    let name = arrivals[0].topic.split('/').nth(1).unwrap().to_owned();
    let points: Vec<String> =
        arrivals.iter().flat_map(|arrival| lines(&arrival.topic, &arrival.payload, now).unwrap()).collect();
    assert!(points.len() > 1000, "{}", points.len());
    database.request("POST", "/query?q=CREATE%20DATABASE%20vibrissa", "");
    database.request("POST", "/write?db=vibrissa", &points.join("\n"));

    let dashboard: Value = serde_json::from_str(DASHBOARD).unwrap();
    let queries = queries(&dashboard);
    assert!(queries.len() > 15, "{}", queries.len());
    for (panel, query) in queries {
        let shown = query
            .replace("$robot", &name)
            .replace("$timeFilter", "time > now() - 1h AND time < now() + 1h")
            .replace("$__interval", "100ms");
        assert!(!shown.contains('$'), "{panel}: {shown}");
        let rows = database.rows(&shown);
        let has_value = |row: &Vec<Value>| row.iter().skip(1).any(|value| !value.is_null());
        assert!(rows.iter().any(has_value), "{panel}: no data for {shown}");
    }

    // The database has every point. Points of one series with the same time are one.
    for (measurement, field) in [("vibrissa_state", "is_paused"), ("vibrissa_whisker", "base_angle_rad")] {
        let of_measurement = points.iter().filter(|point| point.starts_with(&format!("{measurement},")));
        let place = |point: &String| {
            let (series, time) = (point.split(' ').next().unwrap(), point.rsplit(' ').next().unwrap());
            (series.to_owned(), time.to_owned())
        };
        let sent: BTreeSet<_> = of_measurement.map(place).collect();
        let counted = database.rows(&format!("SELECT count(\"{field}\") FROM \"{measurement}\""));
        assert_eq!(counted[0][1].as_u64(), Some(sent.len() as u64), "{measurement}");
    }
}
