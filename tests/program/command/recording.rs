//! Recordings: `drive --record`, `replay` and `keep`.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::Output;
use std::sync::Arc;

use serde_json::Value;
use vibrissa_robot::config::Config;
use vibrissa_robot::drive::LoopRecord;
use vibrissa_robot::emulation::{Emulation, Settings, SwayingPlant};
use vibrissa_robot::recording::{Origin, RecordingWriter, Setup};
use vibrissa_runtime::control::Control;
use vibrissa_runtime::machine::Artifact;
use vibrissa_runtime::rig::Rig;

use super::program::{ROOT, directory, stderr, stdout, vibrissa};
use super::schema::check;

/// A command line in which `@` stands for a folder.
fn in_folder(folder: &Path, line: &str) -> Output {
    let words: Vec<_> = line.split(' ').map(|word| word.replace('@', folder.to_str().unwrap())).collect();
    vibrissa(&words.iter().map(String::as_str).collect::<Vec<_>>())
}

/// A folder with a recorded run of three seconds, in which a sensor is stale after one second.
fn recorded(name: &str) -> PathBuf {
    let folder = directory(name);
    let scene = "name: scene\nworld: quasistatic\nobjects: [{circle: {centre: [40 cm, 40 cm], radius: 30 cm}}]\n\
        start: {position: [0 mm, 72 mm], heading: 90 deg}\nstop: {time: 3 s}\n";
    fs::write(folder.join("scene.yaml"), scene).unwrap();
    fs::write(folder.join("faults.yaml"), "- {at_ms: 1000, for_ms: 200, kind: stale_sensor, part: 0}\n").unwrap();
    let drive = "drive policies/bang.fsm --emulate @/scene.yaml --inject @/faults.yaml";
    let output = in_folder(&folder, &format!("{drive} --json --record @/run.mcap"));
    assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
    // Recording changes nothing.
    let figures = |output: &Output| {
        let mut document: Value = serde_json::from_str(&stdout(output)).unwrap();
        assert_eq!(document["faults"][0]["kind"], "sensor_stale");
        // The times that computers need differ.
        document["run"]
            .as_object_mut()
            .unwrap()
            .retain(|key, _| !key.contains("wall") && !key.contains("_us") && key != "realtime");
        assert!(document["provenance"].take().is_object());
        document
    };
    assert_eq!(figures(&output), figures(&in_folder(&folder, &format!("{drive} --json"))));
    folder
}

fn replayed(folder: &Path, name: &str) -> Value {
    let output = in_folder(folder, &format!("replay @/{name} --json"));
    assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
    let document = serde_json::from_str(&stdout(&output)).unwrap();
    check("replay", &document);
    document
}

#[test]
fn a_recorded_run_replays_bit_for_bit_and_a_part_of_it_is_kept() {
    let folder = recorded("recorded");
    let whole = replayed(&folder, "run.mcap");
    assert_eq!((&whole["difference"], &whole["is_cut"]), (&Value::Null, &false.into()));
    let entries = whole["recording"].as_object().unwrap();
    for key in ["machine_sha256", "program_sha256", "rig_sha256", "configuration.json_sha256"] {
        assert_eq!(entries[key].as_str().unwrap().len(), 64, "{key}");
    }
    assert_eq!(entries["scenario"], "scene");
    let shown = stdout(&in_folder(&folder, "replay @/run.mcap"));
    assert!(shown.contains("bit-identical") && shown.contains("sensor_stale"), "{shown}");

    // By default, the recording is kept until one second after its first stop.
    let output = in_folder(&folder, "inspect keep @/run.mcap --out @/kept.mcap");
    assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
    let kept = replayed(&folder, "kept.mcap");
    let stopped = whole["faults"][0]["reacted_s"].as_f64().unwrap();
    assert!((kept["end_s"].as_f64().unwrap() - stopped - 1.0).abs() < 0.05, "{kept}");
    assert_eq!(kept["faults"], whole["faults"]);
    let output = in_folder(&folder, "inspect keep @/run.mcap --at 0.5s --out @/early.mcap");
    assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
    assert_eq!(replayed(&folder, "early.mcap")["faults"], Value::Array(Vec::new()));
}

