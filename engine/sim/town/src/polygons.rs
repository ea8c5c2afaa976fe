//! Plan-view polygons: what contains a point, cutting by a convex shape, triangulation.

use cosfly_frames::DVec2;

/// Whether a point lies in the polygon (even-odd rule).
pub fn contains(outline: &[DVec2], point: DVec2) -> bool {
    let mut odd = false;
    for i in 0..outline.len() {
        let (a, b) = (outline[i], outline[(i + 1) % outline.len()]);
        if (a.y > point.y) != (b.y > point.y) && point.x < a.x + (b.x - a.x) * ((point.y - a.y) / (b.y - a.y)) {
            odd = !odd;
        }
    }
    odd
}

/// Twice the signed area, positive for corners from x towards y.
pub fn twice_area_m2(outline: &[DVec2]) -> f64 {
    let Some(first) = outline.first() else { return 0.0 };
    outline.windows(2).map(|pair| (pair[0] - *first).perp_dot(pair[1] - *first)).sum()
}

/// The part of `outline` on the inner side of a line through `point` (where `inward` points).
pub fn clipped_by_line(outline: &[DVec2], point: DVec2, inward: DVec2) -> Vec<DVec2> {
    let depth = |p: DVec2| (p - point).dot(inward);
    let mut out = Vec::with_capacity(outline.len() + 2);
    for i in 0..outline.len() {
        let (a, b) = (outline[i], outline[(i + 1) % outline.len()]);
        let (in_a, in_b) = (depth(a), depth(b));
        if in_a >= 0.0 {
            out.push(a);
        }
        if (in_a >= 0.0) != (in_b >= 0.0) {
            out.push(a.lerp(b, in_a / (in_a - in_b)));
        }
    }
    out
}

/// The part of `outline` between two parallel lines across `along` (unit vector) at `from` and `to`.
pub fn clipped_to_band(outline: &[DVec2], along: DVec2, from: f64, to: f64) -> Vec<DVec2> {
    let above = clipped_by_line(outline, from * along, along);
    clipped_by_line(&above, to * along, -along)
}

/// Polygons with more corners are not triangulated.
const MOST_CORNERS: usize = 100;

/// Triangles over the corners of a simple polygon of at most 100 corners, by cutting ears; empty for degenerate or crossed outlines
/// that leave no ear.
pub fn triangulated(outline: &[DVec2]) -> Vec<[u32; 3]> {
    triangulated_up_to(outline, MOST_CORNERS)
}

/// [`triangulated`] with another bound of corners; the time grows with their third power.
pub fn triangulated_up_to(outline: &[DVec2], most_corners: usize) -> Vec<[u32; 3]> {
    if outline.len() > most_corners {
        return Vec::new();
    }
    let mut left: Vec<usize> = (0..outline.len()).collect();
    if twice_area_m2(outline) < 0.0 {
        left.reverse();
    }
    let mut out = Vec::new();
    while left.len() >= 3 {
        let count = left.len();
        let ear = (0..count).find(|i| {
            let [before, at, after] = [left[(i + count - 1) % count], left[*i], left[(i + 1) % count]];
            let [a, b, c] = [outline[before], outline[at], outline[after]];
            let turn = (b - a).perp_dot(c - b);
            turn > 1e-12
                && left
                    .iter()
                    .filter(|k| ![before, at, after].contains(k))
                    .all(|k| !inside_or_on([a, b, c], outline[*k]))
        });
        // A corner without area is no ear but can go; when not even that exists the outline is crossed.
        let flat = || {
            (0..count).find(|i| {
                let [a, b, c] = [left[(i + count - 1) % count], left[*i], left[(i + 1) % count]].map(|k| outline[k]);
                (b - a).perp_dot(c - b).abs() <= 1e-12
            })
        };
        match ear {
            Some(i) => {
                out.push([left[(i + count - 1) % count], left[i], left[(i + 1) % count]].map(|k| k as u32));
                left.remove(i);
            }
            None => match flat() {
                Some(i) => _ = left.remove(i),
                None => return Vec::new(),
            },
        }
    }
    out
}

/// Whether a point that is not one of the corners lies in the triangle or on its rim.
fn inside_or_on([a, b, c]: [DVec2; 3], point: DVec2) -> bool {
    let inside =
        (b - a).perp_dot(point - a) >= 0.0 && (c - b).perp_dot(point - b) >= 0.0 && (a - c).perp_dot(point - c) >= 0.0;
    inside && ![a, b, c].contains(&point)
}

/// Most entries in the lists of an index, beyond one for each polygon.
const MOST_ENTRIES: f64 = 4e6;

/// Polygons in a grid of cells, to find the ones at a point.
#[derive(Clone, Debug)]
pub struct PolygonIndex {
    outlines: Vec<Vec<DVec2>>,
    low: DVec2,
    cell_m: f64,
    columns: usize,
    rows: usize,
    cells: Vec<Vec<u32>>,
}

