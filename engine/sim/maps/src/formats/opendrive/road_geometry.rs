//! Points on a road: reference line, heights, lane edges. Map frame (right-handed), metres, radians.

use super::network::{LaneEdge, LaneHeight, LaneSection, Road, RoadLane, ShapeSection};
use super::plan_view::PlanPoint;
use cosfly_frames::{DVec2, DVec3, real};

/// The edges of a lane at one s.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct LaneSpan {
    /// t of the edge towards the centre and of the outer edge.
    pub t_m: [f64; 2],
    /// Heights of the two edges in the map, lane height included.
    pub z_m: [f64; 2],
}

impl Road {
    /// The reference line at `s`, held to the road.
    pub fn plan_point(&self, s_m: f64) -> PlanPoint {
        let after = self.plan.partition_point(|element| element.start_s_m <= s_m);
        self.plan[after.saturating_sub(1)].at(s_m)
    }

    /// The plan position at (`s`, `t`).
    pub fn plan_position(&self, s_m: f64, t_m: f64) -> DVec2 {
        beside(self.plan_point(s_m), t_m)
    }

    /// Height of the road surface at (`s`, `t`): elevation, superelevation or crossfall, and shape.
    /// The roll keeps the plan position of a point, so `t` is measured level.
    pub fn surface_z_m(&self, s_m: f64, t_m: f64) -> f64 {
        self.elevation.value(s_m) + self.cross_z_m(s_m, t_m)
    }

    /// Height against the reference line.
    fn cross_z_m(&self, s_m: f64, t_m: f64) -> f64 {
        let roll = self.superelevation.value(s_m).clamp(-1.5, 1.5);
        let fall = self.crossfall[usize::from(t_m < 0.0)].value(s_m).clamp(-1.5, 1.5);
        let roll_m = if roll == 0.0 { 0.0 } else { t_m * real::tan(roll) };
        let fall_m = if fall == 0.0 { 0.0 } else { t_m.abs() * real::tan(fall) };
        roll_m - fall_m + shape_z_m(&self.shapes, s_m, t_m)
    }

    /// The point of the road surface at (`s`, `t`), `above_m` above it.
    pub fn point(&self, s_m: f64, t_m: f64, above_m: f64) -> DVec3 {
        self.plan_position(s_m, t_m).extend(self.surface_z_m(s_m, t_m) + above_m)
    }

    /// Index of the lane section that holds at `s`.
    pub fn section_at(&self, s_m: f64) -> usize {
        self.sections.partition_point(|section| section.start_s_m <= s_m).saturating_sub(1)
    }

    /// The edges of all lanes on one side of a section, from the centre outwards.
    pub fn lane_spans(&self, section: &LaneSection, side: usize, s_m: f64, out: &mut Vec<LaneSpan>) {
        out.clear();
        let offset_m = self.lane_offset.value(s_m);
        let (sign, lanes) = section.sides()[side];
        let elevation_m = self.elevation.value(s_m);
        let mut inner_t_m = offset_m;
        let mut inner_z_m = elevation_m + self.cross_z_m(s_m, inner_t_m);
        for lane in lanes {
            let outer_t_m = outer_edge_m(lane, sign, inner_t_m, offset_m, s_m);
            let rise_m = if lane.level { 0.0 } else { self.cross_z_m(s_m, outer_t_m) - self.cross_z_m(s_m, inner_t_m) };
            let outer_z_m = inner_z_m + rise_m;
            let [inner_height_m, outer_height_m] = height_m(&lane.heights, s_m);
            let z_m = [inner_z_m + inner_height_m, outer_z_m + outer_height_m];
            out.push(LaneSpan { t_m: [inner_t_m, outer_t_m], z_m });
            (inner_t_m, inner_z_m) = (outer_t_m, outer_z_m);
        }
    }

