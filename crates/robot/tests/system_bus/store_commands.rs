//! The commands for the store.

use vibrissa_robot::store::{Answer, Role};

use crate::machines::{empty_store, fixtures, hash, machine, push, run, state, store};
use crate::robot::Outside;

fn text(bytes: Vec<u8>) -> String {
    String::from_utf8(bytes).unwrap()
}

#[test]
fn receive_answers_by_one_line_and_refuses_with_the_reason() {
    let folder = empty_store("receive");
    let keys = fixtures();
    let mut frame = Vec::new();
    machine(1).write_frame(&mut frame).unwrap();
    let receive = |keys: &str, input: &[u8]| run(&folder, &["receive", "--keys", keys], input);
    let output = receive(keys.to_str().unwrap(), &frame);
    assert_eq!(text(output.stdout), format!("{}\n", Answer { hash: hash(1), state: Role::Tentative }));
    for (keys, input, expected) in [
        (keys.to_str().unwrap(), &frame[..frame.len() - 1], "ended too soon"),
        (keys.to_str().unwrap(), b"machine bang", "is not a push"),
        ("/nonexistent", &frame, "/nonexistent"),
    ] {
        let output = receive(keys, input);
        assert_eq!((output.status.code(), text(output.stdout)), (Some(2), String::new()));
        let message = text(output.stderr);
        assert!(message.contains(expected), "{message}");
    }
    assert_eq!(state(&folder).tentative.unwrap().hash, hash(1));
}

#[test]
fn status_shows_hash_name_and_signer_of_every_machine() {
    let folder = store("status");
    let keys = fixtures();
    let status = |keys: &str, json: &[&str]| {
        let output = run(&folder, &[&["status", "--keys", keys], json].concat(), &[]);
        assert!(output.status.success());
        text(output.stdout)
    };
    let json = |keys: &str| serde_json::from_str::<serde_json::Value>(&status(keys, &["--json"])).unwrap();
    let keys = keys.to_str().unwrap();
    let document = json(keys);
    assert_eq!([&document["format"], &document["rejected"]], [&serde_json::json!("store"), &serde_json::Value::Null]);
    for (role, number) in [("good", 1), ("tentative", 2)] {
        let machine = &document[role];
        assert_eq!(machine["hash"], hash(number).to_string());
        assert_eq!([&machine["name"], &machine["signer"]], ["bang", "test.pub"]);
        assert!(machine["trusted_comment"].as_str().unwrap().contains(&format!("file:{number}.machine")));
    }
    assert_eq!(document["tentative"]["starts"], 0);
    let lines = status(keys, &[]);
    for expected in [&format!("good:      {}", hash(1)), &format!("tentative: {}", hash(2)), "bang, signed by test.pub"]
    {
        assert!(lines.contains(expected), "{lines}");
    }
    // Without keys, nobody knows the signer.
    let document = json("/nonexistent");
    assert_eq!(document["good"]["signer"], serde_json::Value::Null);
    assert!(document["good"]["problem"].as_str().unwrap().contains("/nonexistent"));
    assert!(status("/nonexistent", &[]).contains("problem: cannot read the folder of public keys"));
}

#[test]
fn a_person_can_decide_about_the_tentative_machine() {
    let folder = store("verdict");
    let refused = run(&folder, &["good", &hash(3).to_string()], &[]);
    assert_eq!(refused.status.code(), Some(2), "another machine was pushed");
    assert!(run(&folder, &["reject", "--reason", "it is slow"], &[]).status.success());
    let now = state(&folder);
    assert_eq!((now.good, now.tentative), (Some(hash(1)), None));
    assert_eq!(now.rejected.unwrap().reason, "it is slow");
    let nothing = run(&folder, &["good"], &[]);
    assert!(text(nothing.stderr).contains("no machine is tentative"));
    push(&folder, 3);
    assert!(run(&folder, &["good", &hash(3).to_string()], &[]).status.success());
    assert_eq!(state(&folder).good, Some(hash(3)));
}

#[test]
fn an_empty_store_has_an_exit_status_of_its_own() {
    let folder = empty_store("empty");
    let outside = Outside::new("empty-store");
    let output = run(&folder, &["drive", "--config", &outside.files.config], &[]);
    assert_eq!(output.status.code(), Some(3));
    assert!(text(output.stderr).contains("vibrissa push"));
    assert_eq!(text(run(&folder, &["status"], &[]).stdout), "good:      none\n");
}
