//! Choices of words, and numbers rounded for people.

use cosfly_random::RandomStream;

/// Numbers of templates that are drawn from; a style uses them modulo its own number of skeletons.
pub(crate) const TEMPLATES: usize = 312;

/// One of several wordings.
pub(crate) fn one_of<'a>(words: &mut RandomStream, choices: &[&'a str]) -> &'a str {
    choices[words.index(choices.len())]
}

/// An English text with other words for some of its `about` before numbers.
pub(crate) fn approximately(text: &str, words: &mut RandomStream) -> String {
    let mut parts = text.split("bout ");
    let mut written = parts.next().unwrap_or_default().to_owned();
    for part in parts {
        let before = written.pop();
        let is_number = part.starts_with(|c: char| c.is_ascii_digit());
        let chosen = match (before, is_number) {
            (Some('A'), true) => one_of(words, &["About ", "Roughly ", "Around "]),
            (Some('a'), true) => one_of(words, &["about ", "roughly ", "around ", "approximately ", "about "]),
            (before, _) => {
                written.extend(before);
                "bout "
            }
        };
        written += chosen;
        written += part;
    }
    written
}

/// A Chinese text with other words for some of its `约` before numbers.
pub(crate) fn approximately_in_chinese(text: &str, words: &mut RandomStream) -> String {
    let mut parts = text.split('约');
    let mut written = parts.next().unwrap_or_default().to_owned();
    for part in parts {
        let number = part.find(|c: char| !c.is_ascii_digit() && c != '.').unwrap_or(part.len());
        let unit = ["米/秒", "米", "度", "秒"].into_iter().find(|unit| part[number..].starts_with(unit));
        let behind = unit.filter(|_| number > 0).map(|unit| number + unit.len());
        // `28米左右的距离` is said, `28米左右距离` is not.
        let may_follow =
            behind.is_some_and(|end| part[end..].is_empty() || part[end..].starts_with(['，', '。', '；', '、']));
        match (words.index(4), behind) {
            (0 | 1, Some(end)) if may_follow => {
                written += &part[..end];
                written += "左右";
                written += &part[end..];
            }
            (2, Some(_)) => written = written + "大约" + part,
            (3, Some(_)) if !written.ends_with('大') => written = written + "大概" + part,
            _ => written = written + "约" + part,
        }
    }
    written
}

/// `value` rounded to a multiple of `step`, without needless decimals.
pub(crate) fn rounded(value: f64, step: f64) -> String {
    let steps = (value / step).round();
    if step < 1.0 { format!("{:.1}", steps * step) } else { format!("{:.0}", steps * step + 0.0) }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_rounded_for_people() {
        for (value, step, expected) in
            [(28.284, 1.0, "28"), (1.3401, 0.1, "1.3"), (99.5, 5.0, "100"), (133.0, 10.0, "130"), (-0.2, 1.0, "0")]
        {
            assert_eq!(rounded(value, step), expected);
        }
    }
}
