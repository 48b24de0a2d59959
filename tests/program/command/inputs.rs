//! Inputs of commands: files that are not regular, or too large, are refused.

use std::fs;
use std::process::Command;

use super::files::{folder, in_folder};
use super::program::{stderr, stdout};

/// Every kind of file that a command reads, directly or because another file names it. Each has a command line that reads it.
const READ: &[(&str, &str)] = &[
    ("run @/scene.yaml", "scene.yaml"),
    ("run @/scene.yaml", "quick.fsm"),
    ("run @/scene.yaml", "laws.fsm"),
    ("run @/scene.yaml", "r0.yaml"),
    ("run @/scene.yaml --policy @/quick.fsm", "quick.fsm"),
    ("inspect explain @/scene.yaml", "scene.yaml"),
    ("inspect mjcf @/scene.yaml", "scene.yaml"),
    ("inspect mjcf @/scene.yaml", "r0.yaml"),
    ("bench --policy @/quick.fsm", "quick.fsm"),
    ("calibrate @/measured.csv", "measured.csv"),
    ("calibrate --touches @/pressed.csv", "pressed.csv"),
    ("calibrate @/measured.csv --rig @/scene.yaml", "scene.yaml"),
    ("compare @/quick.fsm @/quick.fsm", "quick.fsm"),
    ("compare @/quick.fsm @/quick.fsm @/scene.yaml", "scene.yaml"),
    ("study pareto @/scene.yaml", "scene.yaml"),
    ("families --policy @/quick.fsm", "quick.fsm"),
    ("sweep @/small.yaml --out @/out", "small.yaml"),
    ("sweep @/small.yaml --out @/out", "quick.fsm"),
    ("sweep @/small.yaml --out @/out", "laws.fsm"),
    ("sweep @/small.yaml --out @/out", "scene.yaml"),
    ("sweep @/small.yaml --out @/out", "r0.yaml"),
    ("sweep @/small.yaml --out @", "results.jsonl"),
    ("study merge @/results.jsonl", "results.jsonl"),
    ("check @/quick.fsm", "quick.fsm"),
    ("check @/quick.fsm", "laws.fsm"),
    ("compile @/quick.fsm -o @/quick.machine", "quick.fsm"),
    ("compile @/quick.machine -o @/other.machine", "quick.machine"),
    ("graph @/quick.fsm", "laws.fsm"),
    ("test @/quick.fsm", "scene.yaml"),
    ("replay @/run.mcap", "run.mcap"),
    ("inspect keep @/run.mcap --at 1s --out @/kept.mcap", "run.mcap"),
    ("fmt @/quick.fsm", "quick.fsm"),
];

/// A command that opened a pipe without a writer would wait without end.
#[test]
fn what_is_no_regular_file_is_refused_wherever_a_file_is_read() {
    let folder = folder("pipes");
    for &(line, name) in READ {
        let path = folder.join(name);
        let kept = fs::read(&path).ok();
        for (kind, make) in [("a pipe", "mkfifo"), ("a directory", "mkdir"), ("a device", "ln -s /dev/zero")] {
            let _ = fs::remove_file(&path);
            let mut words = make.split(' ');
            assert!(Command::new(words.next().unwrap()).args(words).arg(&path).status().unwrap().success());
            // A directory of results is one that is looked into.
            if (line, kind) != ("study merge @/results.jsonl", "a directory") {
                let refused = in_folder(&folder, line);
                let told = stderr(&refused) + &stdout(&refused);
                assert_eq!(refused.status.code(), Some(2), "{line}, {name} is {kind}: {told}");
                let refusals =
                    [&format!("it is {kind}, not a regular file"), "is a directory", "to a regular file of their own"];
                let said = refusals.iter().any(|refusal| told.contains(refusal));
                assert!(said && told.contains(name), "{line}, {name} is {kind}: {told}");
            }
            if kind == "a directory" { fs::remove_dir(&path).unwrap() } else { fs::remove_file(&path).unwrap() }
        }
        if let Some(kept) = kept {
            fs::write(&path, kept).unwrap();
        }
    }
}

#[test]
fn a_file_larger_than_any_of_its_kind_is_not_read_to_its_end() {
    let folder = folder("large");
    // A sparse file of a terabyte uses no disk space, and all memory of a program that reads it.
    let large = |name: &str| {
        let file = fs::File::create(folder.join(name)).unwrap();
        file.set_len(1 << 40).unwrap();
    };
    for (line, name, reason) in [
        ("check @/large.fsm", "large.fsm", "it is larger than 1 MiB"),
        ("check @/large.machine", "large.machine", "does not begin as compiled machines do"),
        ("run @/large.yaml", "large.yaml", "it is larger than 1 MiB"),
        ("sweep @/large.yaml --out @/out", "large.yaml", "it is larger than 1 MiB"),
        ("calibrate @/large.csv", "large.csv", "it is larger than 1 MiB"),
        ("replay @/large.mcap", "large.mcap", "it is no MCAP file"),
        ("study merge @/large.jsonl", "large.jsonl", "line 1 is longer than 16 MiB"),
        ("run @/scene.yaml", "r0.yaml", "it is not a calibration"),
        ("check @/quick.fsm", "laws.fsm", "it is larger than 1 MiB"),
    ] {
        large(name);
        let refused = in_folder(&folder, line);
        let told = stderr(&refused);
        let said = told.contains(name) && told.contains(reason);
        assert!(refused.status.code() == Some(2) && said, "{line}: {told}");
        fs::remove_file(folder.join(name)).unwrap();
        if name == "r0.yaml" {
            fs::write(folder.join(name), "vibrissa_calibration: 2\nabout: a test\n").unwrap();
        }
    }
}

#[test]
fn a_line_of_results_that_is_too_long_is_told_with_its_place() {
    let folder = folder("long-line");
    assert_eq!(in_folder(&folder, "sweep @/small.yaml --out @").status.code(), Some(0));
    let results = folder.join("results.jsonl");
    let length = fs::metadata(&results).unwrap().len();
    let file = fs::OpenOptions::new().write(true).open(&results).unwrap();
    file.set_len(length + (1 << 40)).unwrap();
    for line in ["sweep @/small.yaml --out @", "study merge @/results.jsonl --out @/merged.jsonl"] {
        let refused = in_folder(&folder, line);
        let told = stderr(&refused);
        assert_eq!(refused.status.code(), Some(2), "{line}: {told}");
        assert!(told.contains("results.jsonl, line 4 is longer than 16 MiB"), "{line}: {told}");
    }
    assert_eq!(fs::metadata(&results).unwrap().len(), length + (1 << 40), "nothing is cut off that is not a torn line");
}
