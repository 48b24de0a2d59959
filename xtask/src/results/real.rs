//! The page of the differences between a real array and its model, alone and together.

use std::fmt::Write as _;

use super::table::Show::{Fixed, Percent, Plain};
use super::table::{Column, NoKey, number, table, text, value};
use super::tables::{names, those};
use crate::json::Json;

/// The scenes with a convex object.
const CONVEX: [&str; 6] = ["disk", "rounded-rectangle", "octagon", "box", "prism", "wall"];
/// The condition in which no difference is left out.
const TOGETHER: &str = "all together";
/// Names a condition, from the settings of a group.
type Name = fn(&Json) -> Result<String, NoKey>;
/// The names of the conditions of each command.
const CONDITIONS: [Name; 4] = [
    |group| Ok(format!("{}, uncalibrated", difference(group)?)),
    |group| Ok(format!("{}, calibrated", difference(group)?)),
    |_| Ok("round wires".to_owned()),
    |_| Ok(TOGETHER.to_owned()),
];

const FIGURES: [Column; 8] = [
    Column("mean error, mm", "error", Fixed(3)),
    Column("coverage, %", "coverage", Percent(1)),
    Column("in 95 % interval, %", "within", Percent(1)),
    Column("completed", "completed", Plain),
    Column("ended", "ended", Plain),
    Column("others", "others", Plain),
    Column("with slips", "slipped", Plain),
    Column("with contacts of the body", "collided", Plain),
];

/// The groups of each condition.
type Conditions<'a> = Vec<(String, Vec<&'a Json>)>;

/// The page, from the summaries of the sweeps.
pub(super) fn page(outputs: &[Json]) -> Result<String, NoKey> {
    let mut page = format!(
        "\nWhiskers are planar, except for *round wires*, which bend in [all directions](../worlds.md#spatial-whiskers) under gravity. \
         The condition *{TOGETHER}* has round wires with all differences of `scenarios/mismatch/real.yaml`: five drawn arrays in each scene, whose frictions nobody states. \
         They are calibrated. *Calibrated* arrays first \
         [measure themselves](../calibration.md#calibration-of-an-array-by-its-own-touches), and *uncalibrated* ones are taken for their model. \
         Errors, coverages and shares are means over scenes, errors and coverages only of runs that met their stop condition. Other columns are numbers of runs. \
         A run that ended met its stop condition, but not all expectations of its scene.\n"
    );
    let groups = value(&outputs[0], "groups")?.items();
    for policy in names(groups, "policy")? {
        let conditions = conditions(outputs, policy)?;
        let _ = write!(page, "\n## `{policy}.fsm`\n");
        for (shapes, is_convex) in [("convex", true), ("other", false)] {
            let rows = conditions.iter().map(|(condition, groups)| {
                let groups = groups.iter().filter(|group| is_of_convex(group) == Ok(is_convex));
                row(condition, &groups.copied().collect::<Vec<_>>())
            });
            let rows = rows.collect::<Result<Vec<_>, NoKey>>()?;
            let columns = [&[Column("condition", "name", Plain)][..], &FIGURES].concat();
            let _ = write!(page, "\nScenes with {shapes} shapes:\n\n{}", table(&rows, &columns)?);
        }
        let together = conditions.iter().filter(|(condition, _)| condition == TOGETHER).flat_map(|(_, groups)| groups);
        let scenes = together.map(|group| row(text(group, "scenes")?, &[group]));
        let scenes = scenes.collect::<Result<Vec<_>, NoKey>>()?;
        let columns = [&[Column("scene", "name", Plain)][..], &FIGURES].concat();
        let _ = write!(page, "\nEach scene with all differences together:\n\n{}", table(&scenes, &columns)?);
    }
    Ok(page)
}

/// The groups of a policy by their conditions, in the order of the commands.
fn conditions<'a>(outputs: &'a [Json], policy: &str) -> Result<Conditions<'a>, NoKey> {
    let mut conditions = Conditions::new();
    for (name, output) in CONDITIONS.into_iter().zip(outputs) {
        for group in those(value(output, "groups")?.items(), |group| Ok(text(group, "policy")? == policy))? {
            let name = name(group)?;
            match conditions.iter_mut().find(|(other, _)| *other == name) {
                Some((_, groups)) => groups.push(group),
                None => conditions.push((name, vec![group])),
            }
        }
    }
    Ok(conditions)
}

