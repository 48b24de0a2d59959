//! Mutated and generated policies, as many as one likes.

use std::panic::{AssertUnwindSafe, catch_unwind};
use std::time::Duration;
use std::{env, fmt, thread};

use rustix::time::{ClockId, clock_gettime};

use crate::answered::{is_answered, is_answered_the_same, is_handled};
use crate::random::Random;
use crate::{STACK, THESIS, allocator, mutate};

/// The largest time of any text, as a multiple of the time of `thesis.fsm`.
const MOST_TIME: f64 = 1000.0;
/// The most bytes that any text may take at once.
pub(crate) const MOST_MEMORY: usize = 256 << 20;

/// The most time of a processor that the compiler may take for a text whose parts share others. Tests are not built for speed.
pub(crate) const MOST_SHARED_TIME: Duration = Duration::from_secs(if cfg!(debug_assertions) { 10 } else { 2 });

/// Where texts come from.
#[derive(Clone, Copy, PartialEq)]
enum Texts {
    /// Policies by rules, and those of the project, as they are or mutated.
    Usual,
    /// Policies whose parts share others, as they are.
    Shared,
    /// The same, mutated.
    SharedAndMutated,
}

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
fn campaign(from: Texts, seed: u64, texts: usize) -> Report {
    let worker = move || {
        let corpus = mutate::corpus();
        let mut report = Report { texts, unit: fastest(|| is_handled(THESIS)), ..Report::default() };
        for index in 0..texts {
            // Every text has a seed of its own, so that one can be made again alone.
            let random = &mut Random(seed.wrapping_add(index as u64));
            let text = match from {
                Texts::Usual => mutate::input(&corpus, random),
                Texts::Shared => mutate::shared_input(&corpus, false, random),
                Texts::SharedAndMutated => mutate::shared_input(&corpus, true, random),
            };
            let start = worked();
            let handle = || {
                // The time is that of the compiler. What else is done with a text is tried with a part.
                if from != Texts::Usual && !index.is_multiple_of(32) {
                    return is_answered(&text);
                }
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
                time = time.min(fastest(|| {
                    catch_unwind(AssertUnwindSafe(|| {
                        if from == Texts::Usual { is_handled(&text) } else { is_answered(&text) }
                    }))
                }));
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
pub(crate) fn worked() -> Duration {
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

    fn check_shared(&self) {
        assert!(self.panics.is_empty(), "{self}");
        assert!(self.largest.0 < MOST_MEMORY, "too large: {self}");
        assert!(self.slowest.0 < MOST_SHARED_TIME, "too slow: {self}");
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
    campaign(Texts::Usual, 1, 3000).check();
}

#[test]
fn policies_with_exponentially_many_uses_are_answered_in_bounded_time_and_memory() {
    campaign(Texts::Shared, 1, 40).check_shared();
    campaign(Texts::SharedAndMutated, 2, 20).check_shared();
}

/// The number and the seed of the texts that are asked for.
fn asked_for() -> (usize, u64) {
    fn number<T: std::str::FromStr>(name: &str) -> Option<T> {
        env::var(name).ok()?.parse().ok()
    }
    (number("FUZZ_TEXTS").unwrap_or(100_000), number("FUZZ_SEED").unwrap_or(0))
}

/// `cargo x fuzz` runs this.
#[test]
#[ignore = "takes minutes; `cargo x fuzz N` runs it on N texts"]
#[expect(clippy::print_stdout, reason = "the figures are what it is run for")]
fn as_many_policies_as_asked_for_are_handled_in_bounded_time_and_memory() {
    let (texts, seed) = asked_for();
    let report = campaign(Texts::Usual, seed, texts);
    println!("{report}");
    assert!(report.ratio() < MOST_TIME, "too slow: {report}");
    report.check();
}

/// `cargo x fuzz` runs this, too.
#[test]
#[ignore = "takes minutes; `cargo x fuzz N` runs it on N texts"]
#[expect(clippy::print_stdout, reason = "the figures are what it is run for")]
fn as_many_policies_with_shared_parts_as_asked_for_are_answered_in_bounded_time_and_memory() {
    let (texts, seed) = asked_for();
    let report = campaign(Texts::Shared, seed, texts);
    println!("{report}");
    report.check_shared();
}

/// And this.
#[test]
#[ignore = "takes minutes; `cargo x fuzz N` runs it on N texts"]
#[expect(clippy::print_stdout, reason = "the figures are what it is run for")]
fn as_many_policies_with_mutated_shared_parts_as_asked_for_are_answered_in_bounded_time_and_memory() {
    let (texts, seed) = asked_for();
    let report = campaign(Texts::SharedAndMutated, seed, texts);
    println!("{report}");
    report.check_shared();
}
