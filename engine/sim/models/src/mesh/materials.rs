//! Files of materials (`.mtl`) that OBJ files name.

use cosfly_town::MapError;
use cosfly_town::text::decoded;

/// Most files that are listed.
const MOST_NAMES: usize = 10_000;

/// A material by its name.
#[derive(Clone, Debug, PartialEq)]
pub struct NamedMaterial {
    /// Name.
    pub name: String,
    /// Linear red, green, blue.
    pub colour: [f32; 3],
    /// Path of its picture, as [`plain`] writes it; beside the file of materials where it has no folders.
    pub picture: Option<String>,
    /// Where places lie in the picture.
    pub placing: Placing,
    /// Whether it is more see-through than not.
    pub is_glass: bool,
}

/// Options of a picture: `-s`, `-o` and `-clamp on`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Placing {
    /// Factors of the places, across and up.
    pub scale: [f32; 2],
    /// Numbers that are added to them then.
    pub shift: [f32; 2],
    /// Whether the edge goes on beyond the picture.
    pub is_clamped: bool,
}

impl Default for Placing {
    fn default() -> Self {
        Self { scale: [1.0; 2], shift: [0.0; 2], is_clamped: false }
    }
}

/// The last part of a path, whichever way its folders are written.
pub fn name_of(path: &str) -> &str {
    path.rsplit(['/', '\\']).next().unwrap_or(path)
}

/// A path without quotes, `\` and steps that lead nowhere: `"a\.\b\..\c.png"` is `a/c.png`.
pub fn plain(path: &str) -> String {
    let path = path.trim();
    let path = path.strip_prefix('"').and_then(|it| it.strip_suffix('"')).unwrap_or(path);
    let mut parts: Vec<&str> = vec![];
    for part in path.split(['/', '\\']) {
        match (part, parts.last()) {
            ("." | "", _) if !parts.is_empty() || part == "." => {}
            ("..", Some(last)) if !matches!(*last, ".." | "") => drop(parts.pop()),
            _ => parts.push(part),
        }
    }
    parts.join("/")
}

/// A path that the file `of` names, for one who stands where `of` was named; both as [`plain`] writes them.
pub fn beside(of: &str, path: &str) -> String {
    let is_whole = path.starts_with('/') || path.contains(':');
    match of.rsplit_once('/') {
        Some((folder, _)) if !is_whole => plain(&format!("{folder}/{path}")),
        _ => path.to_owned(),
    }
}

/// Paths of a line `mtllib`: several, or one with blanks.
pub fn libraries(rest: &str) -> Vec<String> {
    let several: Vec<&str> = rest.split_whitespace().collect();
    let is_one = |path: &&str| path.len() > 4 && path.as_bytes()[path.len() - 4..].eq_ignore_ascii_case(b".mtl");
    if several.iter().all(is_one) { several.into_iter().map(plain).collect() } else { vec![plain(rest)] }
}

/// The number of the file that `path` means among files with names or paths: the one with its last part, in any case;
/// of several the one with all of its path, else with most of its end, else of its case.
///
/// # Errors
/// Names of the files that it may mean, where they are none or several.
pub fn found<'a>(path: &str, files: impl Iterator<Item = &'a str>) -> Result<usize, Vec<&'a str>> {
    let likeness = |file: &str| {
        let file = plain(file);
        let ends = path.rsplit('/').zip(file.rsplit('/'));
        let alike = ends.take_while(|(a, b)| a.eq_ignore_ascii_case(b)).count();
        let is_case = name_of(path) == name_of(&file);
        (alike > 0).then(|| (file.eq_ignore_ascii_case(path), alike, file == path, is_case))
    };
    let alike: Vec<_> = files.enumerate().filter_map(|(at, file)| Some((likeness(file)?, at, file))).collect();
    let Some(most) = alike.iter().map(|it| it.0).max() else { return Err(vec![]) };
    let best: Vec<_> = alike.into_iter().filter(|it| it.0 == most).collect();
    if let [(_, at, _)] = best[..] { Ok(at) } else { Err(best.into_iter().map(|it| it.2).collect()) }
}

/// Files that an OBJ file or a file of materials names, as [`plain`] writes their paths.
pub fn named_files(bytes: &[u8]) -> Vec<String> {
    let Ok(text) = decoded(bytes) else { return vec![] };
    let names = text.lines().flat_map(|line| match line.trim().split_once([' ', '\t']) {
        Some(("mtllib", rest)) => libraries(rest),
        Some(("map_Kd", rest)) => vec![plain(placed(rest).0)],
        _ => vec![],
    });
    let mut names: Vec<String> = names.take(MOST_NAMES).collect();
    names.sort_unstable();
    names.dedup();
    names
}

