//! `PCD`: point clouds of the Point Cloud Library; text, binary or compressed.

use crate::bytes::Bytes;
use crate::cloud::table::{Columns, not_applied};
use crate::cloud::{CloudBuilder, CloudOptions, town_of};
use crate::scalar::Scalar;
use crate::way_out::or_advice;
use cosfly_diagnose::counted;
use cosfly_domain::Town;
use cosfly_town::remarks::speaks_of_a_place;
use cosfly_town::{MapError, MapFormat};
use std::collections::BTreeMap;

/// First words of the lines of the head.
const KEYWORDS: [&str; 10] =
    ["VERSION", "FIELDS", "SIZE", "TYPE", "COUNT", "WIDTH", "HEIGHT", "VIEWPOINT", "POINTS", "DATA"];
/// Longest head, bytes.
const LONGEST_HEAD: usize = 64 << 10;
/// Largest number that a field may have of itself.
const MOST_OF_A_FIELD: usize = 10_000;
/// Most unpacked bytes for each packed one, and of any file: clouds reach a fifth of this.
const MOST_UNPACKED: usize = 16;
const UNPACKED_OF_ANY_FILE: usize = 1 << 20;

/// The way out of a damaged file.
const WAY_OUT: &str = "the file seems to be damaged: fetch it again, or write it with PCL, Open3D or CloudCompare";

/// The format `PCD`.
#[derive(Clone, Copy, Debug)]
pub struct Pcd;

impl MapFormat for Pcd {
    type Options = CloudOptions;

    const NAME: &'static str = "PCD";

    const EXAMPLE: &'static [u8] = include_bytes!("cloud/example.pcd");

    fn recognises(head: &[u8]) -> bool {
        let text = String::from_utf8_lossy(&head[..head.len().min(1024)]);
        let mut lines = text.lines().filter(|line| !line.starts_with('#'));
        let has_version =
            text.starts_with("# .PCD") || lines.clone().next().is_some_and(|line| line.starts_with("VERSION "));
        has_version && lines.any(|line| line.starts_with("FIELDS "))
    }

    fn read(bytes: &[u8], options: &CloudOptions) -> Result<(Town, Vec<String>), MapError> {
        or_advice(town(bytes, options), WAY_OUT)
    }
}

fn town(bytes: &[u8], options: &CloudOptions) -> Result<(Town, Vec<String>), MapError> {
    let (head, data) = Head::read(bytes)?;
    let columns = Columns::find(head.fields.iter().map(|field| field.name.as_str()))?;
    let unit_m = options.unit_m.unwrap_or(1.0);
    let mut cloud = CloudBuilder::new(options.up_axis);
    match head.packing.as_str() {
        "ascii" => head.add_lines(data, &columns, unit_m, &mut cloud)?,
        "binary" => head.add_rows(data, &columns, unit_m, &mut cloud)?,
        "binary_compressed" => head.add_columns(&head.unpacked(data)?, &columns, unit_m, &mut cloud),
        other => {
            let shown: String = other.chars().take(40).collect();
            return Err(MapError::new(format!(
                "`DATA` is `{shown}`; `ascii`, `binary` and `binary_compressed` are read"
            )));
        }
    }
    let mut cloud = columns.finish(cloud, options.unit_m)?;
    cloud.warnings.extend(remarks(&bytes[..bytes.len() - data.len()]));
    town_of(cloud, options)
}

/// Statements of a head about the points' place, which are not applied.
fn remarks(head: &[u8]) -> Vec<String> {
    let text = String::from_utf8_lossy(head);
    let is_moved = |line: &str| {
        let mut words = line.split_whitespace();
        let numbers = |words: std::str::SplitWhitespace<'_>| {
            words.map(|word| word.parse::<f64>().unwrap_or(f64::NAN)).collect::<Vec<_>>()
        };
        words.next() == Some("VIEWPOINT")
            && numbers(words).iter().zip([0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0]).any(|(number, usual)| *number != usual)
    };
    let speaks = |line: &&str| is_moved(line) || line.starts_with('#') && speaks_of_a_place(line);
    text.lines().filter(speaks).map(not_applied).collect()
}

#[derive(Debug)]
struct Field {
    name: String,
    scalar: Scalar,
    /// Numbers that the field consists of.
    count: usize,
}

impl Field {
    fn bytes(&self) -> usize {
        self.scalar.bytes() * self.count
    }
}

#[derive(Debug)]
struct Head {
    fields: Vec<Field>,
    points: usize,
    packing: String,
}

