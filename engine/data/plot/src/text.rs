//! Text and numbers in documents: the one rule of each language for text that comes from elsewhere.
//!
//! Names of datasets, flights, towns and policies, file names, answers of models, reasons of plugins: none of them may bring
//! markup into a document, move text about (characters that change the direction), or control a terminal that shows it.

use cosfly_diagnose::visible_text;

/// Text as it stands in HTML and XML, also in attributes in double quotes. Control characters, which XML cannot hold, are
/// made visible.
pub fn escaped(text: &str) -> String {
    visible_text(text).replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;").replace('"', "&quot;")
}

/// Text as it stands in a line of Markdown, also in a cell of a table: as it is, without markup, in one line.
///
/// A letter that has a meaning anywhere in a line gets a backslash; one at a word's inside that Markdown reads as itself (`_`
/// between letters, as in ids) stays, so that ordinary names read as they are.
pub fn markdown(text: &str) -> String {
    let line = one_line(text);
    let mut shown = String::with_capacity(line.len());
    let letters: Vec<char> = line.chars().collect();
    for (at, letter) in letters.iter().enumerate() {
        let is_word =
            |place: Option<usize>| place.and_then(|at| letters.get(at)).is_some_and(|it| it.is_alphanumeric());
        let is_inside = is_word(at.checked_sub(1)) && is_word(Some(at + 1));
        match letter {
            '&' => shown.push_str("&amp;"),
            '<' => shown.push_str("&lt;"),
            '>' => shown.push_str("&gt;"),
            '\\' | '`' | '*' | '[' | ']' | '|' | '~' | '$' => shown.extend(['\\', *letter]),
            '_' if !is_inside => shown.extend(['\\', '_']),
            '#' | '+' | '-' | '=' if at == 0 => shown.extend(['\\', *letter]),
            _ => shown.push(*letter),
        }
    }
    shown
}

/// Text as code in a line of Markdown, also in a cell of a table: in as many back-ticks as it needs. Without any letter,
/// nothing.
pub fn markdown_code(text: &str) -> String {
    let line = one_line(text).replace('|', "\u{ff5c}");
    let longest = line.split(|letter| letter != '`').map(str::len).max().unwrap_or(0);
    let fence = "`".repeat(longest + 1);
    match line.is_empty() {
        true => String::new(),
        false if line.starts_with('`') || line.ends_with('`') => format!("{fence} {line} {fence}"),
        false => format!("{fence}{line}{fence}"),
    }
}

/// A sentence whose literals are in back-ticks, such as the message of an error, as a line of Markdown.
pub fn markdown_words(sentence: &str) -> String {
    let parts: Vec<&str> = sentence.split('`').collect();
    let (mut shown, last) = (String::new(), parts.len() - 1);
    for (at, part) in parts.into_iter().enumerate() {
        match at % 2 {
            0 => shown.push_str(&markdown(part)),
            _ if at < last => shown.push_str(&markdown_code(part)),
            _ => shown.push_str(&format!("\\`{}", markdown(part))),
        }
    }
    shown
}

/// Text as a double-quoted string of YAML and JSON, with its quotes.
pub fn quoted(text: &str) -> String {
    let mut shown = String::with_capacity(text.len() + 2);
    shown.push('"');
    for letter in text.chars() {
        match letter {
            '"' | '\\' => shown.extend(['\\', letter]),
            '\n' => shown.push_str("\\n"),
            '\t' => shown.push_str("\\t"),
            _ if is_hidden(letter) => shown.push_str(&format!("\\u{:04x}", u32::from(letter))),
            _ => shown.push(letter),
        }
    }
    shown.push('"');
    shown
}

/// Whether a letter is one that [`visible_text`] replaces, or separates lines in YAML.
fn is_hidden(letter: char) -> bool {
    let mut bytes = [0; 4];
    let text: &str = letter.encode_utf8(&mut bytes);
    visible_text(text) != text || matches!(letter, '\u{85}' | '\u{2028}' | '\u{2029}' | '\u{feff}')
}

/// Text without anything hidden, in one line.
pub fn one_line(text: &str) -> String {
    visible_text(text).replace(['\n', '\u{2028}', '\u{2029}'], " ")
}

/// A whole number with a comma before every three digits.
pub fn grouped(number: u64) -> String {
    let digits = number.to_string();
    let mut text = String::new();
    for (place, digit) in digits.chars().enumerate() {
        if place > 0 && (digits.len() - place).is_multiple_of(3) {
            text.push(',');
        }
        text.push(digit);
    }
    text
}

/// A number with about three digits.
pub fn short(number: f64) -> String {
    let size = number.abs();
    match size {
        _ if !number.is_finite() => "–".into(),
        _ if size >= 1e12 => format!("{number:.1e}"),
        _ if size >= 1e6 => format!("{:.1}M", number / 1e6),
        _ if size >= 1e4 => format!("{:.1}K", number / 1e3),
        _ if size >= 100.0 => format!("{number:.0}"),
        _ if size >= 10.0 => trimmed(format!("{number:.1}")),
        _ => trimmed(format!("{number:.2}")),
    }
}

