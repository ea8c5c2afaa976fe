//! Masks of the true things of a frame.

use cosfly_read::predictions::run_lengths::Runs;
use std::collections::BTreeMap;

/// Masks of everything but ground and sky (id 0) in row-major images of `width` x `height` pixels, by instance id and
/// label.
pub fn things(instance: &[u32], labels: &[u8], [width, height]: [u32; 2]) -> BTreeMap<(u32, u8), Runs> {
    let (width, height) = (width as usize, height as usize);
    let mut found: BTreeMap<(u32, u8), Runs> = BTreeMap::new();
    let mut open: Option<((u32, u8), u32)> = None;
    let mut end = |open: Option<((u32, u8), u32)>, place: u32| {
        if let Some((thing, start)) = open.filter(|((instance, _), _)| *instance != 0) {
            found.entry(thing).or_default().0.push([start, place]);
        }
    };
    for column in 0..width {
        for row in 0..height {
            let at = row * width + column;
            let (Some(id), Some(label)) = (instance.get(at), labels.get(at)) else { continue };
            let place = (column * height + row) as u32;
            if open.is_none_or(|(before, _)| before != (*id, *label)) {
                end(open, place);
                open = Some(((*id, *label), place));
            }
        }
    }
    end(open, (width * height) as u32);
    found
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn things_of_one_id_and_two_labels_are_two() {
        let found = things(&[7, 7, 0, 7], &[1, 2, 3, 2], [2, 2]);
        let found: Vec<_> = found.iter().map(|(thing, runs)| (*thing, runs.area(), runs.edges(2))).collect();
        assert_eq!(found, [((7, 1), 1, [0, 0, 1, 1]), ((7, 2), 2, [1, 0, 2, 2])]);
    }
}
