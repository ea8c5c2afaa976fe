//! Work on very many files, by a few threads.

use std::num::NonZero;

/// Fewer files than this are not worth a thread.
pub(crate) const PER_THREAD: usize = 1024;
/// Fewer files than this are not worth a thread that waits for the disk.
const PER_READER: usize = 64;
/// More threads than this wait for the disk, not for each other.
const MOST_THREADS: usize = 8;

/// Results of `work` for all items, in their order; a thread has at least `per_thread` items.
pub(crate) fn side_by_side<T: Sync, R: Send>(items: &[T], per_thread: usize, work: impl Fn(&T) -> R + Sync) -> Vec<R> {
    let threads = std::thread::available_parallelism().map_or(1, NonZero::get).min(MOST_THREADS);
    on_threads(threads, items, per_thread, work)
}

/// Results of `work` for all items, in their order. The work waits for the disk or the network, so that there are more threads
/// than cores.
pub(crate) fn read_side_by_side<T: Sync, R: Send>(items: &[T], work: impl Fn(&T) -> R + Sync) -> Vec<R> {
    on_threads(MOST_THREADS, items, PER_READER, work)
}

fn on_threads<T: Sync, R: Send>(
    threads: usize,
    items: &[T],
    per_thread: usize,
    work: impl Fn(&T) -> R + Sync,
) -> Vec<R> {
    let part = items.len().div_ceil(threads).max(per_thread);
    if items.len() <= part {
        return items.iter().map(work).collect();
    }
    let work = &work;
    std::thread::scope(|scope| {
        let parts: Vec<_> =
            items.chunks(part).map(|items| scope.spawn(|| items.iter().map(work).collect::<Vec<R>>())).collect();
        let join = |part: std::thread::ScopedJoinHandle<'_, Vec<R>>| {
            part.join().unwrap_or_else(|panic| std::panic::resume_unwind(panic))
        };
        parts.into_iter().flat_map(join).collect()
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn results_come_in_the_order_of_the_items() {
        for count in [0, 1, 1024, 1025, 5000, 10_000] {
            let items: Vec<usize> = (0..count).collect();
            assert_eq!(
                side_by_side(&items, PER_THREAD, |item| item * 2),
                items.iter().map(|item| item * 2).collect::<Vec<_>>()
            );
        }
    }
}
