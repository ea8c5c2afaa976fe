//! `croissant.json`: Croissant 1.1 with the Responsible AI and provenance vocabularies.
//!
//! Shapes that validators and loaders accept, found by trying: one `references` per record set, splits by a
//! regular expression over the full path, Parquet as `application/x-parquet`, sizes as text.

mod context;
pub(crate) mod responsible_ai;

use crate::publish::citation::citation;
use crate::publish::layout::LAYOUT_VERSION;
use crate::publish::summary::{Summary, TownSummary};
use cosfly_domain::SemanticLabel;
use cosfly_schema::Split;
use cosfly_schema::config::DatasetConfig;
use cosfly_schema::extras::{self, ExtraShape, ExtraSource, ExtraSummary};
use cosfly_schema::flight_table::{ColumnKind, DeclaredColumn};
use cosfly_schema::tables::{self, DIFFICULTIES, FileRecord, Kind, SCENES, Table};
use serde_json::{Value, json};

/// The text of `croissant.json`. `single_files` become file objects with size and hash.
pub fn document(config: &DatasetConfig, summary: &Summary, single_files: &[FileRecord]) -> String {
    let mut document = json!({
        "@context": context::context(),
        "@type": "sc:Dataset",
        "name": config.name,
        "alternateName": config.title,
        "description": config.description,
        "conformsTo": ["http://mlcommons.org/croissant/1.1", "http://mlcommons.org/croissant/RAI/1.0"],
        "citeAs": citation(config),
        "license": config.license.url,
        "url": config.url,
        "version": config.version,
        "sdVersion": format!("{LAYOUT_VERSION}.0.0"),
        "datePublished": config.date_published,
        "dateCreated": config.date_published,
        "isLiveDataset": false,
        "inLanguage": summary.text_languages(),
        "keywords": ["drone", "UAV", "visual tracking", "trajectory planning", "vision-language-action", "synthetic"],
        "creator": {"@type": "sc:Organization", "name": config.creator.name, "url": config.creator.url},
        "publisher": {"@type": "sc:Organization", "name": config.creator.name, "url": config.creator.url},
        "usageInfo": config.license.responsible_use,
        "prov:wasGeneratedBy": {
            "@type": "prov:Activity",
            "name": "cosfly run",
            "prov:wasAssociatedWith": {
                "@type": "prov:SoftwareAgent",
                "name": "cosfly",
                "softwareVersion": env!("CARGO_PKG_VERSION"),
            },
            "description": "Simulated with cosfly; every flight's seed is in trajectories.seed, every town's geometry \
                            hash in trajectories.town_geometry_blake3.",
        },
        "prov:wasDerivedFrom": derived_from(summary),
        "distribution": distribution(summary, single_files),
        "recordSet": record_sets(summary),
    });
    let object = document.as_object_mut().expect("the document is an object");
    object.extend(responsible_ai::values(config, summary));
    let mut text = serde_json::to_string_pretty(&document).expect("a JSON tree always prints");
    text.push('\n');
    text
}

fn derived_from(summary: &Summary) -> Value {
    let town = |(name, town): (&String, &TownSummary)| {
        json!({
            "@type": "prov:Entity",
            "name": name,
            "identifier": format!("blake3:{}", town.geometry_digest),
            "description": if town.synthetic_notes.is_empty() {
                "Geometry of the town as in its map file.".to_owned()
            } else {
                format!("Geometry of the town. Added to its map file: {}", town.synthetic_notes.join("; "))
            },
        })
    };
    summary.towns.iter().map(town).collect()
}

fn distribution(summary: &Summary, single_files: &[FileRecord]) -> Value {
    let file_set = |id: String, format: Value, includes: String| json!({"@type": "cr:FileSet", "@id": id, "name": id, "encodingFormat": format, "includes": includes});
    let mut all: Vec<Value> = single_files
        .iter()
        .map(|file| {
            json!({
                "@type": "cr:FileObject",
                "@id": file.path,
                "name": file.path,
                "contentUrl": file.path,
                "contentSize": format!("{} B", file.bytes),
                "encodingFormat": media_type(&file.path),
                "sha256": file.sha256,
            })
        })
        .collect();
    let parquet = json!("application/x-parquet");
    let names = tables::of_trajectories()
        .iter()
        .map(|table| table.name)
        .chain([tables::of_objects().name, tables::of_rejections().name])
        .collect::<Vec<_>>();
    all.extend(
        names.iter().map(|name| file_set(format!("{name}-parquet"), parquet.clone(), format!("data/{name}/*.parquet"))),
    );
    let mcap = json!(["application/x-mcap", "https://mcap.dev/spec"]);
    all.push(file_set("mcap-logs".into(), mcap, "mcap/*/*/*.mcap".into()));
    all.extend(
        summary.extras.iter().filter(|kept| kept.source.shape != ExtraShape::Files || kept.files > 0).map(extra_set),
    );
    Value::Array(all)
}

