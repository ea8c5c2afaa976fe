//! Which claims weigh: a reading that a true statement of the same text makes void is none.

use crate::facts::Facts;
use crate::precision::{SPEED_STEP_MPS, STOP_STEP_S, is_step, way_step_m};
use crate::turns::Turn;
use cosfly_claims::Claim;
use cosfly_claims::TurnKind;
use std::collections::BTreeSet;

/// Turns that the text lists, in order.
pub(super) fn listed(claims: &[Claim]) -> Vec<TurnKind> {
    let turn = |claim: &Claim| match claim {
        Claim::Turn(kind) => Some(*kind),
        _ => None,
    };
    claims.iter().filter_map(turn).collect()
}

/// Turns of a flight, in order, each with whether it is a doubtful one, which a text may leave out.
fn told(facts: &Facts) -> Vec<(TurnKind, bool)> {
    let of = |turns: &[Turn], is_doubtful| -> Vec<(u32, TurnKind, bool)> {
        turns.iter().map(|turn| (turn.frame, turn.kind, is_doubtful)).collect()
    };
    let mut all = [of(&facts.turns, false), of(&facts.doubtful_turns, true)].concat();
    all.sort_by_key(|it| it.0);
    all.into_iter().map(|(_, kind, is_doubtful)| (kind, is_doubtful)).collect()
}

/// Whether the turns of a text are those of the flight: words that may be turns count where they fit, and `twice, to the right`
/// lists two.
pub(super) fn is_list_of(claims: &[Claim], facts: &Facts) -> bool {
    let listed = listed(claims);
    let is_counted = claims.contains(&Claim::Turns(facts.turns.len()));
    if let ([kind], true) = (&listed[..], is_counted)
        && facts.turns.iter().all(|turn| turn.kind == *kind)
    {
        return true;
    }
    let told = told(facts);
    let beyond_doubtful = |from: usize| {
        let skipped = told[from..].iter().take_while(|(_, is_doubtful)| *is_doubtful).count();
        from..=from + skipped
    };
    // Of each beginning of the claims, up to which of the flight's turns it may lead.
    let mut reached: BTreeSet<usize> = beyond_doubtful(0).collect();
    for claim in claims {
        let listing = |kind: TurnKind| -> BTreeSet<usize> {
            let next = reached.iter().filter(|at| told.get(**at).is_some_and(|it| it.0 == kind));
            next.flat_map(|at| beyond_doubtful(at + 1)).collect()
        };
        reached = match claim {
            Claim::Turn(kind) => listing(*kind),
            Claim::PerhapsTurn(kind) => &listing(*kind) | &reached,
            _ => reached,
        };
    }
    reached.contains(&told.len())
}

/// Whether a flight may be said to have so many turns, of a kind or of all kinds.
pub(super) fn may_have(count: usize, kind: Option<TurnKind>, facts: &Facts) -> bool {
    let of = |turns: &[Turn]| turns.iter().filter(|turn| kind.is_none_or(|kind| turn.kind == kind)).count();
    let sure = of(&facts.turns);
    (sure..=sure + of(&facts.doubtful_turns)).contains(&count)
}

/// Whether a claim says anything beside the others of its text.
///
/// Words of standing, pausing and going straight have many senses. A number or a list that is true says more: who walks 130 m does
/// not stand all the time, and who stops twice for 8 seconds does stop, whatever else the words may mean.
pub(super) fn is_of_weight(claim: &Claim, claims: &[Claim], facts: &Facts) -> bool {
    let is_turn = |claim: &Claim| matches!(claim, Claim::Turn(_) | Claim::Turns(_) | Claim::TurnsOf(..));
    let stays = |claim: &Claim| matches!(claim, Claim::Stays | Claim::StandsFor(_));
    match claim {
        Claim::Straight => !claims.iter().any(is_turn),
        Claim::NoTurns => !states_the_turns(claims, facts),
        Claim::Turns(count) => {
            !lists_the_turns(claims, facts) || *count > facts.turns.len() + facts.doubtful_turns.len()
        }
        Claim::Stops(0) => !states_the_stops(claims, facts),
        Claim::SomeStops => {
            (facts.walks || !claims.iter().any(stays)) && !claims.contains(&Claim::Stops(facts.stops.len()))
        }
        Claim::Stays => !states_the_walk(claims, facts) && !states_the_stops(claims, facts),
        _ => true,
    }
}

fn lists_the_turns(claims: &[Claim], facts: &Facts) -> bool {
    let has_turns = !facts.turns.is_empty() || !facts.doubtful_turns.is_empty();
    has_turns && !listed(claims).is_empty() && is_list_of(claims, facts)
}

fn states_the_turns(claims: &[Claim], facts: &Facts) -> bool {
    lists_the_turns(claims, facts) || !facts.turns.is_empty() && claims.contains(&Claim::Turns(facts.turns.len()))
}

fn states_the_stops(claims: &[Claim], facts: &Facts) -> bool {
    let is_time = |claim: &Claim| match claim {
        Claim::Standing(found) | Claim::StandsFor(found) => is_step(*found, facts.standing_s(), STOP_STEP_S),
        _ => false,
    };
    !facts.stops.is_empty() && (claims.contains(&Claim::Stops(facts.stops.len())) || claims.iter().any(is_time))
}

/// Whether the text states a way, a speed or turns that the target of the facts has walked.
pub(super) fn states_the_walk(claims: &[Claim], facts: &Facts) -> bool {
    let is_of_the_walk = |claim: &Claim| match claim {
        Claim::Way(found) => is_step(*found, facts.way_m, way_step_m(facts.way_m)),
        Claim::Speed(found) => is_step(*found, facts.walking_speed_mps, SPEED_STEP_MPS),
        _ => false,
    };
    facts.walks && (claims.iter().any(is_of_the_walk) || states_the_turns(claims, facts))
}
