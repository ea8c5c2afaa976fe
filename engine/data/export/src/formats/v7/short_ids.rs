//! Instance ids in the 16 bits of `instance.png`: larger ones get numbers that no other thing of the flight has.

use crate::source::ExportedFlight;
use cosfly_diagnose::{Diagnostic, Fault, Result};
use std::collections::{BTreeMap, BTreeSet};

/// A flight has ids beyond 16 bits only where its town has objects beyond this id: people and vehicles are numbered after the objects.
const LARGE_TOWN: u32 = 1 << 15;

/// Numbers in pictures by ids of the tables, where they differ.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct ShortIds(BTreeMap<u32, u16>);

impl ShortIds {
    /// Short ids of the ids in pictures: those of 16 bits stay, the others get the largest free numbers. None for more
    /// things than numbers.
    pub fn of(ids: &BTreeSet<u32>) -> Option<Self> {
        let is_free = |number: &u16| !ids.contains(&u32::from(*number));
        let mut free = (2..=u16::MAX).rev().filter(is_free);
        let large = ids.iter().filter(|id| u16::try_from(**id).is_err());
        large.map(|id| Some((*id, free.next()?))).collect::<Option<_>>().map(Self)
    }

    /// Short ids of all frames of a flight, which are read for this where `largest_object`, the largest id,
    /// asks for it.
    ///
    /// # Errors
    /// Damage of the log, or more things than numbers.
    pub fn of_frames(episode: &ExportedFlight<'_>, frames: &[usize], largest_object: u32) -> Result<Self> {
        if largest_object < LARGE_TOWN {
            return Ok(Self::default());
        }
        let mut ids = BTreeSet::new();
        let seen = |_, logged: cosfly_read::LoggedFrame| Ok(logged.instance.into_iter().collect::<BTreeSet<u32>>());
        episode.each_picture_silently(frames, seen, |_, seen| {
            ids.extend(seen);
            Ok(())
        })?;
        Self::of(&ids).ok_or_else(|| {
            let message = format!(
                "flight `{}` shows {} things; `instance.png` has numbers for 65,536",
                episode.flight.trajectory_id,
                ids.len()
            );
            Diagnostic::new("export-image", Fault::Input, message)
                .hint("export it in another format: `webdataset` and `coco` keep ids of 32 bits")
        })
    }

    /// The number of an id in pictures.
    ///
    /// # Errors
    /// An id beyond 16 bits that has no number.
    pub fn number(&self, id: u32) -> Result<u16, u32> {
        u16::try_from(id).or_else(|_| self.0.get(&id).copied().ok_or(id))
    }

    /// Numbers in pictures and ids of the tables, where they differ.
    pub fn changed(&self) -> impl Iterator<Item = [u32; 2]> {
        self.0.iter().map(|(id, number)| [u32::from(*number), *id])
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ids_beyond_16_bits_get_numbers_of_nobody_else() {
        let ids = BTreeSet::from([0, 1, 2, 65_534, 65_535, 65_536, 65_537, 131_073]);
        let short = ShortIds::of(&ids).expect("there are free numbers");
        let numbers: BTreeSet<u16> = ids.iter().map(|id| short.number(*id).expect("a number")).collect();
        assert_eq!(numbers.len(), ids.len(), "{short:?}");
        assert_eq!([0, 1, 2, 65_534, 65_535].map(|id| short.number(id)), [Ok(0), Ok(1), Ok(2), Ok(65_534), Ok(65_535)]);
        assert_eq!(short.changed().map(|[_, id]| id).collect::<Vec<_>>(), [65_536, 65_537, 131_073]);
        assert_eq!(short.number(65_538), Err(65_538));
    }

    #[test]
    fn more_things_than_numbers_are_refused_and_as_many_are_not() {
        assert_eq!(ShortIds::of(&(0..=65_536).collect()), None);
        assert!(ShortIds::of(&(0..65_535).chain([70_000]).collect()).is_some());
    }
}
