//! Refuges: where a crossing leads over a median or another piece of grass between carriageways, the ground is paved
//! and level with the road.

use cosfly_domain::SemanticLabel;
use cosfly_frames::{DVec2, DVec3};
use cosfly_town::GroundIndex;
use cosfly_town::mesh::MeshBuilder;

/// Distance of the places across the road that are looked at, metres, and most of them.
const STEP_M: f64 = 0.2;
const MOST_STEPS: f64 = 1000.0;
/// Paved ground beside the crossing, metres.
const BESIDE_M: f64 = 0.3;
/// Pieces lie this far above the grass that they cover and below the road that they meet, metres.
const ABOVE_M: f64 = 0.01;
const BELOW_ROAD_M: f64 = 0.004;
/// Side of the quads, metres.
const QUAD_M: f64 = 0.5;
/// Largest difference of heights between a crossing and its road, metres.
const LEVEL_M: f64 = 0.8;
/// Places beside each other at which the ground is looked at, as shares of a crossing's width.
const PLACES: [f64; 3] = [0.0, 0.5, 1.0];

/// A crossing from above: its walking direction and its spans along and beside it, metres.
#[derive(Clone, Copy, Debug)]
pub(super) struct Walkway {
    pub(super) across: DVec2,
    pub(super) span_m: [f64; 2],
    pub(super) beside_m: [f64; 2],
    pub(super) height_m: f64,
}

impl Walkway {
    /// The ground of an outline that is crossed in a direction (unit vector).
    pub(super) fn new(outline_in_world: &[DVec3], across: DVec2) -> Self {
        let span_m = |along: DVec2| {
            let places = outline_in_world.iter().map(|corner| corner.truncate().dot(along));
            places.fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], at| [low.min(at), high.max(at)])
        };
        let height_m = outline_in_world.iter().map(|corner| corner.z).sum::<f64>() / outline_in_world.len() as f64;
        Self { across, span_m: span_m(across), beside_m: span_m(across.perp()), height_m }
    }

    /// Paves what lies between carriageways and gives the number of pieces; `ground` is all ground so far.
    pub(super) fn pave(&self, builder: &mut MeshBuilder, ground: &GroundIndex) -> usize {
        let [low, high] = self.span_m;
        let steps = ((high - low) / STEP_M).ceil().clamp(1.0, MOST_STEPS) as usize;
        let at = |step: usize| low + (high - low) * (step as f64 / steps as f64);
        let rows: Vec<Row> = (0..=steps).map(|step| self.row(ground, at(step))).collect();
        let (mut count, mut step) = (0, 1);
        while step < steps {
            let end = (step..=steps).find(|at| rows[*at].road_m.is_some()).unwrap_or(steps + 1);
            if let (true, Some(from), Some(to)) =
                (end > step, rows[step - 1].road_m, rows.get(end).and_then(|row| row.road_m))
            {
                self.add(builder, ground, [at(step - 1), at(end)], [from, to]);
                count += 1;
            }
            step = end + 1;
        }
        count
    }

    fn row(&self, ground: &GroundIndex, at_m: f64) -> Row {
        let [right, left] = self.beside_m;
        let height_m = |share: f64| {
            let place = at_m * self.across + (right + share * (left - right)) * self.across.perp();
            let seen = ground.ground_seen(place.extend(self.height_m), LEVEL_M);
            seen.filter(|seen| seen.label == SemanticLabel::Roads).map(|seen| seen.height_m)
        };
        let [a, b, c] = PLACES.map(height_m);
        Row { road_m: a.zip(b).zip(c).map(|((a, _), c)| [a, c]) }
    }

    /// A piece between two places, in quads of half a metre, less those that are road already.
    fn add(&self, builder: &mut MeshBuilder, ground: &GroundIndex, [from, to]: [f64; 2], heights_m: [[f64; 2]; 2]) {
        let [right, left] = [self.beside_m[0] - BESIDE_M, self.beside_m[1] + BESIDE_M];
        let [pieces, strips] =
            [to - from, left - right].map(|side_m| (side_m / QUAD_M).ceil().clamp(1.0, MOST_STEPS) as usize);
        let even = |along: f64, beside: f64| {
            let place =
                (from + along * (to - from)) * self.across + (right + beside * (left - right)) * self.across.perp();
            let [begin_m, end_m] = heights_m.map(|[right_m, left_m]| right_m + beside * (left_m - right_m));
            place.extend(begin_m + along * (end_m - begin_m))
        };
        let road_m = |place: DVec3| {
            let seen = ground.ground_seen(place, LEVEL_M);
            seen.filter(|seen| seen.label == SemanticLabel::Roads).map(|seen| seen.height_m)
        };
        let at = |piece: usize, strip: usize| even(piece as f64 / pieces as f64, strip as f64 / strips as f64);
        for piece in 0..pieces {
            for strip in 0..strips {
                let corners = [(0, 0), (1, 0), (1, 1), (0, 1)].map(|(x, y)| at(piece + x, strip + y));
                let roads_m = corners.map(road_m);
                if roads_m.iter().all(Option::is_some) && road_m(0.5 * (corners[0] + corners[2])).is_some() {
                    continue;
                }
                // Below the road, whose lines stay on top.
                let corner = |k: usize| {
                    let height_m = roads_m[k].map_or(corners[k].z + ABOVE_M, |road_m| road_m - BELOW_ROAD_M);
                    (corners[k].truncate().extend(height_m), corners[k].truncate())
                };
                builder.quad(SemanticLabel::Roads, true, [0, 1, 2, 3].map(corner));
            }
        }
    }
}

