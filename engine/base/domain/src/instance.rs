//! [`BodyId`] and instance ids: the one numbering of bodies and of what pictures show.

use crate::Town;

/// Instance id of the followed target.
pub const TARGET_INSTANCE: u32 = 1;

/// Instance id of an object of the town.
pub fn object_instance(object_id: u32) -> u32 {
    object_id.saturating_add(2)
}

/// Largest instance id of an object of a town.
pub fn largest_object_instance(town: &Town) -> u32 {
    let objects = town.obstacles.iter().map(|obstacle| object_instance(obstacle.object_id));
    objects.max().unwrap_or(TARGET_INSTANCE)
}

/// Number of a body in a world: no other body of the world has it. A world has *sources* of bodies (a stage with walks, a traffic) and
/// the number depends on the places of source and body alone: more bodies, and sources that are added at the end, change no number.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct BodyId(u32);

/// Place among the sources that the drones behind one walk have.
const SOURCE_OF_DRONES: usize = 12;

impl BodyId {
    /// Body number `number` of source number `source`: the first source has every second number, the next one every second of the
    /// rest, and so on. `None` beyond 32 bits.
    pub fn of(source: usize, number: usize) -> Option<Self> {
        Self::odd_multiple(source + usize::from(source >= SOURCE_OF_DRONES), number)
    }

    /// A drone by its number behind the walk.
    pub fn of_drone(number: u32) -> Option<Self> {
        Self::odd_multiple(SOURCE_OF_DRONES, number as usize)
    }

    /// Instance id in pictures of a town whose objects have ids up to `largest_object`. `None` beyond 32 bits.
    pub fn instance(self, largest_object: u32) -> Option<u32> {
        largest_object.checked_add(self.0)
    }

    /// Number `item` of those that can be halved just so often.
    fn odd_multiple(halvings: usize, item: usize) -> Option<Self> {
        let odd = u32::try_from(item).ok()?.checked_mul(2)?.checked_add(1)?;
        odd.checked_mul(1u32.checked_shl(u32::try_from(halvings).ok()?)?).map(Self)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::collections::BTreeSet;

    #[test]
    fn numbers_of_bodies_differ_and_do_not_depend_on_how_many_there_are() {
        let bodies = (0..14).flat_map(|source| (0..300).map(move |item| BodyId::of(source, item).unwrap()));
        let ids: BTreeSet<BodyId> = bodies.chain((0..8).map(|number| BodyId::of_drone(number).unwrap())).collect();
        assert_eq!((ids.len(), ids.first()), (14 * 300 + 8, Some(&BodyId(1))));
        let instance = |source, item| BodyId::of(source, item).and_then(|id| id.instance(10));
        assert_eq!([0, 1, 2].map(|item| instance(0, item)), [Some(11), Some(13), Some(15)]);
        assert_eq!([0, 1, 2].map(|item| instance(1, item)), [Some(12), Some(16), Some(20)]);
        assert_eq!((instance(30, 0), instance(30, 1), instance(31, 0)), (Some(10 + (1 << 31)), None, None));
        assert_eq!(BodyId::of(30, 0).unwrap().instance(u32::MAX), None);
    }
}
