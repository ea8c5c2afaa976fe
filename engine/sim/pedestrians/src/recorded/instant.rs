//! Instants of RFC 3339 (`2010-10-03T09:36:30.5Z`) as seconds since 1970.

/// Seconds since 1970-01-01T00:00:00Z; `None` for other texts. Without a zone, the time counts as UTC.
pub(super) fn seconds(text: &str) -> Option<f64> {
    let (date, time) = text.trim().split_once(['T', 't', ' '])?;
    let mut parts = date.split('-');
    let (year, month, day) = (digits(parts.next()?, 4)?, digits(parts.next()?, 2)?, digits(parts.next()?, 2)?);
    if parts.next().is_some() || !(1..=12).contains(&month) || !(1..=days_of(year, month)).contains(&day) {
        return None;
    }
    let zone_at = time.find(['Z', 'z', '+', '-']).unwrap_or(time.len());
    let (clock, zone) = time.split_at(zone_at);
    let mut parts = clock.split(':');
    let (hour, minute) = (digits(parts.next()?, 2)?, digits(parts.next()?, 2)?);
    let (whole, fraction) =
        parts.next()?.split_once('.').map_or_else(|| (clock.rsplit(':').next(), ""), |it| (Some(it.0), it.1));
    let second = digits(whole?, 2)?;
    if parts.next().is_some() || hour > 23 || minute > 59 || second > 60 {
        return None;
    }
    let fraction = match fraction {
        "" => 0.0,
        digits if digits.bytes().all(|byte| byte.is_ascii_digit()) => format!("0.{digits}").parse().ok()?,
        _ => return None,
    };
    let minutes = hour * 60 + minute - zone_minutes(zone)?;
    Some((days_since_1970(year, month, day) * 86_400 + minutes * 60 + second) as f64 + fraction)
}

fn digits(text: &str, count: usize) -> Option<i64> {
    (text.len() == count && text.bytes().all(|byte| byte.is_ascii_digit())).then(|| text.parse().ok())?
}

fn zone_minutes(zone: &str) -> Option<i64> {
    if zone.is_empty() {
        return Some(0);
    }
    let (sign, clock) = match zone.split_at_checked(1)? {
        ("Z" | "z", "") => return Some(0),
        ("+", clock) => (1, clock),
        ("-", clock) => (-1, clock),
        _ => return None,
    };
    let (hours, minutes) = clock.split_once(':').or_else(|| clock.split_at_checked(2))?;
    Some(sign * (digits(hours, 2)? * 60 + digits(minutes, 2)?))
}

fn days_of(year: i64, month: i64) -> i64 {
    days_since_1970(year + month / 12, month % 12 + 1, 1) - days_since_1970(year, month, 1)
}

/// Days in the Gregorian calendar: years begin in March, so that the leap day is their last.
fn days_since_1970(year: i64, month: i64, day: i64) -> i64 {
    let (year, month) = if month > 2 { (year, month - 3) } else { (year - 1, month + 9) };
    let leap_days = year.div_euclid(4) - year.div_euclid(100) + year.div_euclid(400);
    365 * year + leap_days + (153 * month + 2) / 5 + day - 1 - 719_468
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn instants_are_those_of_date() {
        // `date -u -d ... +%s.%N`
        for (text, expected) in [
            ("1970-01-01T00:00:00Z", 0.0),
            ("2010-10-03T09:36:30Z", 1_286_098_590.0),
            ("2010-10-03T09:36:30", 1_286_098_590.0),
            ("2024-02-29T23:59:59.25+05:30", 1_709_231_399.25),
            ("2000-03-01 00:00:00-0100", 951_872_400.0),
            ("1969-12-31T23:59:59Z", -1.0),
        ] {
            assert_eq!(seconds(text), Some(expected), "{text}");
        }
    }

    #[test]
    fn other_texts_are_none() {
        for text in [
            "",
            "now",
            "2010-10-03",
            "2010-13-03T00:00:00Z",
            "2023-02-29T00:00:00Z",
            "2010-10-03T24:00:00Z",
            "2010-10-03T09:36Z",
            "2010-10-03T09:36:30.x",
            "2010-10-03T09:36:30+5",
            "10-10-03T09:36:30Z",
            "é-é-éTé:é:é",
        ] {
            assert_eq!(seconds(text), None, "{text}");
        }
    }
}
