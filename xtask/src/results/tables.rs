//! The tables of the pages, from the outputs of their commands.

use std::fmt::Write as _;

use super::table::Show::{Code, Fixed, Percent, Plain};
use super::table::{Column, NoKey, Show, number, pivot, table, text, value};
use crate::json::Json;

/// The scene, the policy and the outcome of a run.
const RUN: [Column; 3] = [SCENE, POLICY, Column("outcome", "outcome", Plain)];
pub(super) const SCENE: Column = Column("scene", "scenario", Plain);
const POLICY: Column = Column("policy", "policy", Code);

/// The errors of tips, coverage and body of a run.
const ERRORS: [Column; 9] = [
    Column("mean error, mm", "error_mm.mean", Fixed(3)),
    Column("standard deviation, mm", "error_mm.std", Fixed(3)),
    Column("95th percentile, mm", "error_mm.p95", Fixed(3)),
    Column("largest, mm", "error_mm.max", Fixed(2)),
    Column("in 95 % interval, %", "error_mm.within_band", Percent(1)),
    Column("outliers, %", "error_mm.outliers", Percent(2)),
    Column("coverage, %", "coverage", Percent(1)),
    Column("contacts of the body", "collisions.count", Plain),
    Column("duration, s", "sim_s", Fixed(0)),
];
const BASELINE: Column = Column("baseline's mean error, mm", "baseline.error_mm.mean", Fixed(1));

/// Beside the scene and the policy.
const RETRIEVAL: [Column; 7] = [
    SCENE,
    POLICY,
    Column("retrievals", "retrieval.count", Plain),
    Column("radius, mm", "retrieval.radius_mm.mean", Fixed(1)),
    Column("standard deviation, mm", "retrieval.radius_mm.std", Fixed(1)),
    Column("baseline's radius, mm", "baseline.radius_mm.mean", Fixed(1)),
    Column("mean time, s", "retrieval.time_s.mean", Fixed(1)),
];
const TUNNELS: [Column; 6] = [
    SCENE,
    POLICY,
    Column("distance from the axis, mm", "axis_mm.mean", Fixed(3)),
    Column("baseline's distance, mm", "baseline.axis_mm.mean", Fixed(1)),
    Column("passage, %", "passage.share", Percent(1)),
    Column("coverage of the walls, %", "passage.wall_coverage", Percent(1)),
];
const CORNERS: [Column; 10] = [
    SCENE,
    POLICY,
    Column("corners", "corners.count", Plain),
    Column("traced", "corners.traced", Plain),
    Column("mean error, mm", "corners.place_mm.mean", Fixed(2)),
    Column("largest error, mm", "corners.place_mm.max", Fixed(2)),
    Column("mean time, s", "corners.time_s.mean", Fixed(1)),
    Column("longest time, s", "corners.time_s.max", Fixed(1)),
    Column("mean path, m", "corners.path_m.mean", Fixed(2)),
    Column("longest path, m", "corners.path_m.max", Fixed(2)),
];

/// The rows that a condition holds for.
pub(super) fn those(rows: &[Json], condition: impl Fn(&Json) -> Result<bool, NoKey>) -> Result<Vec<&Json>, NoKey> {
    let kept = rows.iter().map(|row| Ok(condition(row)?.then_some(row)));
    Ok(kept.collect::<Result<Vec<_>, NoKey>>()?.into_iter().flatten().collect())
}

pub(super) fn has(row: &Json, path: &str) -> Result<bool, NoKey> {
    Ok(*value(row, path)? != Json::Null)
}

/// The corners of those runs that traced any.
fn corners(rows: &[Json]) -> Result<String, NoKey> {
    table(those(rows, |row| Ok(number(row, "corners.traced")? > 0.0))?, &CORNERS)
}

