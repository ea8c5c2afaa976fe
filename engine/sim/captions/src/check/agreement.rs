//! Which claims weigh: a reading that a true statement of the same text makes void is none.

use crate::facts::Facts;
use crate::precision::{SPEED_STEP_MPS, STOP_STEP_S, is_step, way_step_m};
use cosfly_claims::Claim;
use cosfly_claims::TurnKind;

/// Turns that the text lists, in order.
pub(super) fn listed(claims: &[Claim]) -> Vec<TurnKind> {
    let turn = |claim: &Claim| match claim {
        Claim::Turn(kind) => Some(*kind),
        _ => None,
    };
    claims.iter().filter_map(turn).collect()
}

/// Whether the turns of a text are these: words that may be turns count where they fit, and `twice, to the right` lists two.
pub(super) fn is_list_of(claims: &[Claim], expected: &[TurnKind]) -> bool {
    let listed = listed(claims);
    let is_counted = claims.contains(&Claim::Turns(expected.len()));
    if let ([kind], true) = (&listed[..], is_counted)
        && expected.iter().all(|it| it == kind)
    {
        return true;
    }
    // Of each beginning of the claims, how many of the expected turns it may list.
    let mut reached = std::collections::BTreeSet::from([0]);
    for claim in claims {
        let next = |count: &usize, kind: TurnKind| (expected.get(*count) == Some(&kind)).then_some(count + 1);
        reached = match claim {
            Claim::Turn(kind) => reached.iter().filter_map(|count| next(count, *kind)).collect(),
            Claim::PerhapsTurn(kind) => {
                reached.iter().flat_map(|count| [Some(*count), next(count, *kind)]).flatten().collect()
            }
            _ => reached,
        };
    }
    reached.contains(&expected.len())
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
        Claim::Turns(count) => !lists_the_turns(claims, facts) || *count > facts.turns.len(),
        Claim::Stops(0) => !states_the_stops(claims, facts),
        Claim::SomeStops => {
            (facts.walks || !claims.iter().any(stays)) && !claims.contains(&Claim::Stops(facts.stops.len()))
        }
        Claim::Stays => !states_the_walk(claims, facts) && !states_the_stops(claims, facts),
        _ => true,
    }
}

fn lists_the_turns(claims: &[Claim], facts: &Facts) -> bool {
    let turns: Vec<TurnKind> = facts.turns.iter().map(|turn| turn.kind).collect();
    !turns.is_empty() && !listed(claims).is_empty() && is_list_of(claims, &turns)
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
