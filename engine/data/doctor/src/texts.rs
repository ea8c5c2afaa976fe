//! Figures of instructions: how different they are, what they speak of, how much of it is true. Anyone's texts can be given in the
//! place of a dataset's own.

use crate::walk::facts_of;
use cosfly_captions::teaching::foreign_words;
use cosfly_captions::{Coverage, Diversity, Facts, Language, Slot, check, claimed, coverage, diversity};
use cosfly_diagnose::{Diagnostic, Fault, Result};
use cosfly_episodes::ExaminedEpisode;
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;
use std::path::Path;

/// A text about an episode, as a line of a file has it.
#[derive(Clone, Debug, Deserialize)]
struct Line {
    trajectory_id: String,
    language: String,
    text: String,
}

/// Texts of others, by episode.
#[derive(Clone, Debug, Default)]
pub struct GivenTexts(BTreeMap<String, Vec<(String, String)>>);

/// Figures of the texts of one language.
#[derive(Clone, Debug, Serialize)]
pub struct TextFigures {
    /// Language code.
    pub language: &'static str,
    /// Lengths, distinct-n, self-BLEU.
    #[serde(flatten)]
    pub diversity: Diversity,
    /// Share of texts without a contradiction.
    pub true_share: f64,
    /// Share of texts that name the target by its clothes, of flights whose clothes are known; none where none are.
    pub names_target_share: Option<f64>,
    /// Share of texts that name clothes which nobody else who is seen in the flight wears, of flights where that is known.
    pub singles_out_share: Option<f64>,
    /// By subject: number of texts that speak of it, and of texts that contradict the facts in it.
    pub subjects: BTreeMap<&'static str, [usize; 2]>,
    /// Number of texts by relation of the target to its surroundings that they speak of.
    pub relations: BTreeMap<&'static str, usize>,
    /// Number of texts by intent, what a pilot shall do.
    pub intents: BTreeMap<&'static str, usize>,
}

/// The verdict on a given text.
#[derive(Clone, Debug, Serialize)]
pub struct TextVerdict {
    /// Episode.
    pub trajectory_id: String,
    /// Language code.
    pub language: String,
    /// The text.
    pub text: String,
    /// Claims that are not true of it.
    pub contradictions: Vec<String>,
}

/// Verdicts on given texts, and the facts that they were compared with.
#[derive(Clone, Debug, Default, Serialize)]
pub struct Judged {
    /// Facts by episode.
    pub facts: BTreeMap<String, Facts>,
    /// Verdicts in the order of the episodes.
    pub verdicts: Vec<TextVerdict>,
}

impl GivenTexts {
    /// Reads lines of JSON with `trajectory_id`, `language` and `text`.
    ///
    /// # Errors
    /// `doctor-texts` names the line; errors of the machine.
    pub fn read(path: &Path) -> Result<Self> {
        let bytes = std::fs::read(path).map_err(|error| Diagnostic::unread(format!("`{}`", path.display()), &error))?;
        let mut texts = Self::default();
        for (number, line) in String::from_utf8_lossy(&bytes).lines().enumerate() {
            if line.trim().is_empty() {
                continue;
            }
            let line: Line = serde_json::from_str(line).map_err(|error| {
                let message = format!("line {} of `{}` is no text: {error}", number + 1, path.display());
                Diagnostic::new("doctor-texts", Fault::Input, message)
                    .hint("a line is a JSON object with `trajectory_id`, `language` (`en` or `zh`) and `text`")
            })?;
            texts.0.entry(line.trajectory_id).or_default().push((line.language, line.text));
        }
        Ok(texts)
    }

    /// Puts the texts in the place of an episode's own.
    pub(crate) fn give(&self, episode: &mut ExaminedEpisode) {
        episode.captions = self.0.get(&episode.id).cloned().unwrap_or_default();
    }

    /// The first episode that has texts and is not among `known`.
    pub(crate) fn stranger<'a>(&'a self, known: impl Iterator<Item = &'a str>) -> Option<&'a str> {
        let known: std::collections::BTreeSet<&str> = known.collect();
        self.0.keys().map(String::as_str).find(|id| !known.contains(id))
    }
}

/// Number of languages.
const LANGUAGES: usize = Language::ALL.len();

/// Tally of the texts of all episodes, by language.
#[derive(Default)]
pub(crate) struct TextTally {
    texts: [Vec<String>; LANGUAGES],
    /// Flight and text, and the film that had it first: texts are of flights, and count once.
    first: [BTreeMap<(String, String), String>; LANGUAGES],
    clean: [usize; LANGUAGES],
    dressed: [[usize; 2]; LANGUAGES],
    singled: [[usize; 2]; LANGUAGES],
    subjects: [BTreeMap<Slot, [usize; 2]>; LANGUAGES],
    /// Only for given texts.
    pub(crate) judged: Option<Judged>,
}

