//! A file as it stands: CityJSON 1.0 to 2.0, and the lines of CityJSONSeq.

use super::boundaries::{Boundaries, FlatNumbers};
use core::fmt;
use cosfly_town::MapError;
use cosfly_town::text::{decoded, refused_json};
use serde::de::{Error, MapAccess, Visitor};
use serde::{Deserialize, Deserializer};
use serde_json::Value;
use std::collections::BTreeMap;

/// A CityJSON object, or one feature of a sequence.
#[derive(Debug, Deserialize)]
pub(super) struct Document {
    #[serde(rename = "type")]
    kind: String,
    version: Option<String>,
    pub(super) transform: Option<Transform>,
    metadata: Option<Metadata>,
    #[serde(rename = "CityObjects", default, deserialize_with = "objects")]
    pub(super) objects: BTreeMap<String, CityObject>,
    #[serde(default)]
    pub(super) vertices: Vec<[f64; 3]>,
    #[serde(rename = "geometry-templates")]
    pub(super) templates: Option<Templates>,
}

/// Objects by their names; a name that is there twice is refused: nobody knows which object is meant.
fn objects<'de, D: Deserializer<'de>>(deserializer: D) -> Result<BTreeMap<String, CityObject>, D::Error> {
    struct Objects;
    impl<'de> Visitor<'de> for Objects {
        type Value = BTreeMap<String, CityObject>;

        fn expecting(&self, out: &mut fmt::Formatter<'_>) -> fmt::Result {
            out.write_str("an object for each city object")
        }

        fn visit_map<A: MapAccess<'de>>(self, mut map: A) -> Result<Self::Value, A::Error> {
            let mut objects = BTreeMap::new();
            while let Some((id, object)) = map.next_entry::<String, CityObject>()? {
                let shown: String = id.chars().take(60).collect();
                if objects.insert(id, object).is_some() {
                    return Err(A::Error::custom(format!("`CityObjects` has `{shown}` twice; names must differ")));
                }
            }
            Ok(objects)
        }
    }
    deserializer.deserialize_map(Objects)
}

/// From the whole numbers of `vertices` to coordinates.
#[derive(Clone, Copy, Debug, PartialEq, Deserialize)]
pub(super) struct Transform {
    pub(super) scale: [f64; 3],
    pub(super) translate: [f64; 3],
}

#[derive(Debug, Deserialize)]
struct Metadata {
    #[serde(rename = "referenceSystem")]
    reference_system: Option<Value>,
}

/// Shapes that several objects have, in frames of their own, metres.
#[derive(Debug, Deserialize)]
pub(super) struct Templates {
    #[serde(default)]
    pub(super) templates: Vec<Geometry>,
    #[serde(rename = "vertices-templates", default)]
    pub(super) vertices: Vec<[f64; 3]>,
}

#[derive(Debug, Deserialize)]
pub(super) struct CityObject {
    #[serde(rename = "type")]
    pub(super) kind: String,
    pub(super) attributes: Option<Attributes>,
    pub(super) geometry: Option<Vec<Geometry>>,
    #[serde(default)]
    pub(super) parents: Vec<String>,
}

/// Attributes of an object or a surface, as far as they are read. Values of a wrong type count as missing.
#[derive(Debug, Default, Deserialize)]
pub(super) struct Attributes {
    function: Option<Value>,
    class: Option<Value>,
    usage: Option<Value>,
    /// Kind in Dutch base maps.
    bgt_type: Option<Value>,
    #[serde(rename = "measuredHeight")]
    measured_height: Option<Value>,
    #[serde(rename = "storeysAboveGround")]
    storeys: Option<Value>,
    height: Option<Value>,
    #[serde(rename = "crownDiameter")]
    crown_diameter: Option<Value>,
}

#[derive(Debug, Deserialize)]
pub(super) struct Geometry {
    lod: Option<Value>,
    #[serde(default)]
    pub(super) boundaries: Boundaries,
    semantics: Option<Semantics>,
    /// Number of the template of a `GeometryInstance`.
    pub(super) template: Option<usize>,
    #[serde(rename = "transformationMatrix")]
    pub(super) matrix: Option<Vec<f64>>,
}

#[derive(Debug, Deserialize)]
struct Semantics {
    #[serde(default)]
    surfaces: Vec<Surface>,
    values: Option<FlatNumbers>,
}

/// Meaning of a face.
#[derive(Debug, Deserialize)]
pub(super) struct Surface {
    #[serde(rename = "type")]
    pub(super) kind: String,
    #[serde(flatten)]
    pub(super) attributes: Attributes,
}

