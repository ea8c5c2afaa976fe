//! A finished flight as stages see it.

use crate::Json;
use crate::arrow_stream::Values;

/// A finished flight: facts, and named columns with one value per frame. It holds the columns that the stage reads.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Flight {
    /// Id of the flight.
    pub item: String,
    pub(crate) frames: usize,
    pub(crate) facts: Vec<(String, String)>,
    pub(crate) columns: Vec<(String, Values)>,
}

impl Flight {
    /// A flight of your own with columns of floats, for tests.
    pub fn new(item: &str, columns: &[(&str, &[f64])]) -> Self {
        let frames = columns.first().map_or(0, |(_, values)| values.len());
        let columns = columns.iter().map(|(name, values)| ((*name).to_owned(), Values::Reals(values.to_vec())));
        Self { item: item.to_owned(), frames, facts: vec![], columns: columns.collect() }
    }

    /// The same with a column of integers, for tests.
    pub fn with_integers(mut self, name: &str, values: &[i64]) -> Self {
        self.columns.push((name.to_owned(), Values::Integers(values.to_vec())));
        self
    }

    /// The same with a column of booleans, for tests.
    pub fn with_booleans(mut self, name: &str, values: &[bool]) -> Self {
        self.columns.push((name.to_owned(), Values::Booleans(values.to_vec())));
        self
    }

    /// The same with a fact, for tests.
    pub fn with_fact(mut self, name: &str, value: &str) -> Self {
        self.facts.push((name.to_owned(), value.to_owned()));
        self
    }

    /// A fact, such as `trajectory_id`; `plugins/wit/stage.wit` lists them.
    pub fn fact(&self, name: &str) -> Option<&str> {
        self.facts.iter().find(|(known, _)| known == name).map(|(_, value)| value.as_str())
    }

    /// The first instruction in a language, such as `en`; none where no captions are connected.
    pub fn instruction(&self, language: &str) -> Option<String> {
        let Json::List(captions) = Json::parse(self.fact("captions")?).ok()? else { return None };
        let of = |caption: &Json, key: &str| match caption.get(key) {
            Some(Json::Text(text)) => text.clone(),
            _ => String::new(),
        };
        let found = captions.iter().find(|it| of(it, "language") == language && of(it, "style") == "instruction")?;
        Some(of(found, "text"))
    }

    /// A column of floats, such as `visibility`.
    ///
    /// # Errors
    /// That the stage does not read it, and what it reads.
    pub fn column(&self, name: &str) -> Result<&[f64], String> {
        match self.values(name)? {
            Values::Reals(values) => Ok(values),
            _ => Err(format!("`{name}` holds no floats")),
        }
    }

    /// A column of integers, such as `frame`.
    ///
    /// # Errors
    /// As [`Self::column`].
    pub fn integers(&self, name: &str) -> Result<&[i64], String> {
        match self.values(name)? {
            Values::Integers(values) => Ok(values),
            _ => Err(format!("`{name}` holds no integers")),
        }
    }

    /// A column of booleans, such as `in_view`.
    ///
    /// # Errors
    /// As [`Self::column`].
    pub fn booleans(&self, name: &str) -> Result<&[bool], String> {
        match self.values(name)? {
            Values::Booleans(values) => Ok(values),
            _ => Err(format!("`{name}` holds no booleans")),
        }
    }

    fn values(&self, name: &str) -> Result<&Values, String> {
        match self.columns.iter().find(|(known, _)| known == name) {
            Some((_, values)) => Ok(values),
            None => {
                let known: Vec<&str> = self.columns.iter().map(|(name, _)| name.as_str()).collect();
                Err(format!("it does not read `{name}`; it reads `{}`", known.join("`, `")))
            }
        }
    }

    /// How many frames it has.
    pub fn len(&self) -> usize {
        self.frames
    }

    /// Whether it has none.
    pub fn is_empty(&self) -> bool {
        self.frames == 0
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn instructions_are_found_by_their_language() {
        let captions = r#"[{"language":"zh","style":"instruction","text":"跟随"},{"language":"en","style":"instruction","text":"Follow"}]"#;
        let flight = Flight::default().with_fact("captions", captions);
        assert_eq!(flight.instruction("en").as_deref(), Some("Follow"));
        assert_eq!(Flight::default().instruction("en"), None);
    }
}
