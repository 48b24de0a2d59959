//! The verdicts of random scenes: which of them passed. The page of the families lists them, and the nightly check reads them there.

use std::collections::BTreeSet;
use std::fmt::Write as _;

use super::table::{NoKey, number, text, value};
use super::tables::names;
use crate::json::Json;

/// The simulators of the page, in the order of its commands.
pub(crate) const SIMULATORS: [&str; 2] = ["Quasi-static simulator", "MuJoCo"];

/// The verdicts of the scenes of one family in one simulator. The scenes have the numbers from 0 on.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) struct Verdicts {
    pub(crate) simulator: String,
    pub(crate) family: String,
    pub(crate) runs: u64,
    /// The numbers of the scenes that did not pass.
    pub(crate) failed: BTreeSet<u64>,
}

/// A page without some verdicts.
#[derive(Debug, PartialEq, Eq, thiserror::Error)]
pub(crate) enum PageError {
    #[error("line {0} cannot be read")]
    Line(usize),
    #[error("there is no list of the scenes of `{family}` that did not pass, {simulator}")]
    NoList { family: String, simulator: String },
    #[error("there are no families")]
    NoFamily,
}

impl Verdicts {
    /// The verdicts of each family, from the output of the program.
    pub(crate) fn of(simulator: &str, runs: &[Json]) -> Result<Vec<Self>, NoKey> {
        let verdicts = names(runs, "family")?.into_iter().map(|family| {
            let mut verdicts =
                Self { simulator: simulator.to_owned(), family: family.to_owned(), runs: 0, failed: BTreeSet::new() };
            for run in runs {
                if text(run, "family")? == family {
                    verdicts.runs += 1;
                    if *value(run, "passed")? != Json::Bool(true) {
                        verdicts.failed.insert(whole(number(run, "trial")?));
                    }
                }
            }
            Ok(verdicts)
        });
        verdicts.collect()
    }

    /// The number of scenes that passed.
    pub(crate) fn passed(&self) -> u64 {
        self.runs - self.failed.len() as u64
    }

    /// The verdicts of the first `runs` scenes.
    pub(crate) fn first(&self, runs: u64) -> Self {
        let failed = self.failed.iter().copied().filter(|&scene| scene < runs).collect();
        Self { runs: runs.min(self.runs), failed, ..self.clone() }
    }

    /// The part of the page that [`Self::published`] reads.
    pub(super) fn list(verdicts: &[Self]) -> String {
        let mut list =
            "Scenes that did not pass, by their trial number:\n\n| family | trials |\n|---|---|\n".to_owned();
        for Self { family, failed, .. } in verdicts {
            let numbers = if failed.is_empty() { "–".to_owned() } else { joined(failed) };
            let _ = writeln!(list, "| `{family}` | {numbers} |");
        }
        list
    }

    /// The verdicts of a page.
    pub(crate) fn published(page: &str) -> Result<Vec<Self>, PageError> {
        let mut found: Vec<(Self, bool)> = Vec::new();
        let mut simulator = "";
        for (number, line) in (1..).zip(page.lines()) {
            if let Some(title) = line.strip_prefix("## ") {
                simulator = title;
            }
            let Some(row) = line.strip_prefix("| `").and_then(|row| row.strip_suffix(" |")) else { continue };
            let unreadable = || PageError::Line(number);
            let (family, cells) = row.split_once("` | ").ok_or_else(unreadable)?;
            if let Some((runs, _)) = cells.split_once(" | ") {
                let runs = runs.parse().map_err(|_| unreadable())?;
                let (simulator, family) = (simulator.to_owned(), family.to_owned());
                found.push((Self { simulator, family, runs, failed: BTreeSet::new() }, false));
                continue;
            }
            let is_it = |(of, _): &&mut (Self, bool)| of.simulator == simulator && of.family == family;
            let (verdicts, is_listed) = found.iter_mut().find(is_it).ok_or_else(unreadable)?;
            let numbers = cells.split(", ").filter(|cell| *cell != "–");
            verdicts.failed = numbers.map(str::parse).collect::<Result<_, _>>().map_err(|_| unreadable())?;
            *is_listed = true;
        }
        if found.is_empty() {
            return Err(PageError::NoFamily);
        }
        let listed = |(verdicts, is_listed): (Self, bool)| {
            let Self { family, simulator, .. } = verdicts.clone();
            if is_listed { Ok(verdicts) } else { Err(PageError::NoList { family, simulator }) }
        };
        found.into_iter().map(listed).collect()
    }
}

/// Numbers in a list.
pub(crate) fn joined<'a>(numbers: impl IntoIterator<Item = &'a u64>) -> String {
    numbers.into_iter().map(ToString::to_string).collect::<Vec<_>>().join(", ")
}

/// A count, which JSON has as a number.
fn whole(number: f64) -> u64 {
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "a number of a scene")]
    let whole = number as u64;
    whole
}

#[cfg(test)]
mod tests {
    use std::fs;
    use std::path::Path;

    use super::*;

    #[test]
    fn the_published_page_has_the_verdicts_behind_its_rates() -> Result<(), PageError> {
        let root = Path::new(env!("CARGO_MANIFEST_DIR")).parent().unwrap_or(Path::new("."));
        let page = fs::read_to_string(root.join("docs/results/families.md")).unwrap_or_default();
        let verdicts = Verdicts::published(&page)?;
        let simulators: BTreeSet<_> = verdicts.iter().map(|verdicts| verdicts.simulator.as_str()).collect();
        assert_eq!(simulators, BTreeSet::from(SIMULATORS));
        for of in &verdicts {
            let Verdicts { simulator, family, runs, failed } = of;
            assert!(failed.iter().all(|scene| scene < runs), "{simulator}, {family}");
            let rate = 100.0 * of.passed() as f64 / *runs as f64;
            let (_, section) = page.split_once(&format!("## {simulator}\n")).unwrap_or_default();
            let row = section.lines().find(|line| line.starts_with(&format!("| `{family}` | "))).unwrap_or_default();
            assert!(row.starts_with(&format!("| `{family}` | {runs} | {rate:.1} | ")), "{simulator}: {row}");
        }
        Ok(())
    }

    #[test]
    fn a_page_without_a_list_is_told() {
        let page = "## MuJoCo\n\n| family | runs | passed, % |\n|---|---|---|\n| `wall` | 2 | 50.0 |\n";
        let error = Verdicts::published(page).map_err(|error| error.to_string());
        assert!(error.is_err_and(|text| text.contains("`wall`") && text.contains("MuJoCo")));
        assert_eq!(Verdicts::published(&format!("{page}\n| `wall` | x |\n")), Err(PageError::Line(7)));
        assert_eq!(Verdicts::published("## MuJoCo\n"), Err(PageError::NoFamily));
        let listed = Verdicts::published(&format!("{page}\n| `wall` | 1 |\n")).unwrap_or_default();
        assert_eq!(listed.iter().map(|of| (of.runs, of.passed())).collect::<Vec<_>>(), [(2, 1)]);
    }

    #[test]
    fn the_first_scenes_have_the_verdicts_that_they_have_among_all() {
        let all = Verdicts { simulator: String::new(), family: String::new(), runs: 9, failed: [1, 4, 8].into() };
        let first = all.first(5);
        assert_eq!((first.runs, first.passed(), joined(&first.failed)), (5, 3, "1, 4".to_owned()));
        assert_eq!(all.first(100), all);
    }
}
