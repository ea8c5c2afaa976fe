//! `OBJ`: meshes of Wavefront OBJ files, by objects and groups.

use crate::mesh::{MeshOptions, PartBuilder, town_of};
use cosfly_frames::DVec3;
use cosfly_town::text::decoded;
use cosfly_town::{MapError, MapFormat, Town};

/// Most corners of a polygon.
const MOST_CORNERS: usize = 10_000;

/// The format `OBJ`.
#[derive(Clone, Copy, Debug)]
pub struct Obj;

impl MapFormat for Obj {
    type Options = MeshOptions;

    const NAME: &'static str = "OBJ";

    const EXAMPLE: &'static [u8] = include_bytes!("mesh/example.obj");

    fn recognises(head: &[u8]) -> bool {
        let text = String::from_utf8_lossy(head);
        const FIRST: [&str; 5] = ["v ", "o ", "g ", "mtllib ", "vn "];
        let mut lines = text.lines().filter(|line| !line.trim().is_empty() && !line.starts_with('#'));
        let is_own = |line: &str| FIRST.iter().any(|word| line.starts_with(word));
        lines.next().is_some_and(is_own) && lines.any(|line| ["v ", "f "].iter().any(|word| line.starts_with(word)))
    }

    fn read(bytes: &[u8], options: &MeshOptions) -> Result<(Town, Vec<String>), MapError> {
        let text = decoded(bytes)?;
        let mut reader = Reader { options, vertices: Vec::new(), groups: vec![Group::default()] };
        for (at, line) in text.lines().enumerate() {
            reader.line(line).map_err(|rule| {
                let shown: String = line.chars().take(60).collect();
                MapError::new(format!("line {} is `{shown}`; {rule}", at + 1))
                    .hint("the file seems to be damaged: export it again")
            })?;
        }
        let parts = reader.parts()?;
        let warnings = parts.warnings();
        town_of(parts.parts, options, warnings)
    }
}

/// Faces under one name; corners are numbers of corners of the whole file, from 0.
#[derive(Default)]
struct Group {
    name: String,
    faces: Vec<[u32; 3]>,
}

struct Reader<'a> {
    options: &'a MeshOptions,
    /// All corners so far, map frame, metres.
    vertices: Vec<DVec3>,
    groups: Vec<Group>,
}

impl Reader<'_> {
    fn line(&mut self, line: &str) -> Result<(), String> {
        let (word, rest) = line.trim_start().split_once([' ', '\t']).unwrap_or((line, ""));
        match word {
            "v" => self.vertices.push(self.options.in_map(vertex(rest)?)),
            "f" => self.face(rest)?,
            "o" | "g" => self.groups.push(Group { name: rest.trim().to_owned(), faces: Vec::new() }),
            _ => {}
        }
        Ok(())
    }

    /// A polygon as a fan of triangles. Its corners may follow later in the file.
    fn face(&mut self, rest: &str) -> Result<(), String> {
        let count = self.vertices.len() as i64;
        let number = |word: &str| {
            let number: Option<i64> = word.split('/').next().and_then(|number| number.parse().ok());
            // Negative numbers count back from here.
            let index =
                number.and_then(|number| if number < 0 { count.checked_add(number) } else { number.checked_sub(1) });
            index
                .and_then(|index| u32::try_from(index).ok())
                .ok_or_else(|| "a corner is no number of a corner".to_owned())
        };
        let corners = rest.split_whitespace().take(MOST_CORNERS).map(number).collect::<Result<Vec<u32>, String>>()?;
        if corners.len() < 3 {
            return Err("a face must have at least three corners".to_owned());
        }
        let triangles = corners[1..].windows(2).map(|pair| [corners[0], pair[0], pair[1]]);
        self.groups.last_mut().ok_or("there is no group")?.faces.extend(triangles);
        Ok(())
    }

    /// The groups as parts, each with the corners that it uses.
    fn parts(&self) -> Result<PartBuilder, MapError> {
        let mut parts = PartBuilder::default();
        for group in &self.groups {
            let mut used: Vec<u32> = group.faces.iter().flatten().copied().collect();
            used.sort_unstable();
            used.dedup();
            let corner = |corner: &u32| {
                self.vertices.get(*corner as usize).copied().ok_or_else(|| {
                    let shown: String = group.name.chars().take(60).collect();
                    let rule = format!(
                        "a face of `{shown}` has corner {}, but the file has {}",
                        u64::from(*corner) + 1,
                        self.vertices.len()
                    );
                    MapError::new(rule).hint("the file seems to be cut off: export it again")
                })
            };
            let vertices = used.iter().map(corner).collect::<Result<Vec<DVec3>, MapError>>()?;
            let own = |corner: u32| used.binary_search(&corner).unwrap_or(0) as u32;
            parts.add(&group.name, vertices, group.faces.iter().map(|face| face.map(own)))?;
        }
        Ok(parts)
    }
}

fn vertex(rest: &str) -> Result<DVec3, String> {
    let mut numbers = rest.split_whitespace().map(str::parse);
    match (numbers.next(), numbers.next(), numbers.next()) {
        (Some(Ok(x)), Some(Ok(y)), Some(Ok(z))) => Ok(DVec3::new(x, y, z)),
        _ => Err("a corner must have three numbers".to_owned()),
    }
}
