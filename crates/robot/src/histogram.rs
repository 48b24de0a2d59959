//! Histograms of durations that threads share without locks.

use std::sync::atomic::{AtomicU64, Ordering};

/// Buckets for each doubling of the duration.
const PER_OCTAVE: u32 = 4;
/// Doublings above the lower end, from 1 µs to 17 s.
const OCTAVES: u32 = 24;
/// Lower end (ns).
const LEAST_NS: u64 = 1000;
/// Number of buckets, with one for everything below the lower end.
const BUCKETS: usize = (PER_OCTAVE * OCTAVES) as usize + 1;

/// A histogram of durations with four buckets for each doubling. One thread adds, others read.
#[derive(Debug)]
pub struct Histogram {
    counts: [AtomicU64; BUCKETS],
    largest_ns: AtomicU64,
}

impl Default for Histogram {
    fn default() -> Self {
        Self { counts: [const { AtomicU64::new(0) }; BUCKETS], largest_ns: AtomicU64::new(0) }
    }
}

impl Histogram {
    /// Adds a duration (ns).
    pub fn add(&self, duration_ns: u64) {
        if let Some(count) = self.counts.get(bucket(duration_ns)) {
            count.fetch_add(1, Ordering::Relaxed);
        }
        self.largest_ns.fetch_max(duration_ns, Ordering::Relaxed);
    }

    /// The duration (ns) below which this share of all durations lies: the upper end of its bucket, or the largest
    /// duration. `None` without any.
    #[must_use]
    pub fn quantile_ns(&self, share: f64) -> Option<u64> {
        let total = self.count();
        let largest_ns = self.largest_ns.load(Ordering::Relaxed);
        let mut below = 0;
        for (index, count) in (0_u32..).zip(&self.counts) {
            below += count.load(Ordering::Relaxed);
            if below > 0 && below as f64 >= share * total as f64 {
                return Some(upper_end_ns(index).min(largest_ns));
            }
        }
        None
    }

    /// The buckets that are not empty: the upper end (ns) and the number of durations, in ascending order.
    pub fn buckets(&self) -> impl Iterator<Item = (u64, u64)> + '_ {
        let all = (0_u32..).zip(&self.counts);
        all.map(|(index, count)| (upper_end_ns(index), count.load(Ordering::Relaxed))).filter(|(_, count)| *count > 0)
    }

    /// The largest duration (ns).
    #[must_use]
    pub fn largest_ns(&self) -> u64 {
        self.largest_ns.load(Ordering::Relaxed)
    }

    /// Number of durations.
    #[must_use]
    pub fn count(&self) -> u64 {
        self.counts.iter().map(|count| count.load(Ordering::Relaxed)).sum()
    }
}

/// The bucket of a duration (ns).
fn bucket(duration_ns: u64) -> usize {
    let ratio = duration_ns / LEAST_NS;
    let Some(octave) = ratio.checked_ilog2() else { return 0 };
    let part = ((duration_ns * u64::from(PER_OCTAVE) / LEAST_NS) >> octave) - u64::from(PER_OCTAVE);
    let index = u64::from(octave * PER_OCTAVE) + part + 1;
    usize::try_from(index).unwrap_or(usize::MAX).min(BUCKETS - 1)
}

/// The upper end (ns) of a bucket.
fn upper_end_ns(bucket: u32) -> u64 {
    let Some(index) = bucket.checked_sub(1) else { return LEAST_NS };
    let (octave, part) = (index / PER_OCTAVE, index % PER_OCTAVE);
    (LEAST_NS << octave) * u64::from(PER_OCTAVE + part + 1) / u64::from(PER_OCTAVE)
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "a test may panic")]

    use super::*;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn a_quantile_is_at_most_a_quarter_above_the_exact_one(
            mut durations in proptest::collection::vec(1000_u64..10_000_000_000, 1..100), share in 0.01..1.0_f64,
        ) {
            let histogram = Histogram::default();
            for &duration in &durations {
                histogram.add(duration);
            }
            durations.sort_unstable();
            #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "an index")]
            let exact = durations[(share * durations.len() as f64).ceil() as usize - 1];
            let found = histogram.quantile_ns(share).unwrap();
            prop_assert!(exact <= found && found as f64 <= 1.25 * exact as f64, "{found} for {exact}");
            for (upper_ns, count) in histogram.buckets() {
                let in_bucket = durations.iter().filter(|&&ns| ns < upper_ns && 1.25 * ns as f64 >= upper_ns as f64);
                prop_assert!(count > 0 && in_bucket.count() as u64 >= count, "{count} up to {upper_ns}");
            }
            prop_assert_eq!(histogram.buckets().map(|(_, count)| count).sum::<u64>(), histogram.count());
        }
    }

    #[test]
    fn the_ends_of_the_range_have_buckets() {
        let histogram = Histogram::default();
        assert_eq!(histogram.quantile_ns(0.5), None);
        histogram.add(0);
        assert_eq!(histogram.quantile_ns(1.0), Some(0));
        histogram.add(u64::MAX / 8);
        assert_eq!((histogram.count(), histogram.largest_ns()), (2, u64::MAX / 8));
        assert!(histogram.quantile_ns(1.0).is_some());
    }
}
