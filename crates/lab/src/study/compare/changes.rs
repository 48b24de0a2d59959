//! Changes of runs since an older report.

use serde_json::Value;

use super::difference::FigureComparison;
use super::figure::figures;

/// The runs of an older report: the documents of `run --json` or `bench --json`.
///
/// Their figures are looked up by name, so that a report by an older version with fewer figures can be read too.
#[derive(Debug, Clone, PartialEq)]
pub struct OlderRuns {
    name: String,
    runs: Vec<Value>,
}

/// The error of a text that is not an older report.
#[derive(Debug, thiserror::Error)]
pub enum OlderRunsError {
    /// The text is not JSON.
    #[error("it is not JSON: {0}")]
    Json(#[from] serde_json::Error),
    /// The document has another format.
    #[error("it is not a list of runs, such as `results.json` of `vibrissa bench --out`")]
    Format,
}

/// The changes of all figures since an older report, over the runs that both have.
#[derive(Debug, Clone, PartialEq)]
pub struct Changes {
    /// Name of the older report.
    pub older: String,
    /// The figures of every policy that both have.
    pub policies: Vec<(String, Vec<FigureComparison>)>,
    /// Number of runs that the older report does not have.
    pub unmatched: usize,
}

/// The keys that identify a run. The hashes are not among them, because a change of the policy is what is compared.
const IDENTITY: [&str; 6] = ["scenario", "policy", "world", "seed", "mismatch", "conditions"];

impl OlderRuns {
    /// Reads the runs of the report with this `name`.
    ///
    /// # Errors
    /// If the text is not a list of runs.
    pub fn read(name: impl Into<String>, text: &str) -> Result<Self, OlderRunsError> {
        let Value::Array(runs) = serde_json::from_str(text)? else { return Err(OlderRunsError::Format) };
        let is_run = |run: &Value| run.get("format").is_some_and(|format| format == "bench" || format == "run");
        if runs.iter().all(is_run) { Ok(Self { name: name.into(), runs }) } else { Err(OlderRunsError::Format) }
    }

    /// The changes since these runs, in the documents of newer ones.
    #[must_use]
    pub fn changes(&self, newer: &[Value]) -> Changes {
        let same = |a: &Value, b: &Value| IDENTITY.iter().all(|key| a.get(key) == b.get(key));
        let pair = |run| self.runs.iter().find(|older| same(older, run)).map(|older| (older, run));
        let pairs: Vec<(&Value, &Value)> = newer.iter().filter_map(pair).collect();
        let mut policies: Vec<&str> = pairs.iter().filter_map(|(_, run)| run.get("policy")?.as_str()).collect();
        policies.dedup();
        policies.sort_unstable();
        policies.dedup();
        let compared = policies.into_iter().map(|policy| {
            let mine = || pairs.iter().filter(|(_, run)| run.get("policy").is_some_and(|name| name == policy));
            let figures = figures().into_iter().filter_map(|figure| {
                let values =
                    mine().filter_map(|(older, run)| Some((figure.in_document(older)?, figure.in_document(run)?)));
                FigureComparison::new(&figure, policy, values.collect())
            });
            (policy.to_owned(), figures.collect())
        });
        Changes { older: self.name.clone(), policies: compared.collect(), unmatched: newer.len() - pairs.len() }
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "a test may panic")]

    use std::sync::Arc;

    use serde_json::json;

    use super::*;
    use crate::results::{Document, figure_in};
    use crate::study::compare::Outlook;
    use crate::trial::Trial;
    use vibrissa_declare::figures::Metric;
    use vibrissa_language as policy;
    use vibrissa_world::scenario;

    use crate::built_in;
    use vibrissa_text::diagnostic::Source;
    use vibrissa_world::scene::WorldKind;

    fn run(scenario: &str, error: f64, outcome: &str) -> Value {
        json!({
            "format": "bench", "scenario": scenario, "policy": "a", "world": "mujoco", "seed": 1, "outcome": outcome,
            "error_mm": {"mean": error}, "collisions": {"count": 0},
        })
    }

    #[test]
    fn runs_are_paired_by_their_names_and_a_run_that_did_not_complete_counts_only_as_that() {
        let older = [run("disk", 0.1, "completed"), run("box", 0.2, "completed"), run("wall", 0.3, "failed")];
        let older = OlderRuns::read("old", &serde_json::to_string(&older).unwrap()).unwrap();
        let newer = [run("wall", 0.1, "completed"), run("disk", 0.05, "completed"), run("prism", 1.0, "completed")];
        let changes = older.changes(&newer);
        let figure = |name: &str| changes.policies[0].1.iter().find(|figure| figure.figure == name).unwrap();
        assert_eq!((figure("error_mm.mean").pairs, figure("error_mm.mean").wins, changes.unmatched), (1, 1, 1));
        assert_eq!((figure("completed").pairs, figure("completed").wins), (2, 1));
        assert_eq!(figure("collisions").outlook, Outlook::Same);
    }

    #[test]
    fn every_figure_of_a_run_is_found_in_its_document() {
        let octagon = built_in::SCENARIOS.iter().find(|file| file.path.ends_with("octagon.yaml")).unwrap();
        let scene = scenario::read(&Source::new(octagon.path, octagon.text)).unwrap();
        let thesis = built_in::POLICIES.iter().find(|file| file.path.ends_with("thesis.fsm")).unwrap();
        let program = policy::compile(&Source::new(thesis.path, thesis.text)).unwrap();
        let mut trial = Trial::new(scene, Arc::new(program));
        trial.world = WorldKind::QuasiStatic.into();
        let run = trial.run().unwrap();
        let (score, result) = (&run.score, trial.document(&run));
        let document = serde_json::to_value(result.versioned(None)).unwrap();
        for metric in Metric::ALL {
            let (figure, read) = (metric.figure(), figure_in(&document, metric));
            assert_eq!(read, result.figure(metric), "{metric:?}");
            assert_eq!(read, figure.key.and(score.figure(metric)).map(|value| value * figure.units()), "{metric:?}");
        }
        let known = figures().into_iter().filter(|figure| figure.of(&result).is_some()).count();
        assert!(known > 12, "the octagon has only {known} figures");
        assert!(figures().iter().all(|figure| figure.in_document(&document) == figure.of(&result)));
    }

    #[test]
    fn other_documents_are_refused() {
        for text in ["{}", "[1]", "[{\"format\": \"sweep-run\"}]", "no"] {
            assert!(OlderRuns::read("old", text).is_err(), "{text}");
        }
    }
}
