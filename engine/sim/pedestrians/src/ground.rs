//! The exact walkable ground: kind and height under a point, and whether a step stays on it.

use crate::areas::{AreaConfig, Closed};
use crate::polygon::{Cut, Polygon};
use crate::{PedestrianError, polygon::Interval};
use cosfly_domain::{Town, WalkableKind};
use cosfly_frames::{DVec2, DVec3};

/// Seams between neighbouring polygons up to this width count as ground, metres: map readers cut one
/// pavement into pieces whose outlines agree only to rounding.
pub const SEAM_M: f64 = 0.05;

/// Polygons farther than this above or below a point are another level, metres.
const LEVEL_M: f64 = 1.0;

/// Side of a bucket of the polygon index, metres.
const BUCKET_M: f64 = 8.0;

/// The walkable polygons of a town with an index over them.
#[derive(Clone, Debug)]
pub struct Ground {
    pub(crate) polygons: Vec<Polygon>,
    pub(crate) min: DVec3,
    pub(crate) max: DVec3,
    /// Areas that nobody enters.
    pub(crate) closed: Closed,
    columns: usize,
    buckets: Vec<Vec<u32>>,
}

/// Rank of a kind where polygons overlap; the lowest decides.
pub(crate) fn rank(kind: WalkableKind) -> u8 {
    match kind {
        WalkableKind::Sidewalk => 0,
        WalkableKind::Plaza => 1,
        WalkableKind::Crossing => 2,
        WalkableKind::Shoulder => 3,
        WalkableKind::Road => 4,
    }
}

impl Ground {
    /// Reads the town's walkable polygons, without closed areas; those with fewer than three corners are no ground.
    pub(crate) fn new(town: &Town, areas: &[AreaConfig]) -> Result<Self, PedestrianError> {
        let mut polygons = Vec::with_capacity(town.walkable.len());
        for (polygon, walkable) in town.walkable.iter().enumerate() {
            // 1e8 m is far beyond any map and keeps the sums below finite.
            if let Some(corner) =
                walkable.outline_in_world.iter().position(|point| !point.is_finite() || point.abs().max_element() > 1e8)
            {
                return Err(PedestrianError::BrokenPolygon { polygon, corner });
            }
            polygons.extend(Polygon::new(walkable.kind, walkable.outline_in_world.clone()));
        }
        if polygons.is_empty() {
            return Err(PedestrianError::NoGround);
        }
        let min = polygons.iter().fold(DVec3::INFINITY, |low, polygon| low.min(polygon.min));
        let max = polygons.iter().fold(DVec3::NEG_INFINITY, |high, polygon| high.max(polygon.max));
        for (area, config) in areas.iter().enumerate() {
            let (Some(from), Some(to)) = (config.min_m, config.max_m) else { continue };
            let (low, high) = (DVec2::from(from), DVec2::from(to));
            let meets = |it: &Polygon| it.min.truncate().cmple(high).all() && it.max.truncate().cmpge(low).all();
            if !polygons.iter().any(meets) {
                let ground_m = [min, max].map(|corner| corner.truncate().to_array());
                return Err(PedestrianError::PictureOff { area, picture_m: [from, to], ground_m });
            }
        }
        Ok(Self { polygons, min, max, closed: Closed::new(areas), columns: 0, buckets: vec![] })
    }

    /// Builds the index; called when the extent is known to be sane.
    pub(crate) fn index(&mut self) {
        let size = (self.max - self.min) / BUCKET_M;
        self.columns = size.x as usize + 1;
        self.buckets = vec![vec![]; self.columns * (size.y as usize + 1)];
        for (id, polygon) in self.polygons.iter().enumerate() {
            let low = ((polygon.min - self.min) / BUCKET_M).floor();
            let high = ((polygon.max - self.min) / BUCKET_M).floor();
            for row in low.y as usize..=high.y as usize {
                for column in low.x as usize..=high.x as usize {
                    self.buckets[row * self.columns + column].push(id as u32);
                }
            }
        }
    }

    /// Calls `visit` with every polygon whose bounds may meet the rectangle; some come more than once.
    fn polygons_near(&self, min: DVec2, max: DVec2, visit: &mut dyn FnMut(&Polygon)) {
        let rows = self.buckets.len() / self.columns.max(1);
        if rows == 0 {
            return;
        }
        let bucket = |point: DVec2| ((point - self.min.truncate()) / BUCKET_M).floor();
        let (low, high) = (bucket(min).max(DVec2::ZERO), bucket(max));
        if high.x < 0.0 || high.y < 0.0 || low.x >= self.columns as f64 || low.y >= rows as f64 {
            return;
        }
        for row in low.y as usize..=(high.y as usize).min(rows - 1) {
            for column in low.x as usize..=(high.x as usize).min(self.columns - 1) {
                for &id in &self.buckets[row * self.columns + column] {
                    visit(&self.polygons[id as usize]);
                }
            }
        }
    }