/// The mismatch of a group of the sweep of single differences.
fn difference(group: &Json) -> Result<String, NoKey> {
    let mismatch = text(group, "settings.mismatch")?;
    Ok(match mismatch {
        "{}" => "no difference".to_owned(),
        drawn if drawn.contains("from:") => "a drawn array without the differences above".to_owned(),
        single => format!("`{single}`"),
    })
}

fn is_of_convex(group: &Json) -> Result<bool, NoKey> {
    Ok(CONVEX.contains(&text(group, "scenes")?))
}

/// The means and the numbers of some groups.
fn row(name: &str, groups: &[&Json]) -> Result<Json, NoKey> {
    let mean = |key: &str| {
        let values = groups.iter().map(|group| value(group, key)).collect::<Result<Vec<_>, NoKey>>()?;
        let known: Vec<f64> = values
            .into_iter()
            .filter_map(|value| if let Json::Number(number) = value { Some(*number) } else { None })
            .collect();
        Ok(if known.is_empty() { Json::Null } else { Json::Number(known.iter().sum::<f64>() / known.len() as f64) })
    };
    let total = |key: &str| groups.iter().map(|group| number(group, key)).sum::<Result<f64, NoKey>>();
    let [runs, met, ended] = [total("runs")?, total("completed")?, total("ended")?];
    let entries = [
        ("name", Json::Text(name.to_owned())),
        ("error", mean("error_mean_mm")?),
        ("coverage", mean("coverage")?),
        ("within", mean("within_band")?),
        ("completed", Json::Number(met - ended)),
        ("ended", Json::Number(ended)),
        ("others", Json::Number(runs - met)),
        ("slipped", Json::Number(total("slipped")?)),
        ("collided", Json::Number(total("collided")?)),
    ];
    Ok(Json::Object(entries.into_iter().map(|(key, value)| (key.to_owned(), value)).collect()))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn summary(groups: &[(&str, &str, &str)]) -> Json {
        let group = |(scene, settings, figures): &(&str, &str, &str)| {
            format!(
                r#"{{"scenes": "{scene}", "policy": "thesis", "settings": {settings}, "runs": 5, "coverage": 0.9, "within_band": 0.95, {figures}}}"#
            )
        };
        let groups: Vec<_> = groups.iter().map(group).collect();
        Json::read(&format!(r#"{{"groups": [{}]}}"#, groups.join(","))).unwrap_or(Json::Null)
    }

    #[test]
    fn scenes_are_averaged_by_their_shapes_and_shown_one_by_one_for_all_differences_together() -> Result<(), NoKey> {
        let figures = |error: &str, completed: u32, slipped: u32| {
            format!(
                r#""error_mean_mm": {error}, "completed": {completed}, "ended": 1, "slipped": {slipped}, "collided": 0"#
            )
        };
        let good = figures("0.1", 5, 0);
        let [none, servo] = ["{}", "{servo: 1 s}"].map(|difference| format!(r#"{{"mismatch": "{difference}"}}"#));
        let scenes = |settings: &str| {
            summary(&[
                ("disk", settings, &good),
                ("box", settings, &figures("0.3", 4, 2)),
                ("complex", settings, &figures("null", 1, 0)),
            ])
        };
        let calibrated = summary(&[("disk", &servo, &good)]);
        let page = page(&[scenes(&none), calibrated, scenes("{}"), scenes("{}")])?;
        assert!(page.contains("| no difference, uncalibrated | 0.200 | 90.0 | 95.0 | 7 | 2 | 1 | 2 | 0 |"), "{page}");
        assert!(page.contains("| `{servo: 1 s}`, calibrated | 0.100 |"), "{page}");
        assert!(page.contains("| all together | – | 90.0 | 95.0 | 0 | 1 | 4 | 0 | 0 |"), "{page}");
        assert!(page.contains("\n| box | 0.300 | 90.0 | 95.0 | 3 | 1 | 1 | 2 | 0 |\n"), "{page}");
        Ok(())
    }
}
