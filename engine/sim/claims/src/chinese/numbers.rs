//! Chinese numbers, in digits and in words.

pub(super) const UNITS: [&str; 20] = [
    "米/秒",
    "米每秒",
    "米",
    "公尺",
    "度",
    "°",
    "分钟",
    "分",
    "秒钟",
    "秒",
    "次",
    "回",
    "个弯",
    "个转弯",
    "道弯",
    "遭",
    "番",
    "遍",
    "处",
    "个停",
];

/// A number at the start of `text`, in digits or as Chinese numerals before a unit, and what follows it.
pub(super) fn number(text: &str) -> Option<(f64, &str)> {
    let first = text.chars().next()?;
    if !first.is_ascii_digit() {
        let end = text.find(|c: char| !"零一二两三四五六七八九十百".contains(c)).unwrap_or(text.len());
        let after = &text[end..];
        let counts =
            UNITS.iter().any(|unit| after.starts_with(unit)) || after.starts_with("个左") || after.starts_with("个右");
        return numeral(&text[..end]).filter(|_| counts).map(|value| (value, after));
    }
    let end = text.find(|c: char| !c.is_ascii_digit() && c != '.').unwrap_or(text.len());
    let value: f64 = text[..end].parse().ok()?;
    Some((value, text[end..].trim_start()))
}

/// The value of numerals below a thousand, such as `一百二十五`.
pub(super) fn numeral(text: &str) -> Option<f64> {
    let digit = |c: char| match c {
        '两' => Some(2),
        c => "零一二三四五六七八九".chars().position(|it| it == c),
    };
    let (mut value, mut last) = (0, None);
    for c in text.chars() {
        match (c, digit(c)) {
            ('百', _) => value += 100 * last.take()?,
            ('十', _) => value += 10 * last.take().unwrap_or(1),
            (_, digit) => last = digit,
        }
    }
    (!text.is_empty()).then_some((value + last.unwrap_or(0)) as f64)
}
