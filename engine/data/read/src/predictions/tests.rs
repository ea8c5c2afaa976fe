//! Valid rows, and invalid rows with their reasons.

use super::*;
use arrow_array::builder::{Float32Builder, ListBuilder};
use arrow_array::{ArrayRef, Int32Array, RecordBatch, StringArray};
use std::sync::Arc;

fn of_text(text: &str) -> Predictions {
    let file = tempfile::NamedTempFile::new().unwrap();
    std::fs::write(file.path(), text).unwrap();
    read(file.path()).unwrap()
}

#[test]
fn arrays_objects_and_model_texts_are_the_same_prediction() {
    let text = r#"{"trajectory_id": "a", "frame": 3, "waypoint_deltas": [[1, 2, 3, 4, 5, 6], [1]]}

{"trajectory_id": "a", "frame": 3.0, "waypoint_deltas": [{"dx": 1, "dy": 2, "dz": 3, "dpitch": 4, "dyaw": 5, "droll": 6}, {"dx": 1}], "more": [1]}
{"trajectory_id": "a", "frame": 3, "text": "<think>hm</think> {\"waypoint_deltas\": [[1,2,3,4,5,6],[1]]}"}
{"trajectory_id": "a", "frame": 3, "prediction": {"waypoint_deltas": [[1,2,3,4,5,6],[1]]}, "boxes": [[1, 2, 3, 4], null]}
"#;
    let found = of_text(text);
    assert_eq!(found.problems, []);
    assert_eq!(found.rows().map(|row| row.line).collect::<Vec<_>>(), [1, 3, 4, 5]);
    for row in found.rows() {
        assert_eq!((row.trajectory_id, row.frame), ("a", 3));
        assert_eq!(row.deltas, [[1.0, 2.0, 3.0, 4.0, 5.0, 6.0], [1.0, 0.0, 0.0, 0.0, 0.0, 0.0]]);
    }
    assert_eq!(found.row(3).boxes, [Some([1.0, 2.0, 3.0, 4.0]), None]);
}

