//! The search for witnesses and proofs. It splits regions until interval analysis decides a region, or the real
//! evaluator confirms a point.

use std::collections::VecDeque;

use vibrissa_runtime::machine::{Register, compute};

use super::bounds::Bounds;
use super::model::{Condition, Model};
use super::point::{Choice, Point};
use super::region::Region;
use super::unknown::Unknown;

/// The maximum number of regions per search.
const REGION_LIMIT: usize = 400;
/// The cost of a region in addition to its operations, in operations.
const REGION_WORK: usize = 50;
/// The maximum number of operations of all searches of a policy together, which bounds the time of analysis.
const WORK_LIMIT: usize = 1_000_000;

/// A disjunction of wanted conditions. The goal is met if at least one of them is as wanted.
#[derive(Clone)]
pub(super) struct Goal<'a> {
    pub(super) any: Vec<Wanted<'a>>,
}

/// A condition, with the wanted value: true or false.
#[derive(Clone, Copy)]
pub(super) struct Wanted<'a> {
    pub(super) condition: Condition<'a>,
    pub(super) truth: bool,
}

impl<'a> Goal<'a> {
    pub(super) fn holds(condition: Condition<'a>) -> Self {
        Self { any: vec![Wanted { condition, truth: true }] }
    }

    pub(super) fn fails(condition: Condition<'a>) -> Self {
        Self { any: vec![Wanted { condition, truth: false }] }
    }

    /// Adds the alternative that one of some conditions holds.
    pub(super) fn or_any_holds(mut self, conditions: impl IntoIterator<Item = Condition<'a>>) -> Self {
        self.any.extend(conditions.into_iter().map(|condition| Wanted { condition, truth: true }));
        self
    }
}

/// Accepts a point, given the registers of a machine there. It may execute the program once.
pub(super) type Accept<'a> = dyn Fn(&Point, Vec<f64>) -> bool + 'a;

/// The result of a search.
enum Outcome {
    /// A point at which every goal is met.
    Witness(Point),
    /// A proof that there is no such point.
    Excluded,
    /// No result within the limits.
    Inconclusive,
}

/// The purpose of a search.
#[derive(Clone, Copy)]
enum Purpose<'a> {
    /// A proof that no point meets the goals.
    Proof,
    /// A point that meets the goals and is accepted.
    Witness(Option<&'a Accept<'a>>),
}

/// A search with its caches and its budget.
pub(super) struct Search<'m> {
    pub(super) model: &'m Model<'m>,
    pub(super) bounds: Bounds<'m>,
    registers: Vec<f64>,
}

impl<'m> Search<'m> {
    pub(super) fn new(model: &'m Model<'m>) -> Self {
        Self { model, bounds: Bounds::new(model), registers: model.program.initial_registers.clone() }
    }

    /// True if the budget of operations is used up.
    pub(super) fn is_exhausted(&self) -> bool {
        self.bounds.work > WORK_LIMIT
    }

    /// True if it is proved that no point meets every goal.
    pub(super) fn excludes(&mut self, goals: &[Goal<'_>]) -> bool {
        matches!(self.find(goals, Purpose::Proof), Outcome::Excluded)
    }

    /// A point at which every goal is met and that `accept` accepts, if it is given. `None` also if the search is
    /// inconclusive.
    pub(super) fn witness(&mut self, goals: &[Goal<'_>], accept: Option<&Accept<'_>>) -> Option<Point> {
        match self.find(goals, Purpose::Witness(accept)) {
            Outcome::Witness(point) => Some(point),
            Outcome::Excluded | Outcome::Inconclusive => None,
        }
    }

    fn find(&mut self, goals: &[Goal<'_>], purpose: Purpose<'_>) -> Outcome {
        let mut open = VecDeque::from([Region::whole(self.model)]);
        let (mut looked_at, mut is_unclear) = (0, false);
        while let Some(mut region) = open.pop_front() {
            looked_at += 1;
            if looked_at > REGION_LIMIT || self.is_exhausted() {
                return Outcome::Inconclusive;
            }
            if !self.may_meet(goals, &mut region) {
                continue;
            }
            let accept = match purpose {
                // No point of this region or of its parts determines the result.
                Purpose::Witness(_) if region.is_partial => {
                    is_unclear = true;
                    continue;
                }
                Purpose::Witness(accept) => accept,
                Purpose::Proof => None,
            };
            if !region.is_partial {
                for choice in [Choice::Plain, Choice::Inside, Choice::Middle, Choice::Low, Choice::High] {
                    let point = Point::of(&region, self.model, choice);
                    if self.meets(goals, &point) && self.accepts(&point, accept) {
                        return Outcome::Witness(point);
                    }
                }
            }
            match region.split() {
                Some(halves) => open.extend(halves),
                None => is_unclear = true,
            }
        }
        if is_unclear { Outcome::Inconclusive } else { Outcome::Excluded }
    }

    /// Narrows a region to the points at which all goals may be met. False if there are none. Goals of earlier calls
    /// for the region must come first, in the same order.
    pub(super) fn may_meet(&mut self, goals: &[Goal<'_>], region: &mut Region<'_>) -> bool {
        self.bounds.work += REGION_WORK;
        // Twice, because the narrowing by one goal can permit more narrowing by another.
        goals.iter().enumerate().chain(goals.iter().enumerate()).all(|goal| self.narrow(goal, region))
    }

    /// Narrows a region by a goal. False if nothing remains. Omitted evaluations of settled goals count as work, so
    /// that limits do not depend on the cache.
    fn narrow(&mut self, (index, goal): (usize, &Goal<'_>), region: &mut Region<'_>) -> bool {
        if let Some(work) = region.begin(index) {
            self.bounds.work += work;
            return true;
        }
        let before = self.bounds.work;
        let has_any = self.bounds.narrow(goal, region);
        region.end(index, self.bounds.work - before);
        has_any
    }

    /// True if the real evaluator confirms every goal at a point.
    pub(super) fn meets(&mut self, goals: &[Goal<'_>], point: &Point) -> bool {
        let program = self.model.program;
        let mut senses = point.clone();
        self.enter(point);
        let mut is_met = |wanted: &Wanted<'_>| {
            self.bounds.work += wanted.condition.code.len() + 1;
            compute(&program.code, wanted.condition.code, &mut self.registers, &mut senses);
            let truth = self.registers[usize::from(wanted.condition.truth)] > 0.5;
            truth == wanted.truth
        };
        let met = goals.iter().all(|goal| goal.any.iter().any(&mut is_met));
        self.leave(point);
        met
    }

    /// True if a point is accepted, or if there is no `accept`.
    pub(super) fn accepts(&mut self, point: &Point, accept: Option<&Accept<'_>>) -> bool {
        let Some(accept) = accept else { return true };
        self.bounds.work += self.model.program.code.len();
        accept(point, self.registers(point))
    }

    /// The registers of a machine at a point.
    pub(super) fn registers(&mut self, point: &Point) -> Vec<f64> {
        self.enter(point);
        let registers = self.registers.clone();
        self.leave(point);
        registers
    }

    fn enter(&mut self, point: &Point) {
        self.put(point, |_, value| value);
    }

    fn leave(&mut self, point: &Point) {
        let image = &self.model.program.initial_registers;
        self.put(point, |register, _| image[usize::from(register)]);
    }

    fn put(&mut self, point: &Point, value: impl Fn(Register, f64) -> f64) {
        for (unknown, known) in point.values() {
            if let Unknown::Register(register) = unknown {
                self.registers[usize::from(register)] = value(register, known);
            }
        }
    }
}