pub(super) fn bench(outputs: &[Json]) -> Result<String, NoKey> {
    let (runs, quasi_static) = (outputs[0].items(), outputs[1].items());
    let has_tunnel = |run: &Json| has(run, "passage");
    let has_edges = |run: &Json| has(run, "baseline.radius_mm");
    let errors = [&RUN[..], &[BASELINE], &ERRORS].concat();
    let groups = [
        ("Contour following", those(runs, |run| Ok(!has_tunnel(run)? && !has_edges(run)?))?),
        ("Retrieval behind edges", those(runs, has_edges)?),
        ("Tunnels", those(runs, has_tunnel)?),
    ];
    let mut page = String::new();
    for (title, runs) in &groups {
        let _ = write!(page, "\n## {title}\n\n{}", table(runs.iter().copied(), &errors)?);
        match *title {
            "Retrieval behind edges" => {
                let _ = write!(page, "\n{}", table(runs.iter().copied(), &RETRIEVAL)?);
            }
            "Tunnels" => {
                let _ = write!(page, "\n{}", table(runs.iter().copied(), &TUNNELS)?);
            }
            _ => {}
        }
    }
    let _ = write!(page, "\n## Corners\n\nOnly runs that traced sharp corners are listed.\n\n{}", corners(runs)?);
    let errors = table(quasi_static, &[&RUN[..], &ERRORS].concat())?;
    Ok(page + &format!("\n## Quasi-static simulator\n\n{errors}\n{}", corners(quasi_static)?))
}

/// The names of the policies in their order.
pub(super) fn names<'a>(rows: &'a [Json], path: &str) -> Result<Vec<&'a str>, NoKey> {
    let mut names = Vec::new();
    for row in rows {
        let name = text(row, path)?;
        if !names.contains(&name) {
            names.push(name);
        }
    }
    Ok(names)
}

pub(super) fn friction(outputs: &[Json]) -> Result<String, NoKey> {
    let runs: Vec<Json> = outputs.iter().flat_map(Json::items).cloned().collect();
    let condition = |run: &Json| {
        let friction = number(run, "conditions.friction")?;
        let is_noisy = *value(run, "conditions.noise")? == Json::Bool(true);
        Ok(match (friction > 0.0, is_noisy) {
            (true, true) => format!("{friction} and noise"),
            (true, false) => friction.to_string(),
            (false, _) => "noise".to_owned(),
        })
    };
    let mut page = "\nA column has the coefficient of friction, and whether there is noise.\n".to_owned();
    let figures = [
        ("Mean errors, mm", "error_mm.mean", Fixed(3)),
        ("95th percentiles of the error, mm", "error_mm.p95", Fixed(2)),
        ("Outliers, %", "error_mm.outliers", Percent(2)),
        ("Mean errors of corners, mm", "corners.place_mm.mean", Fixed(2)),
        ("Mean times of corners, s", "corners.time_s.mean", Fixed(1)),
    ];
    for policy in names(&runs, "policy")? {
        let _ = write!(page, "\n## `{policy}.fsm`\n");
        for (title, path, show) in figures {
            let of_corners = path.starts_with("corners");
            let runs = those(&runs, |run| {
                Ok(text(run, "policy")? == policy && (!of_corners || number(run, "corners.traced")? > 0.0))
            })?;
            let _ = write!(page, "\n{title}:\n\n{}", pivot(runs, SCENE, condition, (path, show))?);
        }
    }
    let conditions =
        [SCENE, POLICY, Column("friction", "conditions.friction", Plain), Column("noise", "conditions.noise", Plain)];
    let stopped = those(&runs, |run| Ok(text(run, "outcome")? != "completed"))?;
    let stopped = stopped.into_iter().map(explained).collect::<Result<Vec<_>, NoKey>>()?;
    let reasons = [&conditions[..], &[RUN[2], Column("reason", "explanation", Plain)]].concat();
    let about = "A run that ended met its stop condition, but not all expectations of its scene.";
    let _ = write!(page, "\n## Runs that did not complete\n\n{about}\n\n{}", table(&stopped, &reasons)?);
    let touched = those(&runs, |run| Ok(number(run, "collisions.count")? > 0.0))?;
    let contacts = [ERRORS[7], Column("their duration, s", "collisions.time_s", Fixed(1))];
    Ok(page
        + &format!(
            "\n## Runs in which the body touched something\n\n{}",
            table(touched, &[&conditions[..], &contacts].concat())?
        ))
}

/// A run with its reason as `explanation`. Of a run that ended, that is what it did not meet.
fn explained(run: &Json) -> Result<Json, NoKey> {
    let explanation = if text(run, "outcome")? == "ended" {
        let missing = value(run, "violations")?.items().iter().map(|one| Plain.text(one));
        missing.collect::<Vec<_>>().join(", ")
    } else {
        text(run, "reason")?.to_owned()
    };
    let Json::Object(mut entries) = run.clone() else { return Err(NoKey("outcome".to_owned())) };
    entries.extend([("explanation".to_owned(), Json::Text(explanation))]);
    Ok(Json::Object(entries))
}

