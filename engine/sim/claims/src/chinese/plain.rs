//! Chinese texts in one spelling: units in Chinese characters, decimals in digits, no spaces and ordinals.

use super::numbers::numeral;

const NUMERALS: &str = "零一二两三四五六七八九十百";
/// Spellings, each with the one that the reader knows.
const SPELLINGS: [(&str, &str); 44] = [
    ("1名", "一名"),
    ("1位", "一位"),
    ("1架", "一架"),
    ("U型弯", "掉头"),
    ("U形弯", "掉头"),
    ("U型转弯", "掉头"),
    ("U形转弯", "掉头"),
    ("U型掉头", "掉头"),
    ("米/s", "米/秒"),
    ("秒速", "每秒"),
    ("OK", "好"),
    ("直线距离", "距离"),
    ("在同一处", "在原地"),
    ("在一处", "在原地"),
    ("于同一处", "在原地"),
    ("于一处", "在原地"),
    ("在一个地方", "在原地"),
    ("步行者", "行人"),
    ("1人", "此人"),
    ("人数：一人", "此人"),
    ("TA", "此人"),
    ("Ta", "此人"),
    ("ta", "此人"),
    ("停机", "完毕"),
    ("再没别的转向", ""),
    ("再没有别的转向", ""),
    ("，一个都没有", "一个都没有"),
    ("停没停", "停"),
    ("转没转", "转"),
    ("拐没拐", "拐"),
    ("有没有", "有"),
    ("→", "、"),
    ("->", "、"),
    ("—", "、"),
    ("–", "、"),
    (">", "、"),
    ("左-", "左、"),
    ("右-", "右、"),
    ("转-", "转、"),
    ("拐-", "拐、"),
    ("头-", "头、"),
    ("返-", "返、"),
    ("俯仰角", "角度"),
    ("俯仰", "角度"),
];
/// Symbols of units behind a number, longer ones first.
const SYMBOLS: [(&str, &str); 6] =
    [("m/s", "米/秒"), ("km/h", "公里/时"), ("min", "分钟"), ("m", "米"), ("s", "秒"), ("deg", "度")];

/// The text in the reader's spelling.
pub fn plain(text: &str) -> String {
    let text = SPELLINGS.iter().fold(text.to_owned(), |text, (from, to)| text.replace(from, to));
    let mut text = with_units(&without_spaces(&text));
    for ordinal in ["第一", "第二", "第三", "第四", "第五", "第六", "第七", "第八"] {
        for behind in ["次", "个", "回", "，", "、", "：", "步"] {
            text = text.replace(&format!("{ordinal}{behind}"), if "，、：".contains(behind) { behind } else { "" });
        }
    }
    with_decimals(&text)
}

/// Without the spaces around digits and between characters; line breaks stay.
fn without_spaces(text: &str) -> String {
    text.chars().filter(|c| *c == '\n' || !c.is_whitespace()).collect()
}

/// `25 m` as `25米`.
fn with_units(text: &str) -> String {
    let mut plain = String::with_capacity(text.len());
    let mut rest = text;
    while let Some(first) = rest.chars().next() {
        let is_number = plain.ends_with(|c: char| c.is_ascii_digit() || NUMERALS.contains(c));
        let unit = SYMBOLS.iter().find(|(symbol, _)| {
            rest.strip_prefix(symbol).is_some_and(|after| !after.starts_with(|c: char| c.is_ascii_alphabetic()))
        });
        match unit.filter(|_| is_number) {
            Some((symbol, unit)) => {
                plain.push_str(unit);
                rest = &rest[symbol.len()..];
            }
            None => {
                plain.push(first);
                rest = &rest[first.len_utf8()..];
            }
        }
    }
    plain
}

/// `一点二米` as `1.2米`.
fn with_decimals(text: &str) -> String {
    let chars: Vec<char> = text.chars().collect();
    let mut plain = String::with_capacity(text.len());
    let mut i = 0;
    while i < chars.len() {
        let run = |from: usize| chars[from..].iter().take_while(|c| NUMERALS.contains(**c)).count();
        let whole = run(i);
        let point = i + whole;
        let digits = if whole > 0 && chars.get(point) == Some(&'点') { run(point + 1) } else { 0 };
        let value = numeral(&chars[i..point].iter().collect::<String>()).filter(|_| digits > 0);
        let length = whole.max(1);
        match value {
            Some(value) => {
                let fraction = chars[point + 1..=point + digits].iter().filter_map(|c| numeral(&c.to_string()));
                plain.push_str(&format!("{value}."));
                fraction.for_each(|digit| plain.push_str(&digit.to_string()));
                i = point + 1 + digits;
            }
            None => {
                plain.extend(&chars[i..i + length]);
                i += length;
            }
        }
    }
    plain
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_and_units_have_one_spelling() {
        for (text, expected) in [
            ("相距 25 m，步速 1.3 m/s", "相距25米，步速1.3米/秒"),
            ("每秒一点二米，走快一点", "每秒1.2米，走快一点"),
            ("第一次左转，第二次右转", "左转，右转"),
            ("跟着TA，左→右", "跟着此人，左、右"),
        ] {
            assert_eq!(plain(text), expected, "{text}");
        }
    }
}