/// Numbers in their order as [`short`] has them, with more digits where neighbours would look the same.
pub fn told_apart(numbers: &[f64]) -> Vec<String> {
    let differ = |texts: &Vec<String>| texts.windows(2).all(|pair| pair[0] != pair[1]);
    let texts: Vec<String> = numbers.iter().map(|number| short(*number)).collect();
    if differ(&texts) {
        return texts;
    }
    let to = |decimals: usize| numbers.iter().map(|number| trimmed(format!("{number:.decimals$}"))).collect();
    (1..=9).map(to).find(differ).unwrap_or(texts)
}

/// A share as percent.
pub fn percent(share: f64) -> String {
    format!("{:.1} %", 100.0 * share)
}

fn trimmed(text: String) -> String {
    let text = if text.contains('.') { text.trim_end_matches('0').trim_end_matches('.').to_owned() } else { text };
    if text == "-0" { "0".to_owned() } else { text }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_written_for_people() {
        assert_eq!(grouped(0), "0");
        assert_eq!(grouped(1_234_567), "1,234,567");
        let cases = [(0.0, "0"), (0.504, "0.5"), (12.34, "12.3"), (250.4, "250"), (12_345.0, "12.3K"), (2.4e6, "2.4M")];
        cases.into_iter().for_each(|(number, text)| assert_eq!(short(number), text));
        assert_eq!(short(-3.25e23), "-3.2e23");
        assert_eq!((short(-0.0), short(-0.001)), ("0".to_owned(), "0".to_owned()));
    }

    #[test]
    fn numbers_of_a_scale_are_told_apart() {
        assert_eq!(told_apart(&[0.0, 10.0, 12.5]), ["0", "10", "12.5"]);
        assert_eq!(told_apart(&[27.8, 27.805, 27.81]), ["27.8", "27.805", "27.81"]);
        assert_eq!(told_apart(&[1234.2, 1234.4]), ["1234.2", "1234.4"]);
        assert_eq!(told_apart(&[1.0, 1.0]), ["1", "1"]);
    }

    /// Texts that would do harm where they are not escaped.
    const FOREIGN: [&str; 9] = [
        "<script>alert(1)</script>",
        "\" onmouseover='alert(1)",
        "a & b &lt;",
        "two\nlines\r\n# heading",
        "a\u{1b}[31m\u{7}\0",
        "\u{202e}gnp.exe\u{2066}",
        "| a | b |\n| --- |",
        "[link](javascript:alert(1)) ![picture](http://example.org) `code` **bold** _it_ ~~no~~ $x$",
        "```\n- list",
    ];

    #[test]
    fn text_of_others_brings_no_markup_into_html() {
        assert_eq!(escaped("<a href=\"x\">&"), "&lt;a href=&quot;x&quot;&gt;&amp;");
        for text in FOREIGN {
            let shown = escaped(text);
            assert!(!shown.contains(['<', '>', '"', '\u{1b}', '\0', '\u{202e}', '\u{2066}']), "{shown}");
            assert!(
                shown.split('&').skip(1).all(|part| part.split_once(';').is_some_and(|it| it.0.len() < 5)),
                "{shown}"
            );
        }
    }

    #[test]
    fn text_of_others_brings_no_markup_into_markdown() {
        for text in FOREIGN {
            let shown = markdown(text);
            assert!(!shown.contains(['\n', '\r', '<', '\u{1b}', '\u{202e}']), "{shown}");
            for (at, _) in shown.match_indices(['`', '|', '[', '*']) {
                assert!(shown[..at].ends_with('\\'), "{shown}");
            }
            let code = markdown_code(text);
            assert!(!code.contains(['\n', '|', '\u{1b}', '\u{202e}']), "{code}");
            let words = markdown_words(&format!("there is no `{text}`: <b>{text}"));
            assert!(words.starts_with("there is no "), "{words}");
            assert!(!words.contains(['\n', '\u{1b}', '\u{202e}']), "{words}");
        }
        assert_eq!(markdown_words("no `a_b*` and `c"), "no `a_b*` and \\`c");
        assert_eq!(markdown("perturbed-p00000 of my_town, 3 %: ok"), "perturbed-p00000 of my_town, 3 %: ok");
        assert_eq!(markdown("# *a*"), "\\# \\*a\\*");
        assert_eq!(markdown_code("a`b``c"), "```a`b``c```");
        assert_eq!((markdown_code("`a"), markdown_code("")), ("`` `a ``".to_owned(), String::new()));
    }

    #[test]
    fn text_of_others_is_one_string_of_yaml_and_json() {
        assert_eq!(quoted("a: \"b\" \\ #c\n- d\u{1b}\u{2028}"), "\"a: \\\"b\\\" \\\\ #c\\n- d\\u001b\\u2028\"");
        for text in FOREIGN {
            assert!(!quoted(text).contains(['\n', '\r', '\u{1b}', '\0', '\u{202e}']), "{text}");
        }
    }
}
