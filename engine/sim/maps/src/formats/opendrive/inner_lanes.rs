//! Lanes without a kind inside of the ways through junctions: paved where carriageways are on both of their sides.
//!
//! A way that begins beside its road's line has such a lane between the line and its first paved lane. It crosses other ways of the
//! junction, whose files say nothing of it: there it is carriageway. Beside grass it stays grass.

use super::network::{RoadLane, RoadLaneKind};
use super::stations::CrossSection;
use cosfly_domain::SemanticLabel;
use cosfly_frames::DVec3;
use cosfly_town::GroundIndex;
use cosfly_town::mesh::MeshBuilder;
use cosfly_town::world::WorldFromMap;

/// Longest piece that is paved or not as a whole, metres.
const PIECE_M: f64 = 1.0;
/// Distance beyond the road's line at which a carriageway must lie, metres.
const BEYOND_M: f64 = 0.5;
/// Largest difference of heights to that carriageway, metres.
const LEVEL_M: f64 = 0.5;
/// Height of the paved pieces above the lanes of grass that they cover, metres.
const ABOVE_GRASS_M: f64 = 0.01;
/// Most pieces of a strip; longer ones are of absurd roads.
const MOST_PIECES: f64 = 1000.0;

/// A piece of such lanes, world frame: ends at the road's line, then those at the paved lane, both in the direction of the road.
pub(super) struct InnerStrip {
    inner: [DVec3; 2],
    outer: [DVec3; 2],
}

/// The strips of one lane section.
pub(super) fn strips(lanes: [&[RoadLane]; 2], rows: &[CrossSection], world: &WorldFromMap) -> Vec<InnerStrip> {
    let mut strips = vec![];
    for (side, lanes) in lanes.into_iter().enumerate() {
        let first = lanes.iter().position(|lane| lane.kind != RoadLaneKind::None).unwrap_or(0);
        let is_paved = |lane: &RoadLane| matches!(lane.kind, RoadLaneKind::Carriageway | RoadLaneKind::Shoulder);
        if first == 0 || !is_paved(&lanes[first]) {
            continue;
        }
        strips.extend(rows.windows(2).map(|pair| {
            let ends =
                |lane: usize, edge: usize| [0, 1].map(|row: usize| world.point(pair[row].points[side][lane][edge]));
            InnerStrip { inner: ends(0, 0), outer: ends(first - 1, 1) }
        }));
    }
    strips
}

/// Paves the parts of strips that lie between carriageways; `ground` is all ground so far. Gives the number of strips with such parts.
pub(super) fn pave(builder: &mut MeshBuilder, ground: &GroundIndex, strips: &[InnerStrip]) -> usize {
    strips.iter().filter(|strip| strip.pave(builder, ground)).count()
}

impl InnerStrip {
    fn pave(&self, builder: &mut MeshBuilder, ground: &GroundIndex) -> bool {
        let length_m = (self.inner[1] - self.inner[0]).length().max((self.outer[1] - self.outer[0]).length());
        let pieces = (length_m / PIECE_M).ceil().clamp(1.0, MOST_PIECES) as usize;
        let at = |ends: &[DVec3; 2], piece: f64| ends[0].lerp(ends[1], piece / pieces as f64);
        let mut is_any_paved = false;
        for piece in 0..pieces {
            let (begin, end) = (piece as f64, piece as f64 + 1.0);
            if is_beside_road(ground, at(&self.inner, begin + 0.5), at(&self.outer, begin + 0.5)) {
                let corners =
                    [at(&self.inner, begin), at(&self.inner, end), at(&self.outer, end), at(&self.outer, begin)];
                let raised = corners.map(|corner| (corner + ABOVE_GRASS_M * DVec3::Z, corner.truncate()));
                builder.quad(SemanticLabel::Roads, true, raised);
                is_any_paved = true;
            }
        }
        is_any_paved
    }
}

/// Whether carriageway lies beyond the inner end of a cut through a strip.
fn is_beside_road(ground: &GroundIndex, inner: DVec3, outer: DVec3) -> bool {
    let Some(beyond) = (inner - outer).with_z(0.0).try_normalize() else { return false };
    let near = ground.ground_near(inner + BEYOND_M * beyond);
    near.is_some_and(|it| it.label == SemanticLabel::Roads && (it.height_m - inner.z).abs() <= LEVEL_M)
}

#[cfg(test)]
mod tests {
    use super::*;
    use cosfly_frames::DVec2;

    /// A carriageway over `from_m..to_m` along x on one side of a strip of 40 m, and the length
    /// of the strip that is paved.
    fn paved_m(from_m: f64, to_m: f64, height_m: f64) -> f64 {
        let mut builder = MeshBuilder::default();
        let corners = [(from_m, -4.0), (to_m, -4.0), (to_m, 0.0), (from_m, 0.0)];
        builder.quad(SemanticLabel::Roads, false, corners.map(|(x, y)| (DVec3::new(x, y, height_m), DVec2::ZERO)));
        let ground = GroundIndex::of_surfaces(&builder.finish(), |_| true);
        let end = |x: f64, y: f64| DVec3::new(x, y, 2.0);
        let strip = InnerStrip { inner: [end(0.0, 0.0), end(40.0, 0.0)], outer: [end(0.0, 3.0), end(40.0, 3.0)] };
        let mut builder = MeshBuilder::default();
        let count = pave(&mut builder, &ground, &[strip]);
        let quads = builder.finish().iter().map(|mesh| mesh.triangles.len() / 2).sum::<usize>();
        assert_eq!(count, usize::from(quads > 0));
        quads as f64 * PIECE_M
    }

    #[test]
    fn strips_are_paved_as_far_as_a_carriageway_is_beyond_them() {
        assert_eq!(paved_m(-5.0, 45.0, 2.0), 40.0);
        assert_eq!(paved_m(10.0, 22.0, 2.1), 12.0);
        assert_eq!(paved_m(-5.0, 45.0, 7.0), 0.0, "a bridge above");
        assert_eq!(paved_m(60.0, 80.0, 2.0), 0.0);
    }
}
