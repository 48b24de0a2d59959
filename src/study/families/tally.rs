//! What became of the runs of one family.

use serde::Serialize;

use crate::scene::Outcome;

use super::run::FamilyRun;

/// What became of the runs of one family, or of those at one speed.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct FamilyTally {
    /// The family.
    pub family: &'static str,
    /// The speed (m/s); `None` for all together.
    pub speed: Option<f64>,
    /// How many runs there were.
    pub runs: usize,
    /// How many completed.
    pub completed: usize,
    /// How many completed without a contact of the body.
    pub clean: usize,
    /// How many were not there in time.
    pub timeout: usize,
    /// How many failed.
    pub failed: usize,
    /// How many can no longer be trusted.
    pub diverged: usize,
    /// In how many the body touched something.
    pub collided: usize,
    /// Mean of the runs' mean errors, those that completed (mm).
    pub error_mean_mm: Option<f64>,
    /// Mean of their 95th percentiles (mm).
    pub error_p95_mm: Option<f64>,
}

impl FamilyTally {
    /// Counts the runs of a family: those at one speed, or all.
    #[must_use]
    pub fn new(family: &'static str, speed: Option<f64>, runs: &[FamilyRun]) -> Self {
        let is_counted =
            |run: &&FamilyRun| run.family == family && speed.is_none_or(|speed| (run.speed - speed).abs() < 1e-9);
        let runs: Vec<_> = runs.iter().filter(is_counted).collect();
        let ended = |outcome| runs.iter().filter(|run| run.result.outcome == outcome).count();
        let touches = |run: &&&FamilyRun| run.result.collisions.count > 0;
        let completed = || runs.iter().filter(|run| run.result.outcome == Outcome::Completed);
        Self {
            family,
            speed,
            runs: runs.len(),
            completed: ended(Outcome::Completed),
            clean: runs.iter().filter(|run| run.passed).count(),
            timeout: ended(Outcome::Timeout),
            failed: ended(Outcome::Failed),
            diverged: ended(Outcome::Diverged),
            collided: runs.iter().filter(touches).count(),
            error_mean_mm: mean(completed().filter_map(|run| run.result.error_mm.mean)),
            error_p95_mm: mean(completed().filter_map(|run| run.result.error_mm.p95)),
        }
    }
}

fn mean(figures: impl Iterator<Item = f64>) -> Option<f64> {
    let figures: Vec<f64> = figures.collect();
    (!figures.is_empty()).then(|| figures.iter().sum::<f64>() / figures.len() as f64)
}
