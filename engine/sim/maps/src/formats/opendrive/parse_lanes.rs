//! `<laneSection>` and everything in it into the model.

use super::attributes::{OFFSET, SIZE, STATION, Source, child, children};
use super::network::{Dash, LaneEdge, LaneHeight, LaneSection, Paint, RoadLane, RoadLaneKind, RoadMark};
use super::polynomial::{Cubic, CubicProfile};
use cosfly_domain::LaneKind as TrafficKind;
use cosfly_town::error::MapError;
use roxmltree::Node;

/// Widths below 0 by less than this are rounding, metres.
const NO_WIDTH_M: f64 = 0.01;

/// The sections of a road in the order of their start.
pub(super) fn lane_sections<'d>(
    source: &Source<'d>,
    lanes: Node<'d, 'd>,
    road_length_m: f64,
) -> Result<Vec<LaneSection>, MapError> {
    let mut sections: Vec<LaneSection> = Vec::new();
    let mut last_s_m = f64::NEG_INFINITY;
    for node in children(lanes, "laneSection") {
        let start_s_m = source.number(node, "s", STATION)?.max(0.0);
        if start_s_m < last_s_m {
            source.warn(node, "`s` is smaller than that of the section before it; the sections are sorted");
        }
        let is_single_side = node.attribute("singleSide") == Some("true");
        if start_s_m == last_s_m && !is_single_side {
            source.warn(node, "a second lane section at the same `s`; the one before it has no length");
        }
        last_s_m = start_s_m;
        if start_s_m > road_length_m {
            source
                .warn(node, &format!("the section begins at {start_s_m} m, after the end of the road; it is left out"));
            continue;
        }
        let mut section = LaneSection {
            start_s_m,
            end_s_m: road_length_m,
            left: side(source, node, "left", start_s_m)?,
            center_marks: center_marks(source, node, start_s_m)?,
            right: side(source, node, "right", start_s_m)?,
        };
        if is_single_side && let Some(before) = sections.last() {
            // Stations of lane records are along the road, so the other side simply goes on.
            if child(node, "left").is_none() {
                section.left = before.left.clone();
            } else {
                section.right = before.right.clone();
            }
        }
        source.count_lanes(node, section.left.len() + section.right.len())?;
        sections.push(section);
    }
    sections.sort_by(|a, b| a.start_s_m.total_cmp(&b.start_s_m));
    for i in 1..sections.len() {
        sections[i - 1].end_s_m = sections[i].start_s_m;
    }
    if sections.is_empty() {
        return Err(source.refuse(lanes, "the road has no lane section"));
    }
    Ok(sections)
}

fn side<'d>(
    source: &Source<'d>,
    section: Node<'d, 'd>,
    name: &'static str,
    section_s_m: f64,
) -> Result<Vec<RoadLane>, MapError> {
    let nodes = source.only_child(section, name)?.into_iter().flat_map(|side| children(side, "lane"));
    let mut lanes = nodes.map(|node| lane(source, node, section_s_m)).collect::<Result<Vec<_>, _>>()?;
    lanes.sort_by_key(|lane| lane.id.unsigned_abs());
    let wanted_sign = if name == "left" { 1 } else { -1 };
    let before = lanes.len();
    lanes.retain(|lane| lane.id.signum() == wanted_sign);
    lanes.dedup_by_key(|lane| lane.id);
    if lanes.len() != before {
        source.warn(section, &format!("lanes on the {name} with a wrong sign or a repeated id are left out"));
    }
    if let Some((wanted, lane)) = (1..).zip(&lanes).find(|(wanted, lane)| lane.id.unsigned_abs() != *wanted) {
        let missing = wanted as i32 * wanted_sign;
        source.warn(section, &format!("lane `{missing}` is missing; lane `{}` takes its place", lane.id));
    }
    Ok(lanes)
}

