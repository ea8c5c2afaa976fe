//! Detections in COCO's format of results (a JSON array) or as JSON lines of the same objects, row by row.

use super::json_array::{Places, bare_word, each_element};
use super::rows::{Refusal, RowProblem, number_of};
use super::run_lengths::Runs;
use super::{json_lines, not_an_array};
use cosfly_diagnose::{Diagnostic, Fault, Result};
use serde::Deserialize;
use serde_json::Value;
use std::collections::BTreeMap;
use std::path::Path;

/// Image of a detection.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum ImageKey {
    /// Number of an image in a COCO list of images.
    Number(i64),
    /// Trajectory id and frame.
    Frame(String, u64),
}

/// A mask with the size of its image, `[width, height]`.
#[derive(Clone, Debug, PartialEq)]
pub struct DetectedMask {
    /// Pixels of the mask.
    pub runs: Runs,
    /// Size of the image.
    pub size: [u32; 2],
}

/// A valid detection.
#[derive(Clone, Debug, PartialEq)]
pub struct Detection {
    /// Line of the file, or index in its array, from 1.
    pub line: u64,
    /// Image of the detection.
    pub image: ImageKey,
    /// CARLA's label id.
    pub category: i64,
    /// Confidence score.
    pub score: f64,
    /// Left, top, right, bottom edge, pixels.
    pub edges: Option<[f64; 4]>,
    /// Mask of the detection.
    pub mask: Option<DetectedMask>,
}

/// Rows of a file, in their order.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Detections {
    /// Valid rows.
    pub rows: Vec<Detection>,
    /// Invalid rows.
    pub problems: Vec<RowProblem>,
}

/// Names of fields that rows of waypoints have, and detections have not.
const OF_WAYPOINTS: [&str; 3] = ["\"waypoint_deltas\"", "\"text\"", "\"prediction\""];

/// Whether the start of a file looks like a file of detections: `Some(true)` for masks, `Some(false)` for boxes.
pub fn recognise(start: &[u8]) -> Option<bool> {
    let text = String::from_utf8_lossy(start);
    let text = text.trim_start();
    let is_array = text.starts_with('[');
    let first = match is_array {
        true => text,
        false => text.split_once('\n').map_or(text, |(line, _)| line),
    };
    let has = |names: &[&str]| names.iter().any(|name| first.contains(name));
    let is_of_detections = has(&["\"score\"", "\"bbox\"", "\"category_id\""]) || is_array && !has(&OF_WAYPOINTS);
    (is_of_detections && !has(&OF_WAYPOINTS[..1])).then(|| first.contains("\"counts\""))
}

/// Reads the file at `path`.
///
/// # Errors
/// The file cannot be read, is empty, or is an array that is cut off. Invalid rows are no error, see [`Detections::problems`].
pub fn read(path: &Path) -> Result<Detections> {
    let bytes = std::fs::read(path).map_err(|error| Diagnostic::unread(format!("`{}`", path.display()), &error))?;
    let mut found = Detections::default();
    if bytes.trim_ascii().is_empty() {
        let message = format!("`{}` is empty", path.display());
        return Err(Diagnostic::new("predictions-damaged", Fault::Input, message)
            .hint("a detector that found nothing writes an empty list: `[]`"));
    }
    if bytes.trim_ascii_start().starts_with(b"[") {
        let mut places = Places::default();
        let end = each_element(&bytes, &mut |number, range| {
            let at = |place: usize| places.of(&bytes, range.start + place);
            let row = parsed(&bytes[range.clone()], at);
            found.take(row, number);
        });
        return end.map_or_else(|fault| Err(not_an_array(path, &bytes, &fault)), |()| Ok(found));
    }
    for (line, number) in bytes.split(|byte| *byte == b'\n').zip(1..) {
        let text = line.trim_ascii();
        if !text.is_empty() {
            let row = serde_json::from_slice(text).map_err(|error| json_lines::refusal(text, &error));
            found.take(row, number);
        }
    }
    Ok(found)
}

