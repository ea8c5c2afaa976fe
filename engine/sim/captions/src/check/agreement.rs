//! Which claims weigh: a reading that a true statement of the same text makes void is none.

use crate::facts::Facts;
use crate::precision::{DISTANCE_STEP_M, SPEED_STEP_MPS, STOP_STEP_S, is_step, way_step_m};
use crate::reading::Claim;
use crate::turns::TurnKind;

/// Turns that the text lists, in order.
pub(super) fn listed(claims: &[Claim]) -> Vec<TurnKind> {
    let turn = |claim: &Claim| match claim {
        Claim::Turn(kind) => Some(*kind),
        _ => None,
    };
    claims.iter().filter_map(turn).collect()
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
        Claim::Stays => !states_the_walk(claims, facts),
        _ => true,
    }
}

fn lists_the_turns(claims: &[Claim], facts: &Facts) -> bool {
    !facts.turns.is_empty() && listed(claims).into_iter().eq(facts.turns.iter().map(|turn| turn.kind))
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

/// The claims, in which the length that is the distance is one, where no other is: words near it may speak of the camera.
pub(super) fn with_distance(mut claims: Vec<Claim>, facts: &Facts) -> Vec<Claim> {
    let is_distance = |value: f64| is_step(value, facts.distance_m, DISTANCE_STEP_M);
    let states = |claim: &Claim| match claim {
        Claim::Distance(_) => true,
        Claim::Metres(value) => is_distance(*value),
        _ => false,
    };
    if !claims.iter().any(states) {
        let length = claims.iter_mut().find_map(|claim| match *claim {
            Claim::Altitude(value) | Claim::Way(value) if is_distance(value) => Some((claim, value)),
            _ => None,
        });
        if let Some((claim, value)) = length {
            *claim = Claim::Distance(value);
        }
    }
    claims
}