    /// dt/ds of the two edges of lane `index` on one side, for headings.
    fn edge_slopes(&self, section: &LaneSection, side: usize, index: usize, s_m: f64) -> [f64; 2] {
        let (sign, lanes) = section.sides()[side];
        let offset_slope = self.lane_offset.slope(s_m);
        let mut inner = offset_slope;
        let mut outer = offset_slope;
        for lane in &lanes[..=index] {
            inner = outer;
            outer = match &lane.edge {
                LaneEdge::Width(width) => inner + sign * width.slope(s_m),
                LaneEdge::Border(border) => offset_slope + border.slope(s_m),
            };
        }
        [inner, outer]
    }

    /// Position (map frame), heading, drift and width of the middle of a lane.
    /// The heading is that of growing s. `None` when there is no such lane at `s`.
    pub(super) fn lane_middle(&self, lane_id: i32, s_m: f64) -> Option<(DVec3, f64, f64, f64)> {
        let section = &self.sections[self.section_at(s_m)];
        let side = usize::from(lane_id < 0);
        let index = section.sides()[side].1.iter().position(|lane| lane.id == lane_id)?;
        let mut spans = Vec::new();
        self.lane_spans(section, side, s_m, &mut spans);
        let span = spans[index];
        let t_m = 0.5 * (span.t_m[0] + span.t_m[1]);
        let plan = self.plan_point(s_m);
        let [inner, outer] = self.edge_slopes(section, side, index, s_m);
        let drift = 0.5 * (inner + outer);
        let heading_rad = plan.heading_rad + real::atan(drift);
        let position = beside(plan, t_m).extend(0.5 * (span.z_m[0] + span.z_m[1]));
        Some((position, heading_rad, drift, (span.t_m[1] - span.t_m[0]).abs()))
    }
}

fn beside(plan: PlanPoint, t_m: f64) -> DVec2 {
    let (sin, cos) = real::sin_cos(plan.heading_rad);
    plan.position_in_map + t_m * DVec2::new(-sin, cos)
}

/// t of a lane's outer edge; never on the inner side of `inner_t_m`.
fn outer_edge_m(lane: &RoadLane, sign: f64, inner_t_m: f64, offset_m: f64, s_m: f64) -> f64 {
    match &lane.edge {
        LaneEdge::Width(width) => inner_t_m + sign * width.value(s_m).max(0.0),
        LaneEdge::Border(border) => inner_t_m + sign * (sign * (offset_m + border.value(s_m) - inner_t_m)).max(0.0),
    }
}

/// Heights of the inner and outer edge; linear between records, level beyond them.
fn height_m(heights: &[LaneHeight], s_m: f64) -> [f64; 2] {
    let after = heights.partition_point(|record| record.s_m <= s_m);
    match (after.checked_sub(1).map(|i| heights[i]), heights.get(after)) {
        (None, None) => [0.0, 0.0],
        (Some(only), None) => [only.inner_m, only.outer_m],
        (None, Some(next)) => [next.inner_m, next.outer_m],
        (Some(low), Some(high)) => {
            let share = (s_m - low.s_m) / (high.s_m - low.s_m);
            [low.inner_m + share * (high.inner_m - low.inner_m), low.outer_m + share * (high.outer_m - low.outer_m)]
        }
    }
}

/// Heights across the road, linear between the given cross-sections.
fn shape_z_m(shapes: &[ShapeSection], s_m: f64, t_m: f64) -> f64 {
    let after = shapes.partition_point(|shape| shape.s_m <= s_m);
    match (after.checked_sub(1).map(|i| &shapes[i]), shapes.get(after)) {
        (None, None) => 0.0,
        (Some(only), None) | (None, Some(only)) => only.over_t.value(t_m),
        (Some(low), Some(high)) => {
            let share = (s_m - low.s_m) / (high.s_m - low.s_m);
            let (low_m, high_m) = (low.over_t.value(t_m), high.over_t.value(t_m));
            low_m + share * (high_m - low_m)
        }
    }
}
