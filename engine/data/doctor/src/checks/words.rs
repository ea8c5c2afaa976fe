//! Instructions that differ from their flights.

use crate::walk::facts_of;
use cosfly_captions::{Language, check as check_caption};
use cosfly_episodes::{ExaminedEpisode, Flag};

/// Parses every instruction in a known language and compares it with the facts of the flight.
pub fn check(episode: &ExaminedEpisode) -> Vec<Flag> {
    let Some(facts) = facts_of(episode).filter(|_| !episode.captions.is_empty()) else { return vec![] };
    let mut flags = vec![];
    for (code, text) in &episode.captions {
        let Some(language) = Language::of_code(code) else { continue };
        if let Err(mismatches) = check_caption(text, language, &facts) {
            let shown: Vec<String> = mismatches.iter().take(2).map(ToString::to_string).collect();
            let message = format!("its instruction ({code}) is not true: {}", shown.join("; "));
            flags.push(Flag::damage("caption-mismatch", &episode.id, message));
        }
    }
    flags
}
