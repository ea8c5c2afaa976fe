//! Elements that all generated towns share as OpenDRIVE 1.6 text, floats with fixed decimals.

use crate::alignment::{Alignment, Curve};
use crate::relief::Relief;
use crate::things::{Footprint, GeneratedThing, ThingKind};
use cosfly_frames::{DVec2, real};
use std::fmt::Write;

/// Height of pavements above the carriageway, metres.
pub const KERB_M: f64 = 0.15;

/// One line of text.
pub fn line(text: &mut String, content: &str) {
    text.push_str(content);
    text.push('\n');
}

/// A number with fixed decimals and no negative zero.
pub fn fixed(value: f64, decimals: usize) -> String {
    let text = format!("{value:.decimals$}");
    let is_zero = text.trim_start_matches('-').bytes().all(|b| b == b'0' || b == b'.');
    if is_zero { text.trim_start_matches('-').to_owned() } else { text }
}

/// Reference line of a road and its heights.
pub fn write_plan_view(text: &mut String, alignment: &Alignment, relief: &Relief) {
    line(text, "<planView>");
    let mut s_m = 0.0;
    for piece in &alignment.pieces {
        let curve = match piece.curve {
            Curve::Line => "<line/>".to_owned(),
            Curve::Arc { curvature } => format!("<arc curvature=\"{}\"/>", fixed(curvature, 12)),
            Curve::Spiral { start, end } => {
                format!("<spiral curvStart=\"{}\" curvEnd=\"{}\"/>", fixed(start, 12), fixed(end, 12))
            }
        };
        line(
            text,
            &format!(
                "<geometry s=\"{}\" x=\"{}\" y=\"{}\" hdg=\"{}\" length=\"{}\">{curve}</geometry>",
                fixed(s_m, 9),
                fixed(piece.start.at.x, 9),
                fixed(piece.start.at.y, 9),
                fixed(real::wrap_angle_rad(piece.start.heading_rad), 12),
                fixed(piece.length_m, 9)
            ),
        );
        s_m += piece.length_m;
    }
    line(text, "</planView>");
    if relief.is_level() {
        line(text, "<elevationProfile><elevation s=\"0\" a=\"0\" b=\"0\" c=\"0\" d=\"0\"/></elevationProfile>");
        return;
    }
    for ((parent, name), records) in PROFILES.iter().zip(relief.profiles(alignment)) {
        line(text, &format!("<{parent}>"));
        for [s_m, cubic @ ..] in records {
            let [a, b, c, d] = cubic.map(|factor| fixed(factor, 9));
            line(text, &format!("<{name} s=\"{}\" a=\"{a}\" b=\"{b}\" c=\"{c}\" d=\"{d}\"/>", fixed(s_m, 9)));
        }
        line(text, &format!("</{parent}>"));
    }
}

/// Elements of the profiles of a road, and of their records.
const PROFILES: [(&str, &str); 2] = [("elevationProfile", "elevation"), ("lateralProfile", "superelevation")];

/// A height of a corner or a foot.
fn level(height_m: f64) -> String {
    if height_m == 0.0 { "0.0".to_owned() } else { fixed(height_m, 3) }
}

/// One lane: its id, width at start and end, links and marking.
pub struct Lane {
    /// Its id.
    pub id: i64,
    /// Whether it is a pavement.
    pub is_sidewalk: bool,
    /// Width at start and end, metres.
    pub width_m: [f64; 2],
    /// Lanes before and after it.
    pub links: Option<[i64; 2]>,
    /// Type of the line at its outer edge.
    pub mark: &'static str,
}

/// A `<lane>`.
pub fn write_lane(text: &mut String, lane: &Lane, length_m: f64) {
    let kind = if lane.is_sidewalk { "sidewalk" } else { "driving" };
    let link = lane.links.map_or_else(
        || "<link/>".to_owned(),
        |[from, to]| format!("<link><predecessor id=\"{from}\"/><successor id=\"{to}\"/></link>"),
    );
    let growth = (lane.width_m[1] - lane.width_m[0]) / length_m;
    let height = if lane.is_sidewalk {
        format!("<height sOffset=\"0\" inner=\"{KERB_M}\" outer=\"{KERB_M}\"/>")
    } else {
        String::new()
    };
    let speed = if lane.is_sidewalk { "" } else { "<speed sOffset=\"0\" max=\"13.89\" unit=\"m/s\"/>" };
    line(
        text,
        &format!(
            "<lane id=\"{}\" type=\"{kind}\" level=\"false\">{link}<width sOffset=\"0\" a=\"{}\" b=\"{}\" c=\"0\" d=\"0\"/>{}{speed}{height}</lane>",
            lane.id,
            fixed(lane.width_m[0], 4),
            fixed(growth, 12),
            road_mark(lane.mark),
        ),
    );
}

/// A `<roadMark>` over the whole of a lane.
pub fn road_mark(kind: &str) -> String {
    let width = if kind == "none" { "0" } else { "0.12" };
    format!(
        "<roadMark sOffset=\"0\" type=\"{kind}\" weight=\"standard\" color=\"standard\" material=\"standard\" width=\"{width}\" laneChange=\"none\"/>"
    )
}

