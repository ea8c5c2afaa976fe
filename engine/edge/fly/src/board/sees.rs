//! [`PolicySees`]: what a policy sees, as far as an entry tells.

use super::notes::Notes;
use crate::flight::Row;
use crate::pilot::Place;
use crate::results::{Card, METRICS};
use cosfly_env::policies::baseline;

/// A flight that stays within this distance of the expert's on average, metres, is the expert's: a policy that sees no future chooses another one.
const EXPERT_M: f64 = 1.0;
/// A flight within this distance, metres, holds the expert's own actions: one is enough, because files can be mixed of several policies.
const COPIED_M: f64 = 0.1;

/// Inputs of a policy, as far as an entry tells.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct PolicySees {
    /// Whether it knows the world: the whole walk, the expert's flight.
    pub world: bool,
    /// In words.
    pub words: String,
}

impl PolicySees {
    /// Inputs by the card, the notes and the flights of an entry; `shown` is what its policy saw where it was run again.
    ///
    /// # Errors
    /// Contradiction between notes and card, in words.
    pub fn of(card: &Card, notes: &Notes, rows: &[Row], shown: Option<&[String]>) -> Result<Self, String> {
        let sent = card.policy.sent();
        let not_sent = notes.sees.iter().find(|it| *it != "world" && !sent.contains(&it.as_str()));
        if let Some(name) = not_sent {
            let sent = sent.join(", ");
            return Err(format!("its notes say that it sees `{name}`, which it was not sent; it was sent {sent}"));
        }
        let is_expert = shown.is_some_and(|shown| shown.iter().any(|it| it == "world"))
            || card.policy.baseline.as_deref().is_some_and(knows_the_world);
        if is_expert || notes.sees.iter().any(|it| it == "world") {
            return Ok(Self { world: true, words: "world".to_owned() });
        }
        // A baseline that was run again is this program's own; a network may know flights by heart.
        let is_known = shown.is_some() && card.policy.baseline.is_some();
        let apart_m = from_expert_m(rows);
        let within = |most_m: f64| apart_m.iter().filter(|apart_m| **apart_m < most_m).count();
        let (near, copied) = (within(EXPERT_M), within(COPIED_M));
        let (flights, most_m) = if 2 * near > apart_m.len() { (near, EXPERT_M) } else { (copied, COPIED_M) };
        if flights > 0 && !is_known {
            let words = format!(
                "world: {flights} of its flights {} the expert's to less than {most_m} m",
                if flights == 1 { "is" } else { "are" }
            );
            return Ok(Self { world: true, words });
        }
        if let Some(shown) = shown {
            return Ok(Self { world: false, words: shown.join(", ") });
        }
        let said: Vec<&str> = notes.sees.iter().map(String::as_str).collect();
        Ok(Self { world: false, words: if said.is_empty() { sent } else { said }.join(", ") })
    }
}

/// Whether the baseline of this name knows the world; one that this program lacks may know anything.
fn knows_the_world(name: &str) -> bool {
    match Place::of_baseline(name) {
        Some(Place::Baseline { name, .. }) => baseline(name).is_none_or(|own| own.sees.contains(&"world")),
        _ => true,
    }
}

/// Mean distances from the expert's flight, metres, of all flights that last for at least half of their length.
fn from_expert_m(rows: &[Row]) -> Vec<f64> {
    let metric = METRICS.iter().find(|metric| metric.name == "from_expert_m");
    let long = rows.iter().filter(|row| 2 * u64::from(row.score.steps) >= u64::from(row.score.planned_steps));
    long.filter_map(|row| (metric?.of)(row)).collect()
}
