//! Recordings of simulated runs: `run --record` and `replay`.

use std::fs;
use std::io::Cursor;
use std::path::{Path, PathBuf};

use serde_json::Value;
use vibrissa_robot::recording::{FileRecord, Records};

use super::program::{directory, stderr, stdout, vibrissa, without_origin};
use super::schema::check;

const SCENE: &str = "name: scene\nworld: quasistatic\nobjects: [{rounded_rectangle: {centre: [26 cm, 30 cm], width: 30 cm, height: 20 cm, \
    corner_radius: 0 mm}}]\nstart: {position: [0 mm, 72 mm], heading: 90 deg}\nstop: {time: 25 s}\n\
    rig: {sensing: {angle_noise: 0.5 urad}}\n";

/// The output of a command line whose last words are paths.
fn with_paths(words: &[&str], paths: &[&Path]) -> std::process::Output {
    let paths = paths.iter().map(|path| path.to_str().unwrap());
    vibrissa(&words.iter().copied().chain(paths).collect::<Vec<_>>())
}

/// A recorded run of a policy in a folder.
fn recorded(name: &str, policy: &str) -> (PathBuf, Value) {
    let folder = directory(name);
    fs::write(folder.join("scene.yaml"), SCENE).unwrap();
    let words = ["run", "--policy", policy, "--set", "speed=40 mm/s", "--json", "--record"];
    let output = with_paths(&words, &[&folder.join("run.mcap"), &folder.join("scene.yaml")]);
    // A run that fails is recorded, too.
    assert!(matches!(output.status.code(), Some(0 | 1)), "{}", stderr(&output));
    (folder, serde_json::from_str(&stdout(&output)).unwrap())
}

/// The messages of a channel.
fn messages(file: &Path, topic: fn(&str) -> Option<()>) -> Vec<Vec<u8>> {
    let mut records = Records::new(fs::File::open(file).unwrap(), topic);
    let mut all = Vec::new();
    while let Some(record) = records.next_record().unwrap() {
        if let FileRecord::Message(message) = record {
            all.push(message.data);
        }
    }
    assert!(!records.is_cut());
    all
}

#[test]
fn a_recorded_run_is_the_same_run_and_replays_bit_for_bit() {
    let (folder, recorded) = recorded("run-recorded", "policies/thesis.fsm");
    let words = ["run", "--policy", "policies/thesis.fsm", "--set", "speed=40 mm/s", "--json"];
    let plain: Value = serde_json::from_str(&stdout(&with_paths(&words, &[&folder.join("scene.yaml")]))).unwrap();
    for key in ["error_mm", "coverage", "sim_s", "states", "path_m", "hash"] {
        assert_eq!(recorded[0][key], plain[0][key], "{key}");
    }
    let output = with_paths(&["replay", "--json"], &[&folder.join("run.mcap")]);
    assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
    let replayed: Value = serde_json::from_str(&stdout(&output)).unwrap();
    check("replay", &replayed);
    assert_eq!((&replayed["ticks"], &replayed["difference"]), (&750.into(), &Value::Null));
    assert_eq!(replayed["recording"]["scenario_hash"], recorded[0]["hash"]["scenario"]);
}

#[test]
fn a_recording_has_the_ticks_the_guards_and_the_transitions_of_the_run() {
    let (folder, _) = recorded("run-channels", "policies/thesis.fsm");
    let file = folder.join("run.mcap");
    let ticks_file = folder.join("ticks.jsonl");
    let words = ["run", "--policy", "policies/thesis.fsm", "--set", "speed=40 mm/s", "--ticks"];
    with_paths(&words, &[&ticks_file, &folder.join("scene.yaml")]);
    let lines = without_origin(&fs::read_to_string(&ticks_file).unwrap());
    let ticks = messages(&file, |topic| (topic == "ticks").then_some(()));
    assert_eq!(ticks.len(), lines.lines().count());
    for (tick, line) in ticks.iter().zip(lines.lines()) {
        assert_eq!(std::str::from_utf8(tick).unwrap(), line);
    }
    let json = |message: &Vec<u8>| serde_json::from_slice::<Value>(message).unwrap();
    let states = messages(&file, |topic| (topic == "state").then_some(()));
    assert!(states.iter().zip(&ticks).all(|(state, tick)| json(state)["state"] == json(tick)["state"]));
    let guards = messages(&file, |topic| (topic == "guards").then_some(()));
    assert!(guards.iter().all(|guards| !json(guards)["guards"].as_array().unwrap().is_empty()));
    let transitions: Vec<Value> =
        messages(&file, |topic| (topic == "transitions").then_some(())).iter().map(json).collect();
    for transition in &transitions {
        check("transition", transition);
    }
    let changes = states.windows(2).filter(|pair| pair[0] != pair[1]).count();
    assert!(changes > 3 && transitions.len() >= changes, "{changes} changes, {} transitions", transitions.len());
}

