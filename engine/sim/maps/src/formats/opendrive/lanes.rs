//! Lanes of vehicles, from the lanes of the road's sections.

use super::network::{LaneSection, Road};
use super::stations::CrossSection;
use cosfly_domain::{Lane, LaneKind};
use cosfly_frames::DVec3;
use cosfly_town::world::WorldFromMap;

/// Limit where the file states none: that of towns, m/s.
const USUAL_LIMIT_MPS: f64 = 50.0 / 3.6;
/// Lanes that are narrower somewhere are left out: they begin or end there, metres.
const NARROWEST_M: [f64; 2] = [1.5, 0.6];

/// The lanes of a section. Which of them follow each other is told from the places of their ends: a file's links say the same, and
/// are often missing.
pub(super) fn lanes_of(road: &Road, section: &LaneSection, rows: &[CrossSection], world: &WorldFromMap) -> Vec<Lane> {
    let mut lanes = vec![];
    for (side, (sign, own)) in section.sides().into_iter().enumerate() {
        for (index, lane) in own.iter().enumerate() {
            let Some(kind) = lane.traffic else { continue };
            let width_m = |row: &CrossSection| {
                let [inner, outer] = row.spans[side][index].t_m;
                (outer - inner).abs()
            };
            let width_m = rows.iter().map(width_m).fold(f64::INFINITY, f64::min);
            if width_m < NARROWEST_M[usize::from(kind == LaneKind::Biking)] {
                continue;
            }
            let middle = |row: &CrossSection| -> DVec3 {
                let [inner, outer] = row.points[side][index];
                world.point(0.5 * (inner + outer))
            };
            let along_road = (sign < 0.0) != road.left_hand;
            let points: Vec<DVec3> = match along_road {
                true => rows.iter().map(middle).collect(),
                false => rows.iter().rev().map(middle).collect(),
            };
            let stated = road.speed_limits.iter().rev().find(|(s_m, _)| *s_m <= section.start_s_m + 0.01);
            let limit = lane.speed_limit_mps.or(stated.map(|(_, limit)| *limit)).unwrap_or(USUAL_LIMIT_MPS);
            let built = Lane::new(kind, points, width_m, limit);
            lanes.extend(built.map(|built| Lane { in_junction: road.junction.is_some(), ..built }));
        }
    }
    lanes
}
