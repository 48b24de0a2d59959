//! The run of a machine, and its effect on the store.

use std::fmt::Display;
use std::sync::Arc;

use vibrissa_runtime::machine::{Artifact, Status};

use super::command_line::print_error;
use crate::drive::{LoopRecord, RecordSink};
use crate::store::{MachineHash, Role, Store, StoreError};

/// The run of a machine. If it tries a tentative machine, the store learns its outcome.
#[derive(Debug)]
pub(super) struct MachineRun {
    /// `None` for the good machine of a store, and for a machine from a file.
    tentative: Option<Tentative>,
    outcome: Outcome,
}

/// A tentative machine in its store.
#[derive(Debug, Clone)]
struct Tentative {
    store: Arc<Store>,
    hash: MachineHash,
}

/// The outcome of a run.
#[derive(Debug)]
enum Outcome {
    /// The machine was not executed, for a reason that is not its own.
    NotExecuted,
    /// The machine was executed until the run was ended from outside.
    Executed,
    /// The machine cannot be executed, or has failed.
    Failed(String),
}

impl MachineRun {
    /// The run of a machine from a file.
    pub(super) fn of_file() -> Self {
        Self { tentative: None, outcome: Outcome::NotExecuted }
    }

    /// Begins the run of the machine of a store.
    pub(super) fn of_store(store: Store) -> Result<(Artifact, Self), StoreError> {
        let before = store.status()?.tentative;
        let machine = store.begin_run()?;
        let (hash, is_tentative) = (machine.hash, machine.role == Role::Tentative);
        if let (Some(_), false, Some(rejected)) = (before, is_tentative, store.status()?.rejected) {
            print_error(&format!("gave the tentative machine up, {rejected}"));
        }
        print_error(&format!("{} machine {hash}", if is_tentative { "tentative" } else { "good" }));
        let tentative = is_tentative.then(|| Tentative { store: Arc::new(store), hash });
        Ok((machine.artifact, Self { tentative, outcome: Outcome::NotExecuted }))
    }

    /// A receiver of records that marks a tentative machine good after `ticks` ticks in a row without a stop.
    pub(super) fn good_after(&self, ticks: u64) -> Option<Box<dyn RecordSink>> {
        let tentative = self.tentative.clone()?;
        Some(Box::new(GoodAfter { tentative, ticks_left: Some(ticks), ticks }))
    }

    /// Notes that the machine was executed.
    pub(super) fn note_executed(&mut self) {
        self.outcome = Outcome::Executed;
    }

    /// Notes that the machine has failed or cannot be executed.
    pub(super) fn note_failure(&mut self, reason: impl Display) {
        self.outcome = Outcome::Failed(reason.to_string());
    }

    /// Tells the store the outcome, after all threads have ended.
    pub(super) fn end(self) {
        let Some(Tentative { store, hash }) = self.tentative else { return };
        let told = match self.outcome {
            Outcome::NotExecuted => store.undo_start(hash),
            Outcome::Executed => store.status().map(|state| {
                if state.tentative.is_some_and(|tentative| tentative.hash == hash) {
                    print_error(
                        "the run was too short to mark the machine good; `vibrissa-robot good` does so by hand",
                    );
                }
            }),
            Outcome::Failed(reason) => store.reject(hash, &reason).map(|()| {
                print_error(&format!("the machine {hash} is given up; the next start runs the last good one"));
            }),
        };
        match told {
            // It was marked good during the run, or another machine was pushed.
            Ok(()) | Err(StoreError::NotTentative { .. }) => {}
            Err(error) => print_error(&error.to_string()),
        }
    }
}

/// Marks a tentative machine good after some ticks in a row without a stop.
#[derive(Debug)]
struct GoodAfter {
    tentative: Tentative,
    ticks: u64,
    /// `None` after the mark.
    ticks_left: Option<u64>,
}

