//! Nested lists of a geometry, flattened while they are parsed: corners to rings, rings to faces, whatever holds faces.

use core::fmt;
use serde::de::{DeserializeSeed, Error, SeqAccess, Visitor};
use serde::{Deserialize, Deserializer};

/// The faces of a geometry: all shells and solids in one list, in the order of the file.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct Boundaries {
    corners: Vec<u32>,
    /// Ends of the rings in `corners`.
    ring_ends: Vec<u32>,
    /// Ends of the faces in `ring_ends`.
    face_ends: Vec<u32>,
}

/// Numbers of nested lists, in their order; null stays.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct FlatNumbers(pub(super) Vec<Option<u32>>);

/// How deep a list is: a corner, a ring, a face, anything beyond.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
enum Level {
    Corner,
    Ring,
    Face,
    Shell,
}

impl Boundaries {
    /// Rings of each face as indices of vertices, the outer one first.
    pub(super) fn faces(&self) -> impl Iterator<Item = impl Iterator<Item = &[u32]>> {
        let start = |ends: &[u32], i: usize| if i == 0 { 0 } else { ends[i - 1] as usize };
        (0..self.face_ends.len()).map(move |face| {
            let rings = start(&self.face_ends, face)..self.face_ends[face] as usize;
            rings.map(move |ring| &self.corners[start(&self.ring_ends, ring)..self.ring_ends[ring] as usize])
        })
    }

    pub(super) fn face_count(&self) -> usize {
        self.face_ends.len()
    }

    /// All corners, of points and lines, too.
    pub(super) fn corners(&self) -> &[u32] {
        &self.corners
    }
}

struct Nested<'b>(&'b mut Boundaries);

impl<'de> DeserializeSeed<'de> for Nested<'_> {
    type Value = Level;

    fn deserialize<D: Deserializer<'de>>(self, deserializer: D) -> Result<Level, D::Error> {
        deserializer.deserialize_any(self)
    }
}

impl<'de> Visitor<'de> for Nested<'_> {
    type Value = Level;

    fn expecting(&self, out: &mut fmt::Formatter<'_>) -> fmt::Result {
        out.write_str("the index of a vertex or a list")
    }

    fn visit_u64<E: Error>(self, index: u64) -> Result<Level, E> {
        self.0.corners.push(u32::try_from(index).map_err(|_| E::custom("an index of a vertex is too large"))?);
        Ok(Level::Corner)
    }

    fn visit_seq<A: SeqAccess<'de>>(self, mut list: A) -> Result<Level, A::Error> {
        let mut inner: Option<Level> = None;
        while let Some(level) = list.next_element_seed(Nested(self.0))? {
            if inner.is_some_and(|inner| inner != level) {
                return Err(A::Error::custom("a list of `boundaries` mixes indices and lists of different depth"));
            }
            inner = Some(level);
        }
        match inner {
            None | Some(Level::Corner) => {
                self.0.ring_ends.push(self.0.corners.len() as u32);
                Ok(Level::Ring)
            }
            Some(Level::Ring) => {
                self.0.face_ends.push(self.0.ring_ends.len() as u32);
                Ok(Level::Face)
            }
            Some(Level::Face | Level::Shell) => Ok(Level::Shell),
        }
    }
}

impl<'de> Deserialize<'de> for Boundaries {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        let mut boundaries = Self::default();
        Nested(&mut boundaries).deserialize(deserializer)?;
        Ok(boundaries)
    }
}

struct Numbers<'n>(&'n mut FlatNumbers);

impl<'de> DeserializeSeed<'de> for Numbers<'_> {
    type Value = ();

    fn deserialize<D: Deserializer<'de>>(self, deserializer: D) -> Result<(), D::Error> {
        deserializer.deserialize_any(self)
    }
}

impl<'de> Visitor<'de> for Numbers<'_> {
    type Value = ();

    fn expecting(&self, out: &mut fmt::Formatter<'_>) -> fmt::Result {
        out.write_str("the index of a surface, null or a list")
    }

    fn visit_u64<E: Error>(self, index: u64) -> Result<(), E> {
        self.0.0.push(u32::try_from(index).ok());
        Ok(())
    }

    fn visit_unit<E: Error>(self) -> Result<(), E> {
        self.0.0.push(None);
        Ok(())
    }

    fn visit_seq<A: SeqAccess<'de>>(self, mut list: A) -> Result<(), A::Error> {
        while list.next_element_seed(Numbers(self.0))?.is_some() {}
        Ok(())
    }
}

impl<'de> Deserialize<'de> for FlatNumbers {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        let mut numbers = Self::default();
        Numbers(&mut numbers).deserialize(deserializer)?;
        Ok(numbers)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn faces(text: &str) -> Result<Vec<Vec<Vec<u32>>>, String> {
        let boundaries: Boundaries = serde_json::from_str(text).map_err(|error| error.to_string())?;
        let rings = boundaries.faces().map(|rings| rings.map(<[u32]>::to_vec).collect());
        Ok(rings.collect())
    }

    #[test]
    fn lists_of_any_depth_give_faces() {
        let two = vec![vec![vec![0, 1, 2], vec![3, 4, 5]], vec![vec![6, 7, 8]]];
        for text in
            ["[[[0,1,2],[3,4,5]],[[6,7,8]]]", "[[[[0,1,2],[3,4,5]]],[[[6,7,8]]]]", "[[[[[0,1,2],[3,4,5]],[[6,7,8]]]]]"]
        {
            assert_eq!(faces(text), Ok(two.clone()), "{text}");
        }
        assert_eq!(faces("[5]"), Ok(vec![]));
        assert_eq!(faces("[[[]]]"), Ok(vec![vec![vec![]]]));
        for text in
            ["[[0],1]", "[-1]", "[1.5]", "[[[0,1,2],[[3]]]]", "[99999999999]", "{}", "[\"a\"]", &"[".repeat(400)]
        {
            assert!(faces(text).is_err(), "{text}");
        }
    }

    #[test]
    fn numbers_keep_their_nulls() {
        let numbers: FlatNumbers = serde_json::from_str("[[0,null],[[2]]]").unwrap();
        assert_eq!(numbers.0, [Some(0), None, Some(2)]);
    }
}
