//! Tables of sums over runs.

use std::collections::BTreeMap;
use std::fmt::Write as _;

use super::table::Show::{Code, Fixed, Percent, Plain};
use super::table::{Column, NoKey, number, pivot, table, text, value};
use super::tables::{SCENE, has, names, those};
use super::verdicts::{SIMULATORS, Verdicts};
use crate::json::Json;
use crate::wilson::wilson;

/// Counts, means and shares over rows, as a row.
#[derive(Default)]
struct Sum {
    runs: f64,
    entries: BTreeMap<&'static str, (f64, f64)>,
}

impl Sum {
    /// Adds a value to a mean, with a weight.
    fn add(&mut self, name: &'static str, value: f64, weight: f64) {
        let (sum, weights) = self.entries.entry(name).or_default();
        *sum += value * weight;
        *weights += weight;
    }

    /// The same as [`Self::row`], with the 95 % intervals of the shares with these keys under `intervals.`.
    fn row_with_intervals(&self, names: &[(&str, &str)], keys: &[&str]) -> Json {
        let count = |key: &str| self.entries.get(key).map_or(0.0, |(sum, _)| *sum);
        let of = |key: &&str| ((*key).to_owned(), Json::Text(interval(count(key), self.runs)));
        let intervals = Json::Object(keys.iter().map(of).collect());
        match self.row(names) {
            Json::Object(entries) => {
                Json::Object(entries.into_iter().chain([("intervals".to_owned(), intervals)]).collect())
            }
            row => row,
        }
    }

    /// The means by name. `runs` and `total.` give the numbers of rows and the sums.
    fn row(&self, names: &[(&str, &str)]) -> Json {
        let texts = names.iter().map(|(key, name)| ((*key).to_owned(), Json::Text((*name).to_owned())));
        let mean = |&(sum, weights): &(f64, f64)| if weights > 0.0 { Json::Number(sum / weights) } else { Json::Null };
        let means = self.entries.iter().map(|(name, entry)| ((*name).to_owned(), mean(entry)));
        let totals = self.entries.iter().map(|(name, (sum, _))| ((*name).to_owned(), Json::Number(*sum))).collect();
        let counts = [("runs".to_owned(), Json::Number(self.runs)), ("total".to_owned(), Json::Object(totals))];
        Json::Object(texts.chain(means).chain(counts).collect())
    }
}

/// The 95 % interval of a rate in %.
fn interval(count: f64, runs: f64) -> String {
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "numbers of runs")]
    let ends = wilson(count as u64, runs as u64);
    ends.map_or_else(String::new, |[low, high]| format!("{:.1} to {:.1}", 100.0 * low, 100.0 * high))
}

pub(super) fn families(outputs: &[Json]) -> Result<String, NoKey> {
    let columns = [
        Column("family", "family", Code),
        Column("runs", "runs", Plain),
        Column("passed, %", "passed", Percent(1)),
        Column("its 95 % interval", "intervals.passed", Plain),
        Column("passed but for tips, %", "passed_but_for_tips", Percent(1)),
        Column("its interval", "intervals.passed_but_for_tips", Plain),
        Column("completed, %", "completed", Percent(1)),
        Column("its interval", "intervals.completed", Plain),
        Column("collision-free, %", "collision_free", Percent(1)),
        Column("its interval", "intervals.collision_free", Plain),
        Column("mean error, mm", "error", Fixed(4)),
        Column("coverage of the object, %", "object", Percent(1)),
        Column("outliers, %", "outliers", Percent(3)),
        Column("in 95 % interval, %", "within", Percent(1)),
    ];
    let mut page = String::new();
    for (title, runs) in SIMULATORS.into_iter().zip(outputs) {
        let mut rows = Vec::new();
        for family in names(runs.items(), "family")? {
            let mut sum = Sum::default();
            for run in those(runs.items(), |run| Ok(text(run, "family")? == family))? {
                let is_complete = ["completed", "ended"].contains(&text(run, "outcome")?);
                let (tips, is_true) = (number(run, "error_mm.n")?, |key| Ok(*value(run, key)? == Json::Bool(true)));
                sum.runs += 1.0;
                for key in ["passed", "passed_but_for_tips"] {
                    sum.add(key, f64::from(is_true(key)?), 1.0);
                }
                sum.add("completed", f64::from(is_complete), 1.0);
                sum.add("collision_free", f64::from(number(run, "collisions.count")? <= 0.0), 1.0);
                sum.add("error", number(run, "error_mm.mean")?, f64::from(is_complete));
                sum.add("object", number(run, "object_coverage")?, f64::from(is_complete));
                sum.add("outliers", number(run, "error_mm.outliers")?, tips);
                sum.add("within", number(run, "error_mm.within_band")?, tips);
            }
            let counted = ["passed", "passed_but_for_tips", "completed", "collision_free"];
            rows.push(sum.row_with_intervals(&[("family", family)], &counted));
        }
        let list = Verdicts::list(&Verdicts::of(title, runs.items())?);
        let _ = write!(page, "\n## {title}\n\n{}\n{list}", table(&rows, &columns)?);
    }
    Ok(page)
}

