//! Progress of many runs, and the message after an interruption.

use std::fmt::Display;
use std::path::PathBuf;
use std::time::Duration;

use indicatif::{HumanDuration, ProgressBar, ProgressStyle};

use vibrissa_text::diagnostic::printable;

use super::exit::Exit;
use super::output;

/// The least time between two lines.
const GAP: Duration = Duration::from_secs(10);

/// The results that remain after an interruption.
#[derive(Debug, Clone)]
pub(super) enum Kept {
    /// None, because results are written at the end.
    Nothing,
    /// The results of the finished runs, in this file. The same command resumes from it.
    In(PathBuf),
}

/// Number of finished runs on standard error. It is a bar on a terminal, else a line from time to time. Ctrl-C ends the
/// program with a message about the remaining results.
pub(super) struct Progress {
    bar: ProgressBar,
    /// Number of runs that earlier processes had finished.
    resumed: u64,
    /// Time of the next line since the start.
    due: Duration,
}

impl Progress {
    /// Progress of `runs` runs, whose results are written at the end.
    pub(super) fn new(runs: usize) -> Self {
        Self::resumed(0, runs as u64, Kept::Nothing)
    }

    /// Progress of the runs that are `left` after earlier processes.
    pub(super) fn resumed(resumed: u64, left: u64, kept: Kept) -> Self {
        let bar = ProgressBar::new(resumed + left).with_position(resumed);
        // Earlier runs took no time in this process and must not affect the rate.
        bar.reset_eta();
        let style =
            ProgressStyle::with_template("{pos} of {len} runs {wide_bar} {per_sec}, {elapsed}, {eta} left; {msg}");
        if let Ok(style) = style {
            bar.set_style(style);
        }
        let shown = bar.clone();
        // It fails in a background process whose shell ignores Ctrl-C. This is intended.
        let _ = ctrlc::try_set_handler(move || {
            let (done, all) = (shown.position(), resumed + left);
            shown.finish_and_clear();
            output::error(interrupted(done, all, &kept));
            std::process::exit(i32::from(Exit::Interrupted.status()));
        });
        Self { bar, resumed, due: GAP }
    }

    /// Shows the current activity.
    pub(super) fn doing(&self, what: impl Display) {
        self.bar.set_message(printable(&what.to_string()).into_owned());
    }

    /// Counts a finished run, and shows its result.
    pub(super) fn done(&mut self, what: impl Display) {
        self.doing(&what);
        self.bar.inc(1);
        let elapsed = self.bar.elapsed();
        if self.bar.is_hidden() && elapsed >= self.due {
            self.due = next(elapsed);
            let all = self.bar.length().unwrap_or_default();
            output::message(format_args!("{}; {what}", line(self.resumed, self.bar.position(), all, elapsed)));
        }
    }

    /// Shows a run that is not one of those that are counted, such as one that makes a case simpler.
    pub(super) fn besides(&mut self, what: impl Display) {
        self.doing(&what);
        let elapsed = self.bar.elapsed();
        if self.bar.is_hidden() && elapsed >= self.due {
            self.due = next(elapsed);
            output::message(format_args!("{what}, after {}", HumanDuration(elapsed)));
        }
    }

    /// Says what begins, also where there is no bar.
    pub(super) fn begins(&mut self, what: impl Display) {
        self.doing(&what);
        if self.bar.is_hidden() {
            self.due = next(self.bar.elapsed());
            output::message(what);
        }
    }

    /// Ends it.
    pub(super) fn finish(self) {
        self.bar.finish_and_clear();
    }
}

/// Time of the line after one at this time. The intervals grow, so that an hour has some 50 lines and a day 80.
fn next(elapsed: Duration) -> Duration {
    elapsed + GAP.max(elapsed / 10)
}

fn line(resumed: u64, done: u64, all: u64, elapsed: Duration) -> String {
    let left = elapsed.mul_f64(all.saturating_sub(done) as f64 / done.saturating_sub(resumed).max(1) as f64);
    format!("{done} of {all} runs in {}, {} left", HumanDuration(elapsed), HumanDuration(left))
}

fn interrupted(done: u64, all: u64, kept: &Kept) -> String {
    match kept {
        Kept::Nothing => {
            format!("interrupted after {done} of {all} runs; their results are not kept")
        }
        Kept::In(path) => format!(
            "interrupted after {done} of {all} runs; their results are in {}, and the same command resumes from them",
            path.display()
        ),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lines_are_never_close_together_and_few_however_long_it_takes() {
        // Runs of a second each.
        let lines = |seconds: u64| {
            let (mut due, mut times) = (GAP, Vec::new());
            for elapsed in (1..=seconds).map(Duration::from_secs) {
                if elapsed >= due {
                    due = next(elapsed);
                    times.push(elapsed);
                }
            }
            times
        };
        assert!(lines(9).is_empty());
        let day = lines(86_400);
        assert!(day.windows(2).all(|pair| pair[1] >= pair[0] + GAP));
        // An interval is at most a tenth of the elapsed time, plus the time of a run.
        let is_late = |pair: &[Duration]| pair[1] > pair[0] + GAP.max(pair[0] / 10) + Duration::from_secs(1);
        assert!(!day.windows(2).any(is_late));
        assert!(lines(3600).len() < 50 && day.len() < 85, "{}, {}", lines(3600).len(), day.len());
    }

    #[test]
    fn what_was_done_before_does_not_count_for_the_time_left() {
        let text = line(900, 910, 1000, Duration::from_mins(1));
        assert_eq!(text, "910 of 1000 runs in 60 seconds, 9 minutes left");
    }
}
