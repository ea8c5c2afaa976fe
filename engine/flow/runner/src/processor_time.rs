//! Processor time of this process, for predictions and summaries. No output depends on it.

/// Seconds that all threads of this process have used; `None` on systems other than Linux.
pub(crate) fn processor_s() -> Option<f64> {
    #[cfg(target_os = "linux")]
    {
        let used = rustix::time::clock_gettime(rustix::time::ClockId::ProcessCPUTime);
        Some(used.tv_sec as f64 + 1e-9 * used.tv_nsec as f64)
    }
    #[cfg(not(target_os = "linux"))]
    None
}
