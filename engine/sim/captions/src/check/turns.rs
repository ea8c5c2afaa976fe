//! Turns of a text against those of a flight, of which some are doubtful.

use crate::facts::Facts;
use crate::turns::Turn;
use cosfly_claims::TurnKind;
use std::collections::BTreeSet;

/// Turns of a flight, in order, each with whether it is a doubtful one, which a text may leave out.
fn told(facts: &Facts) -> Vec<(TurnKind, bool)> {
    let of = |turns: &[Turn], is_doubtful| -> Vec<(u32, TurnKind, bool)> {
        turns.iter().map(|turn| (turn.frame, turn.kind, is_doubtful)).collect()
    };
    let mut all = [of(&facts.turns, false), of(&facts.doubtful_turns, true)].concat();
    all.sort_by_key(|it| it.0);
    all.into_iter().map(|(_, kind, is_doubtful)| (kind, is_doubtful)).collect()
}

/// Whether listed turns are those of the flight, in order.
pub(super) fn is_list_of(listed: &[TurnKind], facts: &Facts) -> bool {
    let told = told(facts);
    let beyond_doubtful = |from: usize| {
        let skipped = told[from..].iter().take_while(|(_, is_doubtful)| *is_doubtful).count();
        from..=from + skipped
    };
    // Of each beginning of the list, up to which of the flight's turns it may lead.
    let mut reached: BTreeSet<usize> = beyond_doubtful(0).collect();
    for kind in listed {
        let next = reached.iter().filter(|at| told.get(**at).is_some_and(|it| it.0 == *kind));
        reached = next.flat_map(|at| beyond_doubtful(at + 1)).collect();
    }
    reached.contains(&told.len())
}

/// Whether a flight may be said to have so many turns, of a kind or of all kinds.
pub(super) fn may_have(count: usize, kind: Option<TurnKind>, facts: &Facts) -> bool {
    let of = |turns: &[Turn]| turns.iter().filter(|turn| kind.is_none_or(|kind| turn.kind == kind)).count();
    let sure = of(&facts.turns);
    (sure..=sure + of(&facts.doubtful_turns)).contains(&count)
}
