//! `OBJ`: meshes of Wavefront OBJ files, by objects and groups.

use crate::cloud::table::not_applied;
use crate::mesh::{MeshOptions, PartBuilder, town_of};
use crate::way_out::or_advice;
use cosfly_domain::Town;
use cosfly_frames::{DVec2, DVec3};
use cosfly_town::polygons::triangulated;
use cosfly_town::remarks::speaks_of_a_place;
use cosfly_town::text::decoded;
use cosfly_town::{MapError, MapFormat};

/// Most remarks about the place of the coordinates that are repeated as warnings.
const MOST_REMARKS: usize = 5;
/// Groups of an object that are searched for one that is entered again.
const MOST_SEARCHED: usize = 1000;
/// Most corners of a polygon.
const MOST_CORNERS: usize = 10_000;

/// The way out of a damaged file.
const WAY_OUT: &str = "the file seems to be damaged: export the scene again as OBJ";

/// The format `OBJ`.
#[derive(Clone, Copy, Debug)]
pub struct Obj;

impl MapFormat for Obj {
    type Options = MeshOptions;

    const NAME: &'static str = "OBJ";

    const EXAMPLE: &'static [u8] = include_bytes!("mesh/example.obj");

    fn recognises(head: &[u8]) -> bool {
        let text = String::from_utf8_lossy(head);
        const FIRST: [&str; 9] = ["v", "o", "g", "mtllib", "usemtl", "s", "vn", "vt", "f"];
        const DATA: [&str; 4] = ["v", "vn", "vt", "f"];
        let mut words = text
            .lines()
            .filter_map(|line| line.trim_start().split_once([' ', '\t']))
            .map(|(word, _)| word)
            .filter(|word| !word.starts_with('#'));
        let begins = text.trim_start_matches(|c: char| c == '\u{feff}' || c.is_whitespace());
        let first = if begins.starts_with('#') { words.next() } else { begins.split([' ', '\t']).next() };
        first.is_some_and(|word| FIRST.contains(&word)) && words.any(|word| DATA.contains(&word))
    }

    fn read(bytes: &[u8], options: &MeshOptions) -> Result<(Town, Vec<String>), MapError> {
        or_advice(town(bytes, options), WAY_OUT)
    }
}

fn town(bytes: &[u8], options: &MeshOptions) -> Result<(Town, Vec<String>), MapError> {
    let text = decoded(bytes)?;
    let mut reader =
        Reader { options, vertices: Vec::new(), object: (String::new(), 0), groups: vec![Group::default()], open: 0 };
    let (mut whole, mut remarks) = (String::new(), vec![]);
    for (at, line) in text.lines().enumerate() {
        if let Some(begun) = line.strip_suffix('\\') {
            whole.push_str(begun);
            continue;
        }
        whole.push_str(line);
        let line = std::mem::take(&mut whole);
        if line.starts_with('#') && remarks.len() < MOST_REMARKS && speaks_of_a_place(&line) {
            remarks.push(not_applied(&line));
        }
        reader.line(&line).map_err(|rule| {
            let shown: String = line.chars().take(60).collect();
            MapError::new(format!("line {} is `{shown}`; {rule}", at + 1))
                .hint("the file seems to be damaged: export it again")
        })?;
    }
    let parts = reader.parts(bytes.len())?;
    let mut warnings = parts.warnings();
    warnings.append(&mut remarks);
    town_of(parts.parts, options, warnings)
}

/// Polygons under one name; corners are numbers of corners of the whole file, from 0.
#[derive(Default)]
struct Group {
    name: String,
    /// Number of its object; groups without one have numbers of their own.
    owner: u32,
    corners: Vec<u32>,
    /// Ends of the polygons in `corners`.
    ends: Vec<usize>,
}

impl Group {
    fn polygons(&self) -> impl Iterator<Item = &[u32]> {
        let starts = core::iter::once(0).chain(self.ends.iter().copied());
        starts.zip(&self.ends).map(|(start, end)| &self.corners[start..*end])
    }
}

struct Reader<'a> {
    options: &'a MeshOptions,
    /// All corners so far, map frame, metres.
    vertices: Vec<DVec3>,
    /// Name and number of the object that groups belong to.
    object: (String, u32),
    groups: Vec<Group>,
    /// The group that faces belong to.
    open: usize,
}

