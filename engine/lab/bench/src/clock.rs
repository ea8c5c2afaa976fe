//! CPU time, which does not depend on the load of the machine.

use rustix::time::{ClockId, clock_gettime};

/// CPU time of this thread, seconds.
pub fn thread_cpu_s() -> f64 {
    seconds(ClockId::ThreadCPUTime)
}

/// CPU time of all threads of this process, seconds.
pub fn process_cpu_s() -> f64 {
    seconds(ClockId::ProcessCPUTime)
}

/// Wall time since an arbitrary moment, seconds.
pub fn wall_s() -> f64 {
    seconds(ClockId::Monotonic)
}

fn seconds(clock: ClockId) -> f64 {
    let now = clock_gettime(clock);
    now.tv_sec as f64 + 1e-9 * now.tv_nsec as f64
}

/// Result of `work` and its CPU time on this thread, seconds.
pub fn timed<T>(work: impl FnOnce() -> T) -> (T, f64) {
    let begin = thread_cpu_s();
    let result = work();
    (result, thread_cpu_s() - begin)
}
