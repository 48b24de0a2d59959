//! Points: one value for every unknown, as input of the real evaluator.

use std::cell::RefCell;

use vibrissa_runtime::geometry::Vector2;
use vibrissa_runtime::machine::{BodyScalar, ContourVector, Senses, WhiskerScalar, WhiskerVector};

use super::interval::Interval;
use super::model::Model;
use super::region::Region;
use super::unknown::{Domain, Source, Unknown, middle, scalar, vector};

/// One value for every unknown of the guards.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Point {
    values: RefCell<Values>,
    /// The readings, in the order of the first access.
    readings: RefCell<Vec<Reading>>,
}

/// An input that a policy can read.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Reading {
    Time,
    Body(BodyScalar),
    BodyPosition,
    Whisker(usize, WhiskerScalar),
    WhiskerVector(usize, WhiskerVector),
}

/// The unknowns, each with a domain of one value.
#[derive(Debug, Clone, PartialEq, Default)]
struct Values(Vec<(Unknown, Domain)>);

impl Source for Values {
    fn domain(&mut self, unknown: Unknown) -> &Domain {
        let known = self.0.iter().position(|(known, _)| *known == unknown);
        let index = known.unwrap_or_else(|| {
            let value = plain(unknown, &Domain::possible(unknown));
            self.0.push((unknown, single(value)));
            self.0.len() - 1
        });
        &self.0[index].1
    }
}

fn single(value: f64) -> Domain {
    Domain::Values(vec![value])
}

/// The rule by which a point of a region is chosen.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Choice {
    /// The simplest point: default parameters, and all other values as near to zero as possible.
    Plain,
    /// The simplest point, but away from the ends of ranges.
    Inside,
    /// The middle of every range.
    Middle,
    /// The low end of every range.
    Low,
    /// The high end of every range.
    High,
}

impl Point {
    /// A point of a region.
    pub(super) fn of(region: &Region<'_>, model: &Model<'_>, choice: Choice) -> Self {
        let value = |unknown, domain: &Domain| match (domain, choice) {
            (Domain::Range(range), Choice::Inside) => inside(*range, plainest(model, unknown, domain)),
            (Domain::Range(range), Choice::Middle) => middle(*range),
            (Domain::Range(range), Choice::Low) => range.low.max(-f64::MAX),
            (Domain::Range(range), Choice::High) => range.high.min(f64::MAX),
            _ => plainest(model, unknown, domain),
        };
        let values = region.parts.iter().map(|part| (part.unknown, single(value(part.unknown, &part.domain))));
        Self { values: RefCell::new(Values(values.collect())), readings: RefCell::default() }
    }

    /// The unknowns with their values.
    pub(super) fn values(&self) -> Vec<(Unknown, f64)> {
        self.values.borrow().0.iter().map(|(unknown, domain)| (*unknown, domain.hull().low)).collect()
    }

    /// The value of an unknown.
    pub(super) fn value(&self, unknown: Unknown) -> f64 {
        self.values.borrow_mut().range(unknown).low
    }

    /// Changes the value of an unknown.
    pub(super) fn set(&mut self, unknown: Unknown, value: f64) {
        self.readings.get_mut().clear();
        let values = &mut self.values.get_mut().0;
        values.retain(|(known, _)| *known != unknown);
        values.push((unknown, single(value)));
    }

    /// The readings so far.
    pub(super) fn readings(&self) -> Vec<Reading> {
        self.readings.borrow().clone()
    }

    fn read<T>(&self, reading: Reading, read: impl FnOnce(&mut Values) -> T) -> T {
        let mut readings = self.readings.borrow_mut();
        if !readings.contains(&reading) {
            readings.push(reading);
        }
        read(&mut self.values.borrow_mut())
    }
}

/// A number near `value`, but away from the ends of the range, where conditions often fail.
fn inside(range: Interval, value: f64) -> f64 {
    let Interval { low, high, .. } = range;
    let step = (value.abs() / 16.0).max(f64::MIN_POSITIVE).min((high - low) / 4.0);
    value.max(low + step).min(high - step)
}

/// The simplest value of an unknown.
pub(super) fn plainest(model: &Model<'_>, unknown: Unknown, domain: &Domain) -> f64 {
    match (unknown, domain) {
        (Unknown::Register(register), _) => match (model.program.parameters.get(usize::from(register)), domain) {
            (Some(parameter), Domain::Range(range)) => parameter.default.clamp(range.low, range.high),
            (Some(parameter), Domain::Values(values)) if values.contains(&parameter.default) => parameter.default,
            _ => plain(unknown, domain),
        },
        _ => plain(unknown, domain),
    }
}

fn plain(unknown: Unknown, domain: &Domain) -> f64 {
    match domain {
        Domain::Values(values) => values.first().copied().unwrap_or(0.0),
        Domain::Range(range) => {
            // A typical whisker is a decimetre long.
            let usual: f64 = if matches!(unknown, Unknown::Whisker(_, WhiskerScalar::Length)) { 0.1 } else { 0.0 };
            usual.clamp(range.low.min(range.high), range.high)
        }
    }
}

/// The number of a reading at a point.
fn number(range: Interval) -> f64 {
    if range.low > range.high { f64::NAN } else { range.low }
}

impl Senses for Point {
    fn time(&self) -> f64 {
        number(self.read(Reading::Time, |values| values.range(Unknown::Time)))
    }

    fn body(&self, quantity: BodyScalar) -> f64 {
        number(self.read(Reading::Body(quantity), |values| values.range(Unknown::Body(quantity))))
    }

    fn body_position(&self) -> Vector2 {
        let position = |values: &mut Values| [0, 1].map(|axis| number(values.range(Unknown::BodyPosition(axis))));
        self.read(Reading::BodyPosition, position).into()
    }

    fn whisker(&self, whisker: usize, quantity: WhiskerScalar) -> f64 {
        number(self.read(Reading::Whisker(whisker, quantity), |values| scalar(values, whisker, quantity)))
    }

    fn whisker_vector(&self, whisker: usize, quantity: WhiskerVector) -> Vector2 {
        let read = |values: &mut Values| vector(values, whisker, quantity).map(number);
        self.read(Reading::WhiskerVector(whisker, quantity), read).into()
    }

    fn tip_at(&self, _: usize, _: f64) -> Vector2 {
        // Regions that read this are partial, so no point of them is used.
        Vector2::new(f64::NAN, f64::NAN)
    }

    fn loop_closed(&self, _: usize, _: f64, _: f64) -> bool {
        // As for `tip_at`.
        false
    }

    fn contour_at(&self, _: usize, _: f64, _: ContourVector) -> Vector2 {
        // As for `tip_at`.
        Vector2::new(f64::NAN, f64::NAN)
    }

    fn record(&mut self, _: usize) {}

    fn record_position(&mut self, _: usize, _: Vector2) {}
}
