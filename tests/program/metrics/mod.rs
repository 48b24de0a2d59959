//! Figures of the ten scenes under both built-in policies in both worlds, compared with `snapshots/metrics`.

mod figures;
mod runs;
mod snapshot;

use std::collections::BTreeMap;
use std::fs;
use std::path::PathBuf;
use std::sync::LazyLock;

use vibrissa::built_in::SCENARIOS;
use vibrissa::results::RunResult;
use vibrissa::trial::Trial;

use figures::{FIGURES, values};
pub(crate) use runs::RUNS;
use snapshot::{SceneFigures, Snapshot};

/// The way to store other figures.
const ACCEPT: &str = "If the change is intended, say so in the commit and store the figures of these scenes with their standard deviations:\n  \
                      INSTA_UPDATE=always cargo test --test program metrics";

fn path(policy: &str, world: &str) -> PathBuf {
    [env!("CARGO_MANIFEST_DIR"), "snapshots/metrics", &format!("{policy}-{world}.txt")].iter().collect()
}

fn figures(result: &RunResult, starts: &[RunResult]) -> SceneFigures {
    let starts: Vec<_> = starts.iter().filter(|start| start.outcome == result.outcome).map(values).collect();
    SceneFigures::new(&result.scenario, result.outcome.name(), &values(result), &starts)
}

/// The text of a file with these scenes.
fn text(policy: &str, world: &str, scenes: &[SceneFigures]) -> String {
    let head = format!(
        "# Figures of {policy}.fsm in the scenes of the bench, world {world}. Written by\n\
         #   INSTA_UPDATE=always cargo test --test program metrics\n"
    );
    scenes.iter().fold(head, |text, scene| text + "\n" + &scene.to_string())
}

/// A stored file, and the runs whose figures it has.
struct Stored {
    policy: &'static str,
    world: &'static str,
    text: String,
    scenes: Vec<SceneFigures>,
    runs: Vec<&'static (Trial, RunResult)>,
}

/// The stored files. If snapshots are to be updated, that is done before.
static STORED: LazyLock<Vec<Stored>> = LazyLock::new(|| {
    let mut files = BTreeMap::<_, Vec<_>>::new();
    for run in RUNS.iter() {
        files.entry((run.1.policy.as_str(), run.1.world.as_str())).or_default().push(run);
    }
    let is_updated = std::env::var("INSTA_UPDATE").is_ok_and(|update| update == "always");
    let stored = |((policy, world), runs): ((&'static str, &'static str), Vec<&'static (Trial, RunResult)>)| {
        let path = path(policy, world);
        let mut text = fs::read_to_string(&path).unwrap_or_default();
        let read = |text: &str| {
            text.parse::<Snapshot>()
                .unwrap_or_else(|fault| panic!("{}: {fault}. Delete the file to store it anew", path.display()))
                .0
        };
        let mut scenes = read(&text);
        if is_updated {
            text = updated(policy, world, &scenes, &runs);
            scenes = read(&text);
            fs::create_dir_all(path.parent().unwrap()).unwrap();
            fs::write(&path, &text).unwrap();
        }
        Stored { policy, world, text, scenes, runs }
    };
    files.into_iter().map(stored).collect()
});

/// The text of a file with the figures of these runs. A scene without a change stays as it is.
fn updated(policy: &str, world: &str, scenes: &[SceneFigures], runs: &[&(Trial, RunResult)]) -> String {
    let scenes = runs.iter().map(|(trial, result)| {
        let unchanged = stored_of(scenes, result).filter(|stored| stored.differences(&figures(result, &[])).is_empty());
        unchanged.cloned().unwrap_or_else(|| figures(result, &runs::displaced(trial)))
    });
    text(policy, world, &scenes.collect::<Vec<_>>())
}

fn stored_of<'s>(scenes: &'s [SceneFigures], result: &RunResult) -> Option<&'s SceneFigures> {
    scenes.iter().find(|stored| stored.scene == result.scenario)
}

#[test]
fn every_figure_of_every_scene_is_that_of_its_snapshot() {
    let mut changes = Vec::new();
    for Stored { policy, world, scenes, runs, .. } in STORED.iter() {
        for (_, result) in runs {
            let differences = stored_of(scenes, result)
                .map_or_else(|| vec!["not stored".to_owned()], |stored| stored.differences(&figures(result, &[])));
            let told = |difference| format!("{} under {policy}.fsm in {world}: {difference}", result.scenario);
            changes.extend(differences.into_iter().map(told));
        }
    }
    assert!(changes.is_empty(), "{} figures changed:\n{}\n{ACCEPT}", changes.len(), changes.join("\n"));
}

#[test]
fn no_whisker_of_the_bench_seems_dead_and_every_run_completes() {
    for (_, result) in RUNS.iter() {
        let dead: Vec<_> = result.dead_whiskers().collect();
        assert!(dead.is_empty(), "{} under {} in {}: {dead:?}", result.scenario, result.policy, result.world);
        assert_eq!((result.outcome.name(), &result.violations), ("completed", &Vec::new()), "{}", result.scenario);
    }
}

