//! What all other benches are measured by, so that machines can be compared: arithmetic of the kind that ticks do, one number after
//! the other.

#![allow(missing_docs, reason = "criterion's macros write undocumented items")]
#![allow(clippy::disallowed_methods, reason = "it measures the platform")]

use std::hint::black_box;

use criterion::Criterion;

fn main() {
    let mut criterion = Criterion::default().configure_from_args();
    let sines = |from: f64| (0..100).fold(from, |angle, _| (angle + 1.0).sin() / 1.5);
    criterion.bench_function("reference/sines", |bencher| bencher.iter(|| sines(black_box(0.1))));
    criterion.final_summary();
}
