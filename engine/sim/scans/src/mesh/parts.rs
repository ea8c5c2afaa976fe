//! [`Part`]: triangles under one name, and how they fall apart.

use cosfly_frames::DVec3;
use cosfly_town::MapError;

/// Largest coordinate, metres.
const FARTHEST_M: f64 = 1e8;
/// Most corners and triangles of a file, instances of one mesh counted each.
const MOST_ELEMENTS: usize = 40_000_000;
/// Corners closer than this are one, metres.
const SAME_M: f64 = 1e-3;

/// Triangles under one name, metres.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Part {
    /// Name in the file.
    pub name: String,
    /// Corners.
    pub vertices: Vec<DVec3>,
    /// Numbers of corners.
    pub triangles: Vec<[u32; 3]>,
}

impl Part {
    /// Corners of a triangle.
    pub fn corners(&self, triangle: [u32; 3]) -> [DVec3; 3] {
        triangle.map(|corner| self.vertices[corner as usize])
    }

    /// The parts that hang together by their corners, in the order of their first triangles.
    pub fn connected(&self) -> Vec<Self> {
        let mut order: Vec<usize> = (0..self.vertices.len()).collect();
        let key = |at: &usize| (self.vertices[*at] / SAME_M).round().as_i64vec3().to_array();
        order.sort_by_key(key);
        let mut root: Vec<usize> = (0..self.vertices.len()).collect();
        for pair in order.windows(2) {
            if key(&pair[0]) == key(&pair[1]) {
                join(&mut root, pair[0], pair[1]);
            }
        }
        for [a, b, c] in self.triangles.iter().map(|triangle| triangle.map(|corner| corner as usize)) {
            join(&mut root, a, b);
            join(&mut root, b, c);
        }
        let mut number = vec![usize::MAX; self.vertices.len()];
        let mut parts: Vec<Self> = Vec::new();
        let mut moved = vec![u32::MAX; self.vertices.len()];
        for triangle in &self.triangles {
            let top = find(&mut root, triangle[0] as usize);
            if number[top] == usize::MAX {
                number[top] = parts.len();
                parts.push(Self { name: self.name.clone(), ..Self::default() });
            }
            let part = &mut parts[number[top]];
            let own = triangle.map(|corner| {
                let place = &mut moved[corner as usize];
                if *place == u32::MAX {
                    *place = part.vertices.len() as u32;
                    part.vertices.push(self.vertices[corner as usize]);
                }
                *place
            });
            part.triangles.push(own);
        }
        parts
    }
}

fn find(root: &mut [usize], mut at: usize) -> usize {
    while root[at] != at {
        root[at] = root[root[at]];
        at = root[at];
    }
    at
}

fn join(root: &mut [usize], a: usize, b: usize) {
    let (a, b) = (find(root, a), find(root, b));
    root[a.max(b)] = a.min(b);
}

/// Smallest and largest corner.
pub fn bounds<'v>(vertices: impl Iterator<Item = &'v DVec3>) -> (DVec3, DVec3) {
    vertices.fold((DVec3::INFINITY, DVec3::NEG_INFINITY), |(low, high), vertex| (low.min(*vertex), high.max(*vertex)))
}

/// Takes triangles; those with corners that are nowhere are counted.
#[derive(Debug, Default)]
pub struct PartBuilder {
    /// Parts so far.
    pub parts: Vec<Part>,
    elements: usize,
    broken: usize,
}

impl PartBuilder {
    /// Adds a part: corners in the map frame, metres, and triangles over them.
    ///
    /// # Errors
    /// More triangles than a file may have.
    pub fn add(
        &mut self,
        name: &str,
        vertices: Vec<DVec3>,
        triangles: impl Iterator<Item = [u32; 3]>,
    ) -> Result<(), MapError> {
        let is_somewhere = |corner: u32| {
            vertices
                .get(corner as usize)
                .is_some_and(|vertex| vertex.abs().max_element() <= FARTHEST_M && vertex.is_finite())
        };
        self.elements += vertices.len();
        let mut kept = Vec::new();
        for triangle in triangles {
            self.elements += 1;
            if triangle.into_iter().all(is_somewhere) { kept.push(triangle) } else { self.broken += 1 }
        }
        if self.elements > MOST_ELEMENTS {
            let error = MapError::new(format!(
                "the file has more than {MOST_ELEMENTS} corners and triangles, instances counted"
            ));
            return Err(error.hint("cut the scene into pieces, or leave out what flights do not meet"));
        }
        let part = Part { name: name.to_owned(), vertices, triangles: kept };
        // Corners that no kept triangle uses may be anywhere.
        self.parts.extend(part.connected().into_iter().reduce(|mut all, more| {
            let first = all.vertices.len() as u32;
            all.vertices.extend(more.vertices);
            all.triangles.extend(more.triangles.iter().map(|triangle| triangle.map(|corner| first + corner)));
            all
        }));
        Ok(())
    }

    /// A warning about what was left out.
    pub fn warnings(&self) -> Vec<String> {
        let broken = format!("{} triangles without finite corners were left out", self.broken);
        if self.broken > 0 { vec![broken] } else { Vec::new() }
    }
}