#[test]
fn a_compiled_machine_is_recorded_without_guards_and_replayed() {
    let machine = directory("run-machine-compiled").join("quick.machine");
    let compiled = with_paths(&["compile", "policies/quick.fsm", "-o"], &[&machine]);
    assert_eq!(compiled.status.code(), Some(0), "{}", stderr(&compiled));
    let (folder, _) = recorded("run-machine", machine.to_str().unwrap());
    let file = folder.join("run.mcap");
    assert!(messages(&file, |topic| (topic == "guards").then_some(())).is_empty());
    assert_eq!(with_paths(&["replay"], &[&file]).status.code(), Some(0));
    let refused = with_paths(&["replay", "--policy", "policies/quick.fsm"], &[&file]);
    assert_eq!(refused.status.code(), Some(2));
    assert!(stderr(&refused).contains("record a run of the policy itself"), "{}", stderr(&refused));
}

#[test]
fn another_policy_differs_first_where_its_guard_does() {
    let (folder, _) = recorded("run-other", "policies/bang.fsm");
    let file = folder.join("run.mcap");
    let text = fs::read_to_string("policies/bang.fsm").unwrap();
    let same = folder.join("same.fsm");
    // Other words, the same machine.
    fs::write(&same, text.replace("param speed  = 30 mm/s", "param speed  = 40 mm/s").replace("Following", "Along"))
        .unwrap();
    let compare = |policy: &Path| {
        let output = with_paths(&["replay", "--json", "--policy"], &[policy, &file]);
        let difference: Value = serde_json::from_str(&stdout(&output)).unwrap();
        check("policy-difference", &difference);
        (output.status.code(), difference)
    };
    let (code, difference) = compare(&same);
    assert_eq!((code, &difference["first"]), (Some(0), &Value::Null), "{difference}");
    let (code, difference) = compare(Path::new("policies/bang.fsm"));
    assert_eq!(code, Some(1));
    assert_eq!(difference["first"]["tick"], 0, "another speed shows in the first tick");
}

#[test]
fn a_damaged_or_foreign_recording_is_refused_with_what_to_do() {
    let (folder, _) = recorded("run-damaged", "policies/bang.fsm");
    let whole = fs::read(folder.join("run.mcap")).unwrap();
    let damaged = folder.join("damaged.mcap");
    for (bytes, message) in [
        (&whole[..whole.len() / 2], "its end is missing"),
        (&whole[..200], "it ends before its first message"),
        (&b"this is no recording of anything"[..], "it is no MCAP file"),
        (&b""[..], "it ends before its first message"),
    ] {
        fs::write(&damaged, bytes).unwrap();
        let output = with_paths(&["replay"], &[&damaged]);
        assert_eq!(output.status.code(), Some(2), "{message}: {}", stderr(&output));
        assert!(stderr(&output).contains(message), "{message}: {}", stderr(&output));
    }
    // Wherever a byte is changed, the file is refused, or its results are compared.
    for at in (0..whole.len()).step_by(whole.len() / 60) {
        let mut bytes = whole.clone();
        bytes[at] ^= 0x10;
        fs::write(&damaged, bytes).unwrap();
        let code = with_paths(&["replay"], &[&damaged]).status.code();
        assert!(matches!(code, Some(0..=2)), "byte {at}: {code:?}");
    }
}

#[test]
fn one_run_is_recorded_at_a_time() {
    let file = directory("run-two").join("run.mcap");
    let output = with_paths(&["run", "scenarios/disk.yaml", "scenarios/box.yaml", "--record"], &[&file]);
    assert_eq!(output.status.code(), Some(2));
    assert!(stderr(&output).contains("give one scenario") && !file.exists(), "{}", stderr(&output));
}

#[test]
fn a_recording_that_another_program_has_written_anew_replays_as_before() {
    let (folder, _) = recorded("run-rewritten", "policies/bang.fsm");
    let file = fs::read(folder.join("run.mcap")).unwrap();
    let summary = mcap::Summary::read(&file).unwrap().unwrap();
    for (name, compression) in [("plain", None), ("lz4", Some(mcap::Compression::Lz4))] {
        // The metadata and the attachments are behind the messages.
        let options = mcap::WriteOptions::new().compression(compression);
        let mut writer = options.create(Cursor::new(Vec::new())).unwrap();
        for message in mcap::MessageStream::new(&file).unwrap() {
            writer.write(&message.unwrap()).unwrap();
        }
        for index in &summary.attachment_indexes {
            writer.attach(&mcap::read::attachment(&file, index).unwrap()).unwrap();
        }
        for index in &summary.metadata_indexes {
            writer.write_metadata(&mcap::read::metadata(&file, index).unwrap()).unwrap();
        }
        writer.finish().unwrap();
        let path = folder.join(name);
        fs::write(&path, writer.into_inner().into_inner()).unwrap();
        let [before, after] = [folder.join("run.mcap"), path].map(|path| with_paths(&["replay", "--json"], &[&path]));
        assert_eq!(after.status.code(), Some(0), "{name}: {}", stderr(&after));
        let document = |output| {
            let mut document: serde_json::Value = serde_json::from_str(&stdout(output)).unwrap();
            // It has the name of the file.
            assert!(document["provenance"].take().is_object());
            document
        };
        assert_eq!(document(&before), document(&after), "{name}");
    }
}