pub(super) fn estimators(outputs: &[Json]) -> Result<String, NoKey> {
    const FIGURES: [Column; 6] = [
        Column("mean error, mm", "mean_mm", Fixed(3)),
        Column("95th percentile, mm", "p95_mm", Fixed(3)),
        Column("in 95 % interval, %", "within_band", Percent(1)),
        Column("reported, %", "told", Percent(1)),
        Column("on the shaft, %", "on_shaft", Percent(1)),
        Column("time of perception, µs", "tick_us", Fixed(1)),
    ];
    let noise = |row: &Json| Ok(format!("{} ×", number(row, "noise")?));
    let (runs, mut rows, mut pages) = (outputs[0].items(), Vec::new(), String::new());
    for model in names(runs, "model")? {
        let runs = those(runs, |run| Ok(text(run, "model")? == model))?;
        let mut sums: Vec<(String, Sum)> = Vec::new();
        for run in &runs {
            let noise = noise(run)?;
            if sums.last().is_none_or(|(last, _)| *last != noise) && !sums.iter().any(|(other, _)| *other == noise) {
                sums.push((noise.clone(), Sum::default()));
            }
            let Some((_, sum)) = sums.iter_mut().find(|(other, _)| *other == noise) else { continue };
            let tips = number(run, "tips")?;
            let told = tips * number(run, "told")?;
            for (name, weight) in [("mean_mm", 1.0), ("p95_mm", 1.0), ("tick_us", 1.0)] {
                sum.add(name, number(run, name)?, if has(run, name)? { weight } else { 0.0 });
            }
            for (name, weight) in [("told", tips), ("on_shaft", tips), ("within_band", told)] {
                sum.add(name, number(run, name)?, weight);
            }
        }
        rows.extend(sums.iter().map(|(noise, sum)| sum.row(&[("model", model), ("noise", noise)])));
        let _ = write!(pages, "\n## `{model}`\n");
        for Column(title, path, show) in &FIGURES[..4] {
            let _ =
                write!(pages, "\nBy scene, {title}:\n\n{}", pivot(runs.iter().copied(), SCENE, noise, (path, *show))?);
        }
    }
    let columns =
        [&[Column("contact estimator", "model", Code), Column("noise", "noise", Plain)][..], &FIGURES].concat();
    let about = "Errors and times are means over the scenes. Shares are of the points of all scenes. Noise is relative to the real sensor's.";
    Ok(format!("\n## All scenes\n\n{about}\n\n{}{pages}", table(&rows, &columns)?))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_page_of_the_families_has_the_verdicts_of_its_runs() -> Result<(), NoKey> {
        let run = |family: &str, trial: u64, passed: bool| {
            format!(
                r#"{{"family": "{family}", "trial": {trial}, "passed": {passed}, "passed_but_for_tips": true, "outcome": "completed", "object_coverage": 1,
                "error_mm": {{"n": 9, "mean": 0, "outliers": 0, "within_band": 1}}, "collisions": {{"count": 0}}}}"#
            )
        };
        let first = [run("wall", 0, true), run("wall", 1, false), run("wall", 2, false), run("disk", 0, true)];
        let second = [run("wall", 0, true), run("wall", 1, false), run("disk", 0, true)];
        let outputs =
            [&first[..], &second[..]].map(|runs| Json::read(&format!("[{}]", runs.join(","))).unwrap_or(Json::Null));
        let page = families(&outputs)?;
        let expected: Vec<_> = SIMULATORS
            .into_iter()
            .zip(&outputs)
            .map(|(simulator, runs)| Verdicts::of(simulator, runs.items()))
            .collect::<Result<Vec<_>, _>>()?
            .concat();
        assert_eq!(Verdicts::published(&page), Ok(expected), "{page}");
        assert!(page.contains("| `wall` | 1, 2 |\n| `disk` | – |\n"), "{page}");
        assert!(page.contains("| `wall` | 3 | 33.3 | 6.1 to 79.2 | 100.0 | 43.9 to 100.0 |"), "{page}");
        Ok(())
    }

    #[test]
    fn means_are_weighted_and_sums_are_kept() {
        let mut sum = Sum::default();
        sum.add("share", 0.1, 3.0);
        sum.add("share", 0.5, 1.0);
        sum.add("error", 7.0, 0.0);
        let row = sum.row(&[("family", "a")]);
        assert!(number(&row, "share").is_ok_and(|share| (share - 0.2).abs() < 1e-12));
        assert_eq!((value(&row, "error"), number(&row, "runs")), (Ok(&Json::Null), Ok(0.0)));
        assert!(number(&row, "total.share").is_ok_and(|total| (total - 0.8).abs() < 1e-12));
    }
}
