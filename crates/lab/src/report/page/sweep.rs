//! A sweep as a page.

use maud::{Markup, html};
use vibrissa_runtime::math;
use vibrissa_runtime::units::parse_quantity;

use super::document::page;
use super::figure::figure;
use super::run::place;
use super::table::{Judgement, PageCell, PageTable};
use crate::report::number::millimetres;
use crate::report::picture::{Axis, Curve, curve_picture};
use crate::report::table::{NONE, known, percent};
use crate::report::tables::summary_table;
use crate::results::{Ending, LargestError, Provenance, Rate, Tally};
use crate::sweep::{ReadLine, SweepCurve, SweepGroup, SweepPoint, SweepSummary};
use vibrissa_declare::figures::Metric;

/// A page with heat maps of a sweep, the table of its groups and the runs of each group. `pictures` gives the address of the picture of
/// a run, if there is one. `rows` has the runs of each group of the `summary`. It needs no other file than these pictures.
#[must_use]
pub fn sweep_page(
    provenance: &Provenance,
    summary: &SweepSummary,
    rows: &[Vec<ReadLine>],
    picture: impl Fn(&ReadLine) -> Option<String>,
) -> String {
    let groups = &summary.groups;
    let (runs, passed) =
        groups.iter().fold((0, 0), |(runs, passed), group| (runs + group.tally.runs, passed + group.tally.passed));
    let introduction = html! {
        p.lead { (passed) " of " (runs) " runs passed, in " (groups.len()) " groups." }
        (worst_groups(groups))
    };
    let table = PageTable::new(summary.sweep.clone(), &summary_table(groups)).linked(|index| Some(address(index)));
    let sections = html! {
        (largest_errors(groups, rows))
        (curves(&summary.curves))
        (heat_maps(groups))
        section { h2 { "Groups" } (table.markup()) }
        section {
            h2 { "Runs" }
            @for (index, (group, rows)) in groups.iter().zip(rows).enumerate() {
                details {
                    summary { (label(group)) ": " (group.tally.passed) " of " (group.tally.runs) " passed" }
                    div id=(format!("group{index}")) { (run_table(group, rows, &picture).markup()) }
                    @if group.tally.runs > rows.len() { p { "The first " (rows.len()) " runs. The file of results has all of them." } }
                }
            }
        }
    };
    page(&format!("Vibrissa sweep: {}", summary.sweep), provenance, &introduction, &sections)
}

fn address(index: usize) -> String {
    format!("#group{index}")
}

/// Number of groups with the fewest passes that are named.
const WORST_NAMED: usize = 3;

/// A sentence with the groups that have the smallest share of passed runs, if not all runs of all groups passed.
fn worst_groups(groups: &[SweepGroup]) -> Markup {
    let share = |group: &SweepGroup| group.tally.passed as f64 / group.tally.runs.max(1) as f64;
    let least = groups.iter().map(share).fold(1.0, f64::min);
    let worst: Vec<_> = groups.iter().enumerate().filter(|(_, group)| share(group) <= least).collect();
    if groups.len() < 2 || least >= 1.0 {
        return html! {};
    }
    html! {
        p {
            "The fewest runs passed, " (percent(least, 0)) ", in "
            @if worst.len() > WORST_NAMED { (worst.len()) " groups. The first of them: " }
            @for (place, (index, group)) in worst.iter().take(WORST_NAMED).enumerate() {
                @if place > 0 { "; " }
                a href=(address(*index)) { (label(group)) }
            }
            "."
        }
    }
}

/// For each policy, the run with the largest error.
fn largest_errors(groups: &[SweepGroup], rows: &[Vec<ReadLine>]) -> Markup {
    let mut worst: Vec<(usize, &SweepGroup, &ReadLine, &LargestError)> = Vec::new();
    let runs = groups.iter().zip(rows).enumerate().flat_map(|(index, (group, rows))| {
        rows.iter().filter_map(move |row| Some((index, group, row, row.largest_error.as_ref()?)))
    });
    for run in runs {
        match worst.iter_mut().find(|(_, group, ..)| group.policy == run.1.policy) {
            Some(entry) if run.3.error_mm > entry.3.error_mm => *entry = run,
            Some(_) => {}
            None => worst.push(run),
        }
    }
    html! {
        @if !worst.is_empty() {
            section {
                h2 { "Largest errors" }
                ul.worst {
                    @for (index, group, row, error) in worst {
                        li { b { (group.policy) ": " } a href=(address(index)) { (label(group)) } ", trial " (row.trial) ", " (place(error)) }
                    }
                }
            }
        }
    }
}

