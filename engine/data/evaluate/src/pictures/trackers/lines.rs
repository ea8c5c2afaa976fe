//! Boxes in the lines of a tracker's file. A file with a faulty line is refused: what it says of the other pictures is in doubt.

use cosfly_diagnose::{counted, plausible};
use cosfly_schema::mot_class::COUNTED;
use std::collections::BTreeSet;

/// Columns of a line about one target.
pub const OF_TARGET: usize = 4;
/// Fewest and most columns of a line about many bodies.
const OF_MANY: [usize; 2] = [7, 10];
/// Column of the class, which may be absent or -1, counted from 0.
const CLASS: usize = 7;

/// A box that a tracker found.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FoundBox {
    /// Id of the track.
    pub id: u64,
    /// MOTChallenge's class, if the tracker names one.
    pub class: Option<u8>,
    /// Left, top, right, bottom edge, pixels; the top-left pixel is (1, 1).
    pub edges: [f64; 4],
}

/// Line of a fault, from 1; its kind; its description.
pub type LineFault = (usize, &'static str, String);

/// Columns of the first line that has something; `None` where there is none or no text.
pub fn columns(bytes: &[u8]) -> Option<usize> {
    let text = std::str::from_utf8(bytes).ok()?;
    text.lines().find(|line| !line.trim().is_empty()).map(|line| cells(line).len())
}

/// Boxes by picture of a sequence of so many pictures.
///
/// # Errors
/// The first faulty line.
pub fn tracks(bytes: &[u8], pictures: usize) -> Result<Vec<Vec<FoundBox>>, LineFault> {
    let mut found = vec![vec![]; pictures];
    let mut known = BTreeSet::new();
    for (line, number) in text(bytes)?.lines().zip(1..).filter(|(line, _)| !line.trim().is_empty()) {
        let (picture, box_found) = track(line, pictures).map_err(|(kind, reason)| (number, kind, reason))?;
        if !known.insert((picture, box_found.id)) {
            return Err((number, "duplicate", format!("a second box of id {} in picture {picture}", box_found.id)));
        }
        found[picture - 1].push(box_found);
    }
    Ok(found)
}

/// A box per picture: left, top, width, height.
///
/// # Errors
/// The first faulty line, or a number of lines that is not the number of pictures.
pub fn target(bytes: &[u8], pictures: usize) -> Result<Vec<[f64; 4]>, LineFault> {
    let mut found = vec![];
    for (line, number) in text(bytes)?.trim_end().lines().zip(1..) {
        let at = |(kind, reason)| (number, kind, reason);
        let values = numbers(line).map_err(at)?;
        let Ok(values) = <[f64; 4]>::try_from(values.as_slice()) else {
            let reason = format!("{}; a line has 4: left, top, width, height", counted(values.len(), "column"));
            return Err((number, "columns", reason));
        };
        size(&values).map_err(at)?;
        found.push(values);
    }
    match found.len() {
        lines if lines == pictures => Ok(found),
        lines => Err((
            lines.max(1),
            "length",
            format!(
                "the file ends after {lines}; the sequence has {pictures}",
                pictures = counted(pictures, "picture"),
                lines = counted(lines, "line")
            ),
        )),
    }
}

type Fault = (&'static str, String);

fn track(line: &str, pictures: usize) -> Result<(usize, FoundBox), Fault> {
    let values = numbers(line)?;
    let [fewest, most] = OF_MANY;
    if !(fewest..=most).contains(&values.len()) {
        let reason = format!(
            "{}; a line has {fewest} to {most}: picture, id, left, top, width, height, score",
            counted(values.len(), "column")
        );
        return Err(("columns", reason));
    }
    let picture = whole(values[0]).filter(|picture| (1..=pictures as u64).contains(picture)).ok_or_else(|| {
        ("no-picture", format!("there is no picture {}; the sequence has pictures 1 to {pictures}", values[0]))
    })?;
    let id = whole(values[1]).ok_or_else(|| ("id", format!("id {} is not a whole number from 0 on", values[1])))?;
    let class = match values.get(CLASS) {
        None => None,
        Some(-1.0) => None,
        Some(class) => Some(known_class(*class)?),
    };
    let [left, top, width, height] = [values[2], values[3], values[4], values[5]];
    size(&[left, top, width, height])?;
    Ok((picture as usize, FoundBox { id, class, edges: [left, top, left + width, top + height] }))
}

fn known_class(class: f64) -> Result<u8, Fault> {
    let known = COUNTED.iter().find(|(known, _)| f64::from(*known) == class);
    known.map(|(known, _)| *known).ok_or_else(|| {
        let names: Vec<String> = COUNTED.iter().map(|(number, name)| format!("{number} {name}")).collect();
        ("class", format!("class {class} in column 8 is none of {}, or -1", names.join(", ")))
    })
}

fn size([_, _, width, height]: &[f64; 4]) -> Result<(), Fault> {
    let is_size = *width >= 0.0 && *height >= 0.0;
    is_size.then_some(()).ok_or_else(|| ("size", format!("width {width} and height {height}; neither may be below 0")))
}

fn whole(value: f64) -> Option<u64> {
    (value >= 0.0 && value.fract() == 0.0).then_some(value as u64)
}

fn numbers(line: &str) -> Result<Vec<f64>, Fault> {
    let number = |(cell, column): (&str, usize)| {
        let value: f64 =
            cell.parse().map_err(|_| ("number", format!("column {column} is `{}`, not a number", shown(cell))))?;
        plausible(value).map_err(|fault| ("not-finite", format!("column {column} is `{}`: it {fault}", shown(cell))))
    };
    cells(line).into_iter().zip(1..).map(number).collect()
}

/// Cells between commas; between blanks in a line without one.
fn cells(line: &str) -> Vec<&str> {
    if line.contains(',') { line.trim().split(',').map(str::trim).collect() } else { line.split_whitespace().collect() }
}

/// The first letters of a cell.
fn shown(cell: &str) -> String {
    cell.chars().take(20).collect()
}

fn text(bytes: &[u8]) -> Result<&str, LineFault> {
    // Some editors begin a text with a mark of its encoding.
    let bytes = bytes.strip_prefix(b"\xef\xbb\xbf").unwrap_or(bytes);
    std::str::from_utf8(bytes).map_err(|error| {
        let line = 1 + bytes[..error.valid_up_to()].iter().filter(|byte| **byte == b'\n').count();
        (line, "text", "the file is not text in UTF-8".to_owned())
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn faulty_lines_are_named() {
        let good = "1,7,10,20,30,40,1,-1,-1,-1\n";
        for (line, kind) in [
            ("2,7,10,20,30,40,1,-1,-1,-1", ""),
            ("2 7 10 20 30 40 1", ""),
            ("2,7,10,20,30,40,0.5,3", ""),
            ("1,7,10,20,30,40,1", "duplicate"),
            ("3,7,10,20,30,40,1", "no-picture"),
            ("0,7,10,20,30,40,1", "no-picture"),
            ("1.5,7,10,20,30,40,1", "no-picture"),
            ("2,-1,10,20,30,40,1", "id"),
            ("2,7,10,20,30,40", "columns"),
            ("2,7,10,20,30,40,1,1,1,1,1", "columns"),
            ("2,7,NaN,20,30,40,1", "not-finite"),
            ("2,7,1e300,20,30,40,1", "not-finite"),
            ("2,7,ten,20,30,40,1", "number"),
            ("2,7,,20,30,40,1", "number"),
            ("2,7,10,20,-30,40,1", "size"),
            ("2,7,10,20,30,40,1,8", "class"),
        ] {
            let found = tracks(format!("{good}\n{line}\n").as_bytes(), 2);
            assert_eq!(
                found.err().map_or("", |(at, kind, _)| if at == 3 { kind } else { "elsewhere" }),
                kind,
                "{line}"
            );
        }
        let boxes = tracks(b"2,7,10,20,30,40,1,5", 2).unwrap();
        assert_eq!(boxes, [vec![], vec![FoundBox { id: 7, class: Some(5), edges: [10.0, 20.0, 40.0, 60.0] }]]);
        assert_eq!(tracks(b"1,1,1,1,1,1,1\n\xff", 2).unwrap_err().0, 2);
        assert_eq!(tracks(b"\xef\xbb\xbf2,7,10,20,30,40,1,5", 2).unwrap(), boxes, "a mark of the encoding");
    }

    #[test]
    fn a_target_has_a_line_per_picture() {
        assert_eq!(target(b"1,2,3,4\n5\t6\t7\t8\n\n", 2).unwrap(), [[1.0, 2.0, 3.0, 4.0], [5.0, 6.0, 7.0, 8.0]]);
        for (text, at, kind) in [
            ("1,2,3,4\n", 1, "length"),
            ("", 1, "length"),
            ("1,2,3,4\n1,2,3,4\n1,2,3,4\n", 3, "length"),
            ("1,2,3,4\n1,2,3\n", 2, "columns"),
            ("1,2,3,4\nNaN,NaN,NaN,NaN\n", 2, "not-finite"),
            ("1,2,3,4\n\n1,2,3,4\n", 2, "columns"),
            ("1,2,-3,4\n1,2,3,4\n", 1, "size"),
        ] {
            let (line, found, _) = target(text.as_bytes(), 2).unwrap_err();
            assert_eq!((line, found), (at, kind), "{text:?}");
        }
    }
}
