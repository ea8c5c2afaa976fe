//! [`AreaPicture`]: pixels of a picture that is an area, and their place in the world.

use cosfly_frames::DVec2;
use std::sync::Arc;

/// Grey pixels, row by row; the first row has the smallest y.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct AreaPicture {
    /// Columns and rows.
    pub size: [usize; 2],
    /// From black, 0, to white, 255.
    pub grey: Vec<u8>,
}

/// Whether a pixel of a closed area is closed.
pub(crate) fn is_light(grey: u8) -> bool {
    grey >= 128
}

/// A picture and its place.
#[derive(Clone, Debug)]
pub(crate) struct PlacedPicture {
    picture: Arc<AreaPicture>,
    min: DVec2,
    pixel_m: DVec2,
}

impl PlacedPicture {
    pub fn new(picture: Arc<AreaPicture>, min_m: [f64; 2], max_m: [f64; 2]) -> Self {
        let (min, size) = (DVec2::from_array(min_m), picture.size.map(|side| side as f64));
        Self { picture, min, pixel_m: (DVec2::from_array(max_m) - min) / DVec2::from_array(size) }
    }

    /// Place in pixels.
    fn place(&self, point: DVec2) -> DVec2 {
        (point - self.min) / self.pixel_m
    }

    fn grey(&self, column: f64, row: f64) -> Option<u8> {
        let [columns, rows] = self.picture.size;
        let inside = column >= 0.0 && row >= 0.0 && column < columns as f64 && row < rows as f64;
        inside.then(|| self.picture.grey[row as usize * columns + column as usize])
    }

    /// Grey value at a point; `None` outside of the picture.
    pub fn grey_at(&self, point: DVec2) -> Option<u8> {
        let place = self.place(point);
        self.grey(place.x, place.y)
    }

    /// Whether a part of the straight step lies on light pixels.
    pub fn light_meets(&self, from: DVec2, to: DVec2) -> bool {
        let (from, to) = (self.place(from), self.place(to));
        let step = to - from;
        let [columns, rows] = self.picture.size.map(|side| side as f64);
        let (first_row, last_row) = (from.y.min(to.y).floor().max(0.0), from.y.max(to.y).min(rows - 1.0));
        (first_row as usize..(last_row + 1.0).max(0.0) as usize).any(|row| {
            let x_at = |y: f64| from.x + ((y - from.y) / step.y).clamp(0.0, 1.0) * step.x;
            let ends = [row as f64, row as f64 + 1.0].map(x_at);
            let [a, b] = if step.y == 0.0 { [from.x, to.x] } else { ends };
            let (first, last) = (a.min(b).floor().max(0.0), a.max(b).min(columns - 1.0));
            (first as usize..(last + 1.0).max(0.0) as usize)
                .any(|column| self.grey(column as f64, row as f64).is_some_and(is_light))
        })
    }

    /// Calls `visit` with the sides between light pixels and others, in the world.
    pub fn visit_light_edges(&self, visit: &mut dyn FnMut(DVec2, DVec2)) {
        let [columns, rows] = self.picture.size;
        let light = |at: DVec2| self.grey(at.x, at.y).is_some_and(is_light);
        let corner = |at: DVec2| self.min + at * self.pixel_m;
        for row in 0..=rows {
            for column in 0..=columns {
                let at = DVec2::new(column as f64, row as f64);
                for (before, end) in [(at - DVec2::Y, at + DVec2::X), (at - DVec2::X, at + DVec2::Y)] {
                    if light(at) != light(before) {
                        visit(corner(at), corner(end));
                    }
                }
            }
        }
    }
}
