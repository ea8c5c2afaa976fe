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
    /// Name of its picture, without folders.
    pub picture: Option<String>,
}

/// The last part of a path, whichever way its folders are written.
pub fn name_of(path: &str) -> &str {
    path.rsplit(['/', '\\']).next().unwrap_or(path)
}

/// Files that an OBJ file or a file of materials names, without folders.
pub fn named_files(bytes: &[u8]) -> Vec<String> {
    let Ok(text) = decoded(bytes) else { return vec![] };
    let names = text.lines().filter_map(|line| match line.trim().split_once([' ', '\t'])? {
        ("mtllib", rest) => Some(name_of(rest.trim()).to_owned()),
        ("map_Kd", rest) => Some(name_of(without_options(rest)).to_owned()),
        _ => None,
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
            ("newmtl", _) => all.push(NamedMaterial { name: rest.to_owned(), colour: [1.0; 3], picture: None }),
            ("Kd", Some(last)) => {
                let mut numbers = rest.split_whitespace().map_while(|number| number.parse::<f32>().ok());
                if let (Some(red), Some(green), Some(blue)) = (numbers.next(), numbers.next(), numbers.next()) {
                    let share = |it: f32| if it.is_finite() { it.clamp(0.0, 1.0) } else { 1.0 };
                    last.colour = [red, green, blue].map(share);
                }
            }
            ("map_Kd", Some(last)) => last.picture = Some(name_of(without_options(rest)).to_owned()),
            _ => {}
        }
    }
    // A picture has all of the colour: exporters write any factor beside it, many of them black.
    all.iter_mut().filter(|it| it.picture.is_some()).for_each(|it| it.colour = [1.0; 3]);
    Ok(all)
}

/// The name behind options such as `-s 1 1 1`.
fn without_options(rest: &str) -> &str {
    let mut rest = rest.trim();
    while let Some(option) = rest.strip_prefix('-') {
        let (word, mut values) = option.split_once([' ', '\t']).unwrap_or((option, ""));
        let most = match word {
            "o" | "s" | "t" => 3,
            "mm" => 2,
            _ => 1,
        };
        for number in 0..most {
            let Some((value, after)) = values.trim_start().split_once([' ', '\t']) else { break };
            if number > 0 && value.parse::<f64>().is_err() {
                break;
            }
            values = after;
        }
        rest = values.trim();
    }
    rest
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_of_pictures_lose_folders_and_options() {
        let text = b"# a scan\nKd 0 0 0\nnewmtl wall\nKd 0 0 0\nmap_Kd -s 1 1 1 -clamp on C:\\scans\\my wall.png\nnewmtl roof\n\tKd .5 nan 0.2\n";
        let [wall, roof] = &read(text).expect("materials")[..] else { panic!("two materials") };
        assert_eq!((wall.name.as_str(), wall.picture.as_deref(), wall.colour), ("wall", Some("my wall.png"), [1.0; 3]));
        assert_eq!((roof.name.as_str(), roof.picture.as_deref(), roof.colour), ("roof", None, [0.5, 1.0, 0.2]));
    }
}
