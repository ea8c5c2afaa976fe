//! How different texts are: distinct-n, self-BLEU, lengths.

use cosfly_claims::{Language, Script};
use cosfly_frames::real;
use serde::Serialize;
use std::collections::{BTreeMap, BTreeSet};

/// Longest runs of words that BLEU counts.
const LONGEST: usize = 4;

/// Figures of the texts of one language. A word is a run of letters or digits, a character in Chinese.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct Diversity {
    /// Number of texts.
    pub texts: usize,
    /// Number of different texts.
    pub different_texts: usize,
    /// Mean number of words of a text.
    pub mean_words: f64,
    /// Fewest and most words of a text.
    pub words: [usize; 2],
    /// Different words / all words.
    pub distinct_1: f64,
    /// Different pairs of neighbouring words / all pairs.
    pub distinct_2: f64,
    /// Number of different pairs of neighbouring words.
    pub pairs: usize,
    /// Mean BLEU-4 of a text against the texts before and after it, up to ten each; 1: all alike.
    pub self_bleu: f64,
}

/// Texts on either side of a text that it is compared with.
const NEIGHBOURS: usize = 10;

/// Words of a text, in lower case, without punctuation.
pub fn words(text: &str, language: Language) -> Vec<String> {
    let lower = text.to_lowercase();
    match language.script() {
        Script::Latin => {
            let parts = lower.split(|c: char| !c.is_alphanumeric() && c != '.' && c != '/' && c != '\'');
            parts.map(|word| word.trim_matches(['.', '\'', '/']).to_owned()).filter(|word| !word.is_empty()).collect()
        }
        Script::Han => {
            // A number is one word.
            let mut words: Vec<String> = vec![];
            let mut in_number = false;
            for c in lower.chars() {
                let is_digit = c.is_ascii_digit() || (c == '.' && in_number);
                match (is_digit, in_number) {
                    (true, true) => words.last_mut().expect("a number has begun").push(c),
                    _ if c.is_alphanumeric() => words.push(c.to_string()),
                    _ => {}
                }
                in_number = is_digit;
            }
            words
        }
    }
}

/// Figures of texts.
pub fn diversity<'t>(texts: impl IntoIterator<Item = &'t str>, language: Language) -> Diversity {
    let mut numbers: BTreeMap<String, u32> = BTreeMap::new();
    let mut different = BTreeSet::new();
    let mut all: Vec<Vec<u32>> = vec![];
    for text in texts {
        different.insert(text);
        let number = |word: String| {
            let next = numbers.len() as u32;
            *numbers.entry(word).or_insert(next)
        };
        all.push(words(text, language).into_iter().map(number).collect());
    }
    let total: usize = all.iter().map(Vec::len).sum();
    let pairs: BTreeSet<(u32, u32)> = all.iter().flat_map(|it| it.windows(2).map(|pair| (pair[0], pair[1]))).collect();
    let all_pairs: usize = all.iter().map(|it| it.len().saturating_sub(1)).sum();
    let share = |part: usize, whole: usize| part as f64 / whole.max(1) as f64;
    let runs = runs_of(&all);
    let bleu = |at: usize| {
        let others = (at.saturating_sub(NEIGHBOURS)..at).chain((at + 1..all.len()).take(NEIGHBOURS));
        bleu(&all, &runs, at, &others.collect::<Vec<_>>())
    };
    Diversity {
        texts: all.len(),
        different_texts: different.len(),
        mean_words: share(total, all.len()),
        words: [all.iter().map(Vec::len).min().unwrap_or(0), all.iter().map(Vec::len).max().unwrap_or(0)],
        distinct_1: share(numbers.len(), total),
        distinct_2: share(pairs.len(), all_pairs),
        pairs: pairs.len(),
        self_bleu: (0..all.len()).map(bleu).sum::<f64>() / all.len().max(1) as f64,
    }
}

/// Runs of words of a text: the number of each different run, in order, and how often it occurs.
type Runs = Vec<(u32, usize)>;

/// The runs of each length in each text; equal runs of one length have the same number in all texts.
fn runs_of(texts: &[Vec<u32>]) -> [Vec<Runs>; LONGEST] {
    // Runs of one word less that begin at each word.
    let mut shorter: Vec<Vec<u32>> = texts.iter().map(|text| vec![0; text.len() + 1]).collect();
    std::array::from_fn(|longer_by| {
        let mut numbers: BTreeMap<(u32, u32), u32> = BTreeMap::new();
        let mut of_length = vec![];
        for (text, shorter) in texts.iter().zip(&mut shorter) {
            let number = |(run, word): (&u32, &u32)| {
                let next = numbers.len() as u32;
                *numbers.entry((*run, *word)).or_insert(next)
            };
            *shorter = shorter.iter().zip(text.iter().skip(longer_by)).map(number).collect();
            let mut sorted = shorter.clone();
            sorted.sort_unstable();
            of_length.push(sorted.chunk_by(|a, b| a == b).map(|alike| (alike[0], alike.len())).collect());
        }
        of_length
    })
}

