//! Reader of `expect`.

use super::fields::Fields;
use super::key::Key;
use super::node::Entry;
use super::reader::Reader;
use crate::scene::{Expectation, Metric, Outcome};

/// The expectation of a scenario without `expect`: its runs complete.
pub(super) const COMPLETION: Expectation = Expectation::Outcome(Outcome::Completed);

/// The largest permitted bound of a number of events.
const MAX_COUNT: u32 = 1_000_000;

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
        if metric.is_count() {
            let count = fields
                .entry(metric.name())
                .and_then(|entry| reader.count(&entry.value, metric.name(), 0..=MAX_COUNT, 0));
            expectations.extend(count.map(|count| Expectation::Bound { metric, bound: count.into() }));
            continue;
        }
        let (range, example) = match metric {
            Metric::Outliers => ((0.0, 1.0), "0.2 %"),
            _ if metric.is_share() => ((0.0, 1.0), "95 %"),
            Metric::CornerTimeMax => ((1e-3, 86_400.0), "3 s"),
            Metric::CornerPathMax => ((1e-9, 1e3), "15 cm"),
            _ => ((1e-9, 1.0), "0.8 mm"),
        };
        let key = Key::new(metric.name(), metric.dimension(), range, example);
        let mut bound = f64::NAN;
        if fields.set(reader, &key, &mut bound).is_some() {
            expectations.push(Expectation::Bound { metric, bound });
        }
    }
    fields.finish(reader);
    Some(expectations)
}