#[test]
fn a_time_without_a_recording_and_a_run_without_a_stop_are_refused() {
    let folder = recorded("not-kept");
    assert_eq!(in_folder(&folder, "inspect keep @/run.mcap --at 0.5s --out @/early.mcap").status.code(), Some(0));
    for (line, reason) in [
        ("inspect keep @/run.mcap --at 100s --out @/kept.mcap", "the recording ends at"),
        ("inspect keep @/early.mcap --out @/kept.mcap", "no fault has stopped the robot"),
        ("inspect keep @/run.mcap --at 1m --out @/kept.mcap", "write a time from 0"),
        ("inspect keep @/run.mcap --out @/run.mcap", "this command reads it as"),
        ("replay @/scene.yaml", "it is no MCAP file"),
        ("replay @/run.mcap @/run.mcap", "give each part once"),
        ("replay @/run.mcap @/early.mcap", "different runs"),
    ] {
        let refused = in_folder(&folder, line);
        assert_eq!(refused.status.code(), Some(2), "{line}");
        assert!(stderr(&refused).contains(reason), "{line}: {}", stderr(&refused));
    }
    assert!(!folder.join("kept.mcap").exists());
}

#[test]
fn a_recording_without_its_end_is_replayed_with_a_warning() {
    let folder = recorded("cut");
    let file = fs::read(folder.join("run.mcap")).unwrap();
    fs::write(folder.join("cut.mcap"), &file[..file.len() - 100]).unwrap();
    let output = in_folder(&folder, "replay @/cut.mcap");
    assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
    assert!(stderr(&output).contains("its end is missing"), "{}", stderr(&output));
    fs::write(folder.join("header.mcap"), &file[..100]).unwrap();
    let output = in_folder(&folder, "replay @/header.mcap");
    assert_eq!(output.status.code(), Some(2), "{}", stderr(&output));
}

#[test]
fn a_result_that_differs_is_reported_with_exit_status_1() {
    let folder = directory("differing");
    let config = Config::emulated(Rig::default(), 1.5);
    let machine = fs::read(Path::new(ROOT).join("crates/runtime/fixtures/bang.machine")).unwrap();
    let artifact = Artifact::from_bytes(&machine).unwrap();
    let control = Control::new(&config.rig, Arc::new(artifact.program.clone())).unwrap();
    let plant = SwayingPlant::new(config.rig.sensing.sample_rate.recip());
    let mut robot = Emulation::new(&config, control, plant, &Settings::default()).unwrap();
    robot.run(2_000_000_000, |_, _, _, _| true).unwrap();
    let origin = Origin { program: "test".to_owned(), program_sha256: None, details: [].into() };
    let setup = Setup::new(config, None, artifact).unwrap();
    let mut writer = RecordingWriter::new(Vec::new(), &setup, &origin).unwrap();
    while let Some(mut record) = robot.next_record() {
        if let LoopRecord::Tick(tick) = &mut record {
            tick.command.yaw_rate += 1e-15;
        }
        writer.take(&record).unwrap();
    }
    fs::write(folder.join("run.mcap"), writer.finish().unwrap()).unwrap();
    let output = in_folder(&folder, "replay @/run.mcap");
    assert_eq!(output.status.code(), Some(1), "{}", stderr(&output));
    assert!(stdout(&output).contains("command.yaw_rate"), "{}", stdout(&output));
    let output = in_folder(&folder, "inspect keep @/run.mcap --at 1s --out @/kept.mcap");
    assert_eq!(output.status.code(), Some(1), "{}", stderr(&output));
    assert!(stderr(&output).contains("`command.yaw_rate` differs"), "{}", stderr(&output));
    // It is kept all the same: the difference is of interest.
    assert!(folder.join("kept.mcap").exists());
}
