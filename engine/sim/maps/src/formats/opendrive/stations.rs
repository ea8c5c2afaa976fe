//! Where along a road cross-sections are taken: at every break of its profiles and as densely as its curves ask for.

use super::network::{LaneEdge, LaneSection, Road, RoadLane};
use super::road_geometry::LaneSpan;
use cosfly_frames::DVec3;
use cosfly_town::error::MapError;

/// Largest distance between a lane edge and the straight piece that stands for it, metres.
const CHORD_ERROR_M: f64 = 0.02;
/// Shortest piece that is still divided, metres.
const SHORTEST_M: f64 = 0.05;
/// Most lane edges over all cross-sections of one file; far more than any city needs.
const MOST_LANE_EDGES: usize = 8_000_000;
/// Most places that are looked at as ends of cross-sections.
const MOST_BREAKS: usize = 200_000_000;

/// A cross-section: every lane edge of a section at one s.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct CrossSection {
    pub(super) s_m: f64,
    /// Lanes of the left and of the right side from the centre outwards.
    pub(super) spans: [Vec<LaneSpan>; 2],
    /// The two edges of each of those lanes, in the map.
    pub(super) points: [Vec<[DVec3; 2]>; 2],
}

/// Counts the work on cross-sections over the whole file and refuses absurd maps.
#[derive(Debug, Default)]
pub(super) struct StationBudget {
    lane_edges: usize,
    breaks: usize,
}

/// The cross-sections of a lane section from its start to its end, none farther than `longest_m` from the next.
pub(super) fn cross_sections(
    road: &Road,
    section: &LaneSection,
    longest_m: f64,
    budget: &mut StationBudget,
) -> Result<Vec<CrossSection>, MapError> {
    let mut out: Vec<CrossSection> = Vec::new();
    for s_m in breaks(road, section, budget)? {
        budget.take_cross_section(road, section)?;
        let next = cross_section(road, section, s_m)?;
        if let Some(before) = out.last().cloned() {
            divide(road, section, before, &next, longest_m, &mut out, budget)?;
        }
        out.push(next);
    }
    Ok(out)
}

/// Sorted stations at which some polynomial of the section begins or ends.
fn breaks(road: &Road, section: &LaneSection, budget: &mut StationBudget) -> Result<Vec<f64>, MapError> {
    let (start, end) = (section.start_s_m, section.end_s_m);
    let mut stations = vec![start, end];
    stations.extend(road.plan.iter().map(|element| element.start_s_m));
    for profile in [&road.elevation, &road.superelevation, &road.lane_offset, &road.crossfall[0], &road.crossfall[1]] {
        stations.extend(profile.records().iter().map(|record| record.start_s_m));
    }
    stations.extend(road.shapes.iter().map(|shape| shape.s_m));
    for lane in section.left.iter().chain(&section.right) {
        let (LaneEdge::Width(profile) | LaneEdge::Border(profile)) = &lane.edge;
        stations.extend(profile.records().iter().map(|record| record.start_s_m));
        stations.extend(lane.heights.iter().map(|height| height.s_m));
    }
    budget.take_breaks(road, stations.len())?;
    stations.retain(|s_m| (start..=end).contains(s_m));
    stations.sort_by(f64::total_cmp);
    // Breaks closer than a centimetre make no visible difference; both ends always stay.
    let mut kept: Vec<f64> = Vec::with_capacity(stations.len());
    for s_m in stations {
        if kept.last().is_none_or(|last| s_m - last > 0.01) {
            kept.push(s_m);
        }
    }
    if kept.len() > 1 && kept.last().is_some_and(|last| end - last <= 0.01) {
        kept.pop();
    }
    if kept.last().is_some_and(|last| *last < end) {
        kept.push(end);
    }
    Ok(kept)
}

