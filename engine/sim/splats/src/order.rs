//! Order of footprints from near to far: equal depths by number.

/// Bits of a digit.
const DIGIT: u32 = 11;
const VALUES: usize = 1 << DIGIT;

/// Sorts pairs of a depth's bits and a number by depth; pairs of one depth keep their order. `spare` is scratch.
pub fn by_depth(pairs: &mut Vec<(u32, u32)>, spare: &mut Vec<(u32, u32)>) {
    spare.clear();
    spare.resize(pairs.len(), (0, 0));
    for shift in [0, DIGIT, 2 * DIGIT] {
        let digit = |key: u32| (key >> shift) as usize % VALUES;
        let mut counts = [0_u32; VALUES];
        pairs.iter().for_each(|(key, _)| counts[digit(*key)] += 1);
        if counts.iter().any(|count| *count as usize == pairs.len()) {
            continue;
        }
        let mut next = 0;
        for count in &mut counts {
            let first = next;
            next += *count;
            *count = first;
        }
        for pair in pairs.iter() {
            let place = &mut counts[digit(pair.0)];
            spare[*place as usize] = *pair;
            *place += 1;
        }
        core::mem::swap(pairs, spare);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn pairs_are_sorted_and_equal_ones_keep_their_order() {
        let mut pairs: Vec<(u32, u32)> =
            (0..5000_u32).map(|number| (number.wrapping_mul(2_654_435_761) % 700 * 5_000_011, number)).collect();
        let mut expected = pairs.clone();
        expected.sort();
        by_depth(&mut pairs, &mut Vec::new());
        assert_eq!(pairs, expected);
        let mut same = vec![(7, 3), (7, 1), (7, 2)];
        by_depth(&mut same, &mut Vec::new());
        assert_eq!(same, [(7, 3), (7, 1), (7, 2)]);
    }
}
