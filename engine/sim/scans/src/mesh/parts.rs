//! [`Part`]: triangles under one name, and how they fall apart.

use cosfly_disjoint_sets::DisjointSets;
use cosfly_frames::DVec3;
use cosfly_town::MapError;

/// Largest coordinate, metres.
const FARTHEST_M: f64 = 1e8;
/// Most corners and triangles of a file, instances of one mesh counted each: a bound, a number for every file, and one for each of its
/// bytes. Memory follows the size of the file.
const MOST_ELEMENTS: usize = 100_000_000;
const ELEMENTS_OF_ANY_FILE: usize = 4_000_000;
const BYTES_OF_ELEMENT: usize = 2;
/// Corners closer than this are one, metres.
const SAME_M: f64 = 1e-3;

/// Triangles under one name, metres.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Part {
    /// Name in the file.
    pub name: String,
    /// Number of the object or node that it belongs to.
    pub owner: u32,
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

    /// For each corner the first one at the same place.
    pub fn merged_corners(&self) -> Vec<usize> {
        let mut order: Vec<usize> = (0..self.vertices.len()).collect();
        let key = |at: &usize| (self.vertices[*at] / SAME_M).round().as_i64vec3().to_array();
        order.sort_by_cached_key(key);
        let mut first: Vec<usize> = (0..self.vertices.len()).collect();
        for same in order.chunk_by(|a, b| key(a) == key(b)) {
            same.iter().for_each(|at| first[*at] = same[0]);
        }
        first
    }

    /// The parts that hang together by their corners, in the order of their first triangles.
    pub fn connected(&self) -> Vec<Self> {
        let merged = self.merged_corners();
        let mut sets = DisjointSets::new(merged.len());
        for [a, b, c] in self.triangles.iter().map(|triangle| triangle.map(|corner| merged[corner as usize])) {
            sets.join(a, b);
            sets.join(b, c);
        }
        let mut number = vec![usize::MAX; self.vertices.len()];
        let mut parts: Vec<Self> = Vec::new();
        let mut moved = vec![u32::MAX; self.vertices.len()];
        for triangle in &self.triangles {
            let top = sets.smallest(merged[triangle[0] as usize]);
            if number[top] == usize::MAX {
                number[top] = parts.len();
                parts.push(Self { name: self.name.clone(), owner: self.owner, ..Self::default() });
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

/// Smallest and largest corner.
pub fn bounds<'v>(vertices: impl Iterator<Item = &'v DVec3>) -> (DVec3, DVec3) {
    vertices.fold((DVec3::INFINITY, DVec3::NEG_INFINITY), |(low, high), vertex| (low.min(*vertex), high.max(*vertex)))
}

/// Takes triangles; those with corners that are nowhere are counted.
#[derive(Debug)]
pub struct PartBuilder {
    /// Parts so far.
    pub parts: Vec<Part>,
    /// Corners and triangles that may follow.
    left: usize,
    broken: usize,
}

impl PartBuilder {
    /// Builder for a file of `bytes` bytes, which limit the elements that may come.
    pub fn of_file(bytes: usize) -> Self {
        let most = (ELEMENTS_OF_ANY_FILE + bytes / BYTES_OF_ELEMENT).min(MOST_ELEMENTS);
        Self { parts: Vec::new(), left: most, broken: 0 }
    }

    /// Counts corners and triangles before they are read.
    ///
    /// # Errors
    /// More of them than a file of its size may have.
    pub fn count(&mut self, elements: usize) -> Result<(), MapError> {
        self.left = self.left.checked_sub(elements).ok_or_else(|| {
            let message =
                "the file has too many corners and triangles for its size, with each place of a repeated mesh counted";
            MapError::new(message).hint("cut the scene into pieces, or leave out what flights do not meet")
        })?;
        Ok(())
    }

    /// Adds a part of an object or node: corners in the map frame, metres, and triangles over them. They were counted before.
    pub fn add(&mut self, name: &str, owner: u32, vertices: Vec<DVec3>, triangles: impl Iterator<Item = [u32; 3]>) {
        let is_somewhere = |corner: u32| {
            vertices
                .get(corner as usize)
                .is_some_and(|vertex| vertex.abs().max_element() <= FARTHEST_M && vertex.is_finite())
        };
        let mut kept = Vec::new();
        for triangle in triangles {
            if triangle.into_iter().all(is_somewhere) { kept.push(triangle) } else { self.broken += 1 }
        }
        let part = Part { name: name.to_owned(), owner, vertices, triangles: kept };
        // Corners that no kept triangle uses may be anywhere.
        self.parts.extend(part.connected().into_iter().reduce(|mut all, more| {
            let first = all.vertices.len() as u32;
            all.vertices.extend(more.vertices);
            all.triangles.extend(more.triangles.iter().map(|triangle| triangle.map(|corner| first + corner)));
            all
        }));
    }

    /// A warning about what was left out.
    pub fn warnings(&self) -> Vec<String> {
        let broken = format!(
            "{} triangles with a corner that is no number, or beyond {FARTHEST_M:.0} m, were left out",
            self.broken
        );
        if self.broken > 0 { vec![broken] } else { Vec::new() }
    }
}