pub(super) fn policies(outputs: &[Json]) -> Result<String, NoKey> {
    let errors = [&RUN[..], &ERRORS].concat();
    let titles = [
        "Policies in the scenes of the bench",
        "Three whiskers on each side",
        "Slow servos",
        "Slow servos, with edges",
    ];
    let mut page = String::new();
    for (title, runs) in titles.into_iter().zip(outputs) {
        let runs = runs.items();
        let retrieved = those(runs, |run| Ok(number(run, "retrieval.count")? > 0.0))?;
        let retrieval = [&RETRIEVAL[..5], &RETRIEVAL[6..]].concat();
        let _ = write!(page, "\n## {title}\n\n{}", table(runs, &errors)?);
        let tables = [("Corners", corners(runs)?), ("Retrievals", table(retrieved, &retrieval)?)];
        for (title, table) in tables.into_iter().filter(|(_, table)| table.starts_with('|')) {
            let _ = write!(page, "\n{title}:\n\n{table}");
        }
    }
    let comparison = &outputs[4];
    let figures = value(comparison, "figures")?.items().iter().map(with_ends).collect::<Result<Vec<_>, NoKey>>()?;
    let columns = [
        Column("figure", "figure", Code),
        Column("policy", "policy", Code),
        Column("pairs", "pairs", Plain),
        Column("mean of the first policy", "first", Fixed(3)),
        Column("mean of this policy", "mean", Fixed(3)),
        Column("difference", "difference.mean", Fixed(3)),
        Column("95 % interval from", "from", Fixed(3)),
        Column("to", "to", Fixed(3)),
        Column("verdict", "outlook", Plain),
    ];
    let runs = number(&value(comparison, "policies")?.items().first().cloned().unwrap_or(Json::Null), "runs")?;
    let about = format!(
        "Each policy has {runs} runs. Units are those of the names, as in [JSON](../json.md). Differences are from the first policy."
    );
    Ok(page + &format!("\n## Comparison from displaced starts\n\n{about}\n\n{}", table(&figures, &columns)?))
}

pub(super) fn thesis_array(outputs: &[Json]) -> Result<String, NoKey> {
    let runs: Vec<Json> = outputs.iter().flat_map(Json::items).cloned().collect();
    let world = [Column("simulator", "world", Plain)];
    let errors = [&RUN[..2], &world, &RUN[2..], &ERRORS].concat();
    let corners = [&CORNERS[..2], &world, &CORNERS[2..]].concat();
    let cornered = those(&runs, |run| Ok(number(run, "corners.traced")? > 0.0))?;
    Ok(format!("\n{}\n## Corners\n\n{}", table(&runs, &errors)?, table(cornered, &corners)?))
}

/// A figure of a comparison, with the ends of its interval as keys.
fn with_ends(figure: &Json) -> Result<Json, NoKey> {
    let interval = value(figure, "difference.interval")?.items();
    let end = |at: usize| interval.get(at).cloned().unwrap_or(Json::Null);
    let Json::Object(mut entries) = figure.clone() else { return Err(NoKey("figures".to_owned())) };
    entries.extend([("from".to_owned(), end(0)), ("to".to_owned(), end(1))]);
    Ok(Json::Object(entries))
}

pub(super) fn worlds(outputs: &[Json]) -> Result<String, NoKey> {
    let columns = [
        SCENE,
        POLICY,
        RUN[2],
        Column("distance of tips, mm", "tip_mm.mean", Fixed(4)),
        Column("its 95th percentile, mm", "tip_mm.p95", Fixed(4)),
        Column("difference of moments, µN m", "moment_un_m.mean", Fixed(2)),
        Column("its 95th percentile, µN m", "moment_un_m.p95", Fixed(2)),
        Column("share of the moment, %", "moment_share", Percent(2)),
        Column("distance of contours, mm", "contour_mm", Fixed(4)),
        Column("left out, %", "left_out", Percent(1)),
    ];
    Ok(format!("\n{}", table(outputs[0].items(), &columns)?))
}

