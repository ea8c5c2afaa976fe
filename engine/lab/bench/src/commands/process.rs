//! Memory and reading of this process, as the system tells them.

use std::fs;

/// Largest memory so far, megabytes; 0 where the system does not tell.
pub fn peak_mb() -> u64 {
    number_of("/proc/self/status", "VmHWM:") / 1000
}

/// Megabytes that were read; 0 where the system does not tell.
pub fn read_mb() -> u64 {
    number_of("/proc/self/io", "rchar:") / 1_000_000
}

/// The number after `name` in a file of lines.
fn number_of(file: &str, name: &str) -> u64 {
    let text = fs::read_to_string(file).unwrap_or_default();
    let line = text.lines().find_map(|line| line.strip_prefix(name));
    line.and_then(|line| line.split_whitespace().next()?.parse().ok()).unwrap_or(0)
}
