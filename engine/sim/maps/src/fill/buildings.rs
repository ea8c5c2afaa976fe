//! Invented buildings: boxes in line with the street, set back from its edge.

use super::FillConfig;
use super::frontage::Front;
use super::land::{Land, Plot, Use};
use super::site::FillSite;
use cosfly_domain::{ObstacleKind, OrientedBox};
use cosfly_frames::{DVec2, RandomStream};

/// Distance between tries along a front, metres.
const STEP_M: f64 = 1.0;
/// Gap between invented things, metres.
const GAP_M: f64 = 0.3;
/// Depth of a building below the lowest ground under it, metres.
const FOUNDATION_M: f64 = 0.5;
/// Shares of the wanted front and depth that are tried, largest first.
const SIZES: [(f64, f64); 5] = [(1.0, 1.0), (0.85, 0.9), (0.7, 0.8), (0.55, 0.7), (0.45, 0.6)];

/// Puts up buildings along all fronts; gives their number.
pub fn put_up_buildings(
    site: &mut FillSite<'_>,
    land: &mut Land,
    fronts: &[Front],
    config: &FillConfig,
    mut stream: RandomStream,
) -> usize {
    let mut count = 0;
    for front in fronts {
        let mut along_m = 0.5 * STEP_M.min(front.length_m());
        while along_m < front.length_m() {
            if let Some(plot) = free_plot(land, front, along_m, config, &mut stream) {
                land.mark(&plot.corners(0.0), Use::Lot);
                if stream.chance(config.building_density) {
                    build(site, front, along_m, &plot, height_m(config, &mut stream));
                    count += 1;
                }
            }
            along_m += STEP_M;
        }
    }
    count
}

/// Most buildings are low, a few reach the top.
fn height_m(config: &FillConfig, stream: &mut RandomStream) -> f64 {
    let share = stream.unit();
    config.min_height_m + share * share * (config.max_height_m - config.min_height_m).max(0.0)
}

/// A lot behind the front at `along_m`: as large as there is room, no closer to any street than the smallest setback.
fn free_plot(land: &Land, front: &Front, along_m: f64, config: &FillConfig, stream: &mut RandomStream) -> Option<Plot> {
    let (front_m, depth_m) = (stream.uniform(12.0, 26.0), stream.uniform(10.0, 18.0));
    let farthest_m = config.max_setback_m.max(config.min_setback_m);
    let setback_m = stream.uniform(config.min_setback_m, farthest_m);
    let edge = front.at(along_m).truncate();
    for (front_share, depth_share) in SIZES {
        for setback_m in [setback_m, 0.5 * (setback_m + farthest_m), farthest_m] {
            let half_m = 0.5 * DVec2::new(front_share * front_m, depth_share * depth_m);
            let center = edge + front.away * (setback_m + half_m.y);
            let plot = Plot { center, half_m, yaw_rad: front.yaw_rad() };
            if is_free(land, &plot, config.min_setback_m) {
                return Some(plot);
            }
        }
    }
    None
}

/// Whether the plot keeps the setback from all streets and a gap from other lots. Cells mark streets a little too
/// large, so the margin that is asked of them is that much smaller.
fn is_free(land: &Land, plot: &Plot, setback_m: f64) -> bool {
    let margin_m = (setback_m - 1.5 * land.cell_m()).max(0.0);
    land.is_free(&plot.corners(GAP_M), Use::Lot) && land.is_free(&plot.corners(margin_m), Use::Street)
}

fn build(site: &mut FillSite<'_>, front: &Front, along_m: f64, plot: &Plot, height_m: f64) {
    let edge = front.at(along_m);
    let corners = plot.corners(0.0).map(|corner| site.ground_m(corner.extend(edge.z)));
    let lowest_m = corners.into_iter().fold(edge.z, f64::min);
    let bottom_m = lowest_m - FOUNDATION_M;
    let top_m = edge.z + height_m;
    let object_id = site.next_object_id();
    let shape = OrientedBox {
        center_in_world: plot.center.extend(0.5 * (bottom_m + top_m)),
        half_extents_m: plot.half_m.extend(0.5 * (top_m - bottom_m)),
        yaw_rad: plot.yaw_rad,
    };
    site.add(ObstacleKind::Building, object_id, shape);
}
