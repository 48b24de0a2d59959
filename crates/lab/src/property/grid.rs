//! The values of one parameter that a property tries.

use proptest::strategy::{NewTree, Strategy, ValueTree};
use proptest::test_runner::TestRunner;

use vibrissa_declare::catalogue::Parameter;
use vibrissa_language::ParameterRange;
use vibrissa_runtime::units::parse_quantity;

/// The fewest steps of a range of a continuous parameter.
const FEWEST: f64 = 16.0;

/// The values of a parameter in steps from the simplest one. Step 0 is the simplest value of the range.
#[derive(Debug, Clone, Copy)]
pub(super) struct Grid {
    parameter: &'static Parameter,
    simplest: f64,
    step: f64,
    least: i32,
    most: i32,
    /// The step at which a search begins. `None` for a random one.
    begin: Option<i32>,
}

impl Grid {
    /// The values in a range.
    pub(super) fn new(range: &ParameterRange) -> Self {
        let ParameterRange { parameter, low, high } = *range;
        let simplest = parameter.simplest.clamp(low, high);
        let fine = (high - low) / FEWEST;
        let step = if parameter.is_stepped || fine == 0.0 { parameter.step } else { parameter.step.min(fine) };
        // A range ends at a step, but not after rounding.
        let steps = |width: f64| {
            #[expect(clippy::cast_possible_truncation, reason = "a cast saturates, and ranges have few steps")]
            let steps = (width / step + 1e-6).floor() as i32;
            steps
        };
        Self { parameter, simplest, step, least: -steps(simplest - low), most: steps(high - simplest), begin: None }
    }

    /// The same values with a search that begins at a step.
    pub(super) fn beginning_at(self, step: i32) -> Self {
        Self { begin: Some(step), ..self }
    }

    /// The parameter and its value (SI) at a step. It is the value of its own text, so that the text repeats the run.
    pub(super) fn value(&self, step: i32) -> (&'static Parameter, f64) {
        let value = self.simplest + f64::from(step) * self.step;
        (self.parameter, parse_quantity(&self.parameter.text(value)).map_or(value, |quantity| quantity.value_si))
    }
}

impl Strategy for Grid {
    type Tree = Bisection;
    type Value = i32;

    fn new_tree(&self, runner: &mut TestRunner) -> NewTree<Self> {
        let failing = match self.begin {
            Some(step) => step,
            None => (self.least..=self.most).new_tree(runner)?.current(),
        };
        Ok(Bisection { current: failing, failing, passing: None })
    }
}

/// A search for the failing step that is nearest to step 0. It tries step 0 first, and then bisects.
#[derive(Debug, Clone, Copy)]
pub(super) struct Bisection {
    current: i32,
    /// The simplest step that failed.
    failing: i32,
    /// The nearest simpler step that passed.
    passing: Option<i32>,
}

impl Bisection {
    /// The next step to try, if there is one between the passing and the failing step.
    fn next(&self) -> Option<i32> {
        match self.passing {
            None => (self.failing != 0).then_some(0),
            Some(passing) => {
                // The midpoint, rounded towards the passing step. Both are on one side of step 0.
                let middle = passing + (self.failing - passing) / 2;
                (middle != passing).then_some(middle)
            }
        }
    }
}

impl ValueTree for Bisection {
    type Value = i32;

    fn current(&self) -> i32 {
        self.current
    }

    /// The current step failed.
    fn simplify(&mut self) -> bool {
        self.failing = self.current;
        let next = self.next();
        self.current = next.unwrap_or(self.failing);
        next.is_some()
    }

    /// The current step passed.
    fn complicate(&mut self) -> bool {
        if self.current == self.failing {
            return false;
        }
        self.passing = Some(self.current);
        self.current = self.next().unwrap_or(self.failing);
        true
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;
    use vibrissa_declare::catalogue;

    fn range(name: &str, low: f64, high: f64) -> ParameterRange {
        let parameter = catalogue::entry("convex-corner").and_then(|entry| entry.parameter(name));
        ParameterRange { parameter: parameter.unwrap_or_else(|| panic!("there is no {name}")), low, high }
    }

    proptest! {
        #[test]
        fn all_values_are_in_the_range_and_the_simplest_is_among_them(ends: [f64; 2], seed: [u8; 32]) {
            let parameter = catalogue::convex_corner::ANGLE;
            let (low, high) = parameter.limits;
            let within = |share: f64| low + share.abs().fract() * (high - low);
            let ends = ends.map(within);
            let (low, high) = (ends[0].min(ends[1]), ends[0].max(ends[1]));
            prop_assume!(low.is_finite() && high.is_finite());
            let grid = Grid::new(&range("angle", low, high));
            let rng = proptest::test_runner::TestRng::from_seed(proptest::test_runner::RngAlgorithm::ChaCha, &seed);
            let tree = grid.new_tree(&mut TestRunner::new_with_rng(ProptestConfig::default(), rng));
            let tree = tree.map_err(|cause| TestCaseError::fail(cause.to_string()))?;
            // A text has six digits.
            for step in [grid.least, grid.most, 0, tree.current()] {
                let value = grid.value(step).1;
                prop_assert!((low - 1e-5..=high + 1e-5).contains(&value), "{value} not in {low} .. {high}");
            }
            prop_assert!((grid.value(0).1 - parameter.simplest.clamp(low, high)).abs() < 1e-5);
        }

        #[test]
        fn a_search_ends_at_the_failing_step_nearest_to_zero(boundary in 0..1000, excess in 0..1000, sign: bool) {
            let sign = if sign { 1 } else { -1 };
            let fails = |step: i32| step * sign >= boundary;
            let start = sign * (boundary + excess);
            let mut tree = Bisection { current: start, failing: start, passing: None };
            let mut runs = 0;
            let mut more = tree.simplify();
            while more {
                runs += 1;
                more = if fails(tree.current()) { tree.simplify() } else { tree.complicate() };
            }
            prop_assert_eq!(tree.current(), sign * boundary);
            prop_assert!(runs <= 14);
        }
    }

    #[test]
    fn stepped_parameters_have_only_their_own_values() {
        let grid = Grid::new(&range("side", -1.0, 1.0));
        assert_eq!((grid.least, grid.most), (-1, 0));
        assert_eq!((grid.value(-1).1, grid.value(0).1), (-1.0, 1.0));
        let angle = Grid::new(&range("angle", 30_f64.to_radians(), 150_f64.to_radians()));
        assert_eq!((angle.least, angle.most), (-120, 120));
        assert_eq!(angle.parameter.text(angle.value(-101).1), "39.5 deg");
    }
}
