//! [`PolicySees`]: what a policy sees, as far as an entry tells.

use super::notes::Notes;
use crate::flight::Row;
use crate::results::{Card, METRICS};

/// A flight that stays within this distance of the expert's on average, metres, is the expert's: a policy that sees no future chooses another one.
const EXPERT_M: f64 = 1.0;

/// What a policy sees, as far as an entry tells.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct PolicySees {
    /// Whether it knows the world: the whole walk, the expert's flight.
    pub world: bool,
    /// In words.
    pub words: String,
}

impl PolicySees {
    /// What the card, the notes and the flights of an entry tell; `shown` is what its policy saw where it was run again.
    ///
    /// # Errors
    /// What the notes say against the card, in words.
    pub fn of(card: &Card, notes: &Notes, rows: &[Row], shown: Option<&[String]>) -> Result<Self, String> {
        let sent = card.policy.sent();
        let not_sent = notes.sees.iter().find(|it| *it != "world" && !sent.contains(&it.as_str()));
        if let Some(name) = not_sent {
            let sent = sent.join(", ");
            return Err(format!("its notes say that it sees `{name}`, which it was not sent; it was sent {sent}"));
        }
        let is_expert = shown.is_some_and(|shown| shown.iter().any(|it| it == "world"))
            || card.policy.baseline.as_ref().is_some_and(|baseline| baseline.starts_with("expert"));
        if is_expert || notes.sees.iter().any(|it| it == "world") {
            return Ok(Self { world: true, words: "world".to_owned() });
        }
        // A baseline that was run again is this program's own; a network may know flights by heart.
        let is_known = shown.is_some() && card.policy.baseline.is_some();
        let (near, long) = near_expert(rows);
        if 2 * near > long && !is_known {
            let words = format!("world: {near} of its flights are the expert's to less than {EXPERT_M} m");
            return Ok(Self { world: true, words });
        }
        if let Some(shown) = shown {
            return Ok(Self { world: false, words: shown.join(", ") });
        }
        let said: Vec<&str> = notes.sees.iter().map(String::as_str).collect();
        Ok(Self { world: false, words: if said.is_empty() { sent } else { said }.join(", ") })
    }
}

/// Numbers of flights that stay near the expert's on average, and of all that were flown for at least half of their length.
fn near_expert(rows: &[Row]) -> (usize, usize) {
    let metric = METRICS.iter().find(|metric| metric.name == "from_expert_m");
    let long = rows.iter().filter(|row| 2 * u64::from(row.score.steps) >= u64::from(row.score.planned_steps));
    let apart_m: Vec<f64> = long.filter_map(|row| (metric?.of)(row)).collect();
    (apart_m.iter().filter(|apart_m| **apart_m < EXPERT_M).count(), apart_m.len())
}
