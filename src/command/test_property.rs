//! The properties of `vibrissa test`.

use std::cell::{Cell, RefCell};
use std::collections::BTreeMap;
use std::time::Instant;

use clap::Args;
use serde::Serialize;
use sha2::Sha256;
use vibrissa_runtime::machine::Program;

use super::failure::Failure;
use super::families::drawn_trial;
use super::options::{ArrayOptions, Jobs, WorldOption};
use super::output;
use super::progress::Progress;
use super::trials::{calibrated, report_events, report_violations};
use super::values::{parse_cases, parse_seed};
use vibrissa_declare::catalogue::Entry;
use vibrissa_declare::catalogue::common::SPEED;
use vibrissa_lab::family::{Draw, Family, NoDraw};
use vibrissa_lab::load::{GivenMismatch, with_settings};
use vibrissa_lab::property::{Case, Drawn, Regressions, Search, Shrunk, Verdict};
use vibrissa_lab::results::RunResult;
use vibrissa_lab::trial::{Trial, TrialResult, in_parallel, violations};
use vibrissa_language::{ParameterRange, PolicyTest};
use vibrissa_text::diagnostic::{Diagnostic, Source};

/// The search for a case that violates a property.
#[derive(Debug, Clone, Copy, Args)]
pub(super) struct SearchOptions {
    /// Number of random cases of each property, from 1 to 100000
    #[arg(long, value_name = "N", default_value_t = 20, allow_negative_numbers = true, value_parser = parse_cases)]
    pub(super) cases: usize,
    /// Seed of the random cases. The default is 1. Refused if no property is tested
    #[arg(long, value_name = "S", allow_negative_numbers = true, value_parser = parse_seed)]
    pub(super) seed: Option<u64>,
    /// Do not keep a case that violates a property in the file beside the policy
    #[arg(long)]
    pub(super) no_keep: bool,
}

/// What the command line says about the simulation.
#[derive(Clone, Copy)]
pub(super) struct Simulated<'a> {
    /// The simulator.
    pub(super) world: &'a WorldOption,
    /// The mismatch of the array. All cases of a property have the same array, so that only the scene distinguishes them.
    pub(super) mismatch: &'a GivenMismatch,
    /// The options that gave the mismatch.
    pub(super) options: &'a ArrayOptions,
}

/// A property of a policy that is ready to run.
pub(super) struct Property<'a> {
    test: PolicyTest,
    entry: &'static Entry,
    ranges: Vec<ParameterRange>,
    family: Family,
    program: Program,
    policy_hash: Sha256,
    simulated: Simulated<'a>,
}

/// The cases of a property that were tried.
#[derive(Debug, Serialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
pub(super) struct CasesTried {
    /// The family of the scenes.
    family: &'static str,
    /// Number of random cases with a run.
    cases: usize,
    /// Number of random cases without a scene. They have no run.
    without_scene: usize,
    /// Number of cases that failed earlier and were tried again.
    kept: usize,
    /// Number of runs that made the failing case simpler. 0 for a property that holds.
    shrinking: usize,
    /// All parameters of the simplest case that fails (SI). `null` for a property that holds.
    values: Option<BTreeMap<&'static str, f64>>,
    /// The scenario of this case.
    scenario: Option<String>,
    /// Wall time of all runs (s).
    wall_s: f64,
}

/// The result of a property.
pub(super) struct Tried {
    pub(super) cases: CasesTried,
    /// The simplest case that fails.
    pub(super) failing: Option<Failing>,
}

/// A run that violates a property.
pub(super) struct Failing {
    pub(super) case: Case,
    /// False if the case was kept before.
    pub(super) is_new: bool,
    pub(super) scenario: String,
    pub(super) trial: Trial,
    pub(super) finished: TrialResult,
    pub(super) result: RunResult,
    /// The expectations that do not hold.
    pub(super) faults: Vec<Diagnostic>,
}

impl<'a> Property<'a> {
    pub(super) fn new(
        test: PolicyTest,
        (entry, ranges): (&'static Entry, Vec<ParameterRange>),
        mut program: Program,
        policy_hash: Sha256,
        simulated: Simulated<'a>,
    ) -> Result<Self, Failure> {
        let family = Family::named(entry.name).ok_or_else(|| Failure::NoSuchFamily { name: entry.name.to_owned() })?;
        test.set(&mut program);
        let settings = test.settings.iter().map(|&(index, value)| (program.parameters[index].name.as_str(), value));
        let policy_hash = with_settings(policy_hash, settings);
        Ok(Self { test, entry, ranges, family, program, policy_hash, simulated })
    }

    pub(super) fn title(&self) -> &str {
        &self.test.title
    }

    pub(super) fn family(&self) -> &'static Entry {
        self.entry
    }