fn lane<'d>(source: &Source<'d>, node: Node<'d, 'd>, section_s_m: f64) -> Result<RoadLane, MapError> {
    let id_text = source.text(node, "id")?;
    let id = id_text.trim().parse::<i32>().ok().filter(|id| id.unsigned_abs() <= 1000);
    let id = id
        .ok_or_else(|| source.refuse(node, format!("`id` is `{id_text}`; a lane's id is a whole number up to 1000")))?;
    let widths = edge_records(source, node, "width", section_s_m, SIZE.into_signed())?;
    let borders = edge_records(source, node, "border", section_s_m, OFFSET)?;
    if widths.is_empty() && borders.is_empty() {
        source.warn(node, "the lane has neither `<width>` nor `<border>`; it is 0 m wide");
    }
    let edge =
        if widths.is_empty() && !borders.is_empty() { LaneEdge::Border(borders) } else { LaneEdge::Width(widths) };
    let mut heights = children(node, "height")
        .map(|height| {
            Ok(LaneHeight {
                s_m: section_s_m + source.number(height, "sOffset", STATION)?,
                inner_m: source.optional_number(height, "inner", OFFSET)?.unwrap_or(0.0),
                outer_m: source.optional_number(height, "outer", OFFSET)?.unwrap_or(0.0),
            })
        })
        .collect::<Result<Vec<_>, MapError>>()?;
    heights.sort_by(|a, b| a.s_m.total_cmp(&b.s_m));
    let has_other = |pair: &[LaneHeight]| pair[0].s_m == pair[1].s_m && pair[0] != pair[1];
    if heights.windows(2).any(has_other) {
        source.warn(node, "a second `<height>` at the same `sOffset`; the last one counts");
    }
    let level = matches!(node.attribute("level"), Some("true" | "1"));
    let type_name = node.attribute("type");
    Ok(RoadLane {
        id,
        kind: kind(type_name),
        traffic: type_name.and_then(traffic),
        speed_limit_mps: speed_limit_mps(source, node),
        level,
        edge,
        heights,
        marks: marks(source, node, section_s_m)?,
    })
}

fn edge_records<'d>(
    source: &Source<'d>,
    lane: Node<'d, 'd>,
    name: &'static str,
    section_s_m: f64,
    limits: super::attributes::Limits,
) -> Result<CubicProfile, MapError> {
    let mut records = Vec::new();
    for node in children(lane, name) {
        let start_m = source.number(node, "a", limits)?;
        if name == "width" && start_m < -NO_WIDTH_M {
            source.warn(node, &format!("`a` is {start_m}; widths below 0 count as 0"));
        }
        let cubic = Cubic {
            start_s_m: section_s_m + source.number(node, "sOffset", STATION)?,
            coefficients: source.coefficients(node, "")?,
        };
        records.push((node, cubic));
    }
    Ok(source.profile(records))
}

/// Vehicles that drive in one direction on a lane of a type. Lanes for both directions have none.
fn traffic(type_name: &str) -> Option<TrafficKind> {
    match type_name {
        "driving" | "entry" | "exit" | "offRamp" | "onRamp" | "connectingRamp" | "slipLane" | "mwyEntry"
        | "mwyExit" | "bus" | "taxi" | "HOV" | "hov" => Some(TrafficKind::Driving),
        "biking" => Some(TrafficKind::Biking),
        _ => None,
    }
}

/// The limit of the `<speed>` of a lane or of a road's type, m/s; `None` where it states none. One that is not believed is a
/// warning.
pub(super) fn speed_limit_mps<'d>(source: &Source<'d>, parent: Node<'d, 'd>) -> Option<f64> {
    let mut all = children(parent, "speed");
    let speed = all.next()?;
    let value = |node: Node<'d, 'd>, name: &str| node.attribute(name).map(str::trim);
    let limit = |node| [value(node, "max"), value(node, "unit")];
    let is_other =
        |other: &Node<'d, 'd>| value(*other, "sOffset") == value(speed, "sOffset") && limit(*other) != limit(speed);
    if let Some(second) = all.find(is_other) {
        source.warn(second, "a second `<speed>` at the same place; the first one counts");
    }
    let [max, unit] = limit(speed);
    let unit_mps = match unit {
        Some("km/h") => 1.0 / 3.6,
        Some("mph") => 0.44704,
        Some("m/s") | None => 1.0,
        Some(other) => {
            let shown: String = other.chars().take(40).collect();
            source.warn(speed, &format!("`unit` is `{shown}`, not `m/s`, `km/h` or `mph`; m/s is assumed"));
            1.0
        }
    };
    let max = max.filter(|max| !["no limit", "undefined"].contains(max))?;
    let limit_mps = max.parse().ok().map(|max: f64| max * unit_mps).filter(|limit| (0.5..=150.0).contains(limit));
    if limit_mps.is_none() {
        let shown: String = max.chars().take(40).collect();
        source.warn(speed, &format!("`max` is `{shown}`, no limit of 0.5 to 150 m/s; it counts as missing"));
    }
    limit_mps
}

