//! Turns and repetitions.

use crate::claim::Claim;
use crate::lexicon::Concept;
use crate::sentence::Sentence;
use crate::token::Token;
use crate::turn::TurnKind;

/// Words between a word of turning and its side: `turns to the right`.
const REACH: usize = 3;
/// No list of turns is longer.
const MOST: usize = 100;

/// The turn at a place, by its phrase or by a side near a word of turning or in a list of turns.
pub(crate) fn turn(sentence: Sentence<'_>, at: usize, claims: &[Claim]) -> Option<TurnKind> {
    let kind = match sentence.concept(at)? {
        Concept::Turn(kind) => return Some(kind),
        Concept::Side(kind) => kind,
        _ => return None,
    };
    let is_turning = |place: usize| sentence.concept(place) == Some(Concept::Turning);
    let is_number = |place: usize| matches!(sentence.0.get(place), Some(Token::Number(..)));
    let near = (sentence.clause(at).start.max(at.saturating_sub(REACH))..at).any(is_turning);
    let begins =
        at == 0 || matches!(sentence.0[at - 1], Token::Comma) || sentence.concept(at - 1) == Some(Concept::And);
    let is_listed = begins && claims.iter().any(|it| matches!(it, Claim::Turn(_) | Claim::Turns(_)));
    // `about 28 m`, with another word for `about`.
    let is_about = kind == TurnKind::Around && is_number(at + 1);
    (!is_about && (near || is_turning(at + 1) || is_listed || at > 0 && is_number(at - 1))).then_some(kind)
}

/// Turns to one side, so many: a list, or a count beside the number of all turns.
pub(crate) fn turns(kind: TurnKind, count: usize, claims: &[Claim]) -> Vec<Claim> {
    let is_counted = claims.iter().any(|it| matches!(it, Claim::Turns(_)));
    if is_counted || count > MOST { vec![Claim::TurnsOf(kind, count)] } else { vec![Claim::Turn(kind); count] }
}

/// Claims in which counts of sides beside single turns are part of the list.
pub(crate) fn listed(claims: Vec<Claim>) -> Vec<Claim> {
    if !claims.iter().any(|it| matches!(it, Claim::Turn(_))) {
        return claims;
    }
    let of = |claim: Claim| match claim {
        Claim::TurnsOf(kind, count) if count <= MOST => vec![Claim::Turn(kind); count],
        other => vec![other],
    };
    claims.into_iter().flat_map(of).collect()
}

/// Claim of a repetition, by the word behind or before it; the repetition takes the tokens `at` to `end`. Gives the
/// place behind what was read.
pub(crate) fn repetition(
    sentence: Sentence<'_>,
    (at, end): (usize, usize),
    count: usize,
    claims: &mut Vec<Claim>,
) -> usize {
    match sentence.concept(end) {
        Some(Concept::Stop) => {
            claims.push(Claim::Stops(if sentence.is_denied(end) { 0 } else { count }));
            return end + 1;
        }
        Some(Concept::Turn(kind)) => {
            claims.extend(turns(kind, count, claims));
            return end + 1;
        }
        _ => {}
    }
    let is_cue = |it| matches!(it, Concept::Stop | Concept::Turning | Concept::Turn(_) | Concept::Side(_));
    let near = sentence.before(at, &is_cue).or_else(|| sentence.long_before(at, &is_cue));
    // `Once they stop`
    let near = near.or_else(|| sentence.behind(end - 1, sentence.0.len(), &is_cue));
    match near.map(|place| (place, sentence.concept(place))) {
        Some((place, Some(Concept::Stop | Concept::Turning))) if sentence.is_denied(place) => {}
        Some((_, Some(Concept::Stop))) => claims.push(Claim::Stops(count)),
        Some((_, Some(Concept::Turn(kind) | Concept::Side(kind)))) => {
            if claims.last() == Some(&Claim::Turn(kind)) {
                claims.pop();
            }
            claims.extend(turns(kind, count, claims));
        }
        Some(_) => claims.push(Claim::Turns(count)),
        // `Once you see them` counts nothing.
        None if matches!(sentence.concept(at), Some(Concept::Repeated(_))) => {}
        None => claims.push(Claim::Unknown(format!("{count} times"))),
    }
    end
}
