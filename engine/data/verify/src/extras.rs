//! Tables of plugins: as `croissant.json` describes them, each row of a flight of its split.

use super::files::{CheckedFiles, State};
use super::report::VerifyReport;
use super::rows::split_of;
use super::tables::SmallTables;
use arrow_array::cast::AsArray;
use arrow_schema::DataType;
use cosfly_schema::extras::is_taken;
use parquet::arrow::ProjectionMask;
use parquet::arrow::arrow_reader::ParquetRecordBatchReaderBuilder;
use serde_json::Value;
use std::collections::{BTreeMap, BTreeSet};
use std::fs::File;
use std::path::Path;

/// Checks every table that is not one of the dataset's own.
pub fn check(folder: &Path, files: &CheckedFiles, tables: &SmallTables, report: &mut VerifyReport) {
    let described = described(folder, files);
    let mut found = BTreeSet::new();
    for file in files.sound_below("data/") {
        let Some(name) = file.split('/').nth(1).filter(|name| !is_taken(name)) else { continue };
        found.insert(name);
        let Some(fields) = described.get(name) else {
            report.find(file, "", "verify-croissant", format!("`croissant.json` describes no table `{name}`"));
            continue;
        };
        if let Err(message) = check_file(&folder.join(file), file, fields, tables) {
            report.find(file, "", "verify-schema", message);
        }
    }
    for name in described.keys().filter(|name| !found.contains(name.as_str())) {
        report.find("croissant.json", format!("record set `{name}`"), "verify-missing-file", "its table is not there");
    }
}

/// The columns of the tables that are described, by name.
fn described(folder: &Path, files: &CheckedFiles) -> BTreeMap<String, Vec<String>> {
    let file = "croissant.json";
    let text = (files.state(file) == State::Sound).then(|| std::fs::read(folder.join(file)).ok()).flatten();
    let document: Value = text.and_then(|text| serde_json::from_slice(&text).ok()).unwrap_or_default();
    let list = |value: &Value| value.as_array().cloned().unwrap_or_default();
    let name_of = |value: &Value| value["name"].as_str().unwrap_or_default().to_owned();
    let sets = list(&document["recordSet"]).into_iter().filter(|set| !is_taken(&name_of(set)));
    sets.map(|set| (name_of(&set), list(&set["field"]).iter().map(name_of).filter(|name| name != "split").collect()))
        .collect()
}

fn check_file(path: &Path, file: &str, fields: &[String], tables: &SmallTables) -> Result<(), String> {
    let opened = File::open(path).map_err(|error| format!("it cannot be opened: {error}"))?;
    let builder = ParquetRecordBatchReaderBuilder::try_new(opened).map_err(|error| format!("not Parquet: {error}"))?;
    let found: Vec<&str> = builder.schema().fields().iter().map(|field| field.name().as_str()).collect();
    if found != fields {
        return Err(format!("its columns are `{}`; `{}` are described", found.join("`, `"), fields.join("`, `")));
    }
    let is_text = |field: &arrow_schema::Field| *field.data_type() == DataType::Utf8;
    if !builder.schema().field_with_name("trajectory_id").is_ok_and(is_text) {
        return Err("it has no column `trajectory_id` of texts".to_owned());
    }
    let mask = ProjectionMask::columns(builder.parquet_schema(), ["trajectory_id"]);
    let reader = builder.with_projection(mask).build().map_err(|error| error.to_string())?;
    for batch in reader {
        let batch = batch.map_err(|error| format!("it cannot be read: {error}"))?;
        for id in batch.column(0).as_string::<i32>().iter().flatten() {
            match tables.flights.get(id) {
                None => return Err(format!("there is no flight `{id}`")),
                Some(flight) if split_of(&flight.place.0) != split_of(file) => {
                    return Err(format!("flight `{id}` is in split {}", split_of(&flight.place.0)));
                }
                Some(_) => {}
            }
        }
    }
    Ok(())
}
