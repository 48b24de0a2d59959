//! Random cases of a property, and the simplest case that fails.

use std::cell::{Cell, RefCell};

use proptest::strategy::{Strategy, ValueTree};
use proptest::test_runner::{
    Config, Reason, RngAlgorithm, TestCaseError, TestError, TestRng, TestRunner, basic_result_cache,
};
use sha2::{Digest, Sha256};

use super::case::Case;
use super::grid::Grid;
use vibrissa_language::ParameterRange;

/// The largest number of passes over all parameters. A later pass shrinks what an earlier one made possible.
const MAX_PASSES: usize = 4;
/// The largest number of runs of one pass.
const MAX_RUNS: u32 = 500;

/// The verdict on one case.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Verdict {
    /// The property holds.
    Holds,
    /// The family has no scene with the values of the case.
    NoScene,
    /// The property does not hold.
    Fails,
}

/// A random case.
#[derive(Debug, Clone, PartialEq)]
pub struct Drawn {
    /// The case.
    pub case: Case,
    steps: Vec<i32>,
}

/// The simplest case that fails.
#[derive(Debug, Clone, PartialEq)]
pub struct Shrunk {
    /// The case.
    pub case: Case,
    /// Number of cases that were tried until it was found.
    pub tried: usize,
}

/// The random cases of a property.
pub struct Search {
    grids: Vec<Grid>,
    runner: TestRunner,
}

impl Search {
    /// The largest number of runs until the simplest case is found.
    pub const MOST_SHRINKING_RUNS: usize = MAX_PASSES * MAX_RUNS as usize;

    /// The cases of a property over these ranges. They depend only on the ranges, the title and the seed.
    pub fn new(ranges: &[ParameterRange], title: &str, seed: u64) -> Self {
        let hash = Sha256::new().chain_update(title).chain_update([0]).chain_update(seed.to_le_bytes()).finalize();
        let config = Config {
            failure_persistence: None,
            max_shrink_iters: MAX_RUNS,
            max_shrink_time: 0,
            result_cache: basic_result_cache,
            verbose: 0,
            ..Config::default()
        };
        let runner = TestRunner::new_with_rng(config, TestRng::from_seed(RngAlgorithm::ChaCha, &hash));
        Self { grids: ranges.iter().map(Grid::new).collect(), runner }
    }

    /// The next case.
    ///
    /// # Errors
    /// The reason of proptest, which has none for these values.
    pub fn draw(&mut self) -> Result<Drawn, Reason> {
        let steps = self.grids.new_tree(&mut self.runner)?.current();
        Ok(Drawn { case: self.case(&steps), steps })
    }

    fn case(&self, steps: &[i32]) -> Case {
        Case::new(self.grids.iter().zip(steps).map(|(grid, &step)| grid.value(step)).collect())
    }

    /// The simplest case that fails, from one that does. Each parameter in turn gets the failing value that is nearest
    /// to its simplest one, until nothing changes. `test` runs a case.
    ///
    /// # Errors
    /// The first error of `test`.
    pub fn shrink<E>(&mut self, failing: Drawn, test: impl Fn(&Case) -> Result<Verdict, E>) -> Result<Shrunk, E> {
        let (fault, tried) = (RefCell::new(None), Cell::new(0));
        let verdict = |steps: &[i32]| {
            tried.set(tried.get() + 1);
            match test(&self.case(steps)) {
                Ok(Verdict::Fails) => Err(TestCaseError::fail("")),
                Ok(Verdict::Holds | Verdict::NoScene) => Ok(()),
                Err(error) => {
                    fault.borrow_mut().get_or_insert(error);
                    Ok(())
                }
            }
        };
        let mut runner = self.runner.clone();
        let mut steps = failing.steps;
        for _ in 0..MAX_PASSES {
            let grids = self.grids.iter().zip(&steps).map(|(grid, &step)| grid.beginning_at(step));
            let Ok(tree) = grids.collect::<Vec<_>>().new_tree(&mut runner) else { break };
            // The first run of a pass fails, unless the policy depends on chance.
            let Err(TestError::Fail(_, simpler)) = runner.run_one(tree, |steps| verdict(&steps)) else { break };
            let is_done = simpler == steps;
            steps = simpler;
            if is_done || fault.borrow().is_some() {
                break;
            }
        }
        match fault.take() {
            Some(error) => Err(error),
            None => Ok(Shrunk { case: self.case(&steps), tried: tried.get() }),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::convert::Infallible;
    use vibrissa_declare::catalogue::convex_corner::ENTRY;

    fn ranges() -> Vec<ParameterRange> {
        let range = |parameter: &'static vibrissa_declare::catalogue::Parameter| {
            let (low, high) = parameter.range;
            ParameterRange { parameter, low, high }
        };
        ENTRY.parameters.iter().map(range).collect()
    }

    fn value(case: &Case, name: &str) -> f64 {
        let found = case.values().iter().find(|(parameter, _)| parameter.name == name);
        found.map_or(f64::NAN, |(_, value)| *value)
    }

    fn shrunk(fails: impl Fn(&Case) -> bool) -> Shrunk {
        let mut search = Search::new(&ranges(), "title", 1);
        let failing = std::iter::repeat_with(|| search.draw()).take(1000).flatten().find(|drawn| fails(&drawn.case));
        let failing = failing.unwrap_or_else(|| panic!("no case fails"));
        let test = |case: &Case| Ok::<_, Infallible>(if fails(case) { Verdict::Fails } else { Verdict::Holds });
        search.shrink(failing, test).unwrap_or_else(|never| match never {})
    }

    #[test]
    fn a_case_shrinks_to_the_boundary_of_its_failure_and_everything_else_to_the_simplest_value() {
        let limit = 40_f64.to_radians();
        let Shrunk { case, tried } = shrunk(|case| value(case, "angle") < limit);
        assert_eq!(case.notable(&ranges()), "angle = 39.5 deg");
        assert!(tried < 60, "{tried}");
    }

    #[test]
    fn what_one_parameter_makes_possible_for_another_is_found_by_a_later_pass() {
        // The first parameter can reach 0 only after the last one is at its simplest value.
        let fails = |case: &Case| {
            let (x, angle) = (value(case, "start_x"), value(case, "angle"));
            x.abs() > 5e-3 * (angle - 90_f64.to_radians()).abs() || x == 0.0
        };
        let shrunk = shrunk(fails);
        assert_eq!(shrunk.case.notable(&ranges()), "the simplest scene");
    }

    #[test]
    fn cases_depend_on_the_title_and_the_seed_and_on_nothing_else() {
        let first = |title: &str, seed| Search::new(&ranges(), title, seed).draw().ok();
        assert!(first("a", 1).is_some());
        assert_eq!(first("a", 1), first("a", 1));
        assert_ne!(first("a", 1), first("b", 1));
        assert_ne!(first("a", 1), first("a", 2));
    }
}
