//! Parallel work on several threads.

use std::convert::Infallible;
use std::num::NonZeroUsize;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::mpsc::sync_channel;
use std::thread::{Builder, available_parallelism, scope};

/// The number of threads that this machine executes at the same time.
#[must_use]
pub fn processors() -> NonZeroUsize {
    available_parallelism().unwrap_or(NonZeroUsize::MIN)
}

/// The number of threads for parallel work.
#[derive(Debug, Clone, Copy)]
pub struct Threads {
    /// The most threads at a time.
    pub count: NonZeroUsize,
    /// Receives the number of threads if the system starts fewer.
    pub fewer: fn(usize),
}

impl From<NonZeroUsize> for Threads {
    /// As many threads. A smaller number is not reported.
    fn from(count: NonZeroUsize) -> Self {
        Self { count, fewer: |_| () }
    }
}

/// Executes `work` on every task with as many `threads`, and returns the results in the order of the tasks. `done`
/// receives each finished task on the calling thread, in the order in which they finish.
pub fn in_parallel<T: Sync, R: Send>(
    tasks: &[T],
    threads: impl Into<Threads>,
    work: impl Fn(&T) -> R + Sync,
    mut done: impl FnMut(&R),
) -> Vec<R> {
    let mut results = Vec::with_capacity(tasks.len());
    let keep = |index, result| {
        done(&result);
        results.push((index, result));
        Ok::<(), Infallible>(())
    };
    let Ok(()) = stream_in_parallel(tasks, threads, || (), |(), task| work(task), keep);
    results.sort_by_key(|&(index, _)| index);
    results.into_iter().map(|(_, result)| result).collect()
}

/// Executes tasks without keeping the results. `done` receives each result with the index of its task. Its first error stops the
/// work. Then only the tasks that have begun are finished. Tasks begin in their order. Each thread has its own `tool`.
///
/// If the system starts fewer threads, they execute all tasks. If it starts none, the calling thread does.
///
/// # Errors
/// The error of `done`.
pub fn stream_in_parallel<T: Sync, S, R: Send, E>(
    tasks: &[T],
    threads: impl Into<Threads>,
    tool: impl Fn() -> S + Sync,
    work: impl Fn(&mut S, &T) -> R + Sync,
    mut done: impl FnMut(usize, R) -> Result<(), E>,
) -> Result<(), E> {
    let next = AtomicUsize::new(0);
    // Each thread waits with its result until the receiver is ready, so that results do not accumulate.
    let threads = threads.into();
    let wanted = threads.count.get().min(tasks.len());
    let (sender, receiver) = sync_channel(wanted);
    scope(|scope| {
        let is_started = |_: &usize| {
            let (sender, next, tool, work) = (sender.clone(), &next, &tool, &work);
            let thread = Builder::new().spawn_scoped(scope, move || {
                let mut tool = tool();
                loop {
                    let index = next.fetch_add(1, Ordering::Relaxed);
                    let Some(task) = tasks.get(index) else { break };
                    // Without a receiver the work has been stopped.
                    if sender.send((index, work(&mut tool, task))).is_err() {
                        break;
                    }
                }
            });
            thread.is_ok()
        };
        let started = (0..wanted).take_while(is_started).count();
        drop(sender);
        if started < wanted {
            (threads.fewer)(started.max(1));
        }
        if started == 0 {
            let mut tool = tool();
            let mut tasks = tasks.iter().enumerate();
            return tasks.try_for_each(|(index, task)| done(index, work(&mut tool, task)));
        }
        receiver.into_iter().try_for_each(|(index, result)| done(index, result))
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn threads(count: usize) -> Threads {
        let fewer = |started| panic!("only {started} threads were started");
        Threads { count: NonZeroUsize::new(count).unwrap_or(NonZeroUsize::MIN), fewer }
    }

    #[test]
    fn every_task_is_done_once_and_results_keep_their_order() {
        let tasks: Vec<u64> = (0..200).collect();
        for count in [1, 2, 7, 100] {
            let mut heard = 0;
            let squares = in_parallel(&tasks, threads(count), |task| task * task, |_| heard += 1);
            assert_eq!(squares, tasks.iter().map(|task| task * task).collect::<Vec<_>>());
            assert_eq!(heard, 200);
        }
        assert_eq!(in_parallel(&[], threads(1), |task: &u64| *task, |_| ()), [0_u64; 0]);
    }

    #[test]
    fn work_that_is_broken_off_ends_with_the_tasks_that_have_begun() {
        let tasks: Vec<u64> = (0..1000).collect();
        let begun = AtomicUsize::new(0);
        let work = |done: &mut u64, task: &u64| {
            begun.fetch_add(1, Ordering::Relaxed);
            *done += 1;
            (*done, *task)
        };
        let mut heard = Vec::new();
        let hear = |index, (done, task)| {
            heard.push((index, done, task));
            if heard.len() < 5 { Ok(()) } else { Err("enough") }
        };
        assert_eq!(stream_in_parallel(&tasks, threads(1), || 0, work, hear), Err("enough"));
        assert_eq!(heard, [(0, 1, 0), (1, 2, 1), (2, 3, 2), (3, 4, 3), (4, 5, 4)]);
        assert!(begun.into_inner() < 10);
    }
}
