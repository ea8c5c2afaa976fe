//! Numbers as people read them.

use std::time::Duration;

/// `1 item`, `2 items`.
pub fn count(number: u64, noun: &str) -> String {
    cosfly_diagnose::counted(number, noun)
}

/// Bytes with a decimal unit and two or three digits.
pub fn bytes(number: u64) -> String {
    const UNITS: [&str; 5] = ["B", "kB", "MB", "GB", "TB"];
    let (mut value, mut unit) = (number as f64, 0);
    while value >= 999.5 && unit + 1 < UNITS.len() {
        value /= 1000.0;
        unit += 1;
    }
    if unit == 0 || value >= 99.5 {
        format!("{value:.0} {}", UNITS[unit])
    } else {
        format!("{value:.1} {}", UNITS[unit])
    }
}

/// A duration as seconds, minutes or hours.
pub fn duration(time: Duration) -> String {
    let seconds = time.as_secs_f64();
    if seconds < 60.0 {
        format!("{seconds:.1} s")
    } else if time.as_secs() < 3 * 3600 {
        format!("{} min {:02} s", time.as_secs() / 60, time.as_secs() % 60)
    } else {
        format!("{} h {:02} min", time.as_secs() / 3600, time.as_secs() / 60 % 60)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_read_well() {
        let shown = [0, 999, 1000, 99_600, 1_234_567, 2_000_000_000].map(bytes);
        assert_eq!(shown, ["0 B", "999 B", "1.0 kB", "100 kB", "1.2 MB", "2.0 GB"]);
        assert_eq!((count(1, "item"), count(0, "item")), ("1 item".to_owned(), "0 items".to_owned()));
        assert_eq!(duration(Duration::from_millis(61_400)), "1 min 01 s");
        assert_eq!(duration(Duration::from_secs(356_000)), "98 h 53 min");
    }
}
