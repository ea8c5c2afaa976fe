//! Valid and malformed answers of plugins.

use super::*;
use arrow_array::types::{Int32Type, Int64Type};
use arrow_array::{
    Array, BinaryArray, BooleanArray, DictionaryArray, Float32Array, Float64Array, Int64Array, ListArray, RecordBatch,
    StringArray,
};
use arrow_ipc::writer::StreamWriter;
use std::sync::Arc;

fn stream(columns: Vec<(&str, Arc<dyn Array>)>) -> Vec<u8> {
    let batch = RecordBatch::try_from_iter(columns).unwrap();
    let mut writer = StreamWriter::try_new(Vec::new(), &batch.schema()).unwrap();
    writer.write(&batch).unwrap();
    writer.finish().unwrap();
    writer.into_inner().unwrap()
}

fn declared(columns: &[(&str, ColumnKind)]) -> Vec<DeclaredColumn> {
    let of = |(name, kind): &(&str, ColumnKind)| DeclaredColumn { name: (*name).into(), kind: *kind, doc: "".into() };
    columns.iter().map(of).collect()
}

fn reals(values: &[f64]) -> Arc<dyn Array> {
    Arc::new(Float64Array::from(values.to_vec()))
}

#[test]
fn answers_are_read_and_wrong_ones_say_what_is_declared() {
    let keep = Arc::new(BooleanArray::from(vec![false]));
    let reason = Arc::new(StringArray::from(vec!["too low"]));
    let gives = declared(&[("keep", ColumnKind::Boolean), ("reason", ColumnKind::Text)]);
    let good = stream(vec![("keep", keep.clone()), ("reason", reason.clone())]);
    assert_eq!(verdict(&good, &gives), Ok(FilterVerdict { keep: false, reason: "too low".into() }));
    assert!(verdict(&stream(vec![("keep", keep.clone())]), &gives).unwrap_err().contains("no column `reason` (text)"));
    let more = stream(vec![("keep", keep.clone()), ("reason", reason.clone()), ("colour", reason.clone())]);
    assert!(verdict(&more, &gives).unwrap_err().contains("`colour` that it does not declare"));
    let order = stream(vec![("reason", reason), ("keep", keep)]);
    assert!(verdict(&order, &gives).unwrap_err().contains("column 0 is `reason`; it declares `keep` (boolean)"));

    let gives = declared(&[("risk", ColumnKind::Real)]);
    let label = stream(vec![("risk", reals(&[0.5, 1.0]))]);
    assert_eq!(labels(&label, &gives, 2).unwrap(), [("risk".to_owned(), vec![0.5, 1.0])]);
    assert!(labels(&label, &gives, 3).unwrap_err().contains("2 rows for 3 frames"));
    assert!(read_answer(&label, &gives, 1..=1).unwrap_err().contains("2 rows; one is required"));
    assert!(read_answer(&label, &gives, 0..=1).unwrap_err().contains("2 rows; at most 1"));
    let endless = stream(vec![("risk", reals(&[0.5, f64::NAN]))]);
    assert!(labels(&endless, &gives, 2).unwrap_err().contains("at row 1 is not a number"));
    let gaps = stream(vec![("risk", Arc::new(Float64Array::from(vec![Some(1.0), None])))]);
    assert!(labels(&gaps, &gives, 2).unwrap_err().contains("1 nulls"));
}

#[test]
fn other_types_than_the_declared_ones_are_refused() {
    let gives = declared(&[("a", ColumnKind::Real)]);
    let nested = ListArray::from_iter_primitive::<Int64Type, _, _>([Some([Some(1)])]);
    let dictionary: DictionaryArray<Int32Type> = vec!["x"].into_iter().collect();
    let others: [Arc<dyn Array>; 5] = [
        Arc::new(Int64Array::from(vec![1])),
        Arc::new(Float32Array::from(vec![1.0])),
        Arc::new(StringArray::from(vec!["x"])),
        Arc::new(nested),
        Arc::new(dictionary),
    ];
    for other in others {
        let words = read_answer(&stream(vec![("a", other)]), &gives, 1..=1).unwrap_err();
        assert!(words.contains("it declares Float64") || words.contains("is a DictionaryBatch"), "{words}");
    }
}

