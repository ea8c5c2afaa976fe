//! Clothes and luggage in Chinese clauses.

use super::garments::{COLOURS, SHADES, TOPS, TROUSERS};
use crate::Claim;
use cosfly_domain::Colour;

/// Whether a text begins with a colour.
pub(crate) fn begins_with_colour(text: &str) -> bool {
    COLOURS.iter().any(|(name, _)| text.starts_with(name)) || SHADES.iter().any(|(name, _)| text.starts_with(name))
}

/// A shade of a garment, or said of one: `藏青色裤子`, `上衣是卡其色`.
pub(super) fn shade<'a>(clause: &str, text: &'a str) -> Option<(Claim, &'a str)> {
    let (name, colours) = SHADES.iter().find(|(name, _)| text.starts_with(name))?;
    let after = &text[name.len()..];
    let is_coloured = after.starts_with('色');
    let after = after.strip_prefix('色').unwrap_or(after);
    let garment = after.trim_start_matches(['的', 'T']);
    let is_top = TOPS.iter().any(|it| garment.starts_with(it));
    let is_trousers = TROUSERS.iter().any(|it| garment.starts_with(it));
    let before = &clause[..clause.len() - text.len()];
    let last = |words: &[&str]| words.iter().filter_map(|word| before.rfind(word)).max();
    let is_top = match (is_top, is_trousers) {
        (false, false) if !is_coloured => return None,
        (false, false) => {
            let (top, trousers) = (last(&TOPS).max(last(&["上身"])), last(&TROUSERS).max(last(&["下身"])));
            (top.is_some() || trousers.is_some()).then_some(top > trousers)?
        }
        (is_top, _) => is_top,
    };
    Some((Claim::Shade { is_top, name: (*name).to_owned(), colours: colours.to_vec() }, after))
}

/// `上衣是红色`, `上身穿红色`: a colour behind its garment; `红色` alone: something that is worn.
pub(super) fn worn<'a>(clause: &str, text: &'a str) -> Option<(Claim, &'a str)> {
    let (colour, after) = COLOURS.iter().find_map(|(name, colour)| Some((*colour, text.strip_prefix(name)?)))?;
    let before = &clause[..clause.len() - text.len()];
    // `上面穿红的`
    let is_worn = || before.ends_with("穿") && after.starts_with('的');
    // `上身黄，下身紫`
    let is_named =
        || ["上身", "下身", "上衣", "裤子", "上装", "下装", "上是", "下是"].iter().any(|it| before.ends_with(it));
    let after = after.strip_prefix('色').or_else(|| (is_worn() || is_named()).then_some(after))?;
    let last = |words: &[&str]| words.iter().filter_map(|word| before.rfind(word)).max();
    let links = before.ends_with(['是', '为', '穿', '着', '呈', '深', '浅', '身'])
        || TOPS.iter().chain(&TROUSERS).any(|garment| before.ends_with(garment));
    let links = links || is_named();
    let top = last(&TOPS).max(last(&["上身", "上面", "上边", "上装"])).filter(|_| links);
    let trousers = last(&TROUSERS).max(last(&["下身", "下面", "下边", "下装"])).filter(|_| links);
    let claim = match (top, trousers) {
        (None, None) => Claim::Wears(colour),
        (top, trousers) if top > trousers => Claim::Top(colour),
        _ => Claim::Trousers(colour),
    };
    Some((claim, after))
}

/// `上衣和裤子都是紫色`, `上下都穿紫色`: the colour of both garments, where a clause names one colour.
pub(super) fn both_garments(clause: &str, claims: &mut Vec<Claim>) {
    let has = |words: &[&str]| words.iter().any(|word| clause.contains(word));
    let names =
        clause.contains("上下") || has(&TOPS) && has(&TROUSERS) || clause.contains("上身") && clause.contains("下身");
    let colour = |claim: &Claim| match claim {
        Claim::Top(colour) | Claim::Trousers(colour) | Claim::Wears(colour) => Some(*colour),
        _ => None,
    };
    let found: Vec<Colour> = claims.iter().filter_map(colour).collect();
    if let (true, [one]) = (names && clause.contains(['都', '全', '均', '同', '一', '皆']), &found[..]) {
        claims.retain(|claim| colour(claim).is_none());
        claims.extend([Claim::Top(*one), Claim::Trousers(*one)]);
    }
}

/// A colour before a garment at the start of `text`, or luggage; and what follows.
pub fn garment(text: &str) -> Option<(Claim, &str)> {
    for luggage in [
        "背囊",
        "行囊",
        "挎包",
        "旅行包",
        "登山包",
        "双肩背包",
        "双肩包",
        "背包",
        "书包",
        "背着包",
        "背着个包",
        "背个包",
        "背了包",
        "背了个包",
    ] {
        if let Some(after) = text.strip_prefix(luggage) {
            return Some((Claim::Backpack, after));
        }
    }
    let (colour, after) = COLOURS.iter().find_map(|(name, colour)| Some((*colour, text.strip_prefix(name)?)))?;
    let after = after.strip_prefix('色').unwrap_or(after).trim_start_matches(['的', 'T']);
    let starts = |garments: &[&str]| garments.iter().find_map(|garment| after.strip_prefix(garment));
    if let Some(after) = starts(&TOPS) {
        return Some((Claim::Top(colour), after));
    }
    if let Some(after) = starts(&TROUSERS) {
        return Some((Claim::Trousers(colour), after));
    }
    // The head of a word for a garment is its last character: `衬衣`, `夹裤`.
    let (at, head) = after.char_indices().take(HEAD).find(|(_, c)| "衣衫袄裤".contains(*c) || is_of_colour(*c))?;
    let rest = &after[at + head.len_utf8()..];
    match head {
        '裤' => Some((Claim::Trousers(colour), rest)),
        head if !is_of_colour(head) => Some((Claim::Top(colour), rest)),
        _ => None,
    }
}

/// Characters of a garment's name.
const HEAD: usize = 3;

fn is_of_colour(c: char) -> bool {
    "色的和与及".contains(c) || COLOURS.iter().any(|(name, _)| name.contains(c))
}