/// The names of a group in one line.
fn label(group: &SweepGroup) -> String {
    let settings = group.settings.iter().map(|(name, value)| format!("{name} = {value}"));
    std::iter::once(group.scenes.clone()).chain(settings).chain([group.policy.clone()]).collect::<Vec<_>>().join(", ")
}

fn run_table(group: &SweepGroup, rows: &[ReadLine], picture: impl Fn(&ReadLine) -> Option<String>) -> PageTable {
    let cells = |row: &ReadLine| {
        let known = |figure: Option<String>| figure.unwrap_or_else(|| NONE.to_owned());
        let largest = row.largest_error.as_ref().map(|worst| worst.error_mm);
        let [mean, max] = [row.figure(Metric::ErrorMean), largest].map(|error| known(error.map(millimetres)));
        let failed = row.outcome != Ending::Completed;
        let outcome = PageCell {
            text: row.outcome.name().to_owned(),
            judgement: failed.then_some(Judgement::Worse),
            link: picture(row),
        };
        let passed = PageCell {
            text: if row.passed { "yes" } else { "no" }.to_owned(),
            judgement: (!row.passed).then_some(Judgement::Worse),
            link: None,
        };
        let coverage = known(row.figure(Metric::Coverage).map(|coverage| percent(coverage, 1)));
        let collisions = row.figure(Metric::Collisions).unwrap_or(0.0).to_string();
        let reasons = if row.violations().is_empty() {
            row.reason.clone().unwrap_or_default()
        } else {
            row.violations().join("; ")
        };
        let about = row.about.clone().unwrap_or_default();
        let texts = [mean, max, coverage, collisions, reasons, about].map(PageCell::from);
        [PageCell::from(row.trial.to_string()), outcome, passed].into_iter().chain(texts).collect()
    };
    PageTable {
        title: label(group),
        headings: [
            "trial",
            "outcome",
            "passed",
            "error mm",
            "largest error mm",
            "coverage",
            "collisions",
            "reason",
            "about",
        ]
        .map(str::to_owned)
        .to_vec(),
        names: 3,
        rows: rows.iter().map(cells).collect(),
    }
}

/// For each axis its pictures: the pass rate and the mean error of each policy with their 95 % intervals.
fn curves(curves: &[SweepCurve]) -> Markup {
    let mut axes: Vec<&str> = curves.iter().map(|curve| curve.axis.as_str()).collect();
    axes.dedup();
    html! {
        @if !axes.is_empty() {
            section {
                h2 { "Curves" }
                p {
                    "Each point is over all runs of a policy with one value of the axis: all scenes, and all values of the other axes. Bands are \
                     95 % intervals, after Wilson for rates and by Student's t for mean errors. They treat runs as independent."
                }
                @for (index, axis) in axes.iter().enumerate() {
                    h3 { (axis) }
                    div.histograms {
                        @for (measure, svg) in pictures_of(axis, curves).iter().enumerate() {
                            @if let Some(svg) = svg {
                                (figure(&format!("{axis}-{}", ["pass-rate", "error"][measure]), &format!("c{index}-{measure}-"), svg, &html! {}, None))
                            }
                        }
                    }
                }
            }
        }
    }
}

/// A figure and its interval.
type WithInterval = (f64, Option<[f64; 2]>);

