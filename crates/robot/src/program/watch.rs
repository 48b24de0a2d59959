//! The main thread during a run.

use std::process::ExitCode;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::Duration;

use super::command_line::print_error;
use super::drive::Error;
use super::machine_run::MachineRun;
use super::system_clock::SystemClock;
use super::threads::{ThreadError, Threads};
use crate::histogram::Histogram;
use crate::vitals::{Phase, Vitals};

/// Time between looks at the threads.
const LOOK: Duration = Duration::from_millis(20);
/// Age (ns) of a sign of life up to which the watchdog of the system is fed.
const ALIVE_NS: u64 = 500_000_000;
/// Time for stop commands at the end.
const FAREWELL: Duration = Duration::from_millis(100);

/// A flag that the signals SIGTERM and SIGINT set.
pub(super) fn termination() -> std::io::Result<Arc<AtomicBool>> {
    let termination = Arc::new(AtomicBool::new(false));
    for signal in [signal_hook::consts::SIGTERM, signal_hook::consts::SIGINT] {
        signal_hook::flag::register(signal, Arc::clone(&termination))?;
    }
    Ok(termination)
}

/// Looks after the threads until the end, feeds the watchdog of the system, and logs faults.
pub(super) fn watch(
    threads: Threads,
    clock: SystemClock,
    termination: &AtomicBool,
    duration: Option<Duration>,
    run: &mut MachineRun,
) -> Result<ExitCode, Error> {
    let _ = sd_notify::notify(&[sd_notify::NotifyState::Ready]);
    let end_ns = duration.map(|duration| u64::try_from(duration.as_nanos()).unwrap_or(u64::MAX));
    let mut error = None;
    loop {
        std::thread::sleep(LOOK);
        if let Ok(cause) = threads.errors.try_recv() {
            error = Some(cause);
            break;
        }
        if termination.load(Ordering::Acquire) || end_ns.is_some_and(|end_ns| clock.now_ns() >= end_ns) {
            break;
        }
        if is_alive(&threads, clock.now_ns()) {
            let _ = sd_notify::notify(&[sd_notify::NotifyState::Watchdog]);
        }
    }
    for line in summary(&threads.vitals, threads.buses) {
        print_error(&line);
    }
    let has_ended = threads.vitals.has_machine_failed.load(Ordering::Acquire)
        || threads.vitals.has_panicked.load(Ordering::Acquire);
    match &error {
        Some(cause @ ThreadError::Machine(_)) => run.note_failure(cause),
        _ if has_ended => run.note_failure("the program has failed during its run"),
        _ if threads.vitals.is_running.load(Ordering::Acquire) => run.note_executed(),
        _ => {}
    }
    let _ = sd_notify::notify(&[sd_notify::NotifyState::Stopping]);
    threads.terminate();
    std::thread::sleep(FAREWELL);
    threads.end();
    match error {
        Some(cause @ ThreadError::Machine(_)) => {
            print_error(&cause.to_string());
            Ok(ExitCode::from(1))
        }
        Some(cause) => Err(cause.into()),
        None if has_ended => Ok(ExitCode::from(1)),
        None => Ok(ExitCode::SUCCESS),
    }
}

/// True if every thread has given a sign of life. The watchdog is fed only then.
fn is_alive(threads: &Threads, now_ns: u64) -> bool {
    let vitals = &threads.vitals;
    if threads.has_own_ticks && !vitals.is_running.load(Ordering::Acquire) {
        return true;
    }
    let is_recent =
        |last: &std::sync::atomic::AtomicU64| now_ns.saturating_sub(last.load(Ordering::Acquire)) < ALIVE_NS;
    let buses = vitals.round_ns.iter().take(threads.buses);
    let ticks = threads.has_own_ticks.then_some(&vitals.tick_ns);
    buses.chain(ticks).chain([&vitals.supervised_ns]).all(is_recent)
}

/// The timing of the run: one line for each histogram, and the missed periods.
fn summary(vitals: &Vitals, buses: usize) -> Vec<String> {
    let microseconds = |ns: u64| ns as f64 * 1e-3;
    let line = |name: String, histogram: &Histogram| {
        let quantile = |share| histogram.quantile_ns(share).map_or(0.0, microseconds);
        format!(
            "{name}: median {:.0} µs, 99 % below {:.0} µs, at most {:.0} µs",
            quantile(0.5),
            quantile(0.99),
            microseconds(histogram.largest_ns())
        )
    };
    let rounds = vitals.round_time.iter().take(buses).enumerate();
    let mut lines: Vec<String> = rounds.map(|(bus, time)| line(format!("round on bus {bus}"), time)).collect();
    // The sensor IO has no ticks.
    if vitals.tick_time.largest_ns() > 0 {
        lines.push(line("tick".to_owned(), &vitals.tick_time));
        lines.push(line("lateness of ticks".to_owned(), &vitals.tick_lateness));
        lines.push(line("age of the newest sample".to_owned(), &vitals.sample_age));
    }
    let missed: Vec<String> =
        Phase::ALL.iter().map(|&phase| format!("{} {}", phase.name(), vitals.missed(phase))).collect();
    lines.push(format!("missed periods: {}", missed.join(", ")));
    lines
}
