//! Mutated and generated policies, as many as one likes.

use std::panic::{AssertUnwindSafe, catch_unwind};
use std::time::Duration;
use std::{env, fmt, thread};

use rustix::time::{ClockId, clock_gettime};

use crate::answered::{is_answered_the_same, is_handled};
use crate::random::Random;
use crate::{STACK, THESIS, allocator, mutate};

/// The largest time of any text, as a multiple of the time of `thesis.fsm`.
const MOST_TIME: f64 = 1000.0;
/// The most bytes that any text may take at once.
const MOST_MEMORY: usize = 256 << 20;

/// What became of the texts.
#[derive(Default)]
struct Report {
    texts: usize,
    compiled: usize,
    bytes: usize,
    /// The time that `thesis.fsm` took.
    unit: Duration,
    slowest: (Duration, String),
    largest: (usize, String),
    panics: Vec<String>,
}

/// Tries `texts` texts that come from `seed`, on a small stack.
fn campaign(seed: u64, texts: usize) -> Report {
    let worker = move || {
        let corpus = mutate::corpus();
        let mut report = Report { texts, unit: fastest(|| is_handled(THESIS)), ..Report::default() };
        for index in 0..texts {
            // Every text has a seed of its own, so that one can be made again alone.
            let text = mutate::input(&corpus, &mut Random(seed.wrapping_add(index as u64)));
            let start = worked();
            let handle = || {
                // Asking again takes several times as long, so only a part is.
                if index.is_multiple_of(16) {
                    is_answered_the_same(&text);
                }
                is_handled(&text)
            };
            let (handled, peak) = allocator::peak(|| catch_unwind(AssertUnwindSafe(handle)));
            let mut time = worked().saturating_sub(start);
            if time > report.slowest.0 {
                // Something else may have had the caches.
                time = time.min(fastest(|| catch_unwind(AssertUnwindSafe(|| is_handled(&text)))));
            }
            report.bytes += text.len();
            report.compiled += usize::from(matches!(handled, Ok(true)));
            if handled.is_err() {
                report.panics.push(text.clone());
            }
            if peak > report.largest.0 {
                report.largest = (peak, text.clone());
            }
            if time > report.slowest.0 {
                report.slowest = (time, text);
            }
        }
        report
    };
    thread::Builder::new().stack_size(STACK).spawn(worker).unwrap().join().unwrap()
}

/// The time for which this thread has had a processor. Time on a clock would count what else the machine does.
fn worked() -> Duration {
    clock_gettime(ClockId::ThreadCPUTime).try_into().unwrap()
}

/// The least time that some work takes of three.
fn fastest<T>(work: impl Fn() -> T) -> Duration {
    let time = || {
        let start = worked();
        work();
        worked().saturating_sub(start)
    };
    time().min(time()).min(time())
}

impl Report {
    /// The time of the slowest text, as a multiple of the time of `thesis.fsm`.
    fn ratio(&self) -> f64 {
        self.slowest.0.as_secs_f64() / self.unit.as_secs_f64()
    }

    fn check(&self) {
        assert!(self.panics.is_empty(), "{self}");
        assert!(self.largest.0 < MOST_MEMORY, "too large: {self}");
        assert!(self.compiled > self.texts * 3 / 20, "hardly any compiles: {self}");
    }
}

impl fmt::Display for Report {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let share = 100.0 * self.compiled as f64 / self.texts as f64;
        writeln!(f, "{} texts, {} bytes; {share:.1} % compiled; {} panics", self.texts, self.bytes, self.panics.len())?;
        writeln!(f, "slowest: {:?}, {:.0} times the time of `thesis.fsm`", self.slowest.0, self.ratio())?;
        writeln!(f, "most memory: {} bytes", self.largest.0)?;
        for (title, text) in [("slowest", &self.slowest.1), ("largest", &self.largest.1)] {
            writeln!(f, "--- {title} ({} bytes)\n{text}", text.len())?;
        }
        self.panics.iter().take(5).try_for_each(|text| writeln!(f, "--- panic\n{text}"))
    }
}

#[test]
fn mutated_and_generated_policies_are_handled_in_bounded_memory() {
    campaign(1, 3000).check();
}

/// `cargo x fuzz` runs this.
#[test]
#[ignore = "takes minutes; `cargo x fuzz N` runs it on N texts"]
#[expect(clippy::print_stdout, reason = "the figures are what it is run for")]
fn as_many_policies_as_asked_for_are_handled_in_bounded_time_and_memory() {
    let texts = env::var("FUZZ_TEXTS").ok().and_then(|texts| texts.parse().ok()).unwrap_or(100_000);
    let seed = env::var("FUZZ_SEED").ok().and_then(|seed| seed.parse().ok()).unwrap_or(0);
    let report = campaign(seed, texts);
    println!("{report}");
    assert!(report.ratio() < MOST_TIME, "too slow: {report}");
    report.check();
}
