//! The commands that write, each with little to do.

use std::fs;
use std::path::Path;

use super::Content;
use crate::command::calibrate::{CONFIG, counts};
use crate::command::program::{ROOT, stderr, vibrissa};

/// A command that writes to the folder `out` in a folder of its own.
pub(super) struct Case {
    pub(super) name: &'static str,
    /// Writes what the command reads; what of that is in `out`.
    pub(super) prepare: fn(&Path) -> Content,
    pub(super) arguments: fn(&Path) -> Vec<String>,
    /// A file that a new one may replace.
    pub(super) old: fn(&[u8]) -> Vec<u8>,
    /// Whether it takes long, and writes by the same calls as the others.
    pub(super) is_long: bool,
}

/// A machine that fails soon, with a test of it.
const POLICY: &str = "machine quick  whisker r0  param speed = 5 cm/s in 1 cm/s .. 10 cm/s  initial Going\n\
    state Going { steer r0 along vector(1, 0) at speed turning 0 deg/s  after 0.1 s -> Failure(\"over\") }\n\
    test \"it fails\" in \"scene.yaml\" { expect run.failed }\n";

fn old(_: &[u8]) -> Vec<u8> {
    b"old\n".to_vec()
}

fn policy(folder: &Path) -> Content {
    let disk = fs::read_to_string(Path::new(ROOT).join("scenarios/disk.yaml")).unwrap();
    let disk = disk.replace("../policies/thesis.fsm", "quick.fsm") + "\nworld: quasistatic\n";
    fs::write(folder.join("scene.yaml"), disk).unwrap();
    fs::write(folder.join("quick.fsm"), POLICY).unwrap();
    Content::new()
}

/// A command line, in which `@` stands for the folder.
fn words(line: &str, folder: &Path) -> Vec<String> {
    line.split(' ').map(|word| word.replace('@', folder.to_str().unwrap())).collect()
}

pub(super) const FMT: Case = Case {
    name: "fmt",
    prepare: |_| Content::from([("quick.fsm".to_owned(), POLICY.into())]),
    arguments: |folder| words("fmt @/out/quick.fsm", folder),
    old,
    is_long: false,
};

pub(super) const GRAPH: Case = Case {
    name: "graph",
    prepare: policy,
    arguments: |folder| words("graph @/quick.fsm -o @/out/chart.svg", folder),
    old,
    is_long: false,
};

pub(super) const COMPILE: Case = Case {
    name: "compile",
    prepare: policy,
    arguments: |folder| words("compile @/quick.fsm -o @/out/quick.machine", folder),
    old,
    is_long: false,
};

pub(super) const DRIVE: Case = Case {
    name: "drive",
    prepare: policy,
    arguments: |folder| words("drive @/quick.fsm --emulate @/scene.yaml --record @/out/run.mcap", folder),
    old,
    is_long: false,
};

pub(super) const KEEP: Case = Case {
    name: "keep",
    prepare: |folder| {
        fs::copy(Path::new(ROOT).join("tests/recordings/stale-sensor.mcap"), folder.join("run.mcap")).unwrap();
        Content::new()
    },
    arguments: |folder| words("inspect keep @/run.mcap --out @/out/kept.mcap", folder),
    old,
    is_long: false,
};

pub(super) const RUN: Case = Case {
    name: "run",
    prepare: policy,
    arguments: |folder| words("run @/scene.yaml --out @/out --ticks @/out/ticks.jsonl", folder),
    old,
    is_long: false,
};

#[cfg(feature = "render")]
pub(super) const VIDEO: Case = Case {
    name: "video",
    prepare: policy,
    arguments: |folder| words("run @/scene.yaml --video @/out/run.gif --video-size 64x64", folder),
    old,
    is_long: true,
};

pub(super) const TEST: Case = Case {
    name: "test",
    prepare: policy,
    arguments: |folder| words("test @/quick.fsm --out @/out", folder),
    old,
    is_long: false,
};

pub(super) const REGRESSIONS: Case = Case {
    name: "regressions",
    prepare: |_| {
        let property = "property \"it goes on\" over thin-wall { expect not run.failed }\n";
        let machine = POLICY.split("test").next().unwrap();
        Content::from([("quick.fsm".to_owned(), format!("{machine}{property}").into())])
    },
    arguments: |folder| words("test @/out/quick.fsm --cases 1 --jobs 1 --simulator quasistatic", folder),
    old,
    is_long: false,
};

pub(super) const FAMILIES: Case = Case {
    name: "families",
    prepare: policy,
    arguments: |folder| {
        words(
            "families convex-corner --count 1 --policy @/quick.fsm --simulator quasistatic --jobs 1 --out @/out",
            folder,
        )
    },
    old,
    is_long: false,
};

pub(super) const BENCH: Case = Case {
    name: "bench",
    prepare: policy,
    arguments: |folder| {
        words("bench --ideal --policy @/quick.fsm --simulator quasistatic --jobs 1 --out @/out", folder)
    },
    old,
    is_long: true,
};

pub(super) const SERVICES: Case = Case {
    name: "services",
    prepare: policy,
    arguments: |folder| words("setup services generate @/quick.fsm --out @/out", folder),
    old,
    is_long: true,
};

#[cfg(feature = "sim")]
pub(super) const PARETO: Case = Case {
    name: "pareto",
    prepare: policy,
    arguments: |folder| words("study pareto @/scene.yaml --policy @/quick.fsm --repeats 1 --out @/out", folder),
    old,
    is_long: true,
};

pub(super) const CALIBRATE: Case = Case {
    name: "calibrate",
    prepare: |folder| {
        fs::write(folder.join("counts.csv"), counts()).unwrap();
        fs::write(folder.join("array.yaml"), CONFIG).unwrap();
        Content::new()
    },
    arguments: |folder| {
        let line = "calibrate @/counts.csv --config @/array.yaml --neutral -812 --whisker l0 --out @/out";
        words(line, folder)
    },
    old,
    is_long: true,
};

pub(super) const MERGE: Case = Case {
    name: "merge",
    prepare: |folder| {
        let sweep = sweep_in(folder);
        for shard in ["1/2", "2/2"] {
            let shards = folder.join("shards").display().to_string();
            let output = vibrissa(&["sweep", &sweep, "--shard", shard, "--out", &shards]);
            assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
        }
        Content::new()
    },
    arguments: |folder| words("study merge @/shards --out @/out/results.jsonl", folder),
    // Merged results replace older ones of the same sweep only.
    old: |new| new.split_inclusive(|byte| *byte == b'\n').next().unwrap().to_vec(),
    is_long: false,
};

/// How many runs the sweep has.
pub(super) const SWEEP_RUNS: usize = 3;

/// Writes a sweep with little to do; where.
pub(super) fn sweep_in(folder: &Path) -> String {
    policy(folder);
    let text = "name: small\npolicies: [quick.fsm]\nscenes: [{family: convex-corner, trials: 3}]\n\
                vary: {scenario: {world: [quasistatic]}}\n";
    let path = folder.join("small.yaml");
    fs::write(&path, text).unwrap();
    path.display().to_string()
}

/// The runs of a tuning of one generation: the given value and four others in a training scene, and the best one in a held-out scene.
pub(super) const TUNE_RUNS: usize = 6;

pub(super) fn tuned_in(folder: &Path) -> String {
    policy(folder);
    folder.join("quick.fsm").display().to_string()
}