/// All documents of a file: one, or the head and the features of a sequence.
pub(super) fn documents(bytes: &[u8]) -> Result<Vec<Document>, MapError> {
    let text = decoded(bytes)?;
    let values = serde_json::Deserializer::from_str(&text).into_iter::<Document>();
    let mut documents = Vec::new();
    for document in values {
        documents.push(document.map_err(|error| refused_json(&error, &text))?);
    }
    let head = documents.first().ok_or_else(|| MapError::new("the file is empty"))?;
    if head.kind != "CityJSON" {
        let shown: String = head.kind.chars().take(40).collect();
        let error = MapError::new(format!("`type` of the first object is `{shown}`; it must be `CityJSON`"));
        return Err(error.hint("a sequence begins with the line that has the transform of its features"));
    }
    if let Some(other) = documents[1..].iter().find(|document| document.kind != "CityJSONFeature") {
        let shown: String = other.kind.chars().take(40).collect();
        return Err(MapError::new(format!("`type` of a line is `{shown}`; it must be `CityJSONFeature`")));
    }
    head.check_version()?;
    head.check_features(&documents[1..])?;
    Ok(documents)
}

impl Document {
    /// All features of a sequence have the reference system of its head; their transforms may be their own.
    fn check_features(&self, features: &[Self]) -> Result<(), MapError> {
        let is_other =
            |feature: &Self| feature.reference_system().is_some_and(|it| Some(it) != self.reference_system());
        let Some(number) = features.iter().position(is_other) else { return Ok(()) };
        let number = number + 1;
        let message = format!("feature {number} has another `metadata.referenceSystem` than the head of the sequence");
        Err(MapError::new(message).hint("write the sequence again: its features share that of the first line"))
    }

    fn check_version(&self) -> Result<(), MapError> {
        let version = self.version.as_deref().unwrap_or_default();
        if version.starts_with("1.") || version.starts_with("2.") {
            return Ok(());
        }
        let shown: String = version.chars().take(20).collect();
        let error = MapError::new(format!("the file is CityJSON `{shown}`; versions 1.0 to 2.0 are read"));
        Err(error.hint("`cjio FILE upgrade save NEW` brings older files to the latest version"))
    }

    /// Whether the version asks for a `transform` and there is none.
    pub(super) fn lacks_transform(&self) -> bool {
        self.transform.is_none() && !self.version.as_deref().unwrap_or_default().starts_with("1.0")
    }

    /// The text of `metadata.referenceSystem`.
    pub(super) fn reference_system(&self) -> Option<&str> {
        self.metadata.as_ref()?.reference_system.as_ref()?.as_str()
    }
}

impl Geometry {
    /// The level of detail as it stands, if it is no number.
    pub(super) fn unread_lod(&self) -> Option<&Value> {
        self.lod.as_ref().filter(|lod| number(lod).is_none())
    }

    /// Level of detail, 0 when it is missing.
    pub(super) fn lod(&self) -> f64 {
        self.lod.as_ref().and_then(number).unwrap_or(0.0)
    }

    /// Meaning of each face, as far as the file says it.
    pub(super) fn surface_of_face(&self, face: usize) -> Option<&Surface> {
        let semantics = self.semantics.as_ref()?;
        let values = &semantics.values.as_ref()?.0;
        // A null in place of a whole shell: nobody knows which face is which.
        if values.len() != self.boundaries.face_count() {
            return None;
        }
        values[face].and_then(|surface| semantics.surfaces.get(surface as usize))
    }
}

impl Attributes {
    /// Heights as they stand, by name.
    pub(super) fn heights(&self) -> [(&'static str, Option<&Value>); 2] {
        [("measuredHeight", self.measured_height.as_ref()), ("height", self.height.as_ref())]
    }

    /// The number of storeys and the diameter of the crown as they stand, by name.
    pub(super) fn other_numbers(&self) -> [(&'static str, Option<&Value>); 2] {
        [("storeysAboveGround", self.storeys.as_ref()), ("crownDiameter", self.crown_diameter.as_ref())]
    }

    /// Height of a building or plant, metres or the file's unit, with the storeys as the second choice.
    pub(super) fn height(&self) -> Option<f64> {
        [&self.measured_height, &self.height].into_iter().flatten().find_map(number).filter(|height| *height > 0.0)
    }

    pub(super) fn storeys(&self) -> Option<f64> {
        self.storeys.as_ref().and_then(number).filter(|storeys| *storeys > 0.0)
    }

    pub(super) fn crown_diameter(&self) -> Option<f64> {
        self.crown_diameter.as_ref().and_then(number).filter(|diameter| *diameter > 0.0)
    }

    /// Words that say what the thing is for, in small letters.
    pub(super) fn words(&self) -> impl Iterator<Item = String> {
        let all = [&self.function, &self.usage, &self.class, &self.bgt_type].into_iter().flatten();
        all.flat_map(|value| match value {
            Value::Array(list) => list.iter().filter_map(word).collect(),
            one => word(one).into_iter().collect::<Vec<_>>(),
        })
    }
}

fn word(value: &Value) -> Option<String> {
    match value {
        Value::String(text) => Some(text.to_lowercase()),
        Value::Number(number) => Some(number.to_string()),
        _ => None,
    }
}

fn number(value: &Value) -> Option<f64> {
    match value {
        Value::Number(number) => number.as_f64(),
        Value::String(text) => text.parse().ok(),
        _ => None,
    }
    .filter(|number: &f64| number.is_finite() && number.abs() < 1e5)
}
