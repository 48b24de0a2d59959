//! The pages: what each says, and the commands that it is made of.

use super::table::NoKey;
use super::{mismatch, reproduction, sums, tables};
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
    /// True if it has times. Then it names the machine.
    pub(super) has_times: bool,
    /// True if it takes more than two minutes. Then it is made only if it is named.
    pub(super) is_slow: bool,
    /// Its tables, from the outputs of the commands.
    pub(super) body: fn(&[Json]) -> Result<String, NoKey>,
}

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

/// All pages.
pub(super) const PAGES: [Page; 14] = [
    Page {
        name: "bench",
        title: "Results of the bench",
        about: "The ten scenes of [the bench](../bench.md) under both built-in policies, in both [simulators](../worlds.md).",
        commands: &["bench --json", "bench --world quasistatic --json"],
        has_times: false,
        is_slow: false,
        body: tables::bench,
    },
    Page {
        name: "reproduction",
        title: "Reproduction of the baseline",
        about: "The claims of the [baseline](../glossary.md#baseline), with their sections, beside the measured figures of both built-in policies in MuJoCo.",
        commands: &[
            "bench --json",
            claimed_scenes!("thesis"),
            claimed_scenes!("vibrissa"),
            "sweep sweeps/turns.yaml --out out/turns --json",
            "run scenarios/wall.yaml --policy policies/thesis.fsm --set radius=20mm --json",
        ],
        has_times: false,
        is_slow: false,
        body: reproduction::page,
    },
    Page {
        name: "friction",
        title: "Results with friction and noise",
        about: "The scenes of [the bench](../bench.md) with friction and with the estimated noise of the real sensor.",
        commands: &["bench --friction 0,0.1,0.3 --noise --json", "bench --friction 0.1,0.3 --json"],
        has_times: false,
        is_slow: true,
        body: tables::friction,
    },
    Page {
        name: "families",
        title: "Results in random scenes",
        about: "Pass rates of `vibrissa.fsm` in random scenes of each [family](../families.md): 200 in the quasi-static simulator, and the first 50 of them in MuJoCo. `cargo x nightly` compares them with those of the current program.",
        commands: &FAMILIES,
        has_times: false,
        is_slow: true,
        body: sums::families,
    },
    Page {
        name: "mismatch",
        title: "Results with mismatches",
        about: "The scenes of [the bench](../bench.md) in MuJoCo with a [mismatch](../mismatch.md) between the true array and the assumed one.",
        commands: &[
            "bench --json",
            "bench --mismatch scenarios/mismatch/plausible.yaml --json",
            "bench --mismatch scenarios/mismatch/plausible.yaml --uncalibrated --json",
            "bench --mismatch scenarios/mismatch/hard.yaml --json",
            "bench --mismatch scenarios/mismatch/hard.yaml --uncalibrated --json",
            "sweep sweeps/mismatch.yaml --out out/mismatch --json",
        ],
        has_times: false,
        is_slow: true,
        body: mismatch::page,
    },
    Page {
        name: "estimators",
        title: "Results of the contact estimators",
        about: "All [contact estimators](../bench.md#vibrissa-estimators) on the samples of the same runs, with three strengths of noise.",
        commands: &["estimators --json"],
        has_times: true,
        is_slow: false,
        body: sums::estimators,
    },
    Page {
        name: "policies",
        title: "Results of the other policies",
        about: "The [policies](../policies.md) that are not in the bench, other rigs, and a comparison from displaced starts.",
        commands: &[
            "bench --policy policies/quick.fsm --policy policies/tilted.fsm --policy policies/reverse.fsm --policy policies/baseline.fsm --json",
            "run scenarios/more/array-octagon.yaml scenarios/more/array-box.yaml scenarios/more/array-prism.yaml --json",
            "run scenarios/more/peer-disk.yaml --json",
            "run scenarios/more/peer-box.yaml scenarios/more/peer-octagon.yaml --set speed=20mm/s --set careful=15mm/s --set clearance=20mm --set radius=12mm --json",
            "compare policies/baseline.fsm policies/thesis.fsm policies/vibrissa.fsm --seeds 4 --jitter 20mm --jitter-heading 10deg --json",
        ],
        has_times: false,
        is_slow: false,
        body: tables::policies,
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
        has_times: false,
        is_slow: false,
        body: tables::thesis_array,
    },
    Page {
        name: "worlds",
        title: "Results of the simulator comparison",
        about: "The quasi-static simulator [compared](../worlds.md#worlds-against-each-other) with chains of links in MuJoCo.",
        commands: &["worlds --against quasistatic --json"],
        has_times: false,
        is_slow: false,
        body: tables::worlds,
    },
    Page {
        name: "cable",
        title: "Results of the peer's cable",
        about: "The [peer's cable](../worlds.md#the-peers-cable) compared with chains of links in MuJoCo, under `thesis.fsm`.",
        commands: &["worlds --against peer_cable --policy policies/thesis.fsm --json"],
        has_times: false,
        is_slow: true,
        body: tables::worlds,
    },
    Page {
        name: "timing",
        title: "Run times",
        about: "[Speed](../bench.md#vibrissa-timing---repeats-n) of both simulators, medians of three runs of each scene.",
        commands: &["timing --repeats 3 --json", "timing --repeats 3 --world quasistatic --json"],
        has_times: true,
        is_slow: false,
        body: tables::timing,
    },
    Page {
        name: "pareto",
        title: "Results of run time against error",
        about: "[Settings of the simulators and contact estimators](../pareto.md) on the disk under both built-in policies, medians of three rounds. The mismatch is that of `scenarios/mismatch/plausible.yaml`.",
        commands: &["pareto --json"],
        has_times: true,
        is_slow: false,
        body: tables::pareto,
    },
    Page {
        name: "stress",
        title: "Results of the stress tests",
        about: "[Stress tests](../stress.md) of both simulators, and their largest stable steps.",
        commands: &["stress --json"],
        has_times: false,
        is_slow: false,
        body: tables::stress,
    },
    Page {
        name: "calibration",
        title: "Results of the calibration",
        about: "[Fits](../calibration.md) to simulated touches of a whisker of the reference rig, without noise and with it.",
        commands: &["calibrate --json", "calibrate --noise --json"],
        has_times: false,
        is_slow: false,
        body: tables::calibration,
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
