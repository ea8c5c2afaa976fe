//! What lies behind bare crowns: the colours of a picture without its plants, people and vehicles, smooth over the places where those
//! hide it.

use super::crown_gaps::is_body;
use cosfly_domain::SemanticLabel;

/// Side of a cell, pixels.
const CELL_PX: usize = 4;
/// Pixels from one that counts to the next along rows, and from one row to the next.
const STEP_PX: [usize; 2] = [2, 4];

/// Cells of one size: rows of mean red, green and blue, and how much each counts, 0 to 1.
struct Level {
    width: usize,
    height: usize,
    cells: Vec<[f32; 4]>,
}

impl Level {
    fn new(width: usize, height: usize) -> Self {
        Self { width, height, cells: vec![[0.0; 4]; width * height] }
    }

    /// The blend of the four cells around a place, in cells.
    fn at(&self, x: f32, y: f32) -> [f32; 4] {
        let clamped = |v: f32, most: usize| (v - 0.5).clamp(0.0, most.saturating_sub(1) as f32);
        let (x, y) = (clamped(x, self.width), clamped(y, self.height));
        let (column, row) = (x as usize, y as usize);
        let (right, below) = ((column + 1).min(self.width - 1), (row + 1).min(self.height - 1));
        let (fx, fy) = (x - column as f32, y - row as f32);
        let cell = |column: usize, row: usize| self.cells[row * self.width + column];
        let mix = |a: [f32; 4], b: [f32; 4], part: f32| [0, 1, 2, 3].map(|k| a[k] + (b[k] - a[k]) * part);
        mix(mix(cell(column, row), cell(right, row), fx), mix(cell(column, below), cell(right, below), fx), fy)
    }

    /// Cells of twice the size.
    fn coarser(&self) -> Self {
        let mut coarser = Self::new(self.width.div_ceil(2), self.height.div_ceil(2));
        for (row, cells) in self.cells.chunks_exact(self.width).enumerate() {
            for (column, [r, g, b, counts]) in cells.iter().enumerate() {
                let sum = &mut coarser.cells[row / 2 * coarser.width + column / 2];
                *sum = [sum[0] + r * counts, sum[1] + g * counts, sum[2] + b * counts, sum[3] + counts];
            }
        }
        coarser.cells.iter_mut().for_each(|sum| *sum = mean(*sum, 3.0));
        coarser
    }

    /// Fills in what the cells of twice the size know.
    fn fill(&mut self, coarser: &Self) {
        for row in 0..self.height {
            for column in 0..self.width {
                let cell = &mut self.cells[row * self.width + column];
                if cell[3] < 1.0 {
                    let wide = coarser.at(0.5 * (column as f32 + 0.5), 0.5 * (row as f32 + 0.5));
                    let [own, counts] = [*cell, [cell[3]; 4]];
                    *cell = [0, 1, 2, 3].map(|k| wide[k] + (own[k] - wide[k]) * counts[k]);
                }
            }
        }
    }
}

/// The mean of what was summed, and how much it counts when `full` counts in full.
fn mean([r, g, b, sum]: [f32; 4], full: f32) -> [f32; 4] {
    let each = if sum > 0.0 { 1.0 / sum } else { 0.0 };
    [r * each, g * each, b * each, (sum / full).min(1.0)]
}

/// Whether a label is of what bare crowns let through: no plant, person or vehicle.
pub fn is_background(label: u8) -> bool {
    label != SemanticLabel::Vegetation.id() && !is_body(label)
}

/// The background of a picture.
pub struct Backdrop(Level);

impl Backdrop {
    /// From rows of colours and labels, `width` pixels each.
    pub fn of(rgb: &[u8], semantic: &[u8], width: usize) -> Self {
        let height = semantic.len() / width;
        let mut finest = Level::new(width.div_ceil(CELL_PX), height.div_ceil(CELL_PX));
        for row in (0..height).step_by(STEP_PX[1]) {
            let (rgb, semantic) = (&rgb[3 * row * width..][..3 * width], &semantic[row * width..][..width]);
            let cells = &mut finest.cells[row / CELL_PX * finest.width..][..finest.width];
            for column in (0..width).step_by(STEP_PX[0]) {
                let (label, at) = (semantic[column], 3 * column);
                if is_background(label) {
                    let sum = &mut cells[column / CELL_PX];
                    let [r, g, b] = [rgb[at], rgb[at + 1], rgb[at + 2]].map(f32::from);
                    *sum = [sum[0] + r, sum[1] + g, sum[2] + b, sum[3] + 1.0];
                }
            }
        }
        let full = (CELL_PX / STEP_PX[0] * CELL_PX / STEP_PX[1]) as f32;
        finest.cells.iter_mut().for_each(|sum| *sum = mean(*sum, full));
        let mut levels = vec![finest];
        while let Some(last) = levels.last()
            && last.width.max(last.height) > 1
        {
            levels.push(last.coarser());
        }
        let mut filled = levels.pop().unwrap_or_else(|| Level::new(1, 1));
        while let Some(mut finer) = levels.pop() {
            finer.fill(&filled);
            filled = finer;
        }
        Self(filled)
    }

    /// The colour at the middle of a pixel.
    pub fn at(&self, column: usize, row: usize) -> [u8; 3] {
        let cells = |at: usize| (at as f32 + 0.5) * (1.0 / CELL_PX as f32);
        let [r, g, b, _] = self.0.at(cells(column), cells(row));
        [r, g, b].map(|code| (code + 0.5) as u8)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn plants_and_bodies_take_the_colours_around_them() {
        let (width, height) = (100, 60);
        let [tree, person, road] =
            [SemanticLabel::Vegetation, SemanticLabel::Pedestrian, SemanticLabel::Roads].map(SemanticLabel::id);
        let (mut rgb, mut semantic) = (vec![], vec![]);
        for row in 0..height {
            for column in 0..width {
                let label = match (column, row) {
                    (20..60, 10..50) => tree,
                    (60..66, 20..40) => person,
                    _ => road,
                };
                semantic.push(label);
                rgb.extend(if label == road { [2 * column as u8, 80, 40] } else { [255, 0, 255] });
            }
        }
        let backdrop = Backdrop::of(&rgb, &semantic, width);
        let mut before = 0;
        for column in 8..92 {
            let [r, g, b] = backdrop.at(column, 30);
            assert!((79..=81).contains(&g) && (39..=41).contains(&b), "{g} {b}");
            assert!((2 * column as i32 - i32::from(r)).abs() < 45, "{r} at {column}");
            assert!(r + 1 >= before, "{r} after {before} at {column}");
            before = r;
        }
        let all_trees = Backdrop::of(&rgb, &vec![tree; width * height], width);
        assert_eq!(all_trees.at(30, 30), [0; 3]);
    }
}