fn media_type(path: &str) -> &'static str {
    match path.rsplit('.').next() {
        Some("parquet") => "application/x-parquet",
        Some("json") => "application/json",
        Some("py") => "text/x-python",
        _ => "text/plain",
    }
}

fn record_sets(summary: &Summary) -> Value {
    let mut sets = vec![splits(), labels(), roles()];
    sets.extend(
        [("scenes", &SCENES[..]), ("difficulties", &DIFFICULTIES[..])].map(|(name, values)| names(name, values)),
    );
    sets.extend(tables::of_trajectories().iter().map(|table| {
        let source = json!({"fileSet": {"@id": format!("{}-parquet", table.name)}});
        record_set(table, &source, true)
    }));
    sets.push(record_set(&tables::of_objects(), &json!({"fileSet": {"@id": "objects-parquet"}}), false));
    let rejected = tables::of_rejections();
    sets.push(record_set(&rejected, &json!({"fileSet": {"@id": "rejected-parquet"}}), false));
    let tables = summary.extras.iter().filter(|kept| kept.source.shape != ExtraShape::Files);
    sets.extend(tables.map(|kept| extra_record_set(&kept.source)));
    sets.push(record_set(&tables::of_files(), &json!({"fileObject": {"@id": "files.parquet"}}), false));
    Value::Array(sets)
}

fn record_set<S>(table: &Table<S>, source: &Value, has_splits: bool) -> Value {
    let name = table.name;
    let keys: Vec<Value> = table.key.iter().map(|column| json!({"@id": format!("{name}/{column}")})).collect();
    let mut fields = vec![];
    if has_splits {
        fields.push(split_field(name, source));
    }
    // Loaders filter by a split that they read from paths of files; the column says the same.
    let columns = table.columns.iter().filter(|column| !(has_splits && column.name() == "split"));
    fields.extend(columns.map(|column| {
        let mut extract = source.clone();
        extract["extract"] = json!({"column": column.name()});
        if column.kind() == Kind::Image {
            extract["transform"] = json!({"jsonPath": "bytes"});
        }
        let mut field = json!({
            "@type": "cr:Field",
            "@id": format!("{name}/{}", column.name()),
            "name": column.name(),
            "description": column.doc(),
            "source": extract,
        });
        let object = field.as_object_mut().expect("a field is an object");
        object.extend(data_type(column.kind()));
        // One reference per record set: a second one breaks filters in loaders.
        if has_splits && column.name() == "trajectory_id" && name != "trajectories" {
            field["references"] = json!({"field": {"@id": "trajectories/trajectory_id"}});
        }
        if name == "pairs" && column.name() == "perturbed_id" {
            field["references"] = json!({"field": {"@id": "trajectories/trajectory_id"}});
        }
        field
    }));
    let key = if keys.len() == 1 { keys[0].clone() } else { Value::Array(keys) };
    json!({
        "@type": "cr:RecordSet",
        "@id": name,
        "name": name,
        "description": table.doc,
        "key": key,
        "field": fields,
    })
}

/// Files of a plugin's table, or of its folder.
fn extra_set(kept: &ExtraSummary) -> Value {
    let name = &kept.source.name;
    let (id, format, includes) = match kept.source.shape {
        ExtraShape::Files => {
            let parts = kept.depths.iter().map(|depth| json!(format!("extras/{name}/*/*/*{}", "/*".repeat(*depth))));
            (format!("{name}-files"), "application/octet-stream", parts.collect())
        }
        _ => (format!("{name}-parquet"), "application/x-parquet", json!(format!("data/{name}/*.parquet"))),
    };
    json!({
        "@type": "cr:FileSet", "@id": id, "name": id, "encodingFormat": format, "includes": includes,
        "description": format!("Given by the {}: {}", kept.source.origin(), kept.source.summary),
    })
}

/// The record set of a plugin's table.
fn extra_record_set(source: &ExtraSource) -> Value {
    let name = &source.name;
    let files = json!({"fileSet": {"@id": format!("{name}-parquet")}});
    let field = |column: &DeclaredColumn| {
        let mut extract = files.clone();
        extract["extract"] = json!({"column": column.name});
        let kind = match column.kind {
            ColumnKind::Real => "cr:Float64",
            ColumnKind::Integer => "cr:Int64",
            ColumnKind::Boolean => "sc:Boolean",
            ColumnKind::Text | ColumnKind::Bytes => "sc:Text",
        };
        let mut field = json!({
            "@type": "cr:Field",
            "@id": format!("{name}/{}", column.name),
            "name": column.name,
            "description": column.doc,
            "dataType": kind,
            "source": extract,
        });
        if column.name == "trajectory_id" {
            field["references"] = json!({"field": {"@id": "trajectories/trajectory_id"}});
        }
        field
    };
    let mut fields = vec![split_field(name, &files)];
    fields.extend(extras::columns_of(source).iter().map(field));
    let id = |column: &str| json!({"@id": format!("{name}/{column}")});
    let key = match source.shape {
        shape if shape.has_rows() => json!([id("trajectory_id"), id("row")]),
        _ => id("trajectory_id"),
    };
    json!({
        "@type": "cr:RecordSet",
        "@id": name,
        "name": name,
        "description": format!("Given by the {}: {}", source.origin(), source.summary),
        "key": key,
        "field": fields,
    })
}