/// The pictures of the pass rate and of the mean error over an axis.
fn pictures_of(axis: &str, curves: &[SweepCurve]) -> [Option<String>; 2] {
    let of_axis: Vec<&SweepCurve> = curves.iter().filter(|curve| curve.axis == axis).collect();
    let mut values: Vec<&str> = Vec::new();
    for point in of_axis.iter().flat_map(|curve| &curve.points) {
        if !values.contains(&point.value.as_str()) {
            values.push(&point.value);
        }
    }
    let numbers: Option<Vec<f64>> = values.iter().map(|value| Some(parse_quantity(value).ok()?.value_si)).collect();
    // Values that are no numbers are at equal distances.
    let places = numbers.unwrap_or_else(|| (0..values.len()).map(|index| index as f64).collect());
    let scale =
        Axis { name: axis.to_owned(), values: values.iter().map(|&value| value.to_owned()).zip(places).collect() };
    let drawn = |of: fn(&Tally) -> Option<WithInterval>| -> Vec<Curve> {
        let curve = |curve: &&SweepCurve| {
            let point = |point: &SweepPoint| {
                let (figure, interval) = of(&point.tally)?;
                Some((values.iter().position(|value| *value == point.value)?, figure, interval))
            };
            Curve { name: curve.policy.clone(), points: curve.points.iter().filter_map(point).collect() }
        };
        of_axis.iter().map(curve).collect()
    };
    let percent = |part: f64| 100.0 * part;
    let rates = drawn(|tally| {
        let rate = Rate::new(tally.passed, tally.runs)?;
        Some((rate.share, Some(rate.interval)))
    });
    let rates: Vec<Curve> = rates
        .into_iter()
        .map(|curve| {
            let points = curve
                .points
                .into_iter()
                .map(|(index, rate, band)| (index, percent(rate), band.map(|ends| ends.map(percent))));
            Curve { points: points.collect(), ..curve }
        })
        .collect();
    let errors = drawn(|tally| Some((tally.error_mean_mm?, tally.error_mean_interval_mm)));
    let has_errors = errors.iter().any(|curve| !curve.points.is_empty());
    [
        curve_picture(&format!("passed runs (%) over {axis}"), &scale, Some((0.0, 100.0)), &rates),
        has_errors
            .then(|| curve_picture(&format!("mean error (mm) of completed runs over {axis}"), &scale, None, &errors))
            .flatten(),
    ]
}

/// A figure of a group that heat maps show.
struct Measure {
    name: &'static str,
    text: fn(&Tally) -> String,
    /// Its value. Larger is worse.
    of: fn(&Tally) -> Option<f64>,
    is_logarithmic: bool,
}

const MEASURES: [Measure; 3] = [
    Measure {
        name: "passed",
        text: |tally| known(tally.rates, |rates| percent(rates.passed.share, 0)),
        of: |tally| tally.rates.map(|rates| 1.0 - rates.passed.share),
        is_logarithmic: false,
    },
    Measure {
        name: "mean error (mm)",
        text: |tally| known(tally.error_mean_mm, millimetres),
        of: |tally| tally.error_mean_mm,
        is_logarithmic: true,
    },
    Measure {
        name: "95th percentile of the error (mm)",
        text: |tally| known(tally.error_p95_mm, millimetres),
        of: |tally| tally.error_p95_mm,
        is_logarithmic: true,
    },
];

/// The name of a dimension of a sweep, and the value of a group in it.
type Dimension = (String, Vec<String>);

/// The dimensions in which the groups differ: scenes, policy and axes, each with its values in the order of the sweep.
fn dimensions(groups: &[SweepGroup]) -> Vec<Dimension> {
    let names = groups.first().into_iter().flat_map(|group| group.settings.keys().cloned());
    let all = ["scenes".to_owned(), "policy".to_owned()].into_iter().chain(names);
    let with_values = all.map(|name| {
        let mut values: Vec<String> = Vec::new();
        for value in groups.iter().filter_map(|group| value_of(group, &name)) {
            if !values.contains(value) {
                values.push(value.clone());
            }
        }
        (name, values)
    });
    with_values.filter(|(_, values)| values.len() > 1).collect()
}

fn value_of<'g>(group: &'g SweepGroup, dimension: &str) -> Option<&'g String> {
    match dimension {
        "scenes" => Some(&group.scenes),
        "policy" => Some(&group.policy),
        axis => group.settings.get(axis),
    }
}

/// The values of a group in some dimensions.
fn values_of<'g>(group: &'g SweepGroup, dimensions: &[Dimension]) -> Vec<&'g String> {
    dimensions.iter().filter_map(|(name, _)| value_of(group, name)).collect()
}

/// A heat map for each measure over the last two dimensions, and for each combination of the others.
fn heat_maps(groups: &[SweepGroup]) -> Markup {
    let mut dimensions = dimensions(groups);
    let Some(columns) = dimensions.pop() else { return html! {} };
    let rows = dimensions.pop();
    let mut facets: Vec<Vec<&String>> = Vec::new();
    for group in groups {
        let values = values_of(group, &dimensions);
        if !facets.contains(&values) {
            facets.push(values);
        }
    }
    html! {
        section {
            h2 { "Heat maps" }
            p { "Each cell is a group of runs and opens its runs. The stronger the colour, the worse the figure." }
            @for values in &facets {
                @let title = dimensions.iter().zip(values).map(|((name, _), value)| format!("{name} = {value}")).collect::<Vec<_>>().join(", ");
                @if !title.is_empty() { h3 { (title) } }
                div.maps {
                    @for measure in &MEASURES {
                        (heat_map(groups, measure, &columns, rows.as_ref(), |group| values_of(group, &dimensions) == *values))
                    }
                }
            }
        }
    }
}

