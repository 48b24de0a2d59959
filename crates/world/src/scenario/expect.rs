//! Reader of `expect`.

use super::reader::Reader;
use crate::scene::{Expectation, Outcome, Stop};
use vibrissa_declare::figures::{Bound, Kind, Metric};
use vibrissa_runtime::units::Key;
use vibrissa_yaml::{Entry, Fields};

/// The expectation of every scenario without an outcome in `expect`: its runs complete.
const COMPLETION: Expectation = Expectation::Outcome(Outcome::Completed);

/// The smallest shares of an outline and of a tunnel's walls that are traced in a scenario without `expect`.
const TRACED: (f64, f64) = (0.9, 0.85);

/// The smallest share of what is in reach that is traced by a run with a complete map, and the largest area (m²) that it claims wrongly.
const MAPPED: [(Metric, f64); 2] = [(Metric::CoverageInReach, 0.9), (Metric::MapWrongFreeArea, 0.0)];

/// The largest permitted bound of a number of events.
const MAX_COUNT: u32 = 1_000_000;

/// The expectations of a scenario without `expect`. A run that goes around an object or through a tunnel traces it, one that
/// completes its map has traced what is in reach, and the body touches nothing.
pub(super) fn default(stop: Option<&Stop>) -> Vec<Expectation> {
    let mut expectations = vec![COMPLETION];
    let goals = stop.map_or([None; 2], |stop| {
        let around = stop.loop_closed.map(|_| (Metric::ObjectCoverage, TRACED.0));
        [around, stop.passed.map(|_| (Metric::WallCoverage, TRACED.1))]
    });
    for (metric, bound) in goals.into_iter().flatten() {
        expectations.push(Expectation::Bound { metric, bound });
        expectations.push(Expectation::Bound { metric: Metric::Collisions, bound: 0.0 });
    }
    if stop.is_some_and(|stop| stop.mapped) {
        expectations.extend(MAPPED.map(|(metric, bound)| Expectation::Bound { metric, bound }));
        expectations.push(Expectation::Bound { metric: Metric::Collisions, bound: 0.0 });
    }
    expectations
}

/// Reads `expect`.
pub(super) fn read(reader: &mut Reader<'_>, entry: &Entry) -> Option<Vec<Expectation>> {
    let mut fields = Fields::of(reader, &entry.value, "an expectation", entry.key.span)?;
    let mut expectations = Vec::new();
    if let Some(entry) = fields.entry("outcome") {
        let index = reader.choice(&entry.value, "an outcome", &Outcome::ALL.map(Outcome::name));
        expectations.extend(index.and_then(|index| Outcome::ALL.get(index)).copied().map(Expectation::Outcome));
    } else {
        expectations.push(COMPLETION);
    }
    for metric in Metric::ALL {
        let figure = metric.figure();
        let Some(Bound { range, example }) = figure.bound else { continue };
        let bound = if figure.kind == Kind::Count {
            let entry = fields.entry(metric.name());
            entry.and_then(|entry| reader.count(&entry.value, metric.name(), 0..=MAX_COUNT, 0)).map(f64::from)
        } else {
            let (mut bound, key) = (f64::NAN, Key::new(metric.name(), figure.dimension(), range, example));
            fields.set(reader, &key, &mut bound).map(|_| bound)
        };
        expectations.extend(bound.map(|bound| Expectation::Bound { metric, bound }));
    }
    fields.finish(reader);
    Some(expectations)
}