impl TextTally {
    pub(crate) fn add(&mut self, episode: &ExaminedEpisode) {
        let Some(facts) = facts_of(episode) else { return };
        for (code, text) in &episode.captions {
            let Some(language) = Language::of_code(code) else { continue };
            let at = language as usize;
            if self.is_of_another_film(at, episode, text) {
                continue;
            }
            let slots = claimed(text, language);
            let mut wrong = check(text, language, &facts).err().unwrap_or_default();
            if self.judged.is_some() {
                wrong.extend(foreign_words(text, language));
            }
            self.clean[at] += usize::from(wrong.is_empty());
            if facts.wear.is_some() {
                self.dressed[at][0] += usize::from(slots.contains(&Slot::Clothes));
                self.dressed[at][1] += 1;
            }
            if let Some(is_unlike_all) = episode.is_unlike_all {
                let is_true = !wrong.iter().any(|it| it.slot == Slot::Clothes);
                self.singled[at][0] += usize::from(is_unlike_all && is_true && slots.contains(&Slot::Clothes));
                self.singled[at][1] += 1;
            }
            slots.iter().for_each(|slot| self.subjects[at].entry(*slot).or_default()[0] += 1);
            let mut false_slots: Vec<Slot> = wrong.iter().map(|it| it.slot).collect();
            false_slots.sort_unstable();
            false_slots.dedup();
            false_slots.iter().for_each(|slot| self.subjects[at].entry(*slot).or_default()[1] += 1);
            if let Some(judged) = &mut self.judged {
                judged.verdicts.push(TextVerdict {
                    trajectory_id: episode.id.clone(),
                    language: code.clone(),
                    text: text.clone(),
                    contradictions: wrong.iter().map(ToString::to_string).collect(),
                });
            }
            self.texts[at].push(text.clone());
        }
        if let Some(judged) = &mut self.judged {
            judged.facts.insert(episode.id.clone(), facts);
        }
    }

    /// Whether another film of the flight had the text: the dataset's own texts are those of flights, given ones of films.
    fn is_of_another_film(&mut self, at: usize, episode: &ExaminedEpisode, text: &str) -> bool {
        if self.judged.is_some() || episode.flight.is_empty() {
            return false;
        }
        let key = (episode.flight.clone(), text.to_owned());
        *self.first[at].entry(key).or_insert_with(|| episode.id.clone()) != episode.id
    }

    pub(crate) fn figures(&self) -> Vec<TextFigures> {
        let of = |at: usize| {
            let share = |part: usize, whole: usize| part as f64 / whole.max(1) as f64;
            let known = |[part, whole]: [usize; 2]| (whole > 0).then(|| share(part, whole));
            let texts = || self.texts[at].iter().map(String::as_str);
            let Coverage { relations, intents } = coverage(texts(), Language::ALL[at]);
            TextFigures {
                language: Language::ALL[at].code(),
                diversity: diversity(texts(), Language::ALL[at]),
                true_share: share(self.clean[at], self.texts[at].len()),
                names_target_share: known(self.dressed[at]),
                singles_out_share: known(self.singled[at]),
                subjects: self.subjects[at].iter().map(|(slot, counts)| (slot.name(), *counts)).collect(),
                relations,
                intents,
            }
        };
        (0..LANGUAGES).filter(|at| !self.texts[*at].is_empty()).map(of).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::walk::tests::episode;

    fn film(id: &str, flight: &str) -> ExaminedEpisode {
        ExaminedEpisode { id: id.to_owned(), flight: flight.to_owned(), ..episode(&[(0.0, 12.0)], "walks straight on") }
    }

    #[test]
    fn a_text_of_several_films_of_a_flight_counts_once() {
        let count = |films: [ExaminedEpisode; 2]| {
            let mut tally = TextTally::default();
            films.iter().for_each(|film| tally.add(film));
            tally.texts[Language::En as usize].len()
        };
        assert_eq!(count([film("a-left", "a"), film("a-right", "a")]), 1);
        assert_eq!(count([film("a", "a"), film("b", "b")]), 2);
        assert_eq!(count([film("a", ""), film("b", "")]), 2);
    }

    #[test]
    fn shares_of_clothes_are_of_flights_whose_clothes_are_known() {
        let of = |is_unlike_all: Option<bool>| {
            let mut tally = TextTally::default();
            tally.add(&ExaminedEpisode { is_unlike_all, ..film("a", "") });
            let figures = tally.figures().remove(0);
            (figures.names_target_share, figures.singles_out_share)
        };
        assert_eq!((of(None), of(Some(true))), ((None, None), (None, Some(0.0))));
    }
}