impl Reader<'_> {
    fn line(&mut self, line: &str) -> Result<(), String> {
        let (word, rest) = line.trim_start().split_once([' ', '\t']).unwrap_or((line, ""));
        match word {
            "v" => self.vertices.push(self.options.in_map(vertex(rest)?)),
            "f" => self.face(rest)?,
            "o" => {
                self.object = (rest.trim().to_owned(), self.groups.len() as u32);
                self.begin(self.object.0.clone());
            }
            "g" => {
                let name = format!("{} {}", self.object.0, rest.trim()).trim().to_owned();
                // A group may be left and entered again.
                let is_it = |group: &&Group| group.owner == self.object.1 && group.name == name;
                let known = self.groups[self.object.1 as usize..].iter().take(MOST_SEARCHED).position(|it| is_it(&it));
                match known.filter(|_| !self.object.0.is_empty()) {
                    Some(at) => self.open = self.object.1 as usize + at,
                    None => self.begin(name),
                }
            }
            _ => {}
        }
        Ok(())
    }

    fn begin(&mut self, name: String) {
        self.open = self.groups.len();
        let owner = if self.object.0.is_empty() { self.open as u32 } else { self.object.1 };
        self.groups.push(Group { name, owner, ..Group::default() });
    }

    /// A polygon. Its corners may follow later in the file.
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
        let group = self.groups.get_mut(self.open).ok_or("there is no group")?;
        let start = group.corners.len();
        for word in rest.split_whitespace() {
            group.corners.push(number(word)?);
        }
        group.ends.push(group.corners.len());
        if (3..=MOST_CORNERS).contains(&(group.corners.len() - start)) {
            return Ok(());
        }
        Err(format!("a face must have at least three corners, and at most {MOST_CORNERS}"))
    }

    /// The groups as parts, each with the corners that it uses.
    fn parts(&self, bytes: usize) -> Result<PartBuilder, MapError> {
        let mut parts = PartBuilder::of_file(bytes);
        for group in &self.groups {
            let mut used: Vec<u32> = group.corners.clone();
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
            let triangles: Vec<[u32; 3]> = group
                .polygons()
                .flat_map(|polygon| {
                    let corners: Vec<u32> = polygon.iter().map(|corner| own(*corner)).collect();
                    in_triangles(&corners, &vertices)
                })
                .collect();
            parts.count(vertices.len() + triangles.len())?;
            parts.add(&group.name, group.owner, vertices, triangles.into_iter());
        }
        Ok(parts)
    }
}

/// Triangles of a polygon whose corners are numbers of vertices: a fan where it is convex, else its ears in the plane that it lies in most.
pub fn in_triangles(corners: &[u32], vertices: &[DVec3]) -> Vec<[u32; 3]> {
    let fan = || corners[1..].windows(2).map(|pair| [corners[0], pair[0], pair[1]]).collect();
    let at = |index: usize| vertices[corners[index % corners.len()] as usize];
    let normal: DVec3 = (2..corners.len()).map(|k| (at(k - 1) - at(0)).cross(at(k) - at(0))).sum();
    let turn = |k: usize| (at(k + 1) - at(k)).cross(at(k + 2) - at(k + 1)).dot(normal);
    if corners.len() == 3 || (0..corners.len()).all(|k| turn(k) >= 0.0) {
        return fan();
    }
    let away = normal.abs();
    let in_plane = |point: DVec3| match () {
        () if away.z >= away.x.max(away.y) => point.truncate(),
        () if away.y >= away.x => DVec2::new(point.x, point.z),
        () => DVec2::new(point.y, point.z),
    };
    let plan: Vec<DVec2> = (0..corners.len()).map(|k| in_plane(at(k))).collect();
    let ears = triangulated(&plan);
    if ears.is_empty() { fan() } else { ears.into_iter().map(|ear| ear.map(|k| corners[k as usize])).collect() }
}

fn vertex(rest: &str) -> Result<DVec3, String> {
    let mut numbers = rest.split_whitespace().map(str::parse);
    match (numbers.next(), numbers.next(), numbers.next()) {
        (Some(Ok(x)), Some(Ok(y)), Some(Ok(z))) => Ok(DVec3::new(x, y, z)),
        _ => Err("a corner must have three numbers".to_owned()),
    }
}
