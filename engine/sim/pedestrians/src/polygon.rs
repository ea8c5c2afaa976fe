//! One walkable polygon, cut by a line: the exact kernel under rasters, heights and coverage tests.

use cosfly_domain::WalkableKind;
use cosfly_frames::{DVec2, DVec3};

/// Edges per bounding chunk; long strips along roads have hundreds of edges.
const CHUNK: usize = 16;

/// A polygon by the nonzero winding rule, so strips that overlap themselves have no holes.
#[derive(Clone, Debug)]
pub struct Polygon {
    /// Kind of the ground.
    pub kind: WalkableKind,
    corners: Vec<DVec3>,
    /// Centre and half size of the bounds of each run of edges.
    chunks: Vec<(DVec2, DVec2)>,
    /// Smallest corner.
    pub min: DVec3,
    /// Largest corner.
    pub max: DVec3,
}

/// A piece of a line inside a polygon, with the outline's heights at its two ends.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Interval {
    /// Start along the line, metres.
    pub from: f64,
    /// End along the line, metres.
    pub to: f64,
    /// Height at the start, metres.
    pub z_from: f64,
    /// Height at the end, metres.
    pub z_to: f64,
}

impl Interval {
    /// Height at `u`, linear between the ends.
    pub fn z_at(&self, u: f64) -> f64 {
        let length = self.to - self.from;
        let share = if length > 0.0 { ((u - self.from) / length).clamp(0.0, 1.0) } else { 0.0 };
        self.z_from + share * (self.z_to - self.z_from)
    }
}

/// Crossing of a line and an edge: place along the line, height, change of the winding number.
type Crossing = (f64, f64, i32);

/// Scratch space and result of cutting a polygon with a line.
#[derive(Default)]
pub struct Cut {
    crossings: Vec<Crossing>,
    /// The pieces inside, in order.
    pub intervals: Vec<Interval>,
}

impl Polygon {
    /// A polygon from its finite corners; `None` when there are fewer than three.
    pub fn new(kind: WalkableKind, corners: Vec<DVec3>) -> Option<Self> {
        if corners.len() < 3 {
            return None;
        }
        let (min, max) = bounds(corners.iter().copied());
        let chunks = (0..corners.len())
            .step_by(CHUNK)
            .map(|first| {
                let run = (first..=(first + CHUNK).min(corners.len())).map(|i| corners[i % corners.len()]);
                let (low, high) = bounds(run);
                (0.5 * (low + high).truncate(), 0.5 * (high - low).truncate())
            })
            .collect();
        Some(Self { kind, corners, chunks, min, max })
    }

    /// The edges, as pairs of corners.
    pub fn edges(&self) -> impl Iterator<Item = (DVec3, DVec3)> {
        let next = self.corners.iter().skip(1).chain(self.corners.first());
        self.corners.iter().copied().zip(next.copied())
    }

    /// Fills `cut` with the pieces of the line `origin + u * direction` inside the polygon; `direction` has length 1.
    pub fn cut_by_line(&self, origin: DVec2, direction: DVec2, cut: &mut Cut) {
        cut.crossings.clear();
        cut.intervals.clear();
        for (chunk, (center, half)) in self.chunks.iter().enumerate() {
            let reach = direction.x.abs() * half.y + direction.y.abs() * half.x;
            if direction.perp_dot(*center - origin).abs() > reach + 1e-9 {
                continue;
            }
            let first = chunk * CHUNK;
            for i in first..(first + CHUNK).min(self.corners.len()) {
                let (a, b) = (self.corners[i], self.corners[(i + 1) % self.corners.len()]);
                let (from, to) = (a.truncate() - origin, b.truncate() - origin);
                let (v_from, v_to) = (direction.perp_dot(from), direction.perp_dot(to));
                if (v_from >= 0.0) != (v_to >= 0.0) {
                    let share = v_from / (v_from - v_to);
                    let u = direction.dot(from) + share * direction.dot(to - from);
                    cut.crossings.push((u, a.z + share * (b.z - a.z), if v_to >= 0.0 { 1 } else { -1 }));
                }
            }
        }
        cut.crossings.sort_by(|a, b| a.0.total_cmp(&b.0));
        let (mut winding, mut start) = (0, (0.0, 0.0));
        for &(u, z, change) in &cut.crossings {
            if winding == 0 {
                start = (u, z);
            }
            winding += change;
            if winding == 0 {
                cut.intervals.push(Interval { from: start.0, to: u, z_from: start.1, z_to: z });
            }
        }
    }