pub(super) fn timing(outputs: &[Json]) -> Result<String, NoKey> {
    const TIMES: [(&str, &str, Show); 4] = [
        ("Simulated seconds per second of processor time", "realtime", Fixed(0)),
        ("Start of a run, ms", "start_ms", Fixed(1)),
        ("Mean time of a control tick, µs", "tick_us.mean", Fixed(2)),
        ("99th percentile of the time of a control tick, µs", "tick_us.p99", Fixed(2)),
    ];
    let runs: Vec<Json> = outputs.iter().flat_map(Json::items).cloned().collect();
    let of = |run: &Json| Ok(format!("{}, {}", text(run, "policy")?, text(run, "world")?));
    let tables = TIMES
        .iter()
        .map(|(title, path, show)| Ok(format!("\n## {title}\n\n{}", pivot(&runs, SCENE, of, (path, *show))?)));
    tables.collect()
}

pub(super) fn scale(outputs: &[Json]) -> Result<String, NoKey> {
    const AXIS: [Column; 2] = [Column("axis", "axis", Plain), Column("simulator", "simulator", Plain)];
    let [scale, ..] = outputs else { return Err(NoKey("axes".to_owned())) };
    let axes = value(scale, "axes")?.items();
    let exponents = [&AXIS[..], &[Column("work", "work", Plain), Column("exponent", "exponent", Fixed(2))]].concat();
    let times = [Column("size", "size", Plain), Column("unit", "unit", Plain), Column("time, s", "time_s", Fixed(3))];
    let sizes = axes.iter().map(sizes).collect::<Result<Vec<_>, NoKey>>()?.concat();
    let sweeps = value(scale, "sweeps")?.items();
    let costs = [
        AXIS[1],
        Column("one processor, h", "processor_hours", Fixed(1)),
        Column("this machine, h", "machine_hours", Fixed(1)),
        Column("array of jobs, min", "array_minutes", Fixed(2)),
        Column("merge, min", "merge_minutes", Fixed(1)),
        Column("results, GB", "results_gb", Fixed(1)),
    ];
    let units = [
        AXIS[1],
        Column("run with its line of results, ms", "run_ms", Fixed(1)),
        Column("line of results, bytes", "line_bytes", Plain),
        Column("job without runs, s", "job_start_s", Fixed(2)),
    ];
    let sweep = sweeps.first().ok_or_else(|| NoKey("sweeps".to_owned()))?;
    let (repeats, processors) = (number(scale, "repeats")?, number(scale, "processors")?);
    let (runs, jobs) = (number(sweep, "runs")?, number(sweep, "jobs")?);
    Ok(format!(
        "
Times are medians of {repeats} measurements: processor time, and wall time for the cores. A cost grows as the size to the power of the \
exponent, which is the slope between the two largest sizes on logarithmic axes. Fixed costs hide it at smaller sizes.

## Exponents

{}
## Times

{}
## A sweep of {runs} runs

The run is that of the disk of the bench under `thesis.fsm`. This machine has {processors} processors. The array has {jobs} jobs of one \
processor each, all at a time. Waiting for disks and for the scheduler does not count.

{}
These costs follow from the measured costs of one run, of one line and of one job:

{}
Under Slurm, this command submits the array, and the second one merges its results:

    sbatch --array=1-{jobs} deploy/slurm/sweep.sbatch FILE DIR
    vibrissa study merge DIR

Job K of the array runs one shard, as any other machine can ([sweeps](../sweeps.md#several-machines)):

    vibrissa sweep FILE --shard K/{jobs} --out DIR
",
        table(axes, &exponents)?,
        table(&sizes, &[&AXIS[..], &times].concat())?,
        table(sweeps, &costs)?,
        table(sweeps, &units)?
    ))
}

/// The times of an axis, each with the axis and its simulator.
fn sizes(axis: &Json) -> Result<Vec<Json>, NoKey> {
    let shared = ["axis", "simulator", "unit"].map(|key| Ok((key.to_owned(), value(axis, key)?.clone())));
    let shared = shared.into_iter().collect::<Result<Vec<_>, NoKey>>()?;
    let with_axis = |time: &Json| {
        let Json::Object(mut entries) = time.clone() else { return Err(NoKey("times".to_owned())) };
        entries.extend(shared.iter().cloned());
        Ok(Json::Object(entries))
    };
    value(axis, "times")?.items().iter().map(with_axis).collect()
}

pub(super) fn pareto(outputs: &[Json]) -> Result<String, NoKey> {
    let columns = [
        Column("setting", "setting", Plain),
        Column("simulator", "world", Plain),
        RUN[2],
        Column("relative time", "relative_time", Fixed(2)),
        Column("exact error, mm", "error_mm", Fixed(4)),
        Column("fine error, mm", "fine_mm", Fixed(4)),
        Column("run with mismatch", "mismatched_outcome", Plain),
        Column("mismatched error, mm", "mismatched_mm", Fixed(2)),
        Column("Pareto-optimal by exact error", "on_front.exact", Plain),
        Column("by fine error", "on_front.fine", Plain),
        Column("by mismatched error", "on_front.mismatched", Plain),
        Column("by exact and mismatched error together", "on_front.together", Plain),
        Column("in its simulator by exact error", "on_front_of_world.exact", Plain),
        Column("by fine error there", "on_front_of_world.fine", Plain),
    ];
    let mut page = String::new();
    for pareto in outputs[0].items() {
        let policy = text(pareto, "policy")?;
        let floor = Fixed(4).text(value(pareto, "floor_mm")?);
        let table = table(value(pareto, "settings")?.items(), &columns)?;
        let _ = write!(
            page,
            "\n## `{policy}.fsm`\n\n{table}\nThe fine run from a start 1 mm farther back differs by {floor} mm.\n"
        );
    }
    Ok(page)
}

pub(super) fn stress(outputs: &[Json]) -> Result<String, NoKey> {
    let all = outputs[0].items();
    let cases = those(all, |row| Ok(text(row, "kind")? == "case"))?;
    let case = [
        Column("case", "name", Plain),
        Column("simulator", "world", Plain),
        Column("platform", "drive", Plain),
        RUN[2],
        Column("numbers are finite", "finite", Plain),
    ];
    let step = [
        Column("setting", "name", Plain),
        Column("simulator", "world", Plain),
        Column("largest stable step, ms", "largest_ms", Fixed(2)),
    ];
    let steps = those(all, |row| Ok(text(row, "kind")? == "step"))?;
    let about = "A dash means that no step from 0.1 ms on is stable.";
    let count = cases.len();
    Ok(format!(
        "\n## Largest stable steps\n\n{about}\n\n{}\n## Cases\n\nThere are {count} cases.\n\n{}",
        table(steps, &step)?,
        table(cases, &case)?
    ))
}

pub(super) fn calibration(outputs: &[Json]) -> Result<String, NoKey> {
    let columns = [
        Column("contact estimator", "model", Code),
        Column("held-out sets", "sets", Plain),
        Column("root mean square of the error, mm", "rms_mm", Fixed(3)),
        Column("largest error, mm", "max_mm", Fixed(3)),
        Column("range", "range", Plain),
    ];
    let mut page = String::new();
    for (title, fit) in ["Without noise", "With the noise of the real sensor"].into_iter().zip(outputs) {
        let (sets, tips) = (number(fit, "sets")?, number(fit, "tip_sets")?);
        let table = table(value(fit, "held_out")?.items(), &columns)?;
        let _ = write!(page, "\n## {title}\n\nOf {sets} touches, {tips} are of the tip.\n\n{table}");
    }
    Ok(page)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn runs_with_friction_have_a_column_for_each_condition() {
        let run = |friction: f64, noise: bool, error: f64| {
            format!(
                r#"{{"scenario": "disk", "policy": "p", "outcome": "failed", "reason": "a; b", "corners": null,
                "error_mm": {{"mean": {error}, "p95": 1, "outliers": 0}}, "collisions": {{"count": 0, "time_s": 0}},
                "conditions": {{"friction": {friction}, "noise": {noise}}}}}"#
            )
        };
        let output = |runs: &[String]| Json::read(&format!("[{}]", runs.join(","))).unwrap_or(Json::Null);
        let ended = run(0.1, false, 3.0)
            .replace(r#""failed", "reason": "a; b""#, r#""ended", "violations": ["c", "d"], "reason": null"#);
        let outputs = [output(&[run(0.0, true, 1.0), run(0.1, true, 2.0)]), output(&[ended])];
        let page = friction(&outputs).unwrap_or_default();
        assert!(
            page.contains(
                "| scene | noise | 0.1 and noise | 0.1 |\n|---|---|---|---|\n| disk | 1.000 | 2.000 | 3.000 |"
            ),
            "{page}"
        );
        assert!(page.contains("| disk | `p` | 0.1 | yes | failed | a, b |"), "{page}");
        assert!(page.contains("| disk | `p` | 0.1 | no | ended | c, d |"), "{page}");
        assert!(page.contains("body touched something\n\nThere are none."), "{page}");
    }
}