/// A cut through a crossing beside its walking direction.
struct Row {
    /// Heights of the road on both sides; `None` where a part of the cut is no road.
    road_m: Option<[f64; 2]>,
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Two carriageways of 5 m with a gap between them, crossed along x; whether the gap is paved, and at which height.
    fn between(label: Option<SemanticLabel>, left_m: f64) -> (usize, Option<f64>) {
        let mut builder = MeshBuilder::default();
        let mut quad = |label: SemanticLabel, [from, to]: [f64; 2], height_m: f64| {
            let corners = [[from, -20.0], [to, -20.0], [to, 20.0], [from, 20.0]].map(DVec2::from);
            builder.quad(label, false, corners.map(|corner| (corner.extend(height_m), corner)));
        };
        quad(SemanticLabel::Roads, [-7.0, -2.0], 0.0);
        quad(SemanticLabel::Roads, [2.0, 7.0], left_m);
        if let Some(label) = label {
            quad(label, [-2.0, 2.0], 0.0);
        }
        let surfaces = builder.finish();
        let ground = GroundIndex::of_surfaces(&surfaces, |_| true);
        let outline = [[-6.0, -1.5], [6.0, -1.5], [6.0, 1.5], [-6.0, 1.5]].map(|[x, y]| DVec3::new(x, y, 0.1));
        let mut builder = MeshBuilder::from_meshes(surfaces);
        let count = Walkway::new(&outline, DVec2::X).pave(&mut builder, &ground);
        let ground = GroundIndex::of_surfaces(&builder.finish(), |_| true);
        let middle = ground.ground_below(DVec3::new(0.1, 0.1, 1.0), 0.0);
        (count, middle.filter(|it| it.label == SemanticLabel::Roads).map(|it| (it.height_m * 1e3).round() * 1e-3))
    }

    #[test]
    fn a_median_is_paved_where_a_crossing_leads_over_it() {
        assert_eq!(between(Some(SemanticLabel::Terrain), 0.0), (1, Some(0.01)));
        assert_eq!(between(None, 0.2), (1, Some(0.115)), "a hole between roads of two heights");
        assert_eq!(between(Some(SemanticLabel::Roads), 0.0), (0, Some(0.0)));
    }
}