impl PolygonIndex {
    /// An index over outlines; their order gives their numbers.
    pub fn new(outlines: Vec<Vec<DVec2>>) -> Self {
        let corners = || outlines.iter().flatten().copied();
        let low = corners().fold(DVec2::INFINITY, DVec2::min);
        let size = corners().fold(DVec2::NEG_INFINITY, DVec2::max) - low;
        let size = if size.is_finite() && size.min_element() >= 0.0 { size } else { DVec2::ZERO };
        let mut cell_m = (size.max_element() / 512.0).max(8.0);
        let extents = || {
            outlines.iter().map(|outline| {
                let low = outline.iter().copied().fold(DVec2::INFINITY, DVec2::min);
                outline.iter().copied().fold(DVec2::NEG_INFINITY, DVec2::max) - low
            })
        };
        // Wide polygons lie in many cells: coarser cells keep the lists short.
        while extents().map(|size| (size.x / cell_m + 1.0) * (size.y / cell_m + 1.0)).sum::<f64>() > MOST_ENTRIES
            && size.max_element() > cell_m
        {
            cell_m *= 2.0;
        }
        let [columns, rows] = size.to_array().map(|side| (side / cell_m) as usize + 1);
        let mut index = Self { outlines, low, cell_m, columns, rows, cells: vec![Vec::new(); columns * rows] };
        for number in 0..index.outlines.len() {
            let corners = || index.outlines[number].iter().copied();
            let (low, high) =
                (corners().fold(DVec2::INFINITY, DVec2::min), corners().fold(DVec2::NEG_INFINITY, DVec2::max));
            let ([low_column, low_row], [high_column, high_row]) = (index.cell(low), index.cell(high));
            for row in low_row..=high_row {
                for column in low_column..=high_column {
                    index.cells[row * index.columns + column].push(number as u32);
                }
            }
        }
        index
    }

    fn cell(&self, point: DVec2) -> [usize; 2] {
        let at = (point - self.low) / self.cell_m;
        [(at.x.max(0.0) as usize).min(self.columns - 1), (at.y.max(0.0) as usize).min(self.rows - 1)]
    }

    /// Numbers of the polygons that contain a point.
    pub fn at(&self, point: DVec2) -> impl Iterator<Item = usize> + '_ {
        let [column, row] = self.cell(point);
        let near = self.cells[row * self.columns + column].iter().map(|number| *number as usize);
        near.filter(move |number| contains(&self.outlines[*number], point))
    }

    /// The outlines.
    pub fn outlines(&self) -> &[Vec<DVec2>] {
        &self.outlines
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn shape(points: &[(f64, f64)]) -> Vec<DVec2> {
        points.iter().map(|(x, y)| DVec2::new(*x, *y)).collect()
    }

    #[test]
    fn triangles_have_the_area_of_their_polygon() {
        for (name, outline) in [
            ("square", shape(&[(0.0, 0.0), (4.0, 0.0), (4.0, 4.0), (0.0, 4.0)])),
            ("clockwise L", shape(&[(0.0, 0.0), (0.0, 6.0), (2.0, 6.0), (2.0, 2.0), (6.0, 2.0), (6.0, 0.0)])),
            (
                "comb",
                shape(&[
                    (0.0, 0.0),
                    (9.0, 0.0),
                    (9.0, 5.0),
                    (8.0, 1.0),
                    (6.0, 5.0),
                    (5.0, 1.0),
                    (3.0, 5.0),
                    (1.0, 1.0),
                ]),
            ),
        ] {
            let triangles = triangulated(&outline);
            assert_eq!(triangles.len(), outline.len() - 2, "{name}");
            let sum: f64 = triangles.iter().map(|t| twice_area_m2(&t.map(|k| outline[k as usize])).abs()).sum();
            assert!((sum - twice_area_m2(&outline).abs()).abs() < 1e-9, "{name}");
        }
        assert!(triangulated(&shape(&[(0.0, 0.0), (1.0, 0.0)])).is_empty());
    }

    #[test]
    fn a_band_cuts_a_polygon_straight() {
        let square = shape(&[(0.0, 0.0), (4.0, 0.0), (4.0, 4.0), (0.0, 4.0)]);
        let cut = clipped_to_band(&square, DVec2::X, 1.0, 2.5);
        assert!((twice_area_m2(&cut) - 12.0).abs() < 1e-12);
        assert!(clipped_to_band(&square, DVec2::X, 5.0, 6.0).is_empty());
    }

    #[test]
    fn the_index_finds_what_contains_a_point() {
        let outlines = (0..40).map(|i| {
            let x = f64::from(i) * 3.0;
            shape(&[(x, 0.0), (x + 5.0, 0.0), (x + 5.0, 90.0), (x, 90.0)])
        });
        let index = PolygonIndex::new(outlines.collect());
        assert_eq!(index.at(DVec2::new(31.0, 50.0)).collect::<Vec<_>>(), vec![9, 10]);
        assert_eq!(index.at(DVec2::new(31.0, 95.0)).count(), 0);
        assert_eq!(PolygonIndex::new(Vec::new()).at(DVec2::ZERO).count(), 0);
    }
}
