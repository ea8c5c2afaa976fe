//! The Arrow schema of a table, with Hugging Face features of labels and images.

use super::{Kind, Table};
use arrow_schema::{Field, Schema};
use std::collections::BTreeMap;

/// Arrow schema of a table. Columns with a Hugging Face feature must be nullable for `datasets` to recognise them.
pub fn schema<S>(table: &Table<S>) -> Schema {
    let field = |column: &&dyn super::AnyColumn<S>| {
        let kind = column.kind();
        Field::new(column.name(), kind.data_type(), column.nullable() || kind.is_featured())
    };
    let features = hugging_face_features(table).map(|json| ("huggingface".to_owned(), json));
    Schema::new(table.columns.iter().map(field).collect::<Vec<_>>())
        .with_metadata(features.into_iter().collect::<BTreeMap<_, _>>())
}

/// `huggingface` metadata of a table with labels or images.
pub fn hugging_face_features<S>(table: &Table<S>) -> Option<String> {
    let feature = |kind: Kind| match kind {
        Kind::Label(names) => Some(serde_json::json!({"names": names, "_type": "ClassLabel"})),
        Kind::Image => Some(serde_json::json!({"_type": "Image"})),
        _ => None,
    };
    let features: serde_json::Map<String, serde_json::Value> =
        table.columns.iter().filter_map(|column| Some((column.name().to_owned(), feature(column.kind())?))).collect();
    (!features.is_empty()).then(|| serde_json::json!({"info": {"features": features}}).to_string())
}
