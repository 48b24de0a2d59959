//! The claims of the baseline beside measured figures.

use std::fmt::Write as _;

use super::table::Show::{Fixed, Plain};
use super::table::{NoKey, Show, markdown, number, text, value};
use crate::json::Json;

/// A claim of the baseline's report about a run in a scene.
struct Claim {
    /// The section of the report.
    section: &'static str,
    statement: &'static str,
    scene: &'static str,
    /// The path of the figure in the result of a run, and its form.
    figure: (&'static str, Show),
    /// The figure in the report. Empty if the report has none.
    report: &'static str,
    /// The figure of the published program in a repeated run, against exact geometry. Empty if it was not measured.
    program: &'static str,
    holds_if: Condition,
}

/// The condition under which a claim holds. The run must also be complete.
enum Condition {
    /// The figure is at most this.
    AtMost(f64),
    /// The figure is exactly this.
    Is(f64),
    /// The run is complete.
    Complete,
}

use Condition::{AtMost, Complete, Is};

/// Mean distance of the recorded tips from the outline (mm).
const ERROR: (&str, Show) = ("error_mm.mean", Fixed(2));
const RADIUS: (&str, Show) = ("retrieval.radius_mm.mean", Fixed(1));
const RETRIEVALS: (&str, Show) = ("retrieval.count", Plain);
const AXIS: (&str, Show) = ("axis_mm.mean", Fixed(1));
const TIME: (&str, Show) = ("corners.time_s.mean", Fixed(1));
const PATH: (&str, Show) = ("corners.path_m.mean", Fixed(2));
const CONTACTS: (&str, Show) = ("collisions.count", Plain);
const OUTCOME: (&str, Show) = ("outcome", Plain);

const fn claim(
    section: &'static str,
    statement: &'static str,
    scene: &'static str,
    figure: (&'static str, Show),
    [report, program]: [&'static str; 2],
    holds_if: Condition,
) -> Claim {
    Claim { section, statement, scene, figure, report, program, holds_if }
}

/// The claims about contour following.
const FOLLOWING: [Claim; 7] = [
    claim("5.1", "disk: error, mm", "disk", ERROR, ["0.8", "0.80"], AtMost(0.8)),
    claim("5.1", "rounded rectangle: error, mm", "rounded-rectangle", ERROR, ["0.8", "0.63"], AtMost(0.8)),
    claim("5.1", "complex object: error, mm", "complex", ERROR, ["0.8", "0.85"], AtMost(0.8)),
    claim(
        "5.1",
        "complex object: no detachment in turns of 30°, retrievals",
        "complex",
        RETRIEVALS,
        ["0", "0"],
        Is(0.0),
    ),
    claim("5.1", "turns of 30°: retrievals", "dodecagon", RETRIEVALS, ["0", ""], Is(0.0)),
    claim("5.1", "turns of 20°: retrievals", "turns-of-20", RETRIEVALS, ["0", ""], Is(0.0)),
    claim("5.1", "turns of 10°: retrievals", "turns-of-10", RETRIEVALS, ["0", ""], Is(0.0)),
];

/// The claims about retrieval. A radius below 30 mm is acceptable to the report.
const RETRIEVAL: [Claim; 18] = [
    claim("5.2", "octagon, 45°: error, mm", "octagon", ERROR, ["1.1", "0.87"], AtMost(1.1)),
    claim("5.2", "octagon: retrievals", "octagon", RETRIEVALS, ["8", "8"], Is(8.0)),
    claim("5.2", "octagon: retrieval radius, mm", "octagon", RADIUS, ["20.9", ""], AtMost(30.0)),
    claim("5.2", "octagon: time per corner, s", "octagon", TIME, ["", "6.2 to 7.5"], AtMost(7.5)),
    claim("5.2", "octagon: path per corner, m", "octagon", PATH, ["", "0.23 to 0.40"], AtMost(0.40)),
    claim("5.2", "box, 90°: error, mm", "box", ERROR, ["0.7", "0.47"], AtMost(0.7)),
    claim("5.2", "box: retrieval radius, mm", "box", RADIUS, ["11.2", ""], AtMost(30.0)),
    claim("5.2", "box: time per corner, s", "box", TIME, ["", "7.2 to 8.1"], AtMost(8.1)),
    claim("5.2", "box: path per corner, m", "box", PATH, ["", "0.23 to 0.40"], AtMost(0.40)),
    claim("5.2", "prism, 120°: error, mm", "prism", ERROR, ["0.8", "0.54"], AtMost(0.8)),
    claim("5.2", "prism: retrieval radius, mm", "prism", RADIUS, ["8.8", ""], AtMost(30.0)),
    claim("5.2", "prism: time per corner, s", "prism", TIME, ["", "8.8 to 10.1"], AtMost(10.1)),
    claim("5.2", "prism: path per corner, m", "prism", PATH, ["", "0.23 to 0.40"], AtMost(0.40)),
    claim("5.2", "wall of 10 mm: error, mm", "wall", ERROR, ["1.1", "0.90"], AtMost(1.1)),
    claim("5.2", "wall of 10 mm: retrieval radius, mm", "wall", RADIUS, ["10.2", ""], AtMost(30.0)),
    claim("5.2", "wall of 10 mm: time per corner, s", "wall", TIME, ["", "7.5 to 9.3"], AtMost(9.3)),
    claim("5.2", "wall a quarter thinner", "thin-wall", OUTCOME, ["handled", ""], Complete),
    claim("5.2", "wall a quarter shorter", "short-wall", OUTCOME, ["handled", ""], Complete),
];

/// The claims about tunnels. All have a width of about 22 cm (7.1).
const TUNNELING: [Claim; 12] = [
    claim("5.3", "smooth tunnel: error, mm", "smooth-tunnel", ERROR, ["1.3", "0.73"], AtMost(1.3)),
    claim("5.3", "smooth tunnel: distance from the axis, mm", "smooth-tunnel", AXIS, ["4", ""], AtMost(4.0)),
    claim("5.3", "zigzag tunnel: error, mm", "zigzag-tunnel", ERROR, ["2", "1.27"], AtMost(2.0)),
    claim("5.3", "zigzag tunnel: distance from the axis, mm", "zigzag-tunnel", AXIS, ["9", ""], AtMost(9.0)),
    claim("5.3", "zigzag tunnel: contacts of the body", "zigzag-tunnel", CONTACTS, ["1", ""], AtMost(1.0)),
    claim("5.3", "round tunnel: error, mm", "round-tunnel", ERROR, ["3", "2.48"], AtMost(3.0)),
    claim("5.3", "round tunnel: distance from the axis, mm", "round-tunnel", AXIS, ["5", ""], AtMost(5.0)),
    claim("5.3", "tunnel with turns of 40°", "steep-tunnel", OUTCOME, ["passed", "stops"], Complete),
    claim("5.3", "tunnel with turns of 40°: contacts of the body", "steep-tunnel", CONTACTS, ["1", ""], AtMost(1.0)),
    claim("5.3", "tunnel with turns of 20° and 40°", "mixed-tunnel", OUTCOME, ["passed", ""], Complete),
    claim("5.3", "tunnel with turns of 20° and 40°: error, mm", "mixed-tunnel", ERROR, ["2", ""], AtMost(2.0)),
    claim("5.3", "smooth tunnel: contacts of the body", "smooth-tunnel", CONTACTS, ["0", ""], Is(0.0)),
];

/// The policies of the page. The claims are those of the first one.
const POLICIES: [&str; 2] = ["thesis", "vibrissa"];

impl Claim {
    fn holds(&self, run: &Json) -> Result<bool, NoKey> {
        let figure = number(run, self.figure.0)?;
        let is_met = match self.holds_if {
            AtMost(most) => figure <= most,
            #[expect(clippy::float_cmp, reason = "counts")]
            Is(count) => figure == count,
            Complete => true,
        };
        Ok(is_met && text(run, "outcome")? == "completed")
    }

    fn row(&self, runs: &[Json]) -> Result<Vec<String>, NoKey> {
        let cell = |text: &str| if text.is_empty() { "–".to_owned() } else { text.to_owned() };
        let mut row = vec![self.section.to_owned(), self.statement.to_owned(), cell(self.report), cell(self.program)];
        for policy in POLICIES {
            let figure = value(run_of(runs, self.scene, policy)?, self.figure.0)?;
            // A run without retrievals has no figures of them.
            let is_none = matches!(self.holds_if, Is(_)) && *figure == Json::Null;
            row.push(if is_none { "0".to_owned() } else { self.figure.1.text(figure) });
        }
        let holds = self.holds(run_of(runs, self.scene, POLICIES[0])?)?;
        row.push(if holds { "yes" } else { "no" }.to_owned());
        Ok(row)
    }
}

/// The run of a scene under a policy.
fn run_of<'a>(runs: &'a [Json], scene: &str, policy: &str) -> Result<&'a Json, NoKey> {
    let is_it = |run: &&Json| text(run, "scenario") == Ok(scene) && text(run, "policy") == Ok(policy);
    runs.iter().find(is_it).ok_or_else(|| NoKey(format!("{scene} under {policy}")))
}

fn claims(runs: &[Json], claims: &[Claim]) -> Result<String, NoKey> {
    let headings =
        ["section", "claim", "report", "program, repeated", "`thesis.fsm`", "`vibrissa.fsm`", "`thesis.fsm` holds"];
    let rows = claims.iter().map(|claim| claim.row(runs)).collect::<Result<Vec<_>, _>>()?;
    Ok(markdown(&headings.map(str::to_owned), &rows))
}

/// The corners of different angles: the results of both policies.
fn corners(groups: &[Json]) -> Result<String, NoKey> {
    let mut angles = Vec::new();
    for group in groups {
        let angle = text(group, "settings.angle")?;
        if !angles.contains(&angle) {
            angles.push(angle);
        }
    }
    let mut rows = Vec::new();
    for angle in angles {
        let mut row = vec![angle.to_owned()];
        for policy in POLICIES {
            let is_it =
                |group: &&Json| text(group, "settings.angle") == Ok(angle) && text(group, "policy") == Ok(policy);
            let group = groups.iter().find(is_it).ok_or_else(|| NoKey(format!("{angle} under {policy}")))?;
            let result = match (number(group, "passed")? > 0.0, number(group, "completed")? > 0.0) {
                (true, _) => "passed",
                (false, true) => "ended",
                (false, false) => "not completed",
            };
            row.extend([result.to_owned(), Fixed(2).text(value(group, "error_mean_mm")?)]);
        }
        rows.push(row);
    }
    let headings = ["turn", "`thesis.fsm`", "its error, mm", "`vibrissa.fsm`", "its error, mm"];
    Ok(markdown(&headings.map(str::to_owned), &rows))
}

/// The page, from the runs of all scenes, a sweep of corners, and a run with the doubled radius.
pub(super) fn page(outputs: &[Json]) -> Result<String, NoKey> {
    let runs: Vec<Json> = outputs[..3].iter().flat_map(Json::items).cloned().collect();
    let mut page = String::from(
        "\n*Report* is the baseline's published figure. *Program, repeated* is its published program, run again and compared with exact geometry. A dash \
         means that there is no figure. The last column says whether the run of `thesis.fsm` is complete and its figure is at most that of the report or program.\n\
         [Departures](../baseline-departures.md) lists where `thesis.fsm` differs from the report.\n",
    );
    for (title, list) in [("Contour following", &FOLLOWING[..]), ("Retrieval", &RETRIEVAL), ("Tunnels", &TUNNELING)] {
        let _ = write!(page, "\n## {title}\n\n{}", claims(&runs, list)?);
    }
    let groups = value(&outputs[3], "groups")?.items();
    let _ = write!(
        page,
        "\n## Corners of all angles\n\nThe report claims turns of 30° to 180° (1.3, 4.6). Each run goes around an object with one corner of the given turn, and \
         around the other corners of the object. A passed run has traced the whole object, its body touched nothing, and no tip is more than 2 mm off. A run that ended met only its stop condition.\n\n{}",
        corners(groups)?
    );
    let doubled = outputs[4].items().first().ok_or_else(|| NoKey("the run with the doubled radius".to_owned()))?;
    let _ = write!(
        page,
        "\n## The doubled radius\n\nWith twice the retrieval radius, the report's platform cannot detect the wall (5.2). `thesis.fsm` with `radius=20mm`: {}.\n",
        text(doubled, "outcome")?
    );
    Ok(page)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn run(text: &str) -> Vec<Json> {
        Json::read(text).map(|json| json.items().to_vec()).unwrap_or_default()
    }

    #[test]
    fn a_claim_holds_only_if_the_run_is_complete_and_its_figure_is_good_enough() {
        let error = claim("5.1", "disk: error, mm", "disk", ERROR, ["0.8", ""], AtMost(0.8));
        for (outcome, mean, holds) in [
            ("completed", 0.8, true),
            ("completed", 0.81, false),
            ("ended", 0.1, false),
            ("timeout", 0.1, false),
            ("failed", 0.1, false),
        ] {
            let runs = run(&format!(
                r#"[{{"scenario": "disk", "policy": "vibrissa", "outcome": "completed", "error_mm": {{"mean": 0.02}}}},
                    {{"scenario": "disk", "policy": "thesis", "outcome": "{outcome}", "error_mm": {{"mean": {mean}}}}}]"#
            ));
            let row = error.row(&runs).unwrap_or_default();
            assert_eq!(row.last().map(String::as_str), Some(if holds { "yes" } else { "no" }), "{row:?}");
            assert_eq!(row[..4], ["5.1", "disk: error, mm", "0.8", "–"]);
        }
    }

    #[test]
    fn a_scene_that_was_not_run_is_an_error() {
        assert_eq!(run_of(&[], "disk", "thesis"), Err(NoKey("disk under thesis".to_owned())));
    }
}
