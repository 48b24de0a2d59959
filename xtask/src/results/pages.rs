//! The pages: what each says, and the commands that it is made of. Its stamp, its head and the check are derived from this table.

use super::table::NoKey;
use super::{FOLDER, mismatch, real, reproduction, sums, tables};
use crate::json::Json;

/// A page of results.
pub(super) struct Page {
    /// Its name, and that of its file.
    pub(super) name: &'static str,
    pub(super) title: &'static str,
    /// A sentence about its content.
    pub(super) about: &'static str,
    /// The arguments of the program. Each prints JSON.
    pub(super) commands: &'static [&'static str],
    /// Files and folders of code with figures that no stored figure of the bench stands for.
    pub(super) code: &'static [&'static str],
    /// True if it has times. Then it names the machine.
    pub(super) has_times: bool,
    /// True if it takes more than two minutes. Then it is made only if it is named or stale.
    pub(super) is_slow: bool,
    pub(super) content: Content,
}

/// What a page shows.
pub(super) enum Content {
    /// Tables, from the outputs of the commands.
    Tables(fn(&[Json]) -> Result<String, NoKey>),
    /// The picture that a command writes as `made` into its folder, published as `shown`. It has no page of its own.
    Picture { command: &'static str, made: &'static str, shown: &'static str },
}

impl Page {
    /// Its file, from the root.
    pub(super) fn path(&self) -> String {
        match self.content {
            Content::Tables(_) => format!("{FOLDER}/{}.md", self.name),
            Content::Picture { shown, .. } => shown.to_owned(),
        }
    }
}

/// The run whose picture README.md shows.
const PICTURE: &str = "run scenarios/disk.yaml --out out/picture --json";
/// The code that draws random scenes.
const SCENES: [&str; 2] = ["crates/declare/src/catalogue", "crates/lab/src/family"];
/// The code that calibrates.
const CALIBRATION: [&str; 2] = ["crates/runtime/src/calibration", "crates/lab/src/calibration"];

/// The arguments of the runs with the array of the thesis under a policy in a simulator.
macro_rules! thesis_array {
    ($policy:literal, $world:literal) => {
        concat!(
            "run scenarios/more/thesis-array-disk.yaml scenarios/more/thesis-array-octagon.yaml ",
            "scenarios/more/thesis-array-box.yaml scenarios/more/thesis-array-wall.yaml ",
            "scenarios/more/thesis-array-smooth-tunnel.yaml --policy policies/",
            $policy,
            ".fsm --world ",
            $world,
            " --json"
        )
    };
}

/// The arguments of the runs of scenes that are not in the bench, but in claims of the baseline.
macro_rules! claimed_scenes {
    ($policy:literal) => {
        concat!(
            "run scenarios/more/dodecagon.yaml scenarios/more/turns-of-20.yaml scenarios/more/turns-of-10.yaml ",
            "scenarios/more/thin-wall.yaml scenarios/more/short-wall.yaml scenarios/more/steep-tunnel.yaml ",
            "scenarios/more/mixed-tunnel.yaml --policy policies/",
            $policy,
            ".fsm --json"
        )
    };
}

/// The runs in random scenes, in each simulator.
pub(crate) const FAMILIES: [&str; 2] = [
    "families --count 200 --seed 11 --world quasistatic --json",
    "families --count 50 --seed 11 --world mujoco --json",
];

/// All pages, roughly those first that take least time.
pub(super) const PAGES: [Page; 17] = [
    Page {
        name: "disk",
        title: "Picture of the disk",
        about: "The picture that README.md shows.",
        commands: &[PICTURE],
        code: &["crates/lab/src/report/picture"],
        has_times: false,
        is_slow: false,
        content: Content::Picture { command: PICTURE, made: "disk.svg", shown: "docs/disk.svg" },
    },
    Page {
        name: "calibration",
        title: "Results of the calibration",
        about: "[Fits](../calibration.md) to simulated touches of a whisker of the reference rig, without noise and with it.",
        commands: &["calibrate --json", "calibrate --noise --json"],
        code: &CALIBRATION,
        has_times: false,
        is_slow: false,
        content: Content::Tables(tables::calibration),
    },
    Page {
        name: "bench",
        title: "Results of the bench",
        about: "The ten scenes of [the bench](../bench.md) under both built-in policies, in both [simulators](../worlds.md).",
        commands: &["bench --ideal --json", "bench --ideal --world quasistatic --json"],
        code: &[],
        has_times: false,
        is_slow: false,
        content: Content::Tables(tables::bench),
    },
    Page {
        name: "timing",
        title: "Run times",
        about: "[Speed](../bench.md#vibrissa-study-timing---repeats-n) of both simulators, medians of three runs of each scene.",
        commands: &[
            "study timing --ideal --repeats 3 --json",
            "study timing --ideal --repeats 3 --world quasistatic --json",
        ],
        code: &["crates/lab/src/study/timing.rs"],
        has_times: true,
        is_slow: false,
        content: Content::Tables(tables::timing),
    },
    Page {
        name: "scale",
        title: "Cost against size",
        about: "[Exponents of costs](../bench.md#vibrissa-study-scale), and the cost of a sweep of a million runs.",
        commands: &["study scale --json"],
        code: &["crates/lab/src/study/scale"],
        has_times: true,
        is_slow: false,
        content: Content::Tables(tables::scale),
    },
    Page {
        name: "thesis-array",
        title: "Results of the array of the thesis",
        about: "Scenes with the [array of the thesis](../rig.md#the-array-of-the-thesis), whose whiskers point forward, in both [simulators](../worlds.md).",
        commands: &[
            thesis_array!("thesis", "mujoco"),
            thesis_array!("vibrissa", "mujoco"),
            thesis_array!("array", "mujoco"),
            thesis_array!("thesis", "quasistatic"),
            thesis_array!("vibrissa", "quasistatic"),
            thesis_array!("array", "quasistatic"),
        ],
        code: &[],
        has_times: false,
        is_slow: false,
        content: Content::Tables(tables::thesis_array),
    },
    Page {
        name: "worlds",
        title: "Results of the simulator comparison",
        about: "The quasi-static simulator [compared](../worlds.md#worlds-against-each-other) with chains of links in MuJoCo.",
        commands: &["study worlds --against quasistatic --json"],
        code: &["crates/lab/src/study/worlds"],
        has_times: false,
        is_slow: false,
        content: Content::Tables(tables::worlds),
    },
    Page {
        name: "policies",
        title: "Results of the other policies",
        about: "The [policies](../policies.md) that are not in the bench, other rigs, and a comparison from displaced starts.",
        commands: &[
            "bench --ideal --policy policies/quick.fsm --policy policies/tilted.fsm --policy policies/reverse.fsm --policy policies/baseline.fsm --json",
            "run scenarios/more/array-octagon.yaml scenarios/more/array-box.yaml scenarios/more/array-prism.yaml --json",
            "run scenarios/more/peer-disk.yaml --json",
            "run scenarios/more/peer-box.yaml scenarios/more/peer-octagon.yaml --json",
            "compare policies/baseline.fsm policies/thesis.fsm policies/vibrissa.fsm --seeds 4 --jitter 20mm --jitter-heading 10deg --json",
        ],
        code: &["crates/lab/src/study/compare"],
        has_times: false,
        is_slow: false,
        content: Content::Tables(tables::policies),
    },
    Page {
        name: "pareto",
        title: "Results of run time against error",
        about: "[Settings of the simulators and contact estimators](../pareto.md) on the disk under both built-in policies, medians of three rounds. The mismatch is that of `scenarios/mismatch/plausible.yaml`, after a calibration.",
        commands: &["study pareto --json"],
        code: &["crates/lab/src/study/pareto", "crates/runtime/src/calibration", "crates/lab/src/calibration"],
        has_times: true,
        is_slow: false,
        content: Content::Tables(tables::pareto),
    },
    Page {
        name: "reproduction",
        title: "Reproduction of the baseline",
        about: "The claims of the [baseline](../glossary.md#baseline), with their sections, beside the measured figures of both built-in policies in MuJoCo.",
        commands: &[
            "bench --ideal --json",
            claimed_scenes!("thesis"),
            claimed_scenes!("vibrissa"),
            "sweep sweeps/turns.yaml --out out/turns --json",
            "run scenarios/wall.yaml --policy policies/thesis.fsm --set radius=20mm --json",
        ],
        code: &SCENES,
        has_times: false,
        is_slow: false,
        content: Content::Tables(reproduction::page),
    },
    Page {
        name: "stress",
        title: "Results of the stress tests",
        about: "[Stress tests](../stress.md) of both simulators, and their largest stable steps.",
        commands: &["study stress --json"],
        code: &["crates/lab/src/study/stress", "crates/lab/src/study/stress/straight.fsm"],
        has_times: false,
        is_slow: false,
        content: Content::Tables(tables::stress),
    },
    Page {
        name: "estimators",
        title: "Results of the contact estimators",
        about: "All [contact estimators](../bench.md#vibrissa-study-estimators) on the samples of the same runs, with three strengths of noise.",
        commands: &["study estimators --json"],
        code: &["crates/lab/src/study/estimators"],
        has_times: true,
        is_slow: false,
        content: Content::Tables(sums::estimators),
    },
    Page {
        name: "cable",
        title: "Results of the peer's cable",
        about: "The [peer's cable](../worlds.md#the-peers-cable) compared with chains of links in MuJoCo, under `thesis.fsm`.",
        commands: &["study worlds --against peer_cable --policy policies/thesis.fsm --json"],
        code: &["crates/lab/src/study/worlds"],
        has_times: false,
        is_slow: true,
        content: Content::Tables(tables::worlds),
    },
    Page {
        name: "friction",
        title: "Results with friction and noise",
        about: "The scenes of [the bench](../bench.md) with friction and with the estimated noise of the real sensor.",
        commands: &["bench --friction 0,0.1,0.3 --noise --json", "bench --friction 0.1,0.3 --json"],
        code: &[],
        has_times: false,
        is_slow: true,
        content: Content::Tables(tables::friction),
    },
    Page {
        name: "families",
        title: "Results in random scenes",
        about: "Pass rates of `vibrissa.fsm` in random scenes of each [family](../families.md): 200 in the quasi-static simulator, and the first 50 of them in MuJoCo. `cargo x nightly` compares them with those of the current program.",
        commands: &FAMILIES,
        code: &SCENES,
        has_times: false,
        is_slow: true,
        content: Content::Tables(sums::families),
    },
    Page {
        name: "mismatch",
        title: "Results with mismatches",
        about: "The scenes of [the bench](../bench.md) in MuJoCo with a [mismatch](../mismatch.md) between the true array and the assumed one.",
        commands: &[
            "bench --ideal --json",
            "bench --mismatch scenarios/mismatch/plausible.yaml --json",
            "bench --mismatch scenarios/mismatch/plausible.yaml --uncalibrated --json",
            "bench --mismatch scenarios/mismatch/hard.yaml --json",
            "bench --mismatch scenarios/mismatch/hard.yaml --uncalibrated --json",
            "sweep sweeps/mismatch.yaml --uncalibrated --out out/mismatch --json",
        ],
        code: &[
            "crates/runtime/src/calibration",
            "crates/lab/src/calibration",
            "crates/declare/src/mismatch",
            "crates/world/src/mismatch",
        ],
        has_times: false,
        is_slow: true,
        content: Content::Tables(mismatch::page),
    },
    Page {
        name: "real",
        title: "Results with real arrays",
        about: "What each [difference](../mismatch.md) between a real array and its model costs, alone and together, in the scenes of [the bench](../bench.md) in MuJoCo.",
        commands: &[
            "sweep sweeps/differences.yaml --uncalibrated --out out/uncalibrated --json",
            "sweep sweeps/differences.yaml --out out/calibrated --json",
            "sweep sweeps/real.yaml --out out/real --json",
            "sweep sweeps/real.yaml --mismatch scenarios/mismatch/real.yaml --out out/together --json",
        ],
        code: &[
            "crates/runtime/src/calibration",
            "crates/lab/src/calibration",
            "crates/declare/src/mismatch",
            "crates/world/src/mismatch",
            "crates/mujoco/src",
        ],
        has_times: false,
        is_slow: true,
        content: Content::Tables(real::page),
    },
];

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn pages_have_different_names() {
        let mut names = PAGES.map(|page| page.name);
        names.sort_unstable();
        assert!(names.windows(2).all(|pair| pair[0] != pair[1]));
    }
}
