//! Painted lane lines as thin strips just above the road.

use super::line_ends::LineFree;
use super::network::{LaneSection, Paint, Road, RoadLane, RoadMark};
use super::stations::CrossSection;
use cosfly_domain::SemanticLabel;
use cosfly_frames::{DVec2, DVec3, real};
use cosfly_town::mesh::MeshBuilder;
use cosfly_town::world::WorldFromMap;

/// Paint lies this far above the surface below it, metres.
pub(super) const PAINT_ABOVE_M: f64 = 0.02;
/// Most dashes and line pieces of one file.
pub(super) const MOST_STROKES: usize = 400_000;

/// Paints the lines of a file and stops at [`MOST_STROKES`].
#[derive(Debug, Default)]
pub(super) struct LinePainter {
    pub(super) strokes: usize,
    /// Ground without lines.
    pub(super) free: LineFree,
}

impl LinePainter {
    /// Paints all lane lines of one section.
    pub(super) fn paint_section(
        &mut self,
        builder: &mut MeshBuilder,
        road: &Road,
        section: &LaneSection,
        rows: &[CrossSection],
        world: &WorldFromMap,
    ) {
        for (side, (_, lanes)) in section.sides().into_iter().enumerate() {
            for (index, lane) in lanes.iter().enumerate() {
                let edge = |row: &CrossSection| (row.points[side][index][1], row.spans[side][index].t_m[1]);
                self.paint_marks(builder, road, section, &lane.marks, rows, &edge, world);
            }
        }
        let center_side = usize::from(section.left.is_empty());
        let has_lane = |lanes: &[RoadLane]| !lanes.is_empty();
        if has_lane(&section.left) || has_lane(&section.right) {
            let edge = |row: &CrossSection| (row.points[center_side][0][0], row.spans[center_side][0].t_m[0]);
            self.paint_marks(builder, road, section, &section.center_marks, rows, &edge, world);
        }
    }

    #[expect(clippy::too_many_arguments, reason = "one line needs its road, section, marks, rows and edge")]
    fn paint_marks(
        &mut self,
        builder: &mut MeshBuilder,
        road: &Road,
        section: &LaneSection,
        marks: &[RoadMark],
        rows: &[CrossSection],
        edge: &dyn Fn(&CrossSection) -> (DVec3, f64),
        world: &WorldFromMap,
    ) {
        for (i, mark) in marks.iter().enumerate() {
            if self.strokes >= MOST_STROKES || rows.len() < 2 {
                return;
            }
            let Some(paint) = mark.paint else { continue };
            let from_s_m = mark.s_m.max(section.start_s_m);
            let to_s_m = marks.get(i + 1).map_or(section.end_s_m, |next| next.s_m).min(section.end_s_m);
            let at = |s_m: f64| world.point(on_edge(rows, edge, s_m)).truncate();
            let stretches = painted_parts(&paint, from_s_m, to_s_m);
            let free: Vec<[f64; 2]> =
                stretches.into_iter().flat_map(|(low, high)| self.free.pieces([low, high], at)).collect();
            for [low_s_m, high_s_m] in free {
                if self.strokes >= MOST_STROKES {
                    return;
                }
                let sides: &[f64] = if paint.double { &[-1.0, 1.0] } else { &[0.0] };
                for shift in sides {
                    let middle_m = shift * paint.width_m;
                    self.strip(
                        builder,
                        road,
                        rows,
                        edge,
                        [low_s_m, high_s_m],
                        [middle_m - 0.5 * paint.width_m, middle_m + 0.5 * paint.width_m],
                        world,
                    );
                }
            }
        }
    }

    /// A strip along an edge between two stations; `across_m` are its sides relative to the edge.
    #[expect(clippy::too_many_arguments, reason = "a strip is an edge, a range along it and one across it")]
    fn strip(
        &mut self,
        builder: &mut MeshBuilder,
        road: &Road,
        rows: &[CrossSection],
        edge: &dyn Fn(&CrossSection) -> (DVec3, f64),
        [low_s_m, high_s_m]: [f64; 2],
        across_m: [f64; 2],
        world: &WorldFromMap,
    ) {
        let first = rows.partition_point(|row| row.s_m <= low_s_m).saturating_sub(1);
        for pair in rows[first..].windows(2) {
            let (from_s_m, to_s_m) = (pair[0].s_m.max(low_s_m), pair[1].s_m.min(high_s_m));
            if pair[0].s_m >= high_s_m {
                break;
            }
            if to_s_m - from_s_m < 1e-3 {
                continue;
            }
            let corner = |s_m: f64, across_m: f64| {
                // Linear between rows like the surface below, so that the paint follows it.
                let share = ((s_m - pair[0].s_m) / (pair[1].s_m - pair[0].s_m)).clamp(0.0, 1.0);
                let ((a, a_t_m), (b, b_t_m)) = (edge(&pair[0]), edge(&pair[1]));
                let (sin, cos) = real::sin_cos(road.plan_point(s_m).heading_rad);
                let point = a.lerp(b, share) + DVec3::new(-sin * across_m, cos * across_m, PAINT_ABOVE_M);
                (world.point(point), DVec2::new(s_m, a_t_m + share * (b_t_m - a_t_m) + across_m))
            };
            let [right_m, left_m] = across_m;
            let corners =
                [corner(from_s_m, right_m), corner(to_s_m, right_m), corner(to_s_m, left_m), corner(from_s_m, left_m)];
            builder.quad(SemanticLabel::RoadLine, false, corners);
            self.strokes += 1;
        }
    }
}

/// The place of an edge at a station, linear between rows.
fn on_edge(rows: &[CrossSection], edge: &dyn Fn(&CrossSection) -> (DVec3, f64), s_m: f64) -> DVec3 {
    let next = rows.partition_point(|row| row.s_m <= s_m).clamp(1, rows.len() - 1);
    let (low, high) = (&rows[next - 1], &rows[next]);
    let share = ((s_m - low.s_m) / (high.s_m - low.s_m)).clamp(0.0, 1.0);
    edge(low).0.lerp(edge(high).0, share)
}

/// The painted stretches of a line between two stations. Dashes keep step from the start of the line.
fn painted_parts(paint: &Paint, from_s_m: f64, to_s_m: f64) -> Vec<(f64, f64)> {
    let length_m = to_s_m - from_s_m;
    if length_m <= 0.0 {
        return Vec::new();
    }
    let Some(dash) = paint.dash else { return vec![(from_s_m, to_s_m)] };
    let period_m = dash.length_m + dash.space_m;
    let count = (length_m / period_m).ceil().min(MOST_STROKES as f64) as usize;
    (0..count)
        .map(|i| from_s_m + i as f64 * period_m)
        .map(|start| (start, (start + dash.length_m).min(to_s_m)))
        .filter(|(start, end)| end > start)
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::formats::opendrive::network::Dash;

    #[test]
    fn dashes_keep_their_pattern_and_stay_on_their_stretch() {
        let paint = Paint { width_m: 0.1, dash: Some(Dash { length_m: 3.0, space_m: 6.0 }), double: false };
        assert_eq!(painted_parts(&paint, 10.0, 30.0), vec![(10.0, 13.0), (19.0, 22.0), (28.0, 30.0)]);
        assert_eq!(painted_parts(&Paint { dash: None, ..paint }, 1.0, 2.0), vec![(1.0, 2.0)]);
        assert_eq!(painted_parts(&paint, 2.0, 2.0), vec![]);
    }
}
