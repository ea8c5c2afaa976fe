//! CPU time: what a computation cost, however busy the machine is.

use rustix::time::{ClockId, clock_gettime};

/// CPU seconds that this thread has used so far.
pub fn thread_cpu_s() -> f64 {
    seconds(ClockId::ThreadCPUTime)
}

/// CPU seconds of all threads of this process.
pub fn process_cpu_s() -> f64 {
    seconds(ClockId::ProcessCPUTime)
}

/// Seconds since some moment.
pub fn wall_s() -> f64 {
    seconds(ClockId::Monotonic)
}

fn seconds(clock: ClockId) -> f64 {
    let now = clock_gettime(clock);
    now.tv_sec as f64 + 1e-9 * now.tv_nsec as f64
}

/// A result and the CPU seconds of this thread that it took.
pub fn timed<T>(work: impl FnOnce() -> T) -> (T, f64) {
    let begin = thread_cpu_s();
    let result = work();
    (result, thread_cpu_s() - begin)
}
