//! Masks of all instances of a picture as COCO's run lengths.

use std::collections::BTreeMap;

/// The pixels of one thing.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Mask {
    /// Id in the instance image.
    pub instance: u32,
    /// Label.
    pub label: u8,
    /// Number of pixels.
    pub area: u32,
    /// Left, top, width, height in pixels.
    pub bbox: [u32; 4],
    /// COCO's compressed run lengths.
    pub counts: String,
}

/// The masks of everything but ground and sky (id 0) in row-major images of `width` x `height` pixels.
pub fn masks(instance: &[u32], semantic: &[u8], [width, height]: [u32; 2]) -> Vec<Mask> {
    let (width, height) = (width as usize, height as usize);
    // COCO runs down the columns.
    let mut runs: BTreeMap<(u32, u8), Vec<[u32; 2]>> = BTreeMap::new();
    let mut open: Option<((u32, u8), u32)> = None;
    for place in 0..width * height {
        let at = place % height * width + place / height;
        let thing = (instance[at], semantic[at]);
        if open.is_none_or(|(before, _)| before != thing) {
            end(open, place as u32, &mut runs);
            open = Some((thing, place as u32));
        }
    }
    end(open, (width * height) as u32, &mut runs);
    runs.into_iter()
        .map(|((instance, label), runs)| mask(instance, label, &runs, [width as u32, height as u32]))
        .collect()
}

fn end(open: Option<((u32, u8), u32)>, place: u32, runs: &mut BTreeMap<(u32, u8), Vec<[u32; 2]>>) {
    if let Some((thing, start)) = open.filter(|((instance, _), _)| *instance != 0) {
        runs.entry(thing).or_default().push([start, place]);
    }
}

fn mask(instance: u32, label: u8, runs: &[[u32; 2]], [width, height]: [u32; 2]) -> Mask {
    let (mut left, mut top, mut right, mut bottom) = (u32::MAX, u32::MAX, 0, 0);
    let (mut counts, mut before, mut area) = (vec![], 0, 0);
    for [start, end] in runs {
        counts.extend([start - before, end - start]);
        (before, area) = (*end, area + end - start);
        let last = end - 1;
        let [first_column, last_column] = [start / height, last / height];
        left = left.min(first_column);
        right = right.max(last_column);
        // A run over several columns touches both ends of a column.
        let [low, high] = if first_column == last_column { [start % height, last % height] } else { [0, height - 1] };
        top = top.min(low);
        bottom = bottom.max(high);
    }
    if before < width * height {
        counts.push(width * height - before);
    }
    Mask { instance, label, area, bbox: [left, top, right + 1 - left, bottom + 1 - top], counts: compressed(&counts) }
}

/// COCO's text of run lengths: from the fourth on differences to the second before, five bits a letter, lowest first.
fn compressed(counts: &[u32]) -> String {
    let mut text = String::new();
    for (i, count) in counts.iter().enumerate() {
        let mut rest = i64::from(*count) - if i > 2 { i64::from(counts[i - 2]) } else { 0 };
        loop {
            let bits = (rest & 0x1f) as u8;
            rest >>= 5;
            let is_last = rest == if bits & 0x10 != 0 { -1 } else { 0 };
            text.push(char::from(48 + bits + if is_last { 0 } else { 0x20 }));
            if is_last {
                break;
            }
        }
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn run_lengths_are_those_of_pycocotools() {
        // What `mask.encode` gives of a 4 x 3 image with the middle column's lower three pixels and the next one's first.
        let instance = [0, 0, 5, 0, 5, 0, 0, 5, 0, 0, 5, 0];
        let found = masks(&instance, &[14; 12], [3, 4]);
        assert_eq!(found, [Mask { instance: 5, label: 14, area: 4, bbox: [1, 0, 2, 4], counts: "543".into() }]);
        assert_eq!(compressed(&[100, 3, 90, 40, 2]), "T33j2U1XM");
    }

    #[test]
    fn things_of_one_id_and_two_labels_are_two_masks() {
        let found = masks(&[7, 7, 0, 7], &[1, 2, 3, 2], [2, 2]);
        assert_eq!(
            found.iter().map(|it| (it.label, it.area, it.bbox)).collect::<Vec<_>>(),
            [(1, 1, [0, 0, 1, 1]), (2, 2, [1, 0, 1, 2])]
        );
    }
}
