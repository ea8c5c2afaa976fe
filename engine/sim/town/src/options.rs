//! [`FormatOptions`]: options of map formats by name, as a recipe gives them.

use serde::{Deserialize, Serialize, de::DeserializeOwned};
use serde_json::{Map, Value};

/// Options of map formats by name. Each format has its own type for them; this one holds those of any format.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(transparent)]
pub struct FormatOptions(Map<String, Value>);

impl FormatOptions {
    /// The fields of `options`, which is a struct.
    pub fn of<T: Serialize>(options: &T) -> Self {
        match serde_json::to_value(options) {
            Ok(Value::Object(fields)) => Self(fields),
            _ => Self::default(),
        }
    }

    /// The options as the type of one format; missing ones get their defaults.
    ///
    /// # Errors
    /// An unknown name or a wrong type, in words.
    pub fn read<T: DeserializeOwned>(&self) -> Result<T, String> {
        serde_json::from_value(Value::Object(self.0.clone())).map_err(|error| error.to_string())
    }

    /// Those called by one of `names`.
    pub fn only(&self, names: &[String]) -> Self {
        Self(self.0.iter().filter(|(name, _)| names.contains(name)).map(|(n, v)| (n.clone(), v.clone())).collect())
    }

    /// Whether none is given.
    pub fn is_empty(&self) -> bool {
        self.0.is_empty()
    }

    /// Names and values, sorted by name.
    pub fn iter(&self) -> impl Iterator<Item = (&String, &Value)> {
        self.0.iter()
    }
}

impl From<Map<String, Value>> for FormatOptions {
    fn from(options: Map<String, Value>) -> Self {
        Self(options)
    }
}
