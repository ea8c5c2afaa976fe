//! Answers of plugin stages. They are untrusted: framing, sizes and schema are checked before anything is decoded.

use super::column::{ColumnKind, DeclaredColumn, Values};
use arrow_array::cast::AsArray;
use arrow_array::types::{Float64Type, Int64Type};
use arrow_array::{Array, RecordBatch};
use arrow_ipc::reader::StreamReader;
use arrow_ipc::{MessageHeader, root_as_message};
use arrow_schema::DataType;
use cosfly_diagnose::{contained, plausible};
use std::collections::BTreeSet;
use std::ops::RangeInclusive;

/// Most rows of an answer.
pub const MOST_ROWS: usize = 1_000_000;
/// Most files of an answer.
pub const MOST_FILES: usize = 1_000;
/// Most bytes of all files of an answer.
pub const MOST_FILE_BYTES: usize = 256 << 20;
/// Longest text, bytes.
const MOST_TEXT_BYTES: usize = 1 << 20;
/// Longest path of a file, and most folders in it.
const MOST_PATH_BYTES: usize = 200;
const MOST_FOLDERS: usize = 8;

/// Verdict of a filter on a flight.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct FilterVerdict {
    /// Whether the flight is kept.
    pub keep: bool,
    /// Reason for a rejection.
    pub reason: String,
}

/// Reads the answer of a filter.
///
/// # Errors
/// The violated rule, in words.
pub fn verdict(answer: &[u8], gives: &[DeclaredColumn]) -> Result<FilterVerdict, String> {
    match <[Values; 2]>::try_from(read_answer(answer, gives, 1..=1)?) {
        Ok([Values::Booleans(keep), Values::Texts(reason)]) => {
            let reason: String = reason[0].chars().take(500).collect();
            let reason = if reason.is_empty() { "no reason is given".to_owned() } else { reason };
            Ok(FilterVerdict { keep: keep[0], reason })
        }
        _ => Err("the columns that it declares are not those of a filter".to_owned()),
    }
}

/// Reads the labels of a flight of `frames` frames, by name.
///
/// # Errors
/// The violated rule, in words.
pub fn labels(answer: &[u8], gives: &[DeclaredColumn], frames: usize) -> Result<Vec<(String, Vec<f64>)>, String> {
    let columns = read_answer(answer, gives, frames..=frames)?;
    let named = gives.iter().zip(columns).map(|(column, values)| match values {
        Values::Reals(values) => Ok((column.name.clone(), values)),
        _ => Err(format!("its label `{}` does not hold floats", column.name)),
    });
    named.collect()
}

/// Reads the columns of an answer, which must be those of `gives`, with a number of rows within `rows`. Paths of files
/// are checked, too.
///
/// # Errors
/// The violated rule, in words.
pub fn read_answer(
    answer: &[u8],
    gives: &[DeclaredColumn],
    rows: RangeInclusive<usize>,
) -> Result<Vec<Values>, String> {
    check_framing(answer, &rows)?;
    // The Arrow reader may panic on malformed streams, which must not end the run.
    let read = || decode(answer, gives);
    let batch = contained(read).unwrap_or_else(|| Err(unreadable("it is damaged")))?;
    check_rows(batch.num_rows() as u64, &rows)?;
    let columns = batch.columns().iter().zip(gives);
    let columns: Vec<Values> = columns.map(|(array, column)| values(array, column)).collect::<Result<_, _>>()?;
    if let [Values::Texts(paths), Values::Bytes(contents)] = &columns[..] {
        check_files(paths, contents)?;
    }
    Ok(columns)
}

fn unreadable(words: impl std::fmt::Display) -> String {
    format!("it returned no Arrow stream: {words}")
}