/// An element of an array; `place` is the line and column of a byte of it.
fn parsed(element: &[u8], place: impl FnOnce(usize) -> (usize, usize)) -> std::result::Result<Value, Refusal> {
    serde_json::from_slice(element).map_err(|error| {
        let word = bare_word(element).filter(|_| error.is_syntax());
        let before = element.len() - element.trim_ascii_start().len();
        let (line, column) = place(word.as_ref().map_or(before, |(at, _)| *at));
        let here = format!("line {line}, column {column} of the file");
        match word {
            Some((_, name)) => ("not-finite", format!("{name} is not finite, which JSON cannot hold: {here}")),
            None if error.to_string().starts_with("number out of range") => {
                ("not-finite", format!("a number of the row at {here} is not finite"))
            }
            None => ("json", format!("not JSON: {error}, in the row at {here}")),
        }
    })
}

impl Detections {
    fn take(&mut self, row: std::result::Result<Value, Refusal>, line: u64) {
        match row.and_then(|row| detection(&row, line)) {
            Ok(row) => self.rows.push(row),
            Err((kind, reason)) => self.problems.push(RowProblem::new(line, kind, reason)),
        }
    }
}

fn detection(row: &Value, line: u64) -> std::result::Result<Detection, Refusal> {
    let missing = |field: &str| ("field-missing", format!("the row has no `{field}`"));
    if !row.is_object() {
        return Err(("field-type", "the row is not an object".to_owned()));
    }
    let image = match (row.get("trajectory_id").and_then(Value::as_str), row.get("frame").and_then(whole)) {
        (Some(id), Some(frame)) => {
            ImageKey::Frame(id.to_owned(), u64::try_from(frame).map_err(|_| ("frame", format!("`frame` is {frame}")))?)
        }
        _ => ImageKey::Number(
            row.get("image_id").and_then(whole).ok_or_else(|| missing("image_id`, or `trajectory_id` and `frame"))?,
        ),
    };
    let category = row.get("category_id").and_then(whole).ok_or_else(|| missing("category_id"))?;
    let score = row.get("score").and_then(Value::as_f64).ok_or_else(|| missing("score"))?;
    number_of(score, || "`score`".to_owned())?;
    // Polygons, which pycocotools adds to boxes, are not read as masks; a row with a box is a detection without a mask.
    let mask = row.get("segmentation").filter(|it| it.is_object()).map(mask).transpose()?;
    let edges = row.get("bbox").filter(|it| !it.is_null()).map(edges).transpose()?;
    if mask.is_none() && edges.is_none() {
        // A row with polygons alone is reported.
        row.get("segmentation").map(self::mask).transpose()?;
        return Err(missing("bbox` or `segmentation"));
    }
    Ok(Detection { line, image, category, score, edges, mask })
}

/// An integer, also one written as 3.0.
fn whole(value: &Value) -> Option<i64> {
    value.as_i64().or_else(|| value.as_f64().filter(|it| it.fract() == 0.0 && it.abs() < 9e15).map(|it| it as i64))
}

/// COCO's left, top, width, height as edges.
fn edges(value: &Value) -> std::result::Result<[f64; 4], Refusal> {
    let numbers: Option<Vec<f64>> = value.as_array().and_then(|list| list.iter().map(Value::as_f64).collect());
    match numbers.as_deref() {
        Some([left, top, width, height]) if *width >= 0.0 && *height >= 0.0 => {
            for (value, name) in [left, top, width, height].into_iter().zip(["left", "top", "width", "height"]) {
                number_of(*value, || format!("the {name} of `bbox`"))?;
            }
            Ok([*left, *top, left + width, top + height])
        }
        _ => Err(("field-type", "`bbox` is not left, top, width and height with sizes from 0".to_owned())),
    }
}