#[test]
fn every_bad_line_is_named_with_its_reason() {
    for (line, kind, words) in [
        ("{", "json", "EOF"),
        ("[1, 2]", "field-type", "invalid"),
        ("\u{fffd}", "json", "not JSON"),
        (r#"{"frame": 0, "waypoint_deltas": []}"#, "field-missing", "trajectory_id"),
        (r#"{"trajectory_id": "a", "waypoint_deltas": []}"#, "field-missing", "frame"),
        (r#"{"trajectory_id": "a", "frame": 0}"#, "field-missing", "waypoint_deltas"),
        (r#"{"trajectory_id": "a", "frame": 0.5, "waypoint_deltas": []}"#, "frame", "whole number"),
        (r#"{"trajectory_id": "a", "frame": -1, "waypoint_deltas": []}"#, "frame", "whole number"),
        (r#"{"trajectory_id": "a", "frame": 0, "waypoint_deltas": [[NaN]]}"#, "not-finite", "not finite"),
        (r#"{"trajectory_id": "a", "frame": 0, "waypoint_deltas": [[1e999]]}"#, "not-finite", "not finite"),
        (
            r#"{"trajectory_id": "a", "frame": 0, "waypoint_deltas": [[0], [0, 1e23]]}"#,
            "implausible",
            "`dy` of waypoint 2",
        ),
        (
            r#"{"trajectory_id": "a", "frame": 0, "text": "{\"waypoint_deltas\": [[-1e24]]}"}"#,
            "implausible",
            "`dx` of waypoint 1 is larger than 1e9 in magnitude: -1e24",
        ),
        (
            r#"{"trajectory_id": "a", "frame": 0, "waypoint_deltas": [[0]], "boxes": [null, [0, 1e12, 2, 3]]}"#,
            "implausible",
            "the top edge of box 2",
        ),
        (r#"{"trajectory_id": "a", "frame": 0, "waypoint_deltas": [["a"]]}"#, "field-type", "invalid type"),
        (r#"{"trajectory_id": "a", "frame": 0, "waypoint_deltas": [null]}"#, "field-type", "a waypoint"),
        (r#"{"trajectory_id": "a", "frame": 0, "text": "no idea"}"#, "model-text", "no `\"waypoint_deltas\"`"),
        (r#"{"trajectory_id": "a", "frame": 0, "waypoint_deltas": [[1]], "boxes": [[1, 2]]}"#, "field-type", "length"),
    ] {
        let found = of_text(line);
        assert!(found.is_empty(), "{line}");
        let problem = &found.problems[0];
        assert!((problem.line, problem.kind) == (1, kind) && problem.reason.contains(words), "{line}: {problem:?}");
    }
}

#[test]
fn an_array_of_rows_is_read_like_lines() {
    let row = r#"{"trajectory_id": "a", "frame": 3, "waypoint_deltas": [[1, 2]]}"#;
    let found = of_text(&format!("[{row},\n{{\"frame\": NaN}}, {row}]"));
    assert_eq!(found.rows().map(|row| row.line).collect::<Vec<_>>(), [1, 3]);
    assert_eq!((found.problems[0].line, found.problems[0].kind), (2, "not-finite"));
    let file = tempfile::NamedTempFile::new().unwrap();
    std::fs::write(file.path(), format!("[{row}, {row}")).unwrap();
    let refusal = read(file.path()).unwrap_err();
    assert!(refusal.code == "predictions-damaged" && refusal.causes[0].contains("within row 2"), "{refusal:?}");
}

#[test]
fn lines_keep_their_numbers_over_segments_and_parts() {
    let row = |number: usize| match number % 1000 {
        7 => "{\n".to_owned(),
        8 => "\n".to_owned(),
        _ => format!(
            "{{\"trajectory_id\": \"a{}\", \"frame\": {number}, \"waypoint_deltas\": [[1, 2, 3]]}}\n",
            number / 64
        ),
    };
    // More than two segments.
    let text: String = (0..560_000).map(row).collect();
    assert!(text.len() > 35_000_000, "{}", text.len());
    let found = of_text(text.trim_end());
    assert_eq!((found.len(), found.problems.len()), (560_000 - 1120, 560));
    assert!(found.rows().all(|row| row.line == row.frame + 1 && row.trajectory_id == format!("a{}", row.frame / 64)));
    assert!(found.problems.iter().zip(0..).all(|(problem, number)| problem.line == 1000 * number + 8));
    assert_eq!(found.row(found.len() - 1).frame, 559_999);
}

fn parquet_file(columns: Vec<(&str, ArrayRef)>) -> tempfile::NamedTempFile {
    let file = tempfile::NamedTempFile::new().unwrap();
    let batch = RecordBatch::try_from_iter(columns).unwrap();
    let mut writer = parquet::arrow::ArrowWriter::try_new(file.reopen().unwrap(), batch.schema(), None).unwrap();
    writer.write(&batch).unwrap();
    writer.close().unwrap();
    file
}

#[test]
fn parquet_rows_are_read_like_lines() {
    let mut deltas = ListBuilder::new(ListBuilder::new(Float32Builder::new()));
    for row in [vec![vec![1.0, 2.0], vec![0.5]], vec![vec![f32::NAN]], vec![vec![0.0; 7]]] {
        for waypoint in row {
            deltas.values().values().append_slice(&waypoint);
            deltas.values().append(true);
        }
        deltas.append(true);
    }
    let file = parquet_file(vec![
        ("trajectory_id", Arc::new(StringArray::from(vec!["a", "b", "c"])) as ArrayRef),
        ("frame", Arc::new(Int32Array::from(vec![0, 3, 6]))),
        ("waypoint_deltas", Arc::new(deltas.finish())),
    ]);
    let found = read(file.path()).unwrap();
    assert_eq!(found.len(), 1);
    assert_eq!(found.row(0).deltas, [[1.0, 2.0, 0.0, 0.0, 0.0, 0.0], [0.5, 0.0, 0.0, 0.0, 0.0, 0.0]]);
    let kinds: Vec<_> = found.problems.iter().map(|problem| (problem.line, problem.kind)).collect();
    assert_eq!(kinds, [(2, "not-finite"), (3, "field-type")]);
}

#[test]
fn parquet_without_the_columns_is_refused_with_those_it_has() {
    let file = parquet_file(vec![("id", Arc::new(StringArray::from(vec!["a"])) as ArrayRef)]);
    let error = read(file.path()).unwrap_err();
    assert_eq!((error.code, error.hints[0].as_str()), ("predictions-column", "its columns are id"));
    let texts = || Arc::new(StringArray::from(vec!["a"])) as ArrayRef;
    let twice = read(parquet_file(vec![("trajectory_id", texts()), ("trajectory_id", texts())]).path()).unwrap_err();
    assert!(twice.causes.iter().any(|cause| cause.contains("two columns are called `trajectory_id`")), "{twice:?}");
    let bytes = std::fs::read(file.path()).unwrap();
    std::fs::write(file.path(), &bytes[..bytes.len() / 2]).unwrap();
    assert_eq!(read(file.path()).unwrap_err().code, "predictions-damaged");
}

#[test]
fn parquet_with_damaged_pages_is_refused_without_a_panic() {
    let path = concat!(env!("CARGO_MANIFEST_DIR"), "/../../../tests/fuzz/corpus/predictions/damaged_page.parquet");
    let refusal = read(std::path::Path::new(path)).unwrap_err();
    assert_eq!(refusal.code, "predictions-damaged");
    assert!(refusal.causes[0].contains("its pages are damaged") && !refusal.hints.is_empty(), "{refusal:?}");
}
