//! Invented street trees and lamps, just beyond the pavement's outer edge so that walkers keep all of it.

use super::FillConfig;
use super::frontage::Front;
use super::land::{Land, Plot, Use};
use super::site::FillSite;
use cosfly_domain::{ObstacleKind, OrientedBox};
use cosfly_frames::{DVec2, DVec3, Seed};
use cosfly_town::crown::crown_boxes;
use std::collections::BTreeMap;

/// Distance between tries along a front, metres.
const STEP_M: f64 = 1.0;
/// Height and half width of a lamp, metres.
const LAMP_M: [f64; 2] = [6.5, 0.08];

/// Plants trees; gives their number.
pub fn plant_trees(
    site: &mut FillSite<'_>,
    land: &mut Land,
    fronts: &[Front],
    config: &FillConfig,
    seed: Seed,
) -> usize {
    let mut stream = seed.stream("fill trees");
    along_fronts(land, fronts, config.tree_spacing_m, 0.2, |foot, yaw_rad| {
        let (trunk_m, crown_m) = (stream.uniform(0.12, 0.2), stream.uniform(1.7, 2.8));
        let (base_m, crown_height_m) = (stream.uniform(2.5, 3.3), stream.uniform(3.5, 6.0));
        let object_id = site.next_object_id();
        let pavement_m = foot.z;
        let foot = foot.with_z(site.ground_m(foot));
        // Where the land falls away from the street, the crown still starts above the walkers' heads.
        let base_m = base_m + (pavement_m - foot.z).max(0.0);
        site.add(ObstacleKind::TreeTrunk, object_id, upright(foot, trunk_m, 0.0, base_m, yaw_rad));
        let crown = upright(foot, crown_m, base_m, base_m + crown_height_m, yaw_rad);
        for layer in crown_boxes(&crown, object_id) {
            site.add(ObstacleKind::TreeCrown, object_id, layer);
        }
    })
}

/// Puts up lamps; gives their number.
pub fn put_up_lamps(site: &mut FillSite<'_>, land: &mut Land, fronts: &[Front], config: &FillConfig) -> usize {
    along_fronts(land, fronts, config.lamp_spacing_m, LAMP_M[1], |foot, yaw_rad| {
        let object_id = site.next_object_id();
        let foot = foot.with_z(site.ground_m(foot));
        site.add(ObstacleKind::Lamp, object_id, upright(foot, LAMP_M[1], 0.0, LAMP_M[0], yaw_rad));
    })
}

/// A square post from `from_m` to `to_m` above its foot.
fn upright(foot: DVec3, half_m: f64, from_m: f64, to_m: f64, yaw_rad: f64) -> OrientedBox {
    OrientedBox {
        center_in_world: foot + 0.5 * (from_m + to_m) * DVec3::Z,
        half_extents_m: DVec3::new(half_m, half_m, 0.5 * (to_m - from_m)),
        yaw_rad,
    }
}

/// Calls `place` with free spots beyond the fronts, no two closer than `spacing_m`; gives their number. The spot's z
/// is the pavement's.
fn along_fronts(
    land: &mut Land,
    fronts: &[Front],
    spacing_m: f64,
    half_m: f64,
    mut place: impl FnMut(DVec3, f64),
) -> usize {
    let mut placed = Spots::new(spacing_m);
    let away_m = half_m + 1.5 * land.cell_m() + 0.01;
    for front in fronts {
        let mut along_m = 0.5 * STEP_M.min(front.length_m());
        while along_m < front.length_m() {
            let edge = front.at(along_m);
            let center = edge.truncate() + away_m * front.away;
            let plot = Plot { center, half_m: DVec2::splat(half_m), yaw_rad: front.yaw_rad() };
            let is_free = |of| land.is_free(&plot.corners(0.0), of);
            if placed.is_free_at(center) && is_free(Use::Street) && is_free(Use::Lot) {
                placed.add(center);
                land.mark(&plot.corners(0.0), Use::Lot);
                place(center.extend(edge.z), plot.yaw_rad);
            }
            along_m += STEP_M;
        }
    }
    placed.count
}

/// Points in buckets as large as their least distance.
struct Spots {
    spacing_m: f64,
    buckets: BTreeMap<(i64, i64), Vec<DVec2>>,
    count: usize,
}

impl Spots {
    fn new(spacing_m: f64) -> Self {
        Self { spacing_m, buckets: BTreeMap::new(), count: 0 }
    }

    fn bucket(&self, at: DVec2) -> (i64, i64) {
        let cell = (at / self.spacing_m).floor();
        (cell.x as i64, cell.y as i64)
    }

    fn is_free_at(&self, at: DVec2) -> bool {
        let (column, row) = self.bucket(at);
        let around = (-1..=1).flat_map(|x| (-1..=1).map(move |y| (column + x, row + y)));
        let mut near = around.filter_map(|bucket| self.buckets.get(&bucket)).flatten();
        near.all(|spot| spot.distance(at) >= self.spacing_m)
    }

    fn add(&mut self, at: DVec2) {
        self.buckets.entry(self.bucket(at)).or_default().push(at);
        self.count += 1;
    }
}