fn heat_map(
    groups: &[SweepGroup],
    measure: &Measure,
    columns: &Dimension,
    rows: Option<&Dimension>,
    is_shown: impl Fn(&SweepGroup) -> bool,
) -> Markup {
    let value = |group: &SweepGroup| {
        let value = (measure.of)(&group.tally)?;
        Some(if measure.is_logarithmic { math::log10(value.max(1e-6)) } else { value })
    };
    // One scale for all heat maps of a measure, so that colours can be compared.
    let all = || groups.iter().filter_map(value);
    let (low, high) =
        all().fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), value| (low.min(value), high.max(value)));
    let heat =
        |group: &SweepGroup| value(group).map(|value| if high > low { (value - low) / (high - low) } else { 0.0 });
    let only = vec![String::new()];
    let row_values = rows.map_or(&only, |(_, values)| values);
    let is_in = |group: &SweepGroup, column: &String, row: &String| {
        value_of(group, &columns.0) == Some(column) && rows.is_none_or(|(name, _)| value_of(group, name) == Some(row))
    };
    html! {
        table.heat {
            caption { (measure.name) }
            thead {
                tr {
                    th scope="col" { (rows.map_or("", |(name, _)| name)) " \\ " (columns.0) }
                    @for column in &columns.1 { th scope="col" { (column) } }
                }
            }
            tbody {
                @for row in row_values {
                    tr {
                        th scope="row" { (row) }
                        @for column in &columns.1 {
                            @let group = groups.iter().enumerate().find(|(_, group)| is_shown(group) && is_in(group, column, row));
                            @match group {
                                Some((index, group)) => td style=[heat(group).map(|heat| format!("--heat:{:.0}%", 100.0 * heat))] {
                                    a href=(address(index)) title=(label(group)) aria-label=(format!("{}: {}, {}", measure.name, (measure.text)(&group.tally), label(group))) { ((measure.text)(&group.tally)) }
                                },
                                None => td { (NONE) },
                            }
                        }
                    }
                }
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use std::collections::BTreeMap;

    use super::*;
    use crate::results::Figures;
    use crate::results::TipShares;

    fn group(scenes: &str, settings: &[(&str, &str)], passed: usize) -> SweepGroup {
        let run = |passed| Figures {
            ending: Ending::Completed,
            passed,
            passed_but_for_tips: passed,
            collided: false,
            slipped: false,
            coverage: Some(1.0),
            error_mean_mm: Some(0.02),
            error_p95_mm: Some(0.05),
            tips: TipShares::default(),
        };
        let settings = settings.iter().map(|(name, value)| ((*name).to_owned(), (*value).to_owned()));
        let tally = Tally::new((0..4).map(|index| run(index < passed)));
        SweepGroup {
            scenes: scenes.to_owned(),
            settings: settings.collect::<BTreeMap<_, _>>(),
            policy: "a.fsm".to_owned(),
            tally,
        }
    }

    #[test]
    fn every_cell_of_a_heat_map_opens_the_runs_of_its_group() {
        let values = ["30 deg", "60 deg"].map(|angle| ["1", "2"].map(|speed| (angle, speed)));
        let groups: Vec<_> = (values.into_iter().flatten().enumerate())
            .map(|(index, (angle, speed))| group("corner", &[("angle", angle), ("speed", speed)], index))
            .collect();
        let page = heat_maps(&groups).into_string();
        for (index, share) in ["0 %", "25 %", "50 %", "75 %"].iter().enumerate() {
            assert!(
                page.contains(&format!("href=\"#group{index}\"")) && page.contains(&format!(">{share}</a>")),
                "{page}"
            );
        }
        assert!(page.contains("--heat:100%") && page.contains("--heat:0%"), "{page}");
    }

    #[test]
    fn a_sweep_with_one_group_has_no_heat_map() {
        assert_eq!(heat_maps(&[group("disk", &[("angle", "1")], 3)]).into_string(), "");
    }
}