impl RecordSink for GoodAfter {
    fn take(&mut self, record: &LoopRecord) {
        let (LoopRecord::Tick(report), Some(left)) = (record, self.ticks_left) else { return };
        let is_stopped = report.is_paused || report.status == Status::Failed;
        let left = if is_stopped { self.ticks } else { left.saturating_sub(1) };
        self.ticks_left = (left > 0).then_some(left);
        if left == 0 {
            let Tentative { store, hash } = &self.tentative;
            match store.mark_good(*hash) {
                Ok(()) => print_error(&format!("the machine {hash} is good from now on")),
                Err(error) => print_error(&error.to_string()),
            }
        }
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "a test may panic")]

    use std::path::Path;

    use vibrissa_runtime::geometry::{Point2, Pose};
    use vibrissa_runtime::signal::{Command, MAX_WHISKERS};

    use super::*;
    use crate::drive::TickReport;
    use crate::store::{Keys, SignedMachine, State};

    const TICKS: u64 = 5;

    fn machine(number: usize) -> SignedMachine {
        let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/fixtures/store");
        SignedMachine::from_file(&folder.join(format!("{number}.machine"))).unwrap()
    }

    /// A store with a good machine, 1, and the run of a tentative one, 2.
    fn begun() -> (tempfile::TempDir, Store, MachineRun) {
        let folder = tempfile::tempdir().unwrap();
        let store = Store::open(folder.path()).unwrap();
        let keys = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/fixtures/store/test.pub");
        for number in [1, 2] {
            let mut frame = Vec::new();
            machine(number).write_frame(&mut frame).unwrap();
            store.receive(&frame[..], &Keys::from_file(&keys).unwrap()).unwrap();
            if number == 1 {
                store.mark_good(machine(1).hash()).unwrap();
            }
        }
        let run = MachineRun::of_store(Store::open(folder.path()).unwrap()).unwrap().1;
        (folder, store, run)
    }

    /// What the good machine, the tentative one with its starts, and the one that was given up are.
    fn roles(store: &Store) -> (usize, Option<(usize, u32)>, Option<usize>) {
        let number = |hash| (1..=2).find(|&number| machine(number).hash() == hash).unwrap();
        let State { good, tentative, rejected, .. } = store.status().unwrap();
        (
            number(good.unwrap()),
            tentative.map(|tentative| (number(tentative.hash), tentative.starts)),
            rejected.map(|rejected| number(rejected.hash)),
        )
    }

    fn tick(is_paused: bool, status: Status) -> LoopRecord {
        LoopRecord::Tick(TickReport {
            due_ns: 0,
            started_ns: 0,
            ended_ns: 0,
            sample_age_ns: 0,
            state: 0,
            status,
            pose: Pose { position: Point2::origin(), heading: 0.0 },
            base_angles: [0.0; MAX_WHISKERS],
            tips: [None; MAX_WHISKERS],
            command: Command::STOP,
            is_paused,
        })
    }

    fn feed(sink: &mut dyn RecordSink, count: u64, record: &LoopRecord) {
        (0..count).for_each(|_| sink.take(record));
    }

    #[test]
    fn only_ticks_in_a_row_without_a_stop_make_a_machine_good() {
        let (_folder, store, run) = begun();
        let mut sink = run.good_after(TICKS).unwrap();
        for stop in [tick(true, Status::Running), tick(false, Status::Failed)] {
            feed(&mut *sink, TICKS - 1, &tick(false, Status::Running));
            feed(&mut *sink, 1, &stop);
            assert_eq!(roles(&store), (1, Some((2, 1)), None));
        }
        feed(&mut *sink, TICKS, &tick(false, Status::Running));
        assert_eq!(roles(&store), (2, None, None));
        // A later failure does not bring the old one back, and nothing else is marked.
        feed(&mut *sink, 2 * TICKS, &tick(false, Status::Running));
        let mut run = run;
        run.note_failure("late");
        run.end();
        assert_eq!(roles(&store), (2, None, None));
    }

    #[test]
    fn the_outcome_of_a_run_decides_about_the_tentative_machine() {
        let (_folder, store, run) = begun();
        run.end();
        assert_eq!(roles(&store), (1, Some((2, 0)), None), "it was not executed");
        let (_folder, store, mut run) = begun();
        run.note_executed();
        run.end();
        assert_eq!(roles(&store), (1, Some((2, 1)), None), "its time was too short");
        let (_folder, store, mut run) = begun();
        run.note_failure("nothing to feel");
        run.end();
        assert_eq!(roles(&store), (1, None, Some(2)));
        assert_eq!(store.status().unwrap().rejected.unwrap().reason, "nothing to feel");
    }

    #[test]
    fn the_run_of_the_good_machine_changes_nothing() {
        let (folder, store, mut run) = begun();
        run.note_failure("a reason");
        run.end();
        let before = store.status().unwrap();
        let (_, mut run) = MachineRun::of_store(Store::open(folder.path()).unwrap()).unwrap();
        assert!(run.good_after(TICKS).is_none());
        run.note_failure("another reason");
        run.end();
        assert_eq!(store.status().unwrap(), before);
    }
}
