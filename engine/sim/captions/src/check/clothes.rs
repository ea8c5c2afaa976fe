//! Claims about clothes against the clothes.

use super::slot::{Slot, SlotMismatch};
use crate::facts::Wear;
use cosfly_claims::Claim;

/// Disagreement of a claim about clothes with the clothes; `None` for other claims.
pub(super) fn clothes_mismatch(claim: &Claim, wear: &Wear) -> Option<SlotMismatch> {
    let backpack = |there: bool| if there { "one" } else { "none" };
    let (garment, found, expected) = match claim {
        Claim::Top(colour) => ("top", colour.name(), wear.top.name()),
        Claim::Trousers(colour) => ("trousers", colour.name(), wear.trousers.name()),
        Claim::Backpack(there) => ("backpack", backpack(*there), backpack(wear.backpack)),
        _ => return None,
    };
    let told = |words: &str| format!("{garment}: {words}");
    (found != expected).then(|| SlotMismatch { slot: Slot::Clothes, found: told(found), expected: told(expected) })
}