fn check_rows(found: u64, rows: &RangeInclusive<usize>) -> Result<(), String> {
    let (least, most) = (*rows.start() as u64, *rows.end() as u64);
    if (least..=most).contains(&found) {
        return Ok(());
    }
    Err(match (least, most) {
        (1, 1) => format!("it returned {found} rows; one is required"),
        (0, most) => format!("it returned {found} rows; at most {most} are allowed"),
        (frames, _) => format!("it returned {found} rows for {frames} frames"),
    })
}

/// Checks for one schema, one record batch with an allowed number of rows, and as many bytes as they declare.
fn check_framing(answer: &[u8], rows: &RangeInclusive<usize>) -> Result<(), String> {
    let number = |at: usize| answer.get(at..)?.first_chunk().map(|bytes| u32::from_le_bytes(*bytes));
    let (mut at, mut messages) = (0, 0);
    while at < answer.len() {
        let (Some(u32::MAX), Some(length)) = (number(at), number(at + 4)) else {
            return Err(unreadable(format!("no message begins at byte {at}")));
        };
        if length == 0 {
            break;
        }
        let ends_within = || unreadable(format!("it ends within message {messages}"));
        let body_at = at + 8 + length as usize;
        let message = answer.get(at + 8..body_at).ok_or_else(ends_within)?;
        let message = root_as_message(message).map_err(|_| unreadable(format!("message {messages} is damaged")))?;
        match (messages, message.header_type()) {
            (0, MessageHeader::Schema) => {}
            (1, MessageHeader::RecordBatch) => {
                let batch = message.header_as_record_batch().ok_or_else(ends_within)?;
                if batch.compression().is_some() {
                    return Err("it returned a compressed record batch; it must be plain".to_owned());
                }
                check_rows(u64::try_from(batch.length()).unwrap_or(u64::MAX), rows)?;
            }
            (2.., MessageHeader::RecordBatch) => return Err("it returned more than one record batch".to_owned()),
            (_, other) => {
                let kind = other.variant_name().unwrap_or("unknown message");
                return Err(unreadable(format!(
                    "message {messages} is a {kind}; a schema and one record batch are required"
                )));
            }
        }
        let body = usize::try_from(message.bodyLength()).ok();
        at = body
            .and_then(|body| body_at.checked_add(body))
            .filter(|end| *end <= answer.len())
            .ok_or_else(ends_within)?;
        messages += 1;
    }
    if messages == 2 { Ok(()) } else { Err("it returned an Arrow stream without a record batch".to_owned()) }
}

/// Decodes the record batch; its schema must be the declared one.
fn decode(answer: &[u8], gives: &[DeclaredColumn]) -> Result<RecordBatch, String> {
    let mut reader = StreamReader::try_new(answer, None).map_err(unreadable)?;
    let schema = reader.schema();
    for (place, column) in gives.iter().enumerate() {
        let wanted = arrow_type(column.kind);
        match schema.fields().get(place) {
            Some(field) if *field.name() != column.name => {
                let found: String = field.name().chars().take(80).collect();
                let (name, kind) = (&column.name, column.kind.name());
                return Err(format!("column {place} is `{found}`; it declares `{name}` ({kind}) there"));
            }
            Some(field) if *field.data_type() != wanted => {
                let found: String = field.data_type().to_string().chars().take(80).collect();
                return Err(format!("its column `{}` holds {found}; it declares {wanted}", column.name));
            }
            Some(_) => {}
            None => return Err(format!("it returned no column `{}` ({})", column.name, column.kind.name())),
        }
    }
    if let Some(field) = schema.fields().get(gives.len()) {
        let found: String = field.name().chars().take(80).collect();
        return Err(format!("it returned a column `{found}` that it does not declare"));
    }
    let batch = reader.next().ok_or_else(|| unreadable("there is no record batch"))?;
    let batch = batch.map_err(unreadable)?;
    // The array was built without checks and is validated as a whole.
    batch.columns().iter().try_for_each(|array| array.to_data().validate_full()).map_err(unreadable)?;
    Ok(batch)
}