fn mask(value: &Value) -> std::result::Result<DetectedMask, Refusal> {
    let refusal = |what: &str| ("field-type", format!("`segmentation` {what}"));
    if value.is_array() {
        return Err(refusal(
            "is a list of polygons; masks are read as run lengths: {\"size\": [h, w], \"counts\": ...}",
        ));
    }
    let size = value.get("size").and_then(Value::as_array).map(|size| size.iter().map(Value::as_u64).collect());
    let Some(Some([Some(height), Some(width)])) = size.map(|size: Vec<_>| <[Option<u64>; 2]>::try_from(size).ok())
    else {
        return Err(refusal("has no `size` of height and width"));
    };
    let pixels = height.saturating_mul(width);
    let (Ok(columns), Ok(rows), true) = (u32::try_from(width), u32::try_from(height), pixels <= u64::from(u32::MAX))
    else {
        return Err(refusal("is larger than any image"));
    };
    let runs = match value.get("counts") {
        Some(Value::String(text)) => Runs::of_text(text, pixels),
        Some(Value::Array(counts)) => {
            let counts: Option<Vec<u64>> = counts.iter().map(Value::as_u64).collect();
            counts.ok_or("has a run that is not a number".to_owned()).and_then(|counts| Runs::of_counts(counts, pixels))
        }
        _ => return Err(refusal("has no `counts`")),
    };
    let runs = runs.map_err(|why| ("mask", format!("the mask cannot be read: {why}")))?;
    Ok(DetectedMask { runs, size: [columns, rows] })
}

/// An image of a COCO annotations file that `cosfly export --format coco` wrote.
#[derive(Clone, Debug, Deserialize, PartialEq)]
pub struct ListedImage {
    /// Image number.
    pub id: i64,
    /// Trajectory id.
    pub trajectory_id: String,
    /// Frame.
    pub frame: u64,
}

