//! The origin of the figures of a page.

use maud::{Markup, html};

use crate::results::{CalibrationKind, InputHash, JitterRecord, MismatchRecord, Provenance, SeedRange};

/// Number of scenes that a title names.
const SCENES_NAMED: usize = 3;

/// A short text by which pages of different runs differ: policies, scenes, simulators, seeds and mismatches.
pub(super) fn subject(provenance: &Provenance) -> String {
    let Provenance { policies, scenes, simulators, seeds, mismatches, .. } = provenance;
    let scenes = if scenes.len() > SCENES_NAMED { format!("{} scenes", scenes.len()) } else { scenes.join(", ") };
    let simulators: Vec<&str> = simulators.iter().map(|simulator| simulator.name.as_str()).collect();
    let mismatches = mismatches.iter().map(|mismatch| mismatch.file.as_deref().unwrap_or("mismatch of the scene"));
    let word = if seeds.len() == 1 && seeds.iter().all(|range| range.first == range.last) { "seed" } else { "seeds" };
    let seeds = if seeds.is_empty() { String::new() } else { format!("{word} {}", ranges(seeds)) };
    let parts =
        [policies.join(", "), scenes, simulators.join(" and "), mismatches.collect::<Vec<_>>().join(", "), seeds];
    parts.into_iter().filter(|part| !part.is_empty()).collect::<Vec<_>>().join(" · ")
}

/// The section with the origin. Its command can be copied.
pub(super) fn origin(provenance: &Provenance) -> Markup {
    let Provenance {
        command,
        version,
        commit,
        date,
        simulators,
        scenes,
        policies,
        seeds,
        jitter,
        mismatches,
        calibrations,
        hashes,
    } = provenance;
    let simulators: Vec<String> = simulators.iter().map(ToString::to_string).collect();
    html! {
        section id="origin" {
            h2 { "How to repeat this" }
            p { (place(commit.as_deref())) }
            pre.command { code { (command) } }
            dl.origin {
                (entry("program", &format!("vibrissa {version}, commit {}", commit.as_deref().unwrap_or("unknown"))))
                (entry("date", date))
                (entry("simulator", &simulators.join(", ")))
                (entry("policies", &policies.join(", ")))
                (entry("hashes of policies", &hash_text(&hashes.policies)))
                (entry("scenes", &scenes.join(", ")))
                (entry("hashes of scenarios", &hash_text(&hashes.scenarios)))
                (entry("seeds", &ranges(seeds)))
                (entry("jitter of starts", &jitter.map_or_else(|| "none".to_owned(), jitter_text)))
                @if mismatches.is_empty() { (entry("mismatch", "none: the simulated array is the assumed one")) }
                @for mismatch in mismatches { (entry("mismatch", &mismatch_text(mismatch))) }
                (entry("calibration", &calibration_text(calibrations)))
            }
        }
    }
}

fn entry(name: &str, text: &str) -> Markup {
    html! { @if !text.is_empty() { dt { (name) } dd { (text) } } }
}

fn hash_text(hashes: &[InputHash]) -> String {
    hashes.iter().map(|InputHash { name, hash }| format!("{name} {hash}")).collect::<Vec<_>>().join(", ")
}

/// Where the command repeats the result.
fn place(commit: Option<&str>) -> String {
    let repository = option_env!("CARGO_PKG_REPOSITORY").filter(|repository| !repository.is_empty());
    let repository = repository.map_or_else(String::new, |repository| format!(" of {repository}"));
    let checkout = match commit {
        Some(commit) => format!("a checkout{repository} of commit {commit}"),
        None => format!("the same checkout{repository}"),
    };
    format!(
        "Run it in the root of {checkout}. Paths of files are relative to where it was first given. The hashes below are equal if all inputs are."
    )
}

fn ranges(seeds: &[SeedRange]) -> String {
    seeds.iter().map(ToString::to_string).collect::<Vec<_>>().join(", ")
}

fn jitter_text(JitterRecord { position_m, heading_rad }: JitterRecord) -> String {
    format!("up to {} mm along x and y, up to {} deg", 1e3 * position_m, heading_rad.to_degrees())
}

fn calibration_text(calibrations: &[CalibrationKind]) -> String {
    let text = |kind: &CalibrationKind| match kind {
        CalibrationKind::Touches => "by the array's own touches before the runs",
        CalibrationKind::Rig => "as the rig of the scenario states",
        CalibrationKind::Uncalibrated => "none, although the simulated array differs from the assumed one",
    };
    if calibrations.is_empty() {
        "none is needed".to_owned()
    } else {
        calibrations.iter().map(text).collect::<Vec<_>>().join(", ")
    }
}

fn mismatch_text(MismatchRecord { file, seeds }: &MismatchRecord) -> String {
    let file = file.as_deref().unwrap_or("of the scene");
    if seeds.is_empty() { file.to_owned() } else { format!("{file}, seeds {}", ranges(seeds)) }
}
