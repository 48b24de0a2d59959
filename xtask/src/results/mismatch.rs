//! The page of mismatches between the true array and the assumed one.

use std::fmt::Write as _;

use super::table::Show::{Code, Fixed, Percent};
use super::table::{Column, NoKey, markdown, pivot, text, value};
use super::tables::{names, those};
use crate::json::Json;

/// The runs of the bench: without a mismatch, and then with each array, first calibrated and then not.
const BENCHES: [&str; 5] =
    ["ideal", "plausible, calibrated", "plausible, uncalibrated", "hard, calibrated", "hard, uncalibrated"];

/// The page, from the outputs of [`BENCHES`] and the summary of a sweep.
pub(super) fn page(outputs: &[Json]) -> Result<String, NoKey> {
    let (benches, sweep) = outputs.split_at(BENCHES.len());
    let mut page = String::from(
        "\nAn *ideal* array is the one that control assumes. The [plausible and the hard array](../mismatch.md) differ from it. A *calibrated* array first \
         [measures itself](../calibration.md#calibration-of-an-array-by-its-own-touches) by touches of a pin. A cell has the outcome of a run that did not complete. A run that ended met its stop condition, but not all expectations of its scene.\n",
    );
    let ideal = benches[0].items();
    for policy in names(ideal, "policy")? {
        let table = |column: fn(&Json) -> Result<String, NoKey>| beside(benches, policy, column);
        let _ = write!(
            page,
            "\n## Arrays under `{policy}.fsm`\n\nMean errors, mm:\n\n{}\nTips within their 95 % interval, %:\n\n{}",
            table(error)?,
            table(within)?
        );
    }
    page += "\n## Single mismatches\n\nA row has the [mismatch](../mismatch.md#keys) of the runs, without a calibration. `{}` is none. A dash means that the run was not complete. \
             Shares are of the tips of all runs, also of incomplete ones.\n";
    let groups = value(&sweep[0], "groups")?.items();
    let scene = |group: &Json| text(group, "scenes").map(str::to_owned);
    let mismatch = Column("mismatch", "settings.mismatch", Code);
    for policy in names(groups, "policy")? {
        let runs = those(groups, |group| Ok(text(group, "policy")? == policy))?;
        let table = |figure| pivot(runs.iter().copied(), mismatch, scene, figure);
        let _ = write!(
            page,
            "\n### `{policy}.fsm`\n\nMean errors, mm:\n\n{}\nTips within their 95 % interval, %:\n\n{}",
            table(("error_mean_mm", Fixed(2)))?,
            table(("within_band", Percent(0)))?
        );
    }
    Ok(page)
}

/// A table with a row for each scene and a column for each of the benches.
fn beside(benches: &[Json], policy: &str, cell: fn(&Json) -> Result<String, NoKey>) -> Result<String, NoKey> {
    let headings: Vec<_> = ["scene"].iter().chain(&BENCHES).map(|heading| (*heading).to_owned()).collect();
    let mut lines = Vec::new();
    for run in those(benches[0].items(), |run| Ok(text(run, "policy")? == policy))? {
        let scene = text(run, "scenario")?;
        let mut line = vec![scene.to_owned()];
        for bench in benches {
            let same = |run: &Json| Ok(text(run, "scenario")? == scene && text(run, "policy")? == policy);
            let runs = those(bench.items(), same)?;
            line.push(runs.first().map_or(Ok(String::new()), |run| cell(run))?);
        }
        lines.push(line);
    }
    Ok(markdown(&headings, &lines))
}

/// The mean error of a run that met its stop condition, and its outcome if it did not complete.
fn error(run: &Json) -> Result<String, NoKey> {
    let error = Fixed(3).text(value(run, "error_mm.mean")?);
    Ok(match text(run, "outcome")? {
        "completed" => error,
        "ended" => format!("{error}, ended"),
        outcome => outcome.to_owned(),
    })
}

/// The share of tips within their interval.
fn within(run: &Json) -> Result<String, NoKey> {
    Ok(Percent(0).text(value(run, "error_mm.within_band")?))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn errors_of_all_arrays_stand_beside_each_other_and_each_mismatch_has_a_row() -> Result<(), NoKey> {
        let run = |scene: &str, outcome: &str, error: f64| {
            format!(
                r#"{{"scenario": "{scene}", "policy": "thesis", "outcome": "{outcome}", "error_mm": {{"mean": {error}, "within_band": 0.95}}}}"#
            )
        };
        let bench = |error: f64, outcome: &str| {
            let text = format!("[{},{}]", run("disk", "completed", error), run("box", outcome, error));
            Json::read(&text).unwrap_or(Json::Null)
        };
        let mut outputs: Vec<_> = [0.03, 0.05, 0.9, 0.1].map(|error| bench(error, "completed")).into();
        outputs[1] = bench(0.05, "ended");
        outputs.push(bench(2.0, "timeout"));
        let group = |mismatch: &str, scenes: &str, error: &str| {
            format!(
                r#"{{"scenes": "{scenes}", "settings": {{"mismatch": "{mismatch}"}}, "policy": "thesis", "error_mean_mm": {error},
                "within_band": 0.5}}"#
            )
        };
        let groups = [
            ("{}", "disk", "0.03"),
            ("{}", "box", "0.01"),
            ("{servo: 1 s}", "disk", "2"),
            ("{servo: 1 s}", "box", "null"),
        ];
        let groups = groups.map(|(mismatch, scenes, error)| group(mismatch, scenes, error)).join(",");
        outputs.push(Json::read(&format!(r#"{{"groups": [{groups}]}}"#)).unwrap_or(Json::Null));
        let page = page(&outputs)?;
        assert!(page.contains("| disk | 0.030 | 0.050 | 0.900 | 0.100 | 2.000 |\n"), "{page}");
        assert!(page.contains("| box | 0.030 | 0.050, ended | 0.900 | 0.100 | timeout |\n"), "{page}");
        assert!(page.contains("| disk | 95 | 95 | 95 | 95 | 95 |\n"), "{page}");
        assert!(page.contains("| mismatch | disk | box |\n|---|---|---|\n| `{}` | 0.03 | 0.01 |\n"), "{page}");
        assert!(page.contains("| `{servo: 1 s}` | 2.00 | – |\n"), "{page}");
        Ok(())
    }
}