    /// Kind and height of the ground at `point`, of the level nearest to `near_z_m`; `None` outside (a seam is inside).
    pub fn at(&self, point: DVec2, near_z_m: f64) -> Option<(WalkableKind, f64)> {
        let exact = self.exactly_at(point, near_z_m);
        // In a seam, the ground beside it counts.
        exact.or_else(|| {
            [DVec2::X, DVec2::NEG_X, DVec2::Y, DVec2::NEG_Y]
                .iter()
                .find_map(|side| self.exactly_at(point + SEAM_M * *side, near_z_m))
        })
    }

    pub(crate) fn exactly_at(&self, point: DVec2, near_z_m: f64) -> Option<(WalkableKind, f64)> {
        if self.closed.contains(point) {
            return None;
        }
        let mut cut = Cut::default();
        let mut best: Option<(bool, u8, f64, WalkableKind)> = None;
        self.polygons_near(point, point, &mut |polygon| {
            if let Some(z) = polygon.height_at(point, &mut cut) {
                let candidate = ((z - near_z_m).abs() > LEVEL_M, rank(polygon.kind), z, polygon.kind);
                let better = best.is_none_or(|kept| {
                    (candidate.0, candidate.1).cmp(&(kept.0, kept.1)).then(candidate.2.total_cmp(&kept.2)).is_lt()
                });
                if better {
                    best = Some(candidate);
                }
            }
        });
        best.map(|(_, _, z, kind)| (kind, z))
    }

    /// Whether every point of the straight step lies on walkable ground of its own level, seams included.
    pub fn covers(&self, from: DVec3, to: DVec3) -> bool {
        let step = (to - from).truncate();
        let length = step.length();
        let (direction, origin) =
            if length > 0.0 { (step / length, from.truncate()) } else { (DVec2::X, from.truncate()) };
        let (low, high) = (from.min(to), from.max(to));
        let mut cut = Cut::default();
        let mut pieces: Vec<Interval> = vec![];
        self.polygons_near(low.truncate() - SEAM_M, high.truncate() + SEAM_M, &mut |polygon| {
            let apart = (polygon.min - high).max(low - polygon.max);
            if apart.truncate().max_element() > SEAM_M || apart.z > LEVEL_M {
                return;
            }
            polygon.cut_by_line(origin, direction, &mut cut);
            pieces.extend(cut.intervals.iter().filter(|piece| {
                let middle = 0.5 * (piece.from.max(0.0) + piece.to.min(length));
                piece.to >= -SEAM_M
                    && piece.from <= length + SEAM_M
                    && (piece.z_at(middle) - (from.z + (to.z - from.z) * (middle / length.max(1e-9)))).abs() <= LEVEL_M
            }));
        });
        pieces.sort_by(|a, b| a.from.total_cmp(&b.from));
        let mut covered = -0.5 * SEAM_M;
        for piece in &pieces {
            if piece.from > covered + SEAM_M {
                break;
            }
            covered = covered.max(piece.to);
        }
        // The two ends themselves may lie in a seam, but at most half its width from ground.
        !pieces.is_empty() && covered >= length - 0.5 * SEAM_M && !self.closed.meets(from.truncate(), to.truncate())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::grid::test_towns::{rectangle, town};

    fn ground(walkable: Vec<cosfly_domain::WalkablePolygon>) -> Ground {
        let mut ground = Ground::new(&town(walkable, vec![]), &[]).unwrap();
        ground.index();
        ground
    }

    #[test]
    fn a_seam_is_crossed_and_a_gap_is_not() {
        let sidewalk = WalkableKind::Sidewalk;
        let ground = ground(vec![
            rectangle(sidewalk, (0.0, 0.0), (10.0, 2.0), 0.0),
            rectangle(sidewalk, (10.02, 0.0), (20.0, 2.0), 0.0),
            rectangle(sidewalk, (20.3, 0.0), (30.0, 2.0), 0.0),
        ]);
        let step = |a: f64, b: f64| ground.covers(DVec3::new(a, 1.0, 0.0), DVec3::new(b, 1.0, 0.0));
        assert!(step(9.0, 11.0) && step(11.0, 9.0));
        assert!(!step(19.0, 21.0));
        assert!(!step(-0.2, 1.0));
    }

    #[test]
    fn a_bridge_above_is_not_the_ground_below() {
        let ground = ground(vec![
            rectangle(WalkableKind::Sidewalk, (0.0, 0.0), (10.0, 2.0), 0.0),
            rectangle(WalkableKind::Sidewalk, (10.0, 0.0), (20.0, 2.0), 6.0),
            rectangle(WalkableKind::Crossing, (2.0, 0.0), (4.0, 2.0), 6.0),
        ]);
        assert!(!ground.covers(DVec3::new(9.0, 1.0, 0.0), DVec3::new(11.0, 1.0, 0.0)));
        assert_eq!(ground.at(DVec2::new(3.0, 1.0), 5.5), Some((WalkableKind::Crossing, 6.0)));
        assert_eq!(ground.at(DVec2::new(3.0, 1.0), 0.3), Some((WalkableKind::Sidewalk, 0.0)));
    }
}