/// Adds the cross-sections between two neighbours by halving until every edge is straight enough.
fn divide(
    road: &Road,
    section: &LaneSection,
    from: CrossSection,
    to: &CrossSection,
    longest_m: f64,
    out: &mut Vec<CrossSection>,
    budget: &mut StationBudget,
) -> Result<(), MapError> {
    let mut low = from;
    // The stack holds the ends still to be reached, nearest last; each is at least halved, so it stays short.
    let mut ends = vec![to.clone()];
    while let Some(high) = ends.last() {
        budget.take_cross_section(road, section)?;
        let length_m = high.s_m - low.s_m;
        let middle = cross_section(road, section, 0.5 * (low.s_m + high.s_m))?;
        if length_m > SHORTEST_M && (length_m > longest_m || !is_straight(road, section, &low, &middle, high)?) {
            ends.push(middle);
        } else {
            low = ends.pop().expect("the loop looked at the last end");
            if !ends.is_empty() {
                out.push(low.clone());
            }
        }
    }
    Ok(())
}

impl StationBudget {
    fn take_cross_section(&mut self, road: &Road, section: &LaneSection) -> Result<(), MapError> {
        self.lane_edges += 1 + section.left.len() + section.right.len();
        if self.lane_edges <= MOST_LANE_EDGES { Ok(()) } else { Err(too_much(road)) }
    }

    fn take_breaks(&mut self, road: &Road, count: usize) -> Result<(), MapError> {
        self.breaks += count;
        if self.breaks <= MOST_BREAKS { Ok(()) } else { Err(too_much(road)) }
    }
}

fn too_much(road: &Road) -> MapError {
    let message =
        format!("the map needs more than {MOST_LANE_EDGES} lane edges in cross-sections (road `{}`)", road.id);
    MapError::new(message).hint("curvatures or widths of this file may be absurd; cut it into smaller pieces")
}

fn is_straight(
    road: &Road,
    section: &LaneSection,
    low: &CrossSection,
    middle: &CrossSection,
    high: &CrossSection,
) -> Result<bool, MapError> {
    if deviation_m(low, high, middle, 0.5) > CHORD_ERROR_M {
        return Ok(false);
    }
    // An S-bend crosses its chord in the middle, so the quarters are looked at, too.
    for share in [0.25, 0.75] {
        let s_m = low.s_m + share * (high.s_m - low.s_m);
        if deviation_m(low, high, &cross_section(road, section, s_m)?, share) > CHORD_ERROR_M {
            return Ok(false);
        }
    }
    Ok(true)
}

fn deviation_m(low: &CrossSection, high: &CrossSection, between: &CrossSection, share: f64) -> f64 {
    let mut worst_m = 0.0_f64;
    for side in 0..2 {
        for ((a, b), p) in low.points[side].iter().zip(&high.points[side]).zip(&between.points[side]) {
            for edge in 0..2 {
                worst_m = worst_m.max(a[edge].lerp(b[edge], share).distance(p[edge]));
            }
        }
    }
    worst_m
}

/// All lane edges of `section` at `s`; refuses points that are not finite or farther than 10^9 m away.
pub(super) fn cross_section(road: &Road, section: &LaneSection, s_m: f64) -> Result<CrossSection, MapError> {
    let plan = road.plan_point(s_m);
    let (sin, cos) = cosfly_frames::real::sin_cos(plan.heading_rad);
    let normal = cosfly_frames::DVec2::new(-sin, cos);
    let mut out = CrossSection { s_m, spans: Default::default(), points: Default::default() };
    for side in 0..2 {
        road.lane_spans(section, side, s_m, &mut out.spans[side]);
        out.points[side] = out.spans[side]
            .iter()
            .map(|span| core::array::from_fn(|i| (plan.position_in_map + span.t_m[i] * normal).extend(span.z_m[i])))
            .collect();
        let lanes: &[RoadLane] = section.sides()[side].1;
        for ((span, points), lane) in out.spans[side].iter().zip(&out.points[side]).zip(lanes) {
            let width_m = (span.t_m[1] - span.t_m[0]).abs();
            let near = |point: &DVec3| point.is_finite() && point.abs().max_element() < 1e9 && point.z.abs() < 1e5;
            if !points.iter().all(near) || width_m.is_nan() || width_m > 1e3 {
                let message = format!(
                    "lane `{}` of road `{}` is {width_m:.1} m wide at {:.1}, {:.1}, {:.1} (s = {s_m:.2} m); \
                     a lane is at most 1000 m wide and lies within 10^8 m of the origin",
                    lane.id, road.id, points[1].x, points[1].y, points[1].z
                );
                return Err(MapError::new(message));
            }
        }
    }
    Ok(out)
}
