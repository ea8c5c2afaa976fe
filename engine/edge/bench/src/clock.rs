//! The CPU time of the calling thread: what a computation cost, however busy the machine is.

use rustix::time::{ClockId, clock_gettime};

/// CPU seconds that this thread has used so far.
pub fn thread_cpu_s() -> f64 {
    let now = clock_gettime(ClockId::ThreadCPUTime);
    now.tv_sec as f64 + 1e-9 * now.tv_nsec as f64
}

/// A result and the CPU seconds of this thread that it took.
pub fn timed<T>(work: impl FnOnce() -> T) -> (T, f64) {
    let begin = thread_cpu_s();
    let result = work();
    (result, thread_cpu_s() - begin)
}