/// The split of a row, from the path of its file.
fn split_field(table: &str, source: &Value) -> Value {
    let mut extract = source.clone();
    extract["extract"] = json!({"fileProperty": "fullpath"});
    extract["transform"] = json!({"regex": format!("data/{table}/(train|val|test)-.+parquet$")});
    let mut field = json!({
        "@type": "cr:Field",
        "@id": format!("{table}/split"),
        "name": "split",
        "description": "train, val or test",
        "dataType": ["sc:Text", "cr:Split"],
        "source": extract,
    });
    if table == "trajectories" {
        field["dataType"] = json!("sc:Text");
        field["references"] = json!({"field": {"@id": "splits/name"}});
    }
    field
}

fn data_type(kind: Kind) -> serde_json::Map<String, Value> {
    let value = match kind {
        Kind::Text => json!({"dataType": "sc:Text"}),
        Kind::Integer | Kind::Label(_) => json!({"dataType": "cr:Int64"}),
        Kind::Real => json!({"dataType": "cr:Float64"}),
        Kind::Flag => json!({"dataType": "sc:Boolean"}),
        Kind::Reals(length) => json!({"dataType": "cr:Float64", "isArray": true, "arrayShape": length.to_string()}),
        Kind::Box => json!({"dataType": ["cr:Float32", "cr:BoundingBox"], "isArray": true, "arrayShape": "4"}),
        Kind::RealList => json!({"dataType": "cr:Float64", "isArray": true, "arrayShape": "-1"}),
        Kind::FloatList => json!({"dataType": "cr:Float32", "isArray": true, "arrayShape": "-1"}),
        Kind::IntegerList => json!({"dataType": "cr:Int64", "isArray": true, "arrayShape": "-1"}),
        Kind::TextList => json!({"dataType": "sc:Text", "isArray": true, "arrayShape": "-1"}),
        Kind::Image => json!({"dataType": "sc:ImageObject"}),
    };
    match value {
        Value::Object(object) => object,
        _ => serde_json::Map::new(),
    }
}

fn inline_set(name: &str, kind: &str, doc: &str, fields: &[(&str, Value)], data: Vec<Value>) -> Value {
    let fields: Vec<Value> = fields
        .iter()
        .map(|(field, kind)| json!({"@type": "cr:Field", "@id": format!("{name}/{field}"), "name": field, "dataType": kind}))
        .collect();
    json!({
        "@type": "cr:RecordSet", "@id": name, "name": name, "description": doc, "dataType": kind,
        "key": fields[0].get("@id").map(|id| json!({"@id": id})), "field": fields, "data": data,
    })
}

fn splits() -> Value {
    let url = |split| match split {
        Split::Train => "cr:TrainingSplit",
        Split::Val => "cr:ValidationSplit",
        Split::Test => "cr:TestSplit",
    };
    let rows = Split::ALL.map(|split| json!({"splits/name": split.name(), "splits/url": url(split)}));
    let fields = [("name", json!("sc:Text")), ("url", json!(["sc:URL", "cr:Split"]))];
    inline_set("splits", "cr:Split", "The parts of the dataset.", &fields, rows.to_vec())
}

fn labels() -> Value {
    let rows = SemanticLabel::ALL.map(|label| {
        let [r, g, b] = label.colour();
        json!({
            "semantic_labels/name": label.name(),
            "semantic_labels/id": label.id(),
            "semantic_labels/colour": format!("#{r:02x}{g:02x}{b:02x}"),
        })
    });
    let fields = [("name", json!(["sc:Text", "sc:name"])), ("id", json!("cr:UInt8")), ("colour", json!("sc:Text"))];
    let doc = "The values of the semantic images: CARLA's label ids (0.9.14 and later) and colours.";
    inline_set("semantic_labels", "sc:Enumeration", doc, &fields, rows.to_vec())
}

fn roles() -> Value {
    names("roles", &cosfly_schema::Role::ALL.map(cosfly_schema::Role::name))
}

/// The values of columns that are numbers in Parquet and names in words.
fn names(set: &str, values: &[&str]) -> Value {
    let row = |(id, name): (usize, &&str)| json!({format!("{set}/name"): name, format!("{set}/id"): id});
    let fields = [("name", json!(["sc:Text", "sc:name"])), ("id", json!("cr:Int64"))];
    let column = match set {
        "difficulties" => "difficulty",
        plural => plural.trim_end_matches('s'),
    };
    let doc = format!("The values of columns `{column}`.");
    inline_set(set, "sc:Enumeration", &doc, &fields, values.iter().enumerate().map(row).collect())
}
