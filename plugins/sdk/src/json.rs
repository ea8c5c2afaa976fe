//! JSON as it arrives from cosfly: small, well-formed, checked against the schema before.

/// A JSON value.
#[derive(Clone, Debug, PartialEq)]
pub enum Json {
    /// `null`
    Null,
    /// `true` or `false`
    Bool(bool),
    /// Any number.
    Number(f64),
    /// A text.
    Text(String),
    /// A list.
    List(Vec<Json>),
    /// A table, in the order of the text.
    Table(Vec<(String, Json)>),
}

/// Deepest nesting that is read.
const MOST_LEVELS: usize = 32;

impl Json {
    /// Reads a text.
    ///
    /// # Errors
    /// At which byte it is no JSON.
    pub fn parse(text: &str) -> Result<Self, String> {
        let mut reader = Reader { bytes: text.as_bytes(), at: 0 };
        let value = reader.value(0)?;
        reader.space();
        if reader.at < text.len() { reader.wrong() } else { Ok(value) }
    }

    /// The value of a key of a table.
    pub fn get(&self, key: &str) -> Option<&Self> {
        match self {
            Self::Table(entries) => entries.iter().find(|(name, _)| name == key).map(|(_, value)| value),
            _ => None,
        }
    }
}

struct Reader<'a> {
    bytes: &'a [u8],
    at: usize,
}

impl Reader<'_> {
    fn wrong<T>(&self) -> Result<T, String> {
        Err(format!("the parameters are no JSON at byte {}", self.at))
    }

    fn space(&mut self) {
        while self.bytes.get(self.at).is_some_and(u8::is_ascii_whitespace) {
            self.at += 1;
        }
    }

    fn next(&mut self, wanted: u8) -> bool {
        self.space();
        let found = self.bytes.get(self.at) == Some(&wanted);
        self.at += usize::from(found);
        found
    }

    fn word(&mut self, word: &str, value: Json) -> Result<Json, String> {
        if self.bytes[self.at..].starts_with(word.as_bytes()) {
            self.at += word.len();
            return Ok(value);
        }
        self.wrong()
    }

    fn value(&mut self, level: usize) -> Result<Json, String> {
        self.space();
        if level > MOST_LEVELS {
            return self.wrong();
        }
        match self.bytes.get(self.at) {
            Some(b'n') => self.word("null", Json::Null),
            Some(b't') => self.word("true", Json::Bool(true)),
            Some(b'f') => self.word("false", Json::Bool(false)),
            Some(b'"') => Ok(Json::Text(self.text()?)),
            Some(b'[') => {
                self.at += 1;
                let mut items = Vec::new();
                while !self.next(b']') {
                    if !items.is_empty() && !self.next(b',') {
                        return self.wrong();
                    }
                    items.push(self.value(level + 1)?);
                }
                Ok(Json::List(items))
            }
            Some(b'{') => {
                self.at += 1;
                let mut entries = Vec::new();
                while !self.next(b'}') {
                    if !entries.is_empty() && !self.next(b',') {
                        return self.wrong();
                    }
                    self.space();
                    let key = self.text()?;
                    if !self.next(b':') {
                        return self.wrong();
                    }
                    entries.push((key, self.value(level + 1)?));
                }
                Ok(Json::Table(entries))
            }
            _ => self.number(),
        }
    }

    fn number(&mut self) -> Result<Json, String> {
        let start = self.at;
        while self.bytes.get(self.at).is_some_and(|byte| byte.is_ascii_digit() || b"+-.eE".contains(byte)) {
            self.at += 1;
        }
        let text = core::str::from_utf8(&self.bytes[start..self.at]).unwrap_or_default();
        match text.parse::<f64>() {
            Ok(number) if number.is_finite() => Ok(Json::Number(number)),
            _ => self.wrong(),
        }
    }

    fn text(&mut self) -> Result<String, String> {
        if self.bytes.get(self.at) != Some(&b'"') {
            return self.wrong();
        }
        self.at += 1;
        let mut out = Vec::new();
        loop {
            let Some(&byte) = self.bytes.get(self.at) else { return self.wrong() };
            self.at += 1;
            match byte {
                b'"' => return String::from_utf8(out).or_else(|_| self.wrong()),
                b'\\' => self.escape(&mut out)?,
                byte => out.push(byte),
            }
        }
    }

    fn escape(&mut self, out: &mut Vec<u8>) -> Result<(), String> {
        let Some(&byte) = self.bytes.get(self.at) else { return self.wrong() };
        self.at += 1;
        let character = match byte {
            b'n' => '\n',
            b't' => '\t',
            b'r' => '\r',
            b'b' => '\u{8}',
            b'f' => '\u{c}',
            b'u' => {
                let digits = self.bytes.get(self.at..self.at + 4).and_then(|hex| core::str::from_utf8(hex).ok());
                let code = digits.and_then(|hex| u32::from_str_radix(hex, 16).ok());
                self.at += 4;
                // Halves of pairs stand for themselves as the replacement character: no parameter needs them.
                code.and_then(char::from_u32).unwrap_or(char::REPLACEMENT_CHARACTER)
            }
            other => char::from(other),
        };
        out.extend(character.encode_utf8(&mut [0; 4]).bytes());
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn values_of_every_kind_are_read_and_damage_is_refused() {
        let value = Json::parse(r#" {"a":[1,-2.5e1,true,null],"b":{"c":"x\"\u00e9\n"}} "#).unwrap();
        let list = vec![Json::Number(1.0), Json::Number(-25.0), Json::Bool(true), Json::Null];
        assert_eq!(value.get("a"), Some(&Json::List(list)));
        assert_eq!(value.get("b").and_then(|b| b.get("c")), Some(&Json::Text("x\"é\n".into())));
        for text in ["", "{", "[1,", "nul", "{\"a\" 1}", "1 2", "\"\\u12\"x", "[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[["] {
            assert!(Json::parse(text).is_err(), "{text}");
        }
    }
}
