//! Claims about clothes against the clothes.

use super::slot::{Slot, SlotMismatch};
use crate::facts::Wear;
use cosfly_claims::Claim;

/// Disagreement of a claim about clothes with the clothes; `None` for other claims.
pub(crate) fn clothes_mismatch(claim: &Claim, wear: &Wear) -> Option<SlotMismatch> {
    let (garment, found, expected) = match claim {
        Claim::Top(colour) => ("top", colour.name(), wear.top.name()),
        Claim::Trousers(colour) => ("trousers", colour.name(), wear.trousers.name()),
        Claim::Backpack => ("backpack", "one", if wear.backpack { "one" } else { "none" }),
        Claim::NoBackpack => ("backpack", "none", if wear.backpack { "one" } else { "none" }),
        Claim::Shade { is_top, name, colours } => {
            let (garment, worn) = if *is_top { ("top", wear.top) } else { ("trousers", wear.trousers) };
            let told = |words: &str| format!("{garment}: {words}");
            let mismatch = SlotMismatch { slot: Slot::Clothes, found: told(name), expected: told(worn.name()) };
            return (!colours.contains(&worn)).then_some(mismatch);
        }
        Claim::Wears(colour) if *colour == wear.top || *colour == wear.trousers => return None,
        Claim::Wears(colour) => ("colour", colour.name(), wear.top.name()),
        _ => return None,
    };
    let told = |words: &str| format!("{garment}: {words}");
    (found != expected).then(|| SlotMismatch { slot: Slot::Clothes, found: told(found), expected: told(expected) })
}