/// Number of runs of a text that others have, too: of each run as many as the one that has most of them.
fn shared_runs(text: &Runs, others: &[&Runs]) -> usize {
    let mut most = vec![0; text.len()];
    for other in others {
        let mut other = other.iter().peekable();
        for ((run, _), most) in text.iter().zip(&mut most) {
            while other.next_if(|(it, _)| it < run).is_some() {}
            if let Some((_, count)) = other.next_if(|(it, _)| it == run) {
                *most = (*most).max(*count);
            }
        }
    }
    text.iter().zip(most).map(|((_, count), most)| (*count).min(most)).sum()
}

/// BLEU-4 of text number `at` against several; runs that do not occur count half of one.
fn bleu(texts: &[Vec<u32>], runs: &[Vec<Runs>; LONGEST], at: usize, others: &[usize]) -> f64 {
    let words = texts[at].len();
    if words == 0 || others.is_empty() {
        return 0.0;
    }
    let longest = LONGEST.min(words);
    let mut logarithms = 0.0;
    for (length, runs) in (1..=longest).zip(runs) {
        let of_others: Vec<&Runs> = others.iter().map(|other| &runs[*other]).collect();
        let shared = shared_runs(&runs[at], &of_others);
        logarithms += real::ln(if shared == 0 { 0.5 } else { shared as f64 } / (words + 1 - length) as f64);
    }
    let distance = |other: &usize| (other.abs_diff(words), *other);
    let nearest = others.iter().map(|other| texts[*other].len()).min_by_key(distance).unwrap_or(0);
    let brevity = if words >= nearest { 0.0 } else { 1.0 - nearest as f64 / words as f64 };
    real::exp(logarithms / longest as f64 + brevity).min(1.0)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn equal_texts_have_no_diversity_and_different_ones_much() {
        let same = diversity(["follow the person now please"; 4], Language::En);
        assert_eq!((same.texts, same.different_texts, same.pairs), (4, 1, 4));
        assert!((same.self_bleu - 1.0).abs() < 1e-12 && (same.distinct_2 - 0.25).abs() < 1e-12);
        let other = diversity(["one two three four", "five six seven eight"], Language::En);
        assert!((other.distinct_1 - 1.0).abs() < 1e-12 && other.self_bleu < 0.3, "{other:?}");
        assert_eq!(diversity([], Language::Zh), Diversity::default());
    }

    /// Runs that a text shares with others, counted run by run.
    fn counted(text: &[u32], others: &[&[u32]], length: usize) -> usize {
        let mut counts: BTreeMap<&[u32], usize> = BTreeMap::new();
        text.windows(length).for_each(|run| *counts.entry(run).or_default() += 1);
        let most = |run: &[u32]| others.iter().map(|it| it.windows(length).filter(|other| *other == run).count()).max();
        counts.iter().map(|(run, count)| (*count).min(most(run).unwrap_or(0))).sum()
    }

    #[test]
    fn shared_runs_are_those_that_are_counted_one_by_one() {
        let text = |seed: u32| (0..seed % 9).map(|at| (seed * 7 + at * at * 5) % 4).collect();
        let texts: Vec<Vec<u32>> = (0..40).map(text).collect();
        let runs = runs_of(&texts);
        for at in 0..texts.len() {
            let others: Vec<usize> = (0..texts.len()).filter(|other| other % 7 == at % 5).collect();
            for length in 1..=LONGEST {
                let of_length = &runs[length - 1];
                let found = shared_runs(&of_length[at], &others.iter().map(|it| &of_length[*it]).collect::<Vec<_>>());
                let all: Vec<&[u32]> = others.iter().map(|it| texts[*it].as_slice()).collect();
                assert_eq!(found, counted(&texts[at], &all, length), "text {at}, length {length}");
            }
        }
    }

    #[test]
    fn words_of_both_languages() {
        assert_eq!(words("Keep 1.4 m/s, don't stop.", Language::En), ["keep", "1.4", "m/s", "don't", "stop"]);
        assert_eq!(words("保持28米，1.4米/秒。", Language::Zh), ["保", "持", "28", "米", "1.4", "米", "秒"]);
    }
}