impl Head {
    /// The head, and the bytes behind it.
    fn read(bytes: &[u8]) -> Result<(Self, &[u8]), MapError> {
        let mut lines: BTreeMap<String, Vec<String>> = BTreeMap::new();
        let mut at = 0;
        for number in 1.. {
            let rest = &bytes[at..];
            let Some(end) =
                rest.iter().take(LONGEST_HEAD).position(|byte| *byte == b'\n').filter(|_| at < LONGEST_HEAD)
            else {
                let error = MapError::new("the head of the file does not end with a line `DATA`");
                return Err(error.hint("the file seems to be cut off: fetch or export it again"));
            };
            let line = String::from_utf8_lossy(&rest[..end]).into_owned();
            at += end + 1;
            let mut words = line.split_whitespace().map(str::to_owned);
            let Some(keyword) = words.next().filter(|keyword| !keyword.starts_with('#')) else { continue };
            let refused = |rule: &str| {
                let shown: String = line.chars().take(60).collect();
                let error = MapError::new(format!("line {number} of the head is `{shown}`; {rule}"));
                error.hint("write the file again with PCL, Open3D or CloudCompare")
            };
            if !KEYWORDS.contains(&keyword.as_str()) {
                return Err(refused(&format!("known are {}", KEYWORDS.join(", "))));
            }
            let is_last = keyword == "DATA";
            if lines.insert(keyword, words.collect()).is_some() {
                return Err(refused("there is such a line before: remove one of the two"));
            }
            if is_last {
                break;
            }
        }
        let words = |keyword: &str| lines.get(keyword).map_or(&[][..], Vec::as_slice);
        let number = |keyword: &str| -> Result<Option<usize>, MapError> {
            let Some(word) = words(keyword).first() else { return Ok(None) };
            let shown: String = word.chars().take(40).collect();
            let refused = |_| MapError::new(format!("`{keyword}` is `{shown}`; it must be a whole number from 0"));
            word.parse().map(Some).map_err(refused)
        };
        let (width, height) = (number("WIDTH")?, number("HEIGHT")?);
        let grid = width.zip(height).and_then(|(width, height)| width.checked_mul(height));
        let points = number("POINTS")?;
        if let Some((points, grid)) = points.zip(grid).filter(|(points, grid)| points != grid) {
            let message = format!("the head states {points} `POINTS`, but `WIDTH` times `HEIGHT` is {grid}");
            return Err(MapError::new(message).hint("write the file again with PCL, Open3D or CloudCompare"));
        }
        let missing = || MapError::new("the head does not state the number of `POINTS`");
        let points = points.or(grid).ok_or_else(missing)?;
        let fields = fields(words("FIELDS"), words("SIZE"), words("TYPE"), words("COUNT"))?;
        let packing = words("DATA").first().cloned().unwrap_or_default();
        Ok((Self { fields, points, packing }, &bytes[at..]))
    }

    fn cut_off(&self) -> MapError {
        let error = MapError::new(format!("the file ends before the last of {} points", self.points));
        error.hint("the file seems to be cut off: fetch or export it again")
    }

    fn row_bytes(&self) -> usize {
        self.fields.iter().map(Field::bytes).sum()
    }

    fn all_bytes(&self) -> Result<usize, MapError> {
        self.points.checked_mul(self.row_bytes()).ok_or_else(|| self.cut_off())
    }

    /// First byte of each field in a row.
    fn places(&self) -> Vec<usize> {
        self.fields
            .iter()
            .scan(0, |next, field| {
                let place = *next;
                *next += field.bytes();
                Some(place)
            })
            .collect()
    }

    fn add_rows(&self, data: &[u8], columns: &Columns, unit_m: f64, cloud: &mut CloudBuilder) -> Result<(), MapError> {
        let rows = data.get(..self.all_bytes()?).ok_or_else(|| self.cut_off())?;
        let places = self.places();
        for row in rows.chunks_exact(self.row_bytes()) {
            let value =
                |column: usize| self.fields[column].scalar.read(&row[places[column]..], false).unwrap_or(f64::NAN);
            columns.push(cloud, unit_m, value);
        }
        Ok(())
    }

    /// Compressed points come field by field.
    fn add_columns(&self, data: &[u8], columns: &Columns, unit_m: f64, cloud: &mut CloudBuilder) {
        let places = self.places();
        for point in 0..self.points {
            let value = |column: usize| {
                let field = &self.fields[column];
                let start = places[column] * self.points + point * field.bytes();
                data.get(start..).and_then(|bytes| field.scalar.read(bytes, false)).unwrap_or(f64::NAN)
            };
            columns.push(cloud, unit_m, value);
        }
    }

