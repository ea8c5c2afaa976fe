//! [`UsedTexels`]: which texels of a picture triangles show. What lies between the pieces of a picture must not mix into far ones.

/// Which texels of a picture are shown, row by row.
pub(super) struct UsedTexels {
    width: usize,
    height: usize,
    is_used: Vec<bool>,
    /// Whether all of them are.
    is_whole: bool,
}

impl UsedTexels {
    /// None of a picture of this size.
    pub fn new(width: usize, height: usize) -> Self {
        Self { width, height, is_used: vec![false; width * height], is_whole: false }
    }

    /// Whether a texel is shown.
    pub fn is_used(&self, column: usize, row: usize) -> bool {
        self.is_whole || self.is_used[row * self.width + column]
    }

    /// Adds the texels that a triangle touches, by the places of its corners. One that reaches beyond the edge shows the whole picture.
    pub fn add(&mut self, places: [[f32; 2]; 3]) {
        let is_within = |at: &f32| (-1e-3..=1.001).contains(at);
        self.is_whole |= !places.iter().flatten().all(is_within);
        if self.is_whole {
            return;
        }
        let corners =
            places.map(|[u, v]| [u.clamp(0.0, 1.0) * self.width as f32, v.clamp(0.0, 1.0) * self.height as f32]);
        let texel = |at: f32, count: usize| (at as usize).min(count - 1);
        let rows = corners.map(|corner| texel(corner[1], self.height));
        for row in rows.into_iter().min().unwrap_or(0)..=rows.into_iter().max().unwrap_or(0) {
            // The part of each side within the row.
            let (low, high) = (row as f32, row as f32 + 1.0);
            let (mut left, mut right) = (f32::INFINITY, f32::NEG_INFINITY);
            for k in 0..3 {
                let ([ax, ay], [bx, by]) = (corners[k], corners[(k + 1) % 3]);
                if ay.max(by) < low || ay.min(by) > high {
                    continue;
                }
                let at = |y: f32| if ay == by { ax } else { ax + (bx - ax) * ((y - ay) / (by - ay)).clamp(0.0, 1.0) };
                for x in if ay == by { [ax, bx] } else { [at(low), at(high)] } {
                    (left, right) = (left.min(x), right.max(x));
                }
            }
            if left <= right {
                let columns = texel(left, self.width)..=texel(right, self.width);
                self.is_used[row * self.width..][columns].fill(true);
            }
        }
    }

    /// Those of the picture of half the size: of each four, any.
    pub fn halved(&self) -> Self {
        let (width, height) = (self.width.div_ceil(2), self.height.div_ceil(2));
        if self.is_whole {
            return Self { width, height, is_used: vec![], is_whole: true };
        }
        let mut halved = Self::new(width, height);
        for (row, texels) in self.is_used.chunks_exact(self.width).enumerate() {
            let below = &mut halved.is_used[row / 2 * width..][..width];
            below.iter_mut().zip(texels.chunks(2)).for_each(|(own, two)| *own |= two.contains(&true));
        }
        halved
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn texels_are_those_that_triangles_touch() {
        let shown = |used: &UsedTexels| {
            let row = |row| (0..used.width).map(|column| if used.is_used(column, row) { '#' } else { '.' }).collect();
            (0..used.height).map(row).collect::<Vec<String>>()
        };
        let mut used = UsedTexels::new(8, 4);
        used.add([[0.01, 0.01], [0.49, 0.01], [0.01, 0.99]]);
        assert_eq!(shown(&used), ["####....", "###.....", "###.....", "##......"]);
        assert_eq!(shown(&used.halved()), ["##..", "##.."]);
        used.add([[0.9, 0.9]; 3]);
        assert_eq!(shown(&used)[3], "##.....#");
        used.add([[0.2, 0.2], [f32::NAN, 0.3], [0.1, 0.1]]);
        assert!(used.is_whole && shown(&used.halved()) == ["####", "####"]);
    }
}
