//! `croissant.json` against the tables and files it describes.

use super::files::{CheckedFiles, State};
use super::report::VerifyReport;
use cosfly_diagnose::Result;
use cosfly_fingerprint::sha256::sha256_of_reader;
use cosfly_schema::tables::{self, Table};
use serde_json::Value;
use std::collections::BTreeSet;
use std::fs::File;
use std::path::Path;

const FILE: &str = "croissant.json";

/// Checks versions, required properties, file objects and fields.
pub fn check(folder: &Path, files: &CheckedFiles, report: &mut VerifyReport) -> Result<()> {
    if files.state(FILE) != State::Sound {
        return Ok(());
    }
    let bytes =
        std::fs::read(folder.join(FILE)).map_err(|e| cosfly_diagnose::Diagnostic::io("read `croissant.json`", &e))?;
    let document: Value = match serde_json::from_slice(&bytes) {
        Ok(document) => document,
        Err(error) => {
            report.find(FILE, "", "verify-croissant", format!("it is not JSON: {error}"));
            return Ok(());
        }
    };
    if !list(&document["conformsTo"]).iter().any(|version| *version == "http://mlcommons.org/croissant/1.1") {
        report.find(FILE, "conformsTo", "verify-croissant", "version 1.1 of Croissant is not named");
    }
    for property in ["name", "description", "license", "usageInfo", "url", "version", "datePublished", "citeAs"] {
        if document[property].as_str().is_none_or(str::is_empty) {
            report.find(FILE, property, "verify-croissant", "it is missing or empty");
        }
    }
    check_file_objects(folder, files, &document, report);
    for table in tables::of_trajectories() {
        check_fields(&document, &table, true, report);
    }
    check_fields(&document, &tables::of_objects(), false, report);
    check_fields(&document, &tables::of_rejections(), false, report);
    check_fields(&document, &tables::of_files(), false, report);
    Ok(())
}

fn list(value: &Value) -> &[Value] {
    value.as_array().map_or(&[], Vec::as_slice)
}

fn check_file_objects(folder: &Path, files: &CheckedFiles, document: &Value, report: &mut VerifyReport) {
    let mut names_files = false;
    for object in list(&document["distribution"]).iter().filter(|object| object["@type"] == "cr:FileObject") {
        let path = object["contentUrl"].as_str().unwrap_or_default();
        names_files |= path == "files.parquet";
        // Only files that were looked at before are opened: no pipes, no paths that lead out.
        let is_regular = files.state(path) >= State::Regular;
        let outcome = is_regular.then(|| File::open(folder.join(path)).ok()).flatten();
        let Some((bytes, sha256)) = outcome.and_then(|mut file| sha256_of_reader(&mut file).ok()) else {
            report.find(FILE, format!("file object `{path}`"), "verify-missing-file", "it is not there");
            continue;
        };
        if object["sha256"] != sha256 || object["contentSize"] != format!("{bytes} B") {
            report.find(FILE, format!("file object `{path}`"), "verify-hash", "its hash or size is another one");
        }
    }
    if !names_files {
        report.find(FILE, "distribution", "verify-croissant", "`files.parquet` is not named");
    }
}

/// The fields of a record set are the columns of its table.
fn check_fields<S>(document: &Value, table: &Table<S>, has_splits: bool, report: &mut VerifyReport) {
    let Some(set) = list(&document["recordSet"]).iter().find(|set| set["@id"] == table.name) else {
        report.find(FILE, "recordSet", "verify-croissant", format!("table `{}` is missing", table.name));
        return;
    };
    let found: BTreeSet<&str> = list(&set["field"]).iter().filter_map(|field| field["name"].as_str()).collect();
    let mut expected: BTreeSet<&str> = table.columns.iter().map(|column| column.name()).collect();
    if has_splits {
        expected.insert("split");
    }
    for name in found.symmetric_difference(&expected) {
        let message = format!("field `{name}` is only on one side, here or in the table");
        report.find(FILE, format!("record set `{}`", table.name), "verify-croissant", message);
    }
}