    fn add_lines(&self, data: &[u8], columns: &Columns, unit_m: f64, cloud: &mut CloudBuilder) -> Result<(), MapError> {
        let text = String::from_utf8_lossy(data);
        let mut lines = text.lines().filter(|line| !line.trim().is_empty());
        // Numbers before each field in a line.
        let before: Vec<usize> =
            (0..self.fields.len()).map(|at| self.fields[..at].iter().map(|field| field.count).sum()).collect();
        let needed = before[columns.last()] + 1;
        let mut numbers = Vec::new();
        for point in 0..self.points {
            let line = lines.next().ok_or_else(|| self.cut_off())?;
            numbers.clear();
            numbers.extend(line.split_whitespace().take(needed).map_while(|word| word.parse::<f64>().ok()));
            if numbers.len() < needed {
                let shown: String = line.chars().take(60).collect();
                return Err(MapError::new(format!(
                    "point {point} is `{shown}`; it must have at least {needed} numbers"
                )));
            }
            columns.push(cloud, unit_m, |column| numbers[before[column]]);
        }
        Ok(())
    }

    fn unpacked(&self, data: &[u8]) -> Result<Vec<u8>, MapError> {
        let sizes = Bytes(data);
        let packed = sizes.u32(0, "the size of the compressed points")?;
        let length = sizes.u32(4, "the size of the points")? as usize;
        let packed = sizes.slice(8, packed.into(), "the compressed points")?;
        if length != self.all_bytes()? || length > UNPACKED_OF_ANY_FILE.max(packed.len().saturating_mul(MOST_UNPACKED))
        {
            let message = format!(
                "the points unpack to {length} bytes of {}, but {} points have {}",
                packed.len(),
                self.points,
                self.all_bytes()?
            );
            return Err(MapError::new(message).hint("the file is damaged: fetch or export it again"));
        }
        unpack(packed, length).ok_or_else(|| {
            MapError::new("the compressed points are damaged").hint("the file is damaged: fetch or export it again")
        })
    }
}

fn fields(names: &[String], sizes: &[String], kinds: &[String], counts: &[String]) -> Result<Vec<Field>, MapError> {
    for (keyword, words) in [("SIZE", sizes), ("TYPE", kinds), ("COUNT", counts)] {
        if words.len() != names.len() && !(keyword == "COUNT" && words.is_empty()) {
            let message = format!("`{keyword}` has {} for {} `FIELDS`", counted(words.len(), "value"), names.len());
            return Err(MapError::new(message).hint("write the file again with PCL, Open3D or CloudCompare"));
        }
    }
    let field = |(at, name): (usize, &String)| {
        let bytes: Option<u8> =
            sizes.get(at).and_then(|size| size.parse().ok()).filter(|size| [1, 2, 4, 8].contains(size));
        let scalar = match (kinds.get(at).map(String::as_str), bytes) {
            (Some("I"), Some(bytes)) => Some(Scalar::Signed(bytes)),
            (Some("U"), Some(bytes)) => Some(Scalar::Unsigned(bytes)),
            (Some("F"), Some(bytes @ (4 | 8))) => Some(Scalar::Real(bytes)),
            _ => None,
        };
        let count = counts
            .get(at)
            .map_or(Some(1), |count| count.parse().ok())
            .filter(|count| (1..=MOST_OF_A_FIELD).contains(count));
        let shown: String = name.chars().take(40).collect();
        let refused = || MapError::new(format!("the field `{shown}` has no known `SIZE`, `TYPE` and `COUNT`"));
        Ok(Field { name: name.clone(), scalar: scalar.ok_or_else(refused)?, count: count.ok_or_else(refused)? })
    };
    names.iter().enumerate().map(field).collect()
}

/// Unpacks LZF (the compression of PCD files): runs of plain bytes, and copies of what came before. None when damaged.
fn unpack(mut packed: &[u8], length: usize) -> Option<Vec<u8>> {
    let mut out = Vec::with_capacity(length);
    while let Some((control, rest)) = packed.split_first() {
        let high = usize::from(control >> 5);
        if high == 0 {
            let (run, rest) = rest.split_at_checked(usize::from(*control) + 1)?;
            out.extend_from_slice(run);
            packed = rest;
        } else {
            let (longer, rest) = if high == 7 { rest.split_first()? } else { (&0, rest) };
            let (low, rest) = rest.split_first()?;
            let back = (usize::from(control & 31) << 8 | usize::from(*low)) + 1;
            let start = out.len().checked_sub(back)?;
            // Byte by byte: a copy may reach into itself.
            for at in start..start + 2 + high + usize::from(*longer) {
                out.push(out[at]);
            }
            packed = rest;
        }
        if out.len() > length {
            return None;
        }
    }
    (out.len() == length).then_some(out)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn runs_and_copies_are_unpacked_and_damage_is_noticed() {
        // Three plain bytes, then five from three back.
        let packed = [2, b'a', b'b', b'c', 3 << 5, 2];
        assert_eq!(unpack(&packed, 8).as_deref(), Some(&b"abcabcab"[..]));
        for (damaged, length) in [(&packed[..5], 8), (&packed[..3], 3), (&packed[..], 7), (&[1 << 5, 9][..], 3)] {
            assert_eq!(unpack(damaged, length), None);
        }
    }
}