/// The materials of a file.
///
/// # Errors
/// Text of no known encoding.
pub fn read(bytes: &[u8]) -> Result<Vec<NamedMaterial>, MapError> {
    let mut all: Vec<NamedMaterial> = Vec::new();
    for line in decoded(bytes)?.lines() {
        let (word, rest) = line.trim().split_once([' ', '\t']).unwrap_or((line.trim(), ""));
        let rest = rest.trim();
        match (word, all.last_mut()) {
            ("newmtl", _) => {
                let (name, placing) = (rest.to_owned(), Placing::default());
                all.push(NamedMaterial { name, colour: [1.0; 3], picture: None, placing, is_glass: false });
            }
            ("d", Some(last)) => last.is_glass = rest.parse::<f32>().is_ok_and(|share| share < 0.5),
            ("Kd", Some(last)) => {
                let mut numbers = rest.split_whitespace().map_while(|number| number.parse::<f32>().ok());
                if let (Some(red), Some(green), Some(blue)) = (numbers.next(), numbers.next(), numbers.next()) {
                    let share = |it: f32| if it.is_finite() { it.clamp(0.0, 1.0) } else { 1.0 };
                    last.colour = [red, green, blue].map(share);
                }
            }
            ("map_Kd", Some(last)) => {
                let (path, placing) = placed(rest);
                (last.picture, last.placing) = (Some(plain(path)), placing);
            }
            _ => {}
        }
    }
    // A picture has all of the colour: exporters write any factor beside it, many of them black.
    all.iter_mut().filter(|it| it.picture.is_some()).for_each(|it| it.colour = [1.0; 3]);
    Ok(all)
}

/// The name behind options such as `-s 1 1 1`, and what they say.
fn placed(rest: &str) -> (&str, Placing) {
    let (mut rest, mut placing) = (rest.trim(), Placing::default());
    while let Some(option) = rest.strip_prefix('-') {
        let (word, mut values) = option.split_once([' ', '\t']).unwrap_or((option, ""));
        let most = match word {
            "o" | "s" | "t" => 3,
            "mm" => 2,
            _ => 1,
        };
        for number in 0..most {
            let Some((value, after)) = values.trim_start().split_once([' ', '\t']) else { break };
            let parsed = value.parse::<f32>().ok().filter(|it| it.is_finite());
            if number > 0 && parsed.is_none() {
                break;
            }
            match (word, parsed) {
                ("s", Some(factor)) if number < 2 => placing.scale[number] = factor,
                ("o", Some(shift)) if number < 2 => placing.shift[number] = shift,
                ("clamp", _) => placing.is_clamped = value == "on",
                _ => {}
            }
            values = after;
        }
        rest = values.trim();
    }
    (rest, placing)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_of_pictures_lose_options() {
        let text = b"# a scan\nKd 0 0 0\nnewmtl wall\nKd 0 0 0\nmap_Kd -s 2 3 1 -o .5 -clamp on C:\\scans\\my wall.png\nnewmtl roof\n\tKd .5 nan 0.2\nd 0.1\n";
        let [wall, roof] = &read(text).expect("materials")[..] else { panic!("two materials") };
        assert_eq!(
            (wall.name.as_str(), wall.picture.as_deref(), wall.colour),
            ("wall", Some("C:/scans/my wall.png"), [1.0; 3])
        );
        assert_eq!(wall.placing, Placing { scale: [2.0, 3.0], shift: [0.5, 0.0], is_clamped: true });
        assert!(roof.is_glass && !wall.is_glass && roof.placing == Placing::default());
        assert_eq!(libraries(" a.mtl B.MTL"), ["a.mtl", "B.MTL"]);
        assert_eq!(libraries("my scan.mtl "), ["my scan.mtl"]);
        assert_eq!(libraries("\"my scan.mtl\""), ["my scan.mtl"]);
        assert_eq!((roof.name.as_str(), roof.picture.as_deref(), roof.colour), ("roof", None, [0.5, 1.0, 0.2]));
    }

    #[test]
    fn a_path_means_the_file_with_most_of_its_end() {
        for (path, written) in [
            ("./a/../b\\c d.png", "b/c d.png"),
            ("../../x", "../../x"),
            ("\"q.png\"", "q.png"),
            ("/etc//passwd", "/etc/passwd"),
        ] {
            assert_eq!(plain(path), written);
        }
        assert_eq!([beside("a/b.mtl", "../c.png"), beside("b.mtl", "c.png")], ["c.png", "c.png"]);
        assert_eq!([beside("a/b.mtl", "/c.png"), beside("a/b.mtl", "C:/c.png")], ["/c.png", "C:/c.png"]);
        let files = ["a/wall.png", "b/wall.png", "roof.png", "Door.png", "door.png"];
        let means = |path: &str| found(path, files.into_iter());
        assert_eq!([means("a/wall.png"), means("x/b/WALL.PNG")], [Ok(0), Ok(1)]);
        assert_eq!([means("any/roof.png"), means("door.png"), means("Door.png")], [Ok(2), Ok(4), Ok(3)]);
        assert_eq!(means("wall.png"), Err(vec!["a/wall.png", "b/wall.png"]));
        assert_eq!((means("DOOR.png"), means("none.png")), (Err(vec!["Door.png", "door.png"]), Err(vec![])));
        assert_eq!(found("wall.png", ["wall.png", "a/wall.png"].into_iter()), Ok(0));
    }
}
