//! Processor time of this process, for predictions and summaries. No output depends on it.

/// Seconds that all threads of this process have used; `None` on systems other than Linux.
pub fn processor_s() -> Option<f64> {
    #[cfg(target_os = "linux")]
    {
        let used = rustix::time::clock_gettime(rustix::time::ClockId::ProcessCPUTime);
        Some(used.tv_sec as f64 + 1e-9 * used.tv_nsec as f64)
    }
    #[cfg(not(target_os = "linux"))]
    None
}

/// Seconds that processes which this one started, and which have ended, have used with all that they started and waited for; `None` on
/// systems other than Linux.
pub fn processor_s_of_children() -> Option<f64> {
    let about = std::fs::read_to_string("/proc/self/stat").ok()?;
    // The name of the program, in brackets, may hold spaces.
    let mut fields = about.rsplit_once(')')?.1.split_ascii_whitespace().skip(13);
    let ticks = fields.next()?.parse::<f64>().ok()? + fields.next()?.parse::<f64>().ok()?;
    Some(ticks / TICKS_IN_A_SECOND)
}

/// Linux counts the time of ended processes in these for programs, on every processor.
const TICKS_IN_A_SECOND: f64 = 100.0;
