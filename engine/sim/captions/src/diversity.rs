//! How different texts are: distinct-n, self-BLEU, lengths.

use crate::language::Language;
use cosfly_frames::real;
use serde::Serialize;
use std::collections::{BTreeMap, BTreeSet};

/// Longest runs of words that BLEU counts.
const LONGEST: usize = 4;

/// Figures of the texts of one language. A word is a run of letters or digits in English, a character in Chinese.
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
    match language {
        Language::En => {
            let parts = lower.split(|c: char| !c.is_alphanumeric() && c != '.' && c != '/' && c != '\'');
            parts.map(|word| word.trim_matches(['.', '\'', '/']).to_owned()).filter(|word| !word.is_empty()).collect()
        }
        Language::Zh => {
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
    let bleu = |at: usize| {
        let others = all[at.saturating_sub(NEIGHBOURS)..at].iter().chain(all.iter().skip(at + 1).take(NEIGHBOURS));
        bleu(&all[at], &others.map(Vec::as_slice).collect::<Vec<_>>())
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

/// BLEU-4 of a text against several; runs that do not occur count half of one.
fn bleu(text: &[u32], others: &[&[u32]]) -> f64 {
    if text.is_empty() || others.is_empty() {
        return 0.0;
    }
    let longest = LONGEST.min(text.len());
    let mut logarithms = 0.0;
    for length in 1..=longest {
        let mut counts: BTreeMap<&[u32], usize> = BTreeMap::new();
        text.windows(length).for_each(|run| *counts.entry(run).or_default() += 1);
        let in_others = |run: &[u32]| {
            others.iter().map(|other| other.windows(length).filter(|it| *it == run).count()).max().unwrap_or(0)
        };
        let shared: usize = counts.iter().map(|(run, count)| (*count).min(in_others(run))).sum();
        let runs = text.len() + 1 - length;
        logarithms += real::ln(if shared == 0 { 0.5 } else { shared as f64 } / runs as f64);
    }
    let distance = |other: &&&[u32]| (other.len().abs_diff(text.len()), other.len());
    let nearest = others.iter().min_by_key(distance).map_or(0, |other| other.len());
    let brevity = if text.len() >= nearest { 0.0 } else { 1.0 - nearest as f64 / text.len() as f64 };
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

    #[test]
    fn words_of_both_languages() {
        assert_eq!(words("Keep 1.4 m/s, don't stop.", Language::En), ["keep", "1.4", "m/s", "don't", "stop"]);
        assert_eq!(words("保持28米，1.4米/秒。", Language::Zh), ["保", "持", "28", "米", "1.4", "米", "秒"]);
    }
}
