//! Remarks of a file in free words: whether one tells a place that no reader applies.

/// Ends of words about the place of coordinates, lower case.
const ENDS: [&str; 14] = [
    "offset",
    "offsets",
    "shift",
    "origin",
    "translation",
    "latitude",
    "longitude",
    "georeference",
    "projection",
    "datum",
    "epsg",
    "crs",
    "srs",
    "utm",
];
/// Whole words about it.
const WORDS: [&str; 4] = ["lat", "lon", "proj", "translate"];

/// Whether a remark seems to state a shift or a projection of the file's coordinates: it has such a word and a number.
pub fn speaks_of_a_place(remark: &str) -> bool {
    let is_about = |word: &str| {
        let word = word.to_lowercase();
        WORDS.contains(&word.as_str()) || ENDS.iter().any(|end| word.ends_with(end))
    };
    remark.contains(|sign: char| sign.is_ascii_digit())
        && remark.split(|sign: char| !sign.is_alphabetic()).any(is_about)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn shifts_and_projections_are_told_from_other_remarks() {
        for remark in ["Global shift: -393706 -5815132 0", "offset 1 2 3", "EPSG:25832", "geoOffset=4,5", "lat 52.4"] {
            assert!(speaks_of_a_place(remark), "{remark}");
        }
        for remark in ["Blender 4.2 OBJ File", "original file 3", "File has 3 vertices", "offset unknown", ""] {
            assert!(!speaks_of_a_place(remark), "{remark}");
        }
    }
}