fn arrow_type(kind: ColumnKind) -> DataType {
    match kind {
        ColumnKind::Real => DataType::Float64,
        ColumnKind::Integer => DataType::Int64,
        ColumnKind::Boolean => DataType::Boolean,
        ColumnKind::Text => DataType::Utf8,
        ColumnKind::Bytes => DataType::Binary,
    }
}

fn values(array: &dyn Array, column: &DeclaredColumn) -> Result<Values, String> {
    let name = &column.name;
    if array.null_count() > 0 {
        return Err(format!("its column `{name}` has {} nulls; there must be none", array.null_count()));
    }
    Ok(match column.kind {
        ColumnKind::Real => {
            let values = array.as_primitive::<Float64Type>().values();
            if let Some((row, fault)) = values.iter().zip(0..).find_map(|(it, row)| Some((row, plausible(*it).err()?)))
            {
                return Err(format!("its column `{name}` at row {row} {fault}: {:e}", values[row]));
            }
            Values::Reals(values.to_vec())
        }
        ColumnKind::Integer => Values::Integers(array.as_primitive::<Int64Type>().values().to_vec()),
        ColumnKind::Boolean => Values::Booleans(array.as_boolean().values().iter().collect()),
        ColumnKind::Text => {
            let texts = array.as_string::<i32>();
            if let Some(row) = (0..texts.len()).find(|row| texts.value(*row).len() > MOST_TEXT_BYTES) {
                let bytes = texts.value(row).len();
                return Err(format!(
                    "its text `{name}` at row {row} has {bytes} bytes; at most {MOST_TEXT_BYTES} are allowed"
                ));
            }
            Values::Texts((0..texts.len()).map(|row| texts.value(row).to_owned()).collect())
        }
        ColumnKind::Bytes => {
            let values = array.as_binary::<i32>();
            Values::Bytes((0..values.len()).map(|row| values.value(row).to_vec()).collect())
        }
    })
}

fn check_files(paths: &[String], contents: &[Vec<u8>]) -> Result<(), String> {
    let bytes: usize = contents.iter().map(Vec::len).sum();
    if bytes > MOST_FILE_BYTES {
        return Err(format!("its files have {} MiB; at most {} are allowed", bytes >> 20, MOST_FILE_BYTES >> 20));
    }
    let mut seen: BTreeSet<String> = BTreeSet::new();
    for path in paths {
        if let Some(rule) = broken_rule(path) {
            let shown: String = path.chars().take(80).collect();
            return Err(format!("it returned a file `{}`; {rule}", shown.escape_debug()));
        }
        // Some file systems do not distinguish upper and lower case.
        if !seen.insert(path.to_ascii_lowercase()) {
            return Err(format!("it returned the file `{path}` twice"));
        }
    }
    let is_folder = |path: &&String| {
        let inside = format!("{path}/");
        seen.range(inside.clone()..).next().is_some_and(|next| next.starts_with(&inside))
    };
    match seen.iter().find(is_folder) {
        Some(path) => Err(format!("it returned the file `{path}`, which is a folder of another one")),
        None => Ok(()),
    }
}

/// Violated rule of the path of a file, if any.
fn broken_rule(path: &str) -> Option<String> {
    let is_plain = |byte: u8| byte.is_ascii_alphanumeric() || matches!(byte, b'.' | b'_' | b'-' | b'/');
    if !(1..=MOST_PATH_BYTES).contains(&path.len()) {
        return Some(format!("paths have 1 to {MOST_PATH_BYTES} characters"));
    }
    if !path.bytes().all(is_plain) {
        return Some("paths consist of letters, digits, `.`, `_`, `-` and `/`".to_owned());
    }
    if path.split('/').any(|part| part.is_empty() || part.starts_with('.') || part.ends_with('.')) {
        return Some("paths are relative, and no part of them is empty or begins or ends with a dot".to_owned());
    }
    (path.split('/').count() > MOST_FOLDERS).then(|| format!("paths have at most {MOST_FOLDERS} parts"))
}
