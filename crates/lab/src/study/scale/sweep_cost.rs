//! The cost of a sweep of a million runs.

use serde::Serialize;

/// Number of runs of the sweep, the most that one may have, and of the jobs of the array. Slurm allows arrays of 1000 jobs
/// unless it is set otherwise.
pub(super) const RUNS: usize = 1_000_000;
const JOBS: usize = 1000;

/// The cost of a sweep in a simulator, derived from the cost of one run, one line of results and one job.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct SweepCost {
    /// The simulator.
    pub simulator: String,
    /// Number of runs.
    pub runs: usize,
    /// Number of jobs of an array with one shard each.
    pub jobs: usize,
    /// Processor time of a run of the disk of the bench, with its line of results.
    pub run_ms: f64,
    /// Size of the line.
    pub line_bytes: usize,
    /// Wall time of a job without the time of its runs.
    pub job_start_s: f64,
    /// Time of all runs on one processor.
    pub processor_hours: f64,
    /// Time of all runs on all processors of the machine.
    pub machine_hours: f64,
    /// Time of a job, if all run at a time on processors of their own.
    pub array_minutes: f64,
    /// Processor time of the merge.
    pub merge_minutes: f64,
    /// Size of all results.
    pub results_gb: f64,
}

/// The measured costs.
#[derive(Debug, Clone, Copy)]
pub(super) struct UnitCosts {
    /// Processor time of a run (s).
    pub(super) run: f64,
    /// Size of its line of results with the end of the line (bytes).
    pub(super) line: usize,
    /// Wall time of a job without runs (s).
    pub(super) job: f64,
    /// Processor time of the merge of a line (s).
    pub(super) merge: f64,
    /// Ratio of the time on one processor to that on all.
    pub(super) speedup: f64,
}

impl SweepCost {
    pub(super) fn new(simulator: String, costs: &UnitCosts) -> Self {
        let runs = RUNS as f64;
        let processor = runs * costs.run;
        Self {
            simulator,
            runs: RUNS,
            jobs: JOBS,
            run_ms: 1e3 * costs.run,
            line_bytes: costs.line,
            job_start_s: costs.job,
            processor_hours: processor / 3600.0,
            machine_hours: processor / costs.speedup / 3600.0,
            array_minutes: (costs.job + processor / JOBS as f64) / 60.0,
            merge_minutes: runs * costs.merge / 60.0,
            results_gb: runs * costs.line as f64 / 1e9,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_cost_of_a_million_runs_follows_from_that_of_one() {
        let costs = UnitCosts { run: 0.036, line: 3000, job: 24.0, merge: 6e-5, speedup: 5.0 };
        let cost = SweepCost::new("quasistatic".to_owned(), &costs);
        assert_eq!((cost.processor_hours, cost.machine_hours, cost.array_minutes), (10.0, 2.0, 1.0));
        assert_eq!((cost.merge_minutes, cost.results_gb), (1.0, 3.0));
    }
}
