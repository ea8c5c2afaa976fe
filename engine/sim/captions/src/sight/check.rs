//! The check of a text about one picture: its claims against the facts.

use super::beside::NearLandmark;
use super::facts::{Place, Seen, Sight};
use super::reading::{SightClaim, read};
use crate::check::{Slot, SlotMismatch, clothes_mismatch, script_mismatch};
use cosfly_claims::Language;
use std::fmt::Debug;

/// Compares what a text claims of the target's place, way, clothes and of the people around it with the facts of the picture.
///
/// What the facts leave open must not be claimed. A text about a picture without the target says so.
///
/// # Errors
/// All disagreements, in the order of the text.
pub fn check_sight(text: &str, language: Language, sight: &Sight) -> Result<(), Vec<SlotMismatch>> {
    let claims = read(text, language);
    let mut mismatches: Vec<SlotMismatch> = script_mismatch(text, language).into_iter().collect();
    mismatches.extend(claims.iter().filter_map(|claim| mismatch(claim, sight)));
    if sight.seen.is_none() && !claims.contains(&SightClaim::Hidden) {
        mismatches.push(told(Slot::Place, "in the picture", "not in the picture"));
    }
    if mismatches.is_empty() { Ok(()) } else { Err(mismatches) }
}

fn mismatch(claim: &SightClaim, sight: &Sight) -> Option<SlotMismatch> {
    let seen = match (claim, &sight.seen) {
        (SightClaim::Clothes(clothes), _) => {
            return sight.wear.as_ref().and_then(|wear| clothes_mismatch(clothes, wear));
        }
        (SightClaim::Unknown(words), _) => return Some(told(Slot::Number, words, "nothing of the kind")),
        (SightClaim::Hidden, None) => return None,
        (_, None) => return Some(told(Slot::Place, claim, "not in the picture")),
        (SightClaim::Hidden, Some(_)) => return Some(told(Slot::Place, "not in the picture", "in the picture")),
        (_, Some(seen)) => seen,
    };
    let differs = |slot, holds: bool, fact: &dyn Debug| (!holds).then(|| told(slot, claim, fact));
    match claim {
        SightClaim::Across(across) => differs(Slot::Direction, seen.across == Some(*across), &seen.across),
        SightClaim::Part(part) => differs(Slot::Place, seen.part == Some(*part), &seen.part),
        SightClaim::People(count) => differs(Slot::People, seen.people == Some(*count), &seen.people),
        SightClaim::Outermost(side) => differs(Slot::Place, seen.side == Some(*side), &seen.side),
        SightClaim::Nearest => differs(Slot::Place, seen.is_nearest, &seen.is_nearest),
        SightClaim::Near(place, count) => {
            let near = &seen.near[*place as usize];
            differs(Slot::People, near.is_clear && near.tops.len() == *count, near)
        }
        SightClaim::Landmark(it) => {
            let is_so = |fact: &NearLandmark| {
                Some(fact.beside) == it.beside && fact.kind == it.kind && (it.side.is_none() || it.side == fact.side)
            };
            differs(Slot::Place, seen.landmarks.iter().any(is_so), &seen.landmarks)
        }
        SightClaim::NearTop(top) => differs(Slot::Clothes, is_worn_near(seen, *top), &seen.near),
        SightClaim::Clothes(_) | SightClaim::Hidden | SightClaim::Unknown(_) => None,
    }
}

/// Whether a single person near the target wears a top of this colour.
fn is_worn_near(seen: &Seen, top: cosfly_domain::Colour) -> bool {
    Place::ALL.iter().zip(&seen.near).any(|(_, near)| near.is_clear && near.tops == [top])
}

fn told(slot: Slot, found: impl Debug, expected: impl Debug) -> SlotMismatch {
    SlotMismatch { slot, found: format!("{found:?}"), expected: format!("{expected:?}") }
}

#[cfg(test)]
mod tests {
    use super::super::facts::sight;
    use super::super::facts::test_views::{town, views};
    use super::super::instruction;
    use super::*;
    use cosfly_random::Seed;

    /// All texts of all views, with their facts.
    fn texts() -> Vec<(String, Language, Sight)> {
        let mut texts = vec![];
        for view in views() {
            for language in Language::ALL {
                for item in 0..40 {
                    let facts = sight(&view, &town());
                    let seed = Seed::of_item(1, "windows", &format!("p{item}"));
                    texts.push((instruction(&facts, language, seed), language, facts));
                }
            }
        }
        texts
    }

    #[test]
    fn every_text_passes_its_own_check_and_singles_out() {
        for (text, language, facts) in texts() {
            assert_eq!(check_sight(&text, language, &facts), Ok(()), "{text}\n{facts:?}");
            let local = |claim: &SightClaim| !matches!(claim, SightClaim::Clothes(_));
            let claims = read(&text, language);
            assert!(claims.iter().any(local), "{text}\n{facts:?}");
            assert!(claims.iter().any(|claim| !local(claim)), "{text}");
        }
    }

    #[test]
    fn every_text_with_a_word_changed_fails() {
        let swaps = [
            ("away from", "towards"),
            ("towards", "away from"),
            ("to the left", "to the right"),
            ("to the right", "to the left"),
            ("on the left", "on the right"),
            ("on the right", "in the middle"),
            ("in the middle", "on the left"),
            ("leftmost", "rightmost"),
            ("rightmost", "leftmost"),
            ("only person", "nearest person"),
            ("ahead of", "behind"),
            ("just behind", "side by side with"),
            ("side by side with", "ahead of"),
            ("the three people", "the four people"),
            ("the two people", "the three people"),
            ("two others", "three others"),
            ("black top", "white top"),
            ("beige top", "brown top"),
            ("red top", "green top"),
            ("standing still", "walking to the left"),
            ("a tree", "a street lamp"),
            ("a street lamp", "a tree"),
            ("a building", "a parked car"),
            ("passing", "approaching"),
            ("approaching", "passing"),
            ("next to a", "in front of a"),
            ("in front of a", "next to a"),
            ("cannot be seen", "is the nearest"),
            ("背对镜头", "迎着镜头"),
            ("迎着镜头", "背对镜头"),
            ("左侧", "右侧"),
            ("右侧", "左侧"),
            ("中央", "左侧"),
            ("最左", "最右"),
            ("最右", "最左"),
            ("唯一的", "三个"),
            ("前面", "后面"),
            ("后面", "前面"),
            ("并排走着", "走着前面"),
            ("两人", "三人"),
            ("三个人", "四个人"),
            ("黑色", "白色"),
            ("红色", "绿色"),
            ("站着不动", "迎着镜头走来"),
            ("一棵树", "一盏路灯"),
            ("一盏路灯", "一棵树"),
            ("一栋楼房", "一辆停着的汽车"),
            ("从左侧的", "从右侧的"),
            ("旁走过", "前"),
            ("走近", "位于"),
            ("不在视野内", "离镜头最近"),
        ];
        let (mut tried, mut used) = (0, std::collections::BTreeSet::new());
        for (text, language, facts) in texts() {
            for (from, to) in swaps.iter().filter(|(from, _)| text.contains(from)) {
                let changed = text.replacen(from, to, 1);
                assert!(check_sight(&changed, language, &facts).is_err(), "{text}\n{changed}\n{facts:?}");
                tried += 1;
                used.insert(*from);
            }
        }
        assert!(tried > 1_000, "{tried}");
        let unused: Vec<&str> = swaps.iter().map(|(from, _)| *from).filter(|from| !used.contains(from)).collect();
        assert!(unused.is_empty(), "{unused:?}");
    }
}