/// Images of the annotations file at `path`.
///
/// # Errors
/// The file cannot be read, its images have no trajectory and frame, or two of them have one number.
pub fn read_images(path: &Path) -> Result<Vec<ListedImage>> {
    #[derive(Deserialize)]
    struct Annotations {
        images: Vec<ListedImage>,
    }
    let file = std::fs::read(path).map_err(|error| Diagnostic::unread(format!("`{}`", path.display()), &error))?;
    let annotations: Annotations = serde_json::from_slice(&file).map_err(|error| {
        let message = format!("`{}` does not say which frames its images are", path.display());
        Diagnostic::new("predictions-images", Fault::Input, message)
            .because(error)
            .hint("it must be `annotations/instances_<split>.json` of `cosfly export --format coco`")
    })?;
    let mut frames: BTreeMap<i64, &ListedImage> = BTreeMap::new();
    for image in &annotations.images {
        if let Some(first) = frames.insert(image.id, image).filter(|first| *first != image) {
            let (id, place) = (image.id, |it: &ListedImage| format!("frame {} of `{}`", it.frame, it.trajectory_id));
            let message = format!("two images of `{}` have the number {id}", path.display());
            return Err(Diagnostic::new("predictions-images", Fault::Input, message)
                .because(format!("it is {} and {}", place(first), place(image)))
                .hint("it must be `annotations/instances_<split>.json` of `cosfly export --format coco`, unchanged"));
        }
    }
    Ok(annotations.images)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn of(text: &str) -> Detections {
        let file = tempfile::NamedTempFile::new().unwrap();
        std::fs::write(file.path(), text).unwrap();
        read(file.path()).unwrap()
    }

    #[test]
    fn an_array_and_lines_say_the_same() {
        let row = "{\"image_id\": 3, \"category_id\": 12, \"bbox\": [1, 2, 3, 4], \"score\": 0.5}";
        let found = of(&format!("[{row}]"));
        assert_eq!(found, of(&format!("\n{row}\n")).tap(|it| it.rows[0].line = 1));
        assert_eq!((found.rows[0].edges, &found.rows[0].image), (Some([1.0, 2.0, 4.0, 6.0]), &ImageKey::Number(3)));
        assert_eq!(
            (recognise(row.as_bytes()), recognise(b"[]"), recognise(b"{\"frame\":1}")),
            (Some(false), Some(false), None)
        );
        assert_eq!(recognise(b"[{\"trajectory_id\": \"a\", \"waypoint_deltas\": []}]"), None);
        assert_eq!(recognise(b"[{\"segmentation\": {\"counts\": \"0\"}, \"score\": 1}]"), Some(true));
    }

    #[test]
    fn a_number_that_json_cannot_hold_is_a_fault_of_its_row_alone() {
        let row = |score: &str, width: &str| {
            format!("{{\"image_id\": 3, \"category_id\": 12, \"bbox\": [1, 2, {width}, 4], \"score\": {score}}}")
        };
        let rows = [row("NaN", "3"), row("0.5", "3"), row("0.5", "Infinity"), row("1e999", "3"), row("1e23", "3")];
        let rows = [&rows[..], &[row("0.5", "1e10"), row("0.5", "3"), "{\"a\": 1,}".to_owned()]].concat();
        let found = of(&format!("[\n{}]", rows.join(",\n")));
        let kinds: Vec<_> = found.problems.iter().map(|it| (it.line, it.kind)).collect();
        let expected = [
            (1, "not-finite"),
            (3, "not-finite"),
            (4, "not-finite"),
            (5, "implausible"),
            (6, "implausible"),
            (8, "json"),
        ];
        assert_eq!((kinds.as_slice(), found.rows.len()), (&expected[..], 2));
        let said = |problem: usize, words: &str| {
            let reason = &found.problems[problem].reason;
            assert!(reason.contains(words), "{reason}");
        };
        said(0, "`score` is not finite, which JSON cannot hold: line 2, column 67");
        said(1, "`bbox` is not finite");
        said(3, "`score` is larger than 1e9 in magnitude: 1e23");
        said(4, "the width of `bbox`");
        assert_eq!(of("[]"), Detections::default());
    }

    #[test]
    fn an_empty_file_and_an_array_that_is_cut_off_are_refused() {
        let file = tempfile::NamedTempFile::new().unwrap();
        std::fs::write(file.path(), "[{\"image_id\": 3},\n {\"image_id\":").unwrap();
        let refusal = read(file.path()).unwrap_err();
        assert_eq!(refusal.code, "predictions-damaged");
        std::fs::write(file.path(), "\n").unwrap();
        assert!(read(file.path()).unwrap_err().message.ends_with("is empty"));
        assert!(refusal.causes[0].contains("line 1, column 18: the file ends within row 2"), "{:?}", refusal.causes);
    }

    impl Detections {
        fn tap(mut self, change: impl Fn(&mut Self)) -> Self {
            change(&mut self);
            self
        }
    }

    #[test]
    fn what_is_wrong_with_a_row_is_said_and_the_others_are_read() {
        let rows = [
            "{\"image_id\": 3, \"category_id\": 12, \"bbox\": [1, 2, 3, 4], \"score\": 0.5}",
            "{\"category_id\": 12, \"bbox\": [1, 2, 3, 4], \"score\": 0.5}",
            "{\"image_id\": 3, \"category_id\": 12, \"bbox\": [1, 2, -3, 4], \"score\": 0.5}",
            "{\"image_id\": 3, \"category_id\": 12, \"score\": 0.5}",
            "{\"image_id\": 3, \"category_id\": 12, \"score\": 0.5, \"segmentation\": [[1, 2, 3, 4, 5, 6]]}",
            "{\"image_id\": 3, \"category_id\": 12, \"score\": 0.5, \"segmentation\": {\"size\": [4, 3], \"counts\": \"543\"}}",
            "{\"image_id\": 3, \"category_id\": 12, \"score\": 0.5, \"segmentation\": {\"size\": [4, 4], \"counts\": \"543\"}}",
            "7",
        ];
        let found = of(&format!("[{}]", rows.join(",")));
        let kinds: Vec<_> = found.problems.iter().map(|it| (it.line, it.kind)).collect();
        let expected = [
            (2, "field-missing"),
            (3, "field-type"),
            (4, "field-missing"),
            (5, "field-type"),
            (7, "mask"),
            (8, "field-type"),
        ];
        assert_eq!((kinds.as_slice(), found.rows.len()), (&expected[..], 2));
    }
}
