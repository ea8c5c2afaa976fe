//! Marks of list items, which say nothing: `1.`, `(2)`, `a)`, `- `.

/// Characters behind which an item of a list may begin, with a mark in brackets or with a number and a point.
const BEFORE_BRACKETS: &str = "\n;:.!?,。；：！？，、";
const BEFORE_POINTS: &str = "\n;.。；";
const BULLETS: &str = "-*•·–—";

/// The text without the marks of its list items.
pub fn without_marks(text: &str) -> String {
    let chars: Vec<char> = text.chars().collect();
    let mut plain = String::with_capacity(text.len());
    let mut last = '\n';
    let mut i = 0;
    while i < chars.len() {
        let is_apart = i == 0 || chars[i - 1].is_whitespace() || !".:".contains(chars[i - 1]);
        let begins = is_apart && BEFORE_BRACKETS.contains(last);
        // `1) left 2) right`
        if !begins && !plain.contains(['(', '（']) && i > 0 && chars[i - 1] == ' ' && is_numbered(&chars[i..]) {
            plain.push(',');
            i += 1 + chars[i..].iter().take_while(|c| c.is_ascii_digit()).count();
            continue;
        }
        if let Some(length) = begins.then(|| mark(&chars[i..], BEFORE_POINTS.contains(last))).flatten() {
            i += length;
            continue;
        }
        if chars[i] == '\n' || !chars[i].is_whitespace() {
            last = chars[i];
        }
        plain.push(chars[i]);
        i += 1;
    }
    plain
}

/// `2)`
fn is_numbered(chars: &[char]) -> bool {
    let digits = chars.iter().take_while(|c| c.is_ascii_digit()).count();
    (1..=2).contains(&digits) && chars.get(digits) == Some(&')')
}

/// Length of a mark at the start; `pointed`: a number with a point may be one.
fn mark(chars: &[char], pointed: bool) -> Option<usize> {
    if BULLETS.contains(chars[0]) && chars.get(1) == Some(&' ') {
        return Some(2);
    }
    if ('①'..='⑳').contains(&chars[0]) {
        return Some(1);
    }
    let open = usize::from("(（".contains(chars[0]));
    let digits = chars[open..].iter().take_while(|c| c.is_ascii_digit()).count();
    let name = match digits {
        0 => usize::from(chars.get(open).is_some_and(|c| c.is_ascii_lowercase())),
        digits => digits,
    };
    let end = open + name;
    let close = *chars.get(end)?;
    let goes_on = chars.get(end + 1).is_some_and(char::is_ascii_digit);
    let is_closed = match close {
        ')' | '）' => true,
        '.' | '、' | '．' => pointed && open == 0 && digits > 0 && !goes_on,
        _ => false,
    };
    (name > 0 && digits <= 2 && is_closed).then_some(end + 1)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn marks_of_items_are_taken_out_and_numbers_stay() {
        for (text, plain) in [
            ("1. Follow.\n2. Keep 1.5 m.", " Follow.\n Keep 1.5 m."),
            ("Turns: (1) left; (2) right.", "Turns:  left;  right."),
            ("(a) stay; (b) 2.5 m/s", " stay;  2.5 m/s"),
            ("（1）跟随；2、保持25米", "跟随；保持25米"),
            ("- Pitch: -8 degrees", "Pitch: -8 degrees"),
            ("Turns (4): right", "Turns (4): right"),
            ("turns: 1) left 2) right", "turns:  left , right"),
            ("six (turns 2) right", "six (turns 2) right"),
            ("Stops: 0. Turns: 2.", "Stops: 0. Turns: 2."),
        ] {
            assert_eq!(without_marks(text), plain, "{text}");
        }
    }
}