#[test]
fn files_stay_in_their_folder() {
    let gives = declared(&[("path", ColumnKind::Text), ("content", ColumnKind::Bytes)]);
    let answer = |paths: &[&str]| {
        let contents: Vec<&[u8]> = paths.iter().map(|_| &b"x"[..]).collect();
        let contents = Arc::new(BinaryArray::from(contents));
        stream(vec![("path", Arc::new(StringArray::from(paths.to_vec()))), ("content", contents)])
    };
    read_answer(&answer(&["a.txt", "labels/b-1.txt"]), &gives, 0..=10).unwrap();
    read_answer(&answer(&[]), &gives, 0..=10).unwrap();
    for path in [
        "../../x",
        "/etc/x",
        "a//b",
        "a/../b",
        ".hidden",
        "",
        "a\\b",
        "C:x",
        "ü",
        "a/",
        "x.",
        "a\0",
        "a/b/c/d/e/f/g/h/i",
    ] {
        let words = read_answer(&answer(&[path]), &gives, 0..=10).unwrap_err();
        assert!(words.contains("; paths "), "{path}: {words}");
    }
    assert!(read_answer(&answer(&["a", "A"]), &gives, 0..=10).unwrap_err().contains("twice"));
    assert!(read_answer(&answer(&["a", "a-b", "a/b"]), &gives, 0..=10).unwrap_err().contains("is a folder"));
    let many: Vec<String> = (0..11).map(|k| format!("f{k}")).collect();
    let many: Vec<&str> = many.iter().map(String::as_str).collect();
    assert!(read_answer(&answer(&many), &gives, 0..=10).unwrap_err().contains("11 rows; at most 10"));
}

#[test]
fn damaged_streams_are_refused_without_a_panic_and_without_the_memory_that_they_ask_for() {
    let gives = declared(&[("a", ColumnKind::Real), ("b", ColumnKind::Text), ("c", ColumnKind::Boolean)]);
    let texts = Arc::new(StringArray::from(vec!["one", "", "three"]));
    let truths = Arc::new(BooleanArray::from(vec![true, false, true]));
    let good = stream(vec![("a", reals(&[0.5, 1.0, 2.0])), ("b", texts), ("c", truths)]);
    read_answer(&good, &gives, 3..=3).unwrap();
    for end in 0..good.len() - 8 {
        assert!(read_answer(&good[..end], &gives, 3..=3).is_err(), "cut at {end}");
    }
    for at in 0..good.len() {
        for change in [0x01, 0x40, 0x80, 0xFF] {
            let mut damaged = good.clone();
            damaged[at] ^= change;
            if let Ok(columns) = read_answer(&damaged, &gives, 3..=3) {
                assert!(columns.iter().all(|values| values.len() == 3));
            }
        }
    }
    // Sets eight bytes at every position to their maximum: lengths, offsets, row counts.
    for at in 0..good.len() - 8 {
        for wild in [i64::MAX, i64::MIN, 10 << 30, -1] {
            let mut damaged = good.clone();
            damaged[at..at + 8].copy_from_slice(&wild.to_le_bytes());
            let _ = read_answer(&damaged, &gives, 3..=3);
        }
    }
}

#[test]
fn flights_give_the_columns_that_are_asked_for_and_name_those_that_there_are() {
    let sample = FlightColumns::sample();
    let read = |names: &[(&str, ColumnKind)]| {
        let wanted = declared(names);
        sample.encode(&wanted).map(|stream| read_answer(&stream, &wanted, SAMPLE_FRAMES..=SAMPLE_FRAMES).unwrap())
    };
    let columns =
        read(&[("in_view", ColumnKind::Boolean), ("frame", ColumnKind::Integer), ("time_s", ColumnKind::Real)]);
    let columns = columns.unwrap();
    assert_eq!(columns[1], Values::Integers((0..SAMPLE_FRAMES as i64).collect()));
    let refused = read(&[("visibilty", ColumnKind::Real)]).unwrap_err();
    assert!(
        refused.message.contains("`visibilty`; flights have no such column; their columns are `frame`, `time_s`"),
        "{refused:?}"
    );
    assert_eq!(refused.hint.as_deref(), Some("did you mean `visibility`?"));
    assert!(read(&[("frame", ColumnKind::Real)]).unwrap_err().message.contains("as real; it is integer"));
    assert_eq!(check_names(&declared(&[("cost_mine", ColumnKind::Real)]), false), Ok(()));
    assert!(check_names(&declared(&[("cost_mine", ColumnKind::Text)]), false).is_err());
    let unrendered = check_names(&declared(&[("in_view", ColumnKind::Boolean)]), false).unwrap_err();
    assert!(unrendered.message.contains("only rendered flights"), "{unrendered:?}");
    // A stage may read no column at all.
    sample.encode(&[]).unwrap();
}