fn kind(type_name: Option<&str>) -> RoadLaneKind {
    match type_name.unwrap_or("none") {
        "sidewalk" | "walking" => RoadLaneKind::Sidewalk,
        "shoulder" => RoadLaneKind::Shoulder,
        "border" | "curb" => RoadLaneKind::Kerb,
        "median" => RoadLaneKind::Median,
        "tram" | "rail" => RoadLaneKind::Rail,
        "none" => RoadLaneKind::None,
        "driving" | "stop" | "parking" | "biking" | "bidirectional" | "restricted" | "entry" | "exit" | "offRamp"
        | "onRamp" | "connectingRamp" | "slipLane" | "mwyEntry" | "mwyExit" | "bus" | "taxi" | "HOV" | "hov"
        | "roadWorks" | "special1" | "special2" | "special3" | "shared" => RoadLaneKind::Carriageway,
        _ => RoadLaneKind::None,
    }
}

fn center_marks<'d>(source: &Source<'d>, section: Node<'d, 'd>, section_s_m: f64) -> Result<Vec<RoadMark>, MapError> {
    let Some(center) = source.only_child(section, "center")? else { return Ok(Vec::new()) };
    let lane = source.only_child(center, "lane")?;
    lane.map_or(Ok(Vec::new()), |lane| marks(source, lane, section_s_m))
}

fn marks<'d>(source: &Source<'d>, lane: Node<'d, 'd>, section_s_m: f64) -> Result<Vec<RoadMark>, MapError> {
    let mut out = children(lane, "roadMark")
        .map(|node| {
            let s_m = section_s_m + source.optional_number(node, "sOffset", STATION)?.unwrap_or(0.0);
            Ok(RoadMark { s_m, paint: paint(source, node)?, is_kerb: node.attribute("type") == Some("curb") })
        })
        .collect::<Result<Vec<_>, MapError>>()?;
    out.sort_by(|a, b| a.s_m.total_cmp(&b.s_m));
    Ok(out)
}

const DEFAULT_LINE_WIDTH_M: f64 = 0.12;
/// Least and greatest width of painted lines, metres.
const LINE_WIDTHS_M: [f64; 2] = [0.05, 1.0];
/// Dashes of towns where the file gives no pattern.
const DEFAULT_DASH: Dash = Dash { length_m: 3.0, space_m: 6.0 };

fn paint<'d>(source: &Source<'d>, node: Node<'d, 'd>) -> Result<Option<Paint>, MapError> {
    let width_m = source.optional_number(node, "width", SIZE)?.filter(|width_m| *width_m > 0.0);
    let (dashed, double) = match node.attribute("type").unwrap_or("none") {
        "solid" => (false, false),
        "broken" => (true, false),
        "solid solid" => (false, true),
        "solid broken" | "broken solid" => (false, false),
        "broken broken" => (true, true),
        // Kerbs, grass and edges carry no paint; `botts dots` are too small to see from the air.
        _ => return Ok(None),
    };
    let [least_m, most_m] = LINE_WIDTHS_M;
    let drawn_m = width_m.unwrap_or(DEFAULT_LINE_WIDTH_M).clamp(least_m, most_m);
    if let Some(width_m) = width_m.filter(|width_m| *width_m != drawn_m) {
        source
            .warn(node, &format!("`width` is `{width_m}`, no line of {least_m} to {most_m} m; {drawn_m} m are drawn"));
    }
    let line = child(node, "type").and_then(|kind| child(kind, "line"));
    let own_dash = match line {
        Some(line) => Some(Dash {
            length_m: source.optional_number(line, "length", SIZE)?.unwrap_or(0.0),
            space_m: source.optional_number(line, "space", SIZE)?.unwrap_or(0.0),
        }),
        None => None,
    };
    let usable = own_dash.filter(|dash| dash.length_m >= 0.1 && dash.space_m >= 0.1);
    Ok(Some(Paint { width_m: drawn_m, dash: dashed.then(|| usable.unwrap_or(DEFAULT_DASH)), double }))
}
