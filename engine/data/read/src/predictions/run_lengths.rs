//! Masks as run lengths of their pixels along columns, and COCO's text encoding of them.

/// Sorted, separate runs of pixels (first, one past the last) of an image in column-major order.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Runs(pub Vec<[u32; 2]>);

impl Runs {
    /// Runs from COCO's run lengths: background first, then alternating. They must fill `pixels` exactly.
    ///
    /// # Errors
    /// The violation, in words.
    pub fn of_counts(counts: impl IntoIterator<Item = u64>, pixels: u64) -> Result<Self, String> {
        let (mut runs, mut at): (Vec<[u32; 2]>, u64) = (vec![], 0);
        for (number, count) in counts.into_iter().enumerate() {
            let end = at.saturating_add(count);
            if end > pixels || end > u64::from(u32::MAX) {
                return Err(format!("the runs are longer than the {pixels} pixels of the image"));
            }
            if number % 2 == 1 && count > 0 {
                match runs.last_mut() {
                    Some([_, last]) if *last == at as u32 => *last = end as u32,
                    _ => runs.push([at as u32, end as u32]),
                }
            }
            at = end;
        }
        if at == pixels { Ok(Self(runs)) } else { Err(format!("the runs have {at} of {pixels} pixels")) }
    }

    /// Runs from COCO's compressed text: five bits a character, lowest first; from the fourth number on, differences to
    /// the second number before.
    ///
    /// # Errors
    /// Invalid text, in words.
    pub fn of_text(text: &str, pixels: u64) -> Result<Self, String> {
        let (mut counts, mut value, mut shift) = (Vec::<i64>::new(), 0_i64, 0_u32);
        for letter in text.bytes() {
            let bits = letter
                .checked_sub(48)
                .filter(|bits| *bits < 64)
                .ok_or("it has a character that is not one of COCO's")?;
            if shift > 40 {
                return Err("it has a number that is too long".to_owned());
            }
            value |= i64::from(bits & 0x1f) << shift;
            shift += 5;
            if bits & 0x20 == 0 {
                if bits & 0x10 != 0 {
                    value |= -1_i64 << shift;
                }
                if counts.len() > 2 {
                    let before = counts[counts.len() - 2];
                    value = value.checked_add(before).ok_or("it has a number that is too large")?;
                }
                counts.push(value);
                (value, shift) = (0, 0);
            }
        }
        if shift > 0 {
            return Err("it ends within a number".to_owned());
        }
        let counts: Option<Vec<u64>> = counts.into_iter().map(|count| u64::try_from(count).ok()).collect();
        Self::of_counts(counts.ok_or("it has a negative run")?, pixels)
    }

    /// Number of pixels of the mask.
    pub fn area(&self) -> u64 {
        self.0.iter().map(|[start, end]| u64::from(end - start)).sum()
    }

    /// Left, top, right and bottom edge in an image of `height` rows; zeros for an empty mask.
    pub fn edges(&self, height: u32) -> [u32; 4] {
        let (mut low, mut high) = ([u32::MAX; 2], [0; 2]);
        for [start, end] in &self.0 {
            let columns = [start / height.max(1), (end - 1) / height.max(1)];
            // A run over several columns touches both ends of a column.
            let rows = if columns[0] == columns[1] { [start % height, (end - 1) % height] } else { [0, height - 1] };
            low = [low[0].min(columns[0]), low[1].min(rows[0])];
            high = [high[0].max(columns[1] + 1), high[1].max(rows[1] + 1)];
        }
        if self.0.is_empty() { [0; 4] } else { [low[0], low[1], high[0], high[1]] }
    }

    /// Intersection over union; 0 when both are empty.
    pub fn iou(&self, other: &Self) -> f64 {
        let (mut common, mut a, mut b) = (0_u64, self.0.iter().peekable(), other.0.iter().peekable());
        while let (Some(x), Some(y)) = (a.peek(), b.peek()) {
            common += u64::from(x[1].min(y[1]).saturating_sub(x[0].max(y[0])));
            if x[1] <= y[1] {
                a.next()
            } else {
                b.next()
            };
        }
        let union = self.area() + other.area() - common;
        if union > 0 { common as f64 / union as f64 } else { 0.0 }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::collection::vec;
    use proptest::prelude::*;

    #[test]
    fn texts_are_those_of_pycocotools() {
        // The text that `mask.encode` gives for a 4 x 3 image with the middle column's lower three pixels and the next
        // one's first.
        let runs = Runs::of_text("543", 12).unwrap();
        assert_eq!((runs.0.clone(), runs.area(), runs.edges(4)), (vec![[5, 9]], 4, [1, 0, 3, 4]));
        assert_eq!(Runs::of_text("T33j2U1XM", 235).unwrap(), Runs::of_counts([100, 3, 90, 40, 2], 235).unwrap());
        for (text, expected) in
            [("54", "of 12 pixels"), ("5433", "longer"), ("5 3", "not one of COCO's"), ("54S", "within")]
        {
            let why = Runs::of_text(text, 12).unwrap_err();
            assert!(why.contains(expected), "{text}: {why}");
        }
        assert!(Runs::of_text(&"o".repeat(100), 12).is_err());
    }

    /// Runs of an image's pixels in column-major order.
    fn drawn(pixels: &[bool]) -> Runs {
        let mut counts = vec![0];
        for (at, pixel) in pixels.iter().enumerate() {
            if at > 0 && *pixel != pixels[at - 1] || at == 0 && *pixel {
                counts.push(0);
            }
            *counts.last_mut().unwrap() += 1;
        }
        Runs::of_counts(counts, pixels.len() as u64).unwrap()
    }

    proptest! {
        #![proptest_config(ProptestConfig { failure_persistence: None, ..ProptestConfig::default() })]

        #[test]
        fn runs_measure_what_pixels_measure(
            height in 1..9_u32,
            pixels in vec(any::<(bool, bool)>(), 0..40),
        ) {
            let whole = pixels.len() / height as usize * height as usize;
            let (a, b): (Vec<bool>, Vec<bool>) = pixels.into_iter().take(whole).unzip();
            let (of_a, of_b) = (drawn(&a), drawn(&b));
            let count = |mask: &dyn Fn(usize) -> bool| (0..whole).filter(|at| mask(*at)).count();
            prop_assert_eq!(of_a.area(), count(&|at| a[at]) as u64);
            let (common, union) = (count(&|at| a[at] && b[at]), count(&|at| a[at] || b[at]));
            prop_assert_eq!(of_a.iou(&of_b), if union > 0 { common as f64 / union as f64 } else { 0.0 });
            let places = || (0..whole as u32).filter(|at| a[*at as usize]).map(|at| [at / height, at % height]);
            let low = |axis: usize| places().map(|place| place[axis]).min().unwrap_or(0);
            let high = |axis: usize| places().map(|place| place[axis] + 1).max().unwrap_or(0);
            prop_assert_eq!(of_a.edges(height), [low(0), low(1), high(0), high(1)]);
        }
    }
}