    /// Tries the kept cases and then random ones, until one fails, and makes that one simpler.
    pub(super) fn run(
        &self,
        regressions: &Regressions,
        options: SearchOptions,
        jobs: Jobs,
        progress: &mut Progress,
    ) -> Result<Tried, Failure> {
        let start = Instant::now();
        let mut cases = CasesTried {
            family: self.entry.name,
            cases: 0,
            without_scene: 0,
            kept: 0,
            shrinking: 0,
            values: None,
            scenario: None,
            wall_s: 0.0,
        };
        let mut failing = None;
        for case in regressions.cases(self.title(), self.entry, &self.ranges) {
            progress.doing(format_args!("{}: a kept case", self.title()));
            cases.kept += 1;
            if self.verdict(&case)? == Verdict::Fails {
                failing = Some((case, false));
                break;
            }
        }
        if failing.is_none() {
            let mut search = Search::new(&self.ranges, self.title(), options.seed.unwrap_or(1));
            if let Some(drawn) = self.first_failure(&mut search, options.cases, jobs, progress, &mut cases)? {
                let most = Search::MOST_SHRINKING_RUNS;
                progress.begins(format_args!(
                    "{}: a case fails; looking for the simplest one, in {most} runs at most",
                    self.title()
                ));
                let (progress, tries) = (RefCell::new(progress), Cell::new(0_usize));
                let Shrunk { case, tried } = search.shrink(drawn, |case| {
                    tries.set(tries.get() + 1);
                    progress.borrow_mut().besides(format_args!(
                        "{}: run {} of {most} at most, for the simplest case that fails: {}",
                        self.title(),
                        tries.get(),
                        case.notable(&self.ranges)
                    ));
                    self.verdict(case)
                })?;
                cases.shrinking = tried;
                failing = Some((case, true));
            }
        }
        let failing = failing.map(|(case, is_new)| self.failing(case, is_new)).transpose()?;
        if let Some(failing) = &failing {
            let values = failing.case.values().iter();
            cases.values = Some(values.map(|(parameter, value)| (parameter.name, *value)).collect());
            cases.scenario = Some(failing.scenario.clone());
        }
        cases.wall_s = start.elapsed().as_secs_f64();
        Ok(Tried { cases, failing })
    }

    /// The first of `count` random cases that fails. Cases run in parallel.
    fn first_failure(
        &self,
        search: &mut Search,
        count: usize,
        jobs: Jobs,
        progress: &mut Progress,
        cases: &mut CasesTried,
    ) -> Result<Option<Drawn>, Failure> {
        let drawn = std::iter::repeat_with(|| search.draw()).take(count);
        let drawn = drawn.collect::<Result<Vec<_>, _>>().map_err(|cause| Failure::NoCase(cause.to_string()))?;
        let threads = jobs.threads();
        for group in drawn.chunks(threads.count.get()) {
            let run = |drawn: &Drawn| self.verdict(&drawn.case);
            let done = |_: &Result<Verdict, Failure>| progress.done(self.title());
            for (verdict, drawn) in in_parallel(group, jobs.threads(), run, done).into_iter().zip(group) {
                match verdict? {
                    Verdict::NoScene => cases.without_scene += 1,
                    Verdict::Holds => cases.cases += 1,
                    Verdict::Fails => {
                        cases.cases += 1;
                        return Ok(Some(drawn.clone()));
                    }
                }
            }
        }
        if cases.cases == 0 {
            return Err(Failure::NoScenes { title: self.title().to_owned() });
        }
        Ok(None)
    }

    fn verdict(&self, case: &Case) -> Result<Verdict, Failure> {
        let draw = match self.family.scene(&case.given()) {
            Ok(draw) => draw,
            Err(NoDraw::Given { .. }) => return Ok(Verdict::NoScene),
            Err(fault) => return Err(fault.into()),
        };
        let trial = self.trial(&draw)?;
        let result = trial.run().map_err(Failure::execute(&trial))?;
        let holds = violations(&self.test, &trial.program, &result).is_empty();
        Ok(if holds { Verdict::Holds } else { Verdict::Fails })
    }

    fn trial(&self, draw: &Draw) -> Result<Trial, Failure> {
        let Simulated { world, mismatch, .. } = self.simulated;
        let program = (&self.program, &self.policy_hash);
        calibrated(&drawn_trial(draw, program, mismatch, |scene| world.of(scene).into(), 0)?, mismatch)
    }

    /// Runs a case that fails once more, for its report.
    fn failing(&self, case: Case, is_new: bool) -> Result<Failing, Failure> {
        let draw = self.family.scene(&case.given())?;
        let all =
            case.values().iter().map(|(parameter, value)| format!("{} = {}", parameter.name, parameter.text(*value)));
        let all = all.collect::<Vec<_>>().join(", ");
        let speed = SPEED.text(draw.speed);
        let array: String = (self.simulated.options.arguments())
            .flat_map(|argument| [" ".to_owned(), argument.to_string_lossy().into_owned()])
            .collect();
        let scenario = format!(
            "# {}: {}({all})\n# vibrissa run FILE --policy POLICY --set \"speed={speed}\"{array}\n{}",
            self.title(),
            self.entry.name,
            draw.text
        );
        let trial = self.trial(&draw)?;
        let finished = trial.run().map_err(Failure::execute(&trial))?;
        let faults = violations(&self.test, &trial.program, &finished);
        let result = trial.document(&finished);
        Ok(Failing { case, is_new, scenario, trial, finished, result, faults })
    }
}

/// Prints whether a property holds, and the simplest case that fails.
pub(super) fn print_verdict(
    source: &Source,
    property: &Property<'_>,
    cases: &CasesTried,
    failing: Option<&Failing>,
) -> Result<(), Failure> {
    let CasesTried { family, cases, without_scene, kept, shrinking, wall_s, .. } = cases;
    let verdict = if failing.is_none() { "ok    " } else { "FAILED" };
    let mut details = vec![format!("{cases} cases of {family}")];
    if *without_scene > 0 {
        details.push(format!("{without_scene} without a scene"));
    }
    if *kept > 0 {
        details.push(format!("{kept} kept"));
    }
    if *shrinking > 0 {
        details.push(format!("{shrinking} runs to the simplest"));
    }
    let details = details.join(", ");
    output::result(format_args!("{verdict} {}: {} ({details}, in {wall_s:.2} s)", source.name, property.title()))?;
    let Some(Failing { case, scenario, result, finished, faults, .. }) = failing else { return Ok(()) };
    output::message(format_args!("the simplest case that fails: {}", case.notable(&property.ranges)));
    report_events(result);
    report_violations(&result.scenario, finished);
    output::diagnostics(source, faults);
    output::text(scenario)
}