    /// Height of the ground at `point`, or `None` outside: linear between the outline's nearest two points
    /// along x or along y, whichever are closer together.
    pub fn height_at(&self, point: DVec2, cut: &mut Cut) -> Option<f64> {
        if point.x < self.min.x || point.y < self.min.y || point.x > self.max.x || point.y > self.max.y {
            return None;
        }
        self.cut_by_line(point, DVec2::X, cut);
        let along_x = *cut.intervals.iter().find(|piece| piece.from <= 0.0 && 0.0 <= piece.to)?;
        self.cut_by_line(point, DVec2::Y, cut);
        let along_y = cut.intervals.iter().find(|piece| piece.from <= 0.0 && 0.0 <= piece.to);
        let shorter = along_y.filter(|piece| piece.to - piece.from < along_x.to - along_x.from).unwrap_or(&along_x);
        Some(shorter.z_at(0.0))
    }
}

fn bounds(points: impl Iterator<Item = DVec3>) -> (DVec3, DVec3) {
    points.fold((DVec3::INFINITY, DVec3::NEG_INFINITY), |(min, max), point| (min.min(point), max.max(point)))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn strip(corners: &[(f64, f64, f64)]) -> Polygon {
        Polygon::new(WalkableKind::Sidewalk, corners.iter().map(|&(x, y, z)| DVec3::new(x, y, z)).collect()).unwrap()
    }

    #[test]
    fn a_height_is_linear_across_the_shorter_way() {
        // A long strip that rises along x: the way across (y) is the shorter one and sees the local height.
        let strip = strip(&[
            (0.0, 0.0, 0.0),
            (50.0, 0.0, 0.0),
            (100.0, 0.0, 10.0),
            (100.0, 2.0, 10.0),
            (50.0, 2.0, 0.0),
            (0.0, 2.0, 0.0),
        ]);
        let mut cut = Cut::default();
        assert_eq!(strip.height_at(DVec2::new(25.0, 1.0), &mut cut), Some(0.0));
        assert!((strip.height_at(DVec2::new(75.0, 1.0), &mut cut).unwrap() - 5.0).abs() < 1e-12);
        assert_eq!(strip.height_at(DVec2::new(75.0, 2.5), &mut cut), None);
    }

    #[test]
    fn a_ring_shaped_strip_has_a_hole_and_no_seam() {
        // Outer square, then the inner square in the other sense, joined at (0, 0)-(4, 4).
        let ring = strip(&[
            (0.0, 0.0, 0.0),
            (20.0, 0.0, 0.0),
            (20.0, 20.0, 0.0),
            (0.0, 20.0, 0.0),
            (0.0, 0.0, 0.0),
            (4.0, 4.0, 0.0),
            (4.0, 16.0, 0.0),
            (16.0, 16.0, 0.0),
            (16.0, 4.0, 0.0),
            (4.0, 4.0, 0.0),
        ]);
        let mut cut = Cut::default();
        assert!(ring.height_at(DVec2::new(2.0, 2.0), &mut cut).is_some());
        assert!(ring.height_at(DVec2::new(10.0, 10.0), &mut cut).is_none());
        ring.cut_by_line(DVec2::new(0.0, 10.0), DVec2::X, &mut cut);
        assert_eq!(
            cut.intervals.iter().map(|piece| (piece.from, piece.to)).collect::<Vec<_>>(),
            [(0.0, 4.0), (16.0, 20.0)]
        );
    }

    #[test]
    fn a_strip_that_overlaps_itself_is_inside_once() {
        let folded = strip(&[
            (0.0, 0.0, 0.0),
            (10.0, 0.0, 0.0),
            (10.0, 5.0, 0.0),
            (5.0, 5.0, 0.0),
            (5.0, -3.0, 0.0),
            (8.0, -3.0, 0.0),
            (8.0, 4.0, 0.0),
            (0.0, 4.0, 0.0),
        ]);
        let mut cut = Cut::default();
        folded.cut_by_line(DVec2::new(0.0, 2.0), DVec2::X, &mut cut);
        assert_eq!(cut.intervals.len(), 1);
        assert_eq!((cut.intervals[0].from, cut.intervals[0].to), (0.0, 10.0));
    }
}
