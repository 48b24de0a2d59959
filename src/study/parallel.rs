//! Work on several processors at once.

use std::num::NonZeroUsize;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::mpsc::channel;
use std::thread::{available_parallelism, scope};

/// How many threads make sense on this machine.
#[must_use]
pub fn processors() -> NonZeroUsize {
    available_parallelism().unwrap_or(NonZeroUsize::MIN)
}

/// Does `work` on every task, on so many `threads`, and gives what came of it in the order of the tasks. `done` hears on the
/// calling thread of each that is done, in the order in which they are.
pub fn in_parallel<T: Sync, R: Send>(
    tasks: &[T],
    threads: NonZeroUsize,
    work: impl Fn(&T) -> R + Sync,
    mut done: impl FnMut(&R),
) -> Vec<R> {
    let next = AtomicUsize::new(0);
    let (sender, receiver) = channel();
    let mut results: Vec<(usize, R)> = scope(|scope| {
        for _ in 0..threads.get().min(tasks.len()) {
            let (sender, next, work) = (sender.clone(), &next, &work);
            scope.spawn(move || {
                loop {
                    let index = next.fetch_add(1, Ordering::Relaxed);
                    let Some(task) = tasks.get(index) else { break };
                    // When nobody listens any more the program is about to end.
                    if sender.send((index, work(task))).is_err() {
                        break;
                    }
                }
            });
        }
        drop(sender);
        receiver.iter().inspect(|(_, result)| done(result)).collect()
    });
    results.sort_by_key(|&(index, _)| index);
    results.into_iter().map(|(_, result)| result).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_task_is_done_once_and_results_keep_their_order() {
        let tasks: Vec<u64> = (0..200).collect();
        for threads in [1, 2, 7, 500].into_iter().filter_map(NonZeroUsize::new) {
            let mut heard = 0;
            let squares = in_parallel(&tasks, threads, |task| task * task, |_| heard += 1);
            assert_eq!(squares, tasks.iter().map(|task| task * task).collect::<Vec<_>>());
            assert_eq!(heard, 200);
        }
        assert_eq!(in_parallel(&[], NonZeroUsize::MIN, |task: &u64| *task, |_| ()), [0_u64; 0]);
    }
}