#[test]
fn forty_snapshots_have_all_figures() {
    let names = SCENARIOS.iter().map(|file| file.path.trim_start_matches("scenarios/").trim_end_matches(".yaml"));
    let names: Vec<_> = names.collect();
    assert_eq!(STORED.iter().map(|stored| stored.scenes.len()).sum::<usize>(), 40);
    for Stored { scenes, .. } in STORED.iter() {
        assert_eq!(scenes.iter().map(|scene| scene.scene.as_str()).collect::<Vec<_>>(), names);
        for SceneFigures { scene, figures, .. } in scenes {
            assert_eq!(figures.iter().map(|figure| figure.path.as_str()).collect::<Vec<_>>(), FIGURES, "{scene}");
        }
    }
}

/// Texts that differ from a stored figure: by 20 % to either side. A figure of zero has no per cent, so it becomes tiny. One that
/// is missing appears.
fn mutations(stored: &str) -> Vec<String> {
    match stored.parse::<f64>() {
        Err(_) => vec!["0 ± 0 deviation 0".to_owned()],
        Ok(0.0) => vec!["0.000001".to_owned(), "1".to_owned()],
        Ok(value) => [0.8, 1.2].map(|factor| (factor * value).to_string()).to_vec(),
    }
}

#[test]
fn a_change_of_20_per_cent_of_any_figure_fails() {
    let mut count = 0;
    for Stored { text, scenes, .. } in STORED.iter() {
        let lines: Vec<_> = text.lines().collect();
        let mut scene = None;
        for (number, line) in lines.iter().enumerate() {
            let words: Vec<_> = line.split_whitespace().collect();
            let (what, changed) = match words.as_slice() {
                ["#", ..] | [] => continue,
                [_, outcome] if !line.starts_with(' ') => {
                    scene = Some(scene.map_or(0, |scene: usize| scene + 1));
                    ("outcome", vec![line.replace(outcome, "timeout")])
                }
                [path, value, ..] => (*path, mutations(value).iter().map(|to| line.replacen(value, to, 1)).collect()),
                [_] => panic!("{line}"),
            };
            for changed in changed {
                let mut lines = lines.clone();
                lines[number] = &changed;
                let Snapshot(mutated) = lines.join("\n").parse().unwrap();
                let scene = scene.unwrap();
                // As a snapshot that is not that of the run, and as a run that is not that of its snapshot.
                for (stored, found) in [(&mutated, scenes), (scenes, &mutated)] {
                    let differences: Vec<_> =
                        stored.iter().zip(found).map(|(stored, found)| stored.differences(found)).collect();
                    for (index, differences) in differences.iter().enumerate() {
                        assert_eq!(
                            differences.len(),
                            usize::from(index == scene),
                            "{line} -> {changed}: {differences:?}"
                        );
                    }
                    assert!(differences[scene][0].starts_with(&format!("{what}: ")), "{differences:?}");
                }
                count += 1;
            }
        }
    }
    // The outcome of every run, and every figure at least once.
    assert!(count >= 40 * (1 + FIGURES.len()), "{count}");
}

#[test]
fn a_change_within_three_deviations_is_permitted_and_a_larger_one_is_told_in_per_cent() {
    let run = |value: f64| [Some(value); FIGURES.len()];
    // Their standard deviation is 1.
    let stored = SceneFigures::new("disk", "completed", &run(100.0), &[run(99.0), run(101.0)]);
    let found = |value| SceneFigures::new("disk", "completed", &run(value), &[]);
    assert!(stored.differences(&found(102.9)).is_empty() && stored.differences(&found(97.1)).is_empty());
    let differences = stored.differences(&found(103.1));
    assert_eq!(differences.len(), FIGURES.len());
    assert_eq!(differences[0], "error_mm.mean: 100 -> 103.1 (+3.1 %, permitted 3.0 %)");
    let wild = SceneFigures::new("disk", "completed", &run(100.0), &[run(0.0), run(300.0)]);
    assert_eq!(wild.differences(&found(119.0)).len(), FIGURES.len());
    let calm = SceneFigures::new("disk", "completed", &run(100.0), &[run(100.0)]);
    assert!(calm.differences(&found(100.9)).is_empty());
    let none = SceneFigures::new("disk", "completed", &[None; FIGURES.len()], &[]);
    assert_eq!(none.differences(&found(0.0))[0], "error_mm.mean: – -> 0");
    let fails = SceneFigures::new("disk", "failed", &run(100.0), &[]);
    assert_eq!(stored.differences(&fails), ["outcome: completed -> failed"]);
}

#[test]
fn a_snapshot_is_read_as_it_was_written() {
    for Stored { text, scenes, .. } in STORED.iter() {
        let body = text.split_once("\n\n").unwrap().1;
        let written: Vec<_> = scenes.iter().map(ToString::to_string).collect();
        assert_eq!(body, written.join("\n"));
    }
    let fault = "disk: completed\n  coverage 1\n".parse::<Snapshot>().err().unwrap();
    assert!(fault.contains("coverage 1"), "{fault}");
}