/// A crossing at a station of a line; `along_m` wide along the street, to `reach_m` on either side. The outline repeats its first corner, as
/// CARLA's own towns do.
pub fn write_crossing(
    text: &mut String,
    id: usize,
    (alignment, s_m): (&Alignment, f64),
    [along_m, reach_m]: [f64; 2],
    relief: &Relief,
) {
    let height_m = |u_m: f64, v_m: f64| {
        let pose = alignment.pose_at(s_m + u_m);
        relief.height_m(pose.at) + v_m * relief.rise(pose.at).dot(pose.left())
    };

    line(
        text,
        &format!(
            "<object id=\"{0}\" name=\"crosswalk_{0}\" type=\"crosswalk\" s=\"{1}\" t=\"0.0\" zOffset=\"0.0\" hdg=\"0.0\" pitch=\"0.0\" roll=\"0.0\" orientation=\"none\" length=\"{2}\" width=\"{3}\">",
            id,
            fixed(s_m, 4),
            fixed(along_m, 2),
            fixed(2.0 * reach_m, 2)
        ),
    );
    text.push_str("<outline closed=\"true\">");
    for (u, v) in [(-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0), (-1.0, -1.0)] {
        let (u_m, v_m) = (0.5 * u * along_m, v * reach_m);
        let z_m = level(height_m(u_m, v_m) - height_m(0.0, 0.0));
        let (u_m, v_m) = (fixed(u_m, 3), fixed(v_m, 3));
        let _ = write!(text, "<cornerLocal u=\"{u_m}\" v=\"{v_m}\" z=\"{z_m}\" height=\"0.0\"/>");
    }
    line(text, "</outline></object>");
}

/// A point in the frame of a straight street.
pub struct Foot {
    /// Station, metres.
    pub s_m: f64,
    /// Distance to the left, metres.
    pub t_m: f64,
    /// Distance along the street from the nearer end, for points beyond the ends, metres.
    pub beyond_m: f64,
    /// The point itself, map frame.
    pub origin: DVec2,
    /// Direction of the street, radians.
    pub heading_rad: f64,
    /// Heights of the ground.
    pub relief: Relief,
}

/// An `<object>`.
pub fn write_object(text: &mut String, id: usize, thing: &GeneratedThing, foot: &Foot) {
    let (kind, name) = thing.kind.type_and_name();
    let (level_m, height_m) =
        if thing.kind == ThingKind::Ground { (thing.height_m, 0.0) } else { (0.0, thing.height_m) };
    let relief = &foot.relief;
    // Where ground is not level, things start at its lowest point and are as much taller.
    let base_m = match &thing.footprint {
        Footprint::Rectangle(lot) => {
            lot.corners().map(|at| relief.height_m(at)).into_iter().fold(f64::INFINITY, f64::min)
        }
        Footprint::Polygon(_) => 0.0,
        Footprint::Disc { center, .. } => relief.height_m(*center),
    };
    let height_m = match &thing.footprint {
        Footprint::Rectangle(lot) if height_m > 0.0 => height_m + relief.height_m(lot.center) - base_m,
        _ => height_m,
    };
    let subtype = if name == "wall" { " subtype=\"wall\"" } else { "" };
    let corners = match &thing.footprint {
        Footprint::Polygon(corners) => Some(corners.clone()),
        Footprint::Rectangle(lot) if foot.beyond_m != 0.0 => Some(lot.corners().to_vec()),
        Footprint::Disc { .. } if foot.beyond_m != 0.0 => return,
        _ => None,
    };
    let (hdg_rad, size) = match &thing.footprint {
        Footprint::Rectangle(lot) if corners.is_none() => (
            real::wrap_angle_rad(lot.heading_rad - foot.heading_rad),
            format!(" length=\"{}\" width=\"{}\"", fixed(2.0 * lot.half_m.x, 3), fixed(2.0 * lot.half_m.y, 3)),
        ),
        Footprint::Disc { radius_m, .. } => (0.0, format!(" radius=\"{}\"", fixed(*radius_m, 3))),
        _ => (0.0, String::new()),
    };
    let _ = write!(
        text,
        "<object id=\"{id}\" name=\"{name}\" type=\"{kind}\"{subtype} s=\"{}\" t=\"{}\" zOffset=\"{}\" hdg=\"{}\" pitch=\"0.0\" roll=\"0.0\" orientation=\"none\"{size} height=\"{}\"",
        fixed(foot.s_m, 4),
        fixed(foot.t_m, 4),
        level(base_m),
        fixed(hdg_rad, 9),
        fixed(height_m, 2)
    );
    let mut content = String::new();
    if let Some(corners) = corners {
        content.push_str("<outlines><outline id=\"0\" closed=\"true\" outer=\"true\">");
        let (sin, cos) = real::sin_cos(foot.heading_rad);
        for corner in corners {
            let away = corner - foot.origin;
            let (u_m, v_m) = (cos * away.x + sin * away.y, cos * away.y - sin * away.x);
            let _ = write!(
                content,
                "<cornerLocal u=\"{}\" v=\"{}\" z=\"{}\" height=\"{}\"/>",
                fixed(u_m, 4),
                fixed(v_m, 4),
                if relief.is_level() && level_m != 0.0 {
                    fixed(level_m, 2)
                } else {
                    level(level_m + relief.height_m(corner))
                },
                fixed(height_m, 2)
            );
        }
        content.push_str("</outline></outlines>");
    }
    for (code, value) in &thing.data {
        let _ = write!(content, "<userData code=\"{code}\" value=\"{value}\"/>");
    }
    line(text, &if content.is_empty() { "/>".to_owned() } else { format!(">{content}</object>") });
}
