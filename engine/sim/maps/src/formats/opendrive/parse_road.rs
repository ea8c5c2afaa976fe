//! `<header>`, `<road>`, `<planView>`, `<elevationProfile>` and `<lateralProfile>` into the model.

use super::attributes::{ANGLE, COEFFICIENT, COORDINATE, CURVATURE, LENGTH, STATION, Source, children};
use super::header::{self, Header};
use super::network::{Road, RoadNetwork, ShapeSection};
use super::parse_lanes::{lane_sections, speed_limit_mps};
use super::parse_objects::{objects, signals};
use super::plan_view::{Curve, PlanElement, PlanPoint};
use super::polynomial::{Cubic, CubicProfile};
use super::{repeats, unread};
use cosfly_frames::DVec2;
use cosfly_town::error::MapError;
use roxmltree::Node;
use std::collections::BTreeMap;

/// The whole file.
pub(super) fn network(source: &Source<'_>) -> Result<RoadNetwork, MapError> {
    let root = source.document.root_element();
    let Header { name, geo_reference, offset_m, turn_rad, has_lawn } = header::read(source, root)?;
    unread::warn(source, root);
    repeats::warn(source, root);
    let mut lines: BTreeMap<&str, u32> = BTreeMap::new();
    let mut roads = Vec::new();
    for node in children(root, "road") {
        let road = road(source, node)?;
        if let Some(first) = node.attribute("id").and_then(|id| lines.insert(id, source.line(node))) {
            source.warn(node, &format!("the road of line {first} has the same `id`; both are read"));
        }
        roads.push(road);
    }
    if roads.is_empty() {
        return Err(source.refuse(root, "the file has no road").hint("give a file with elements `<road>`"));
    }
    let mut network = RoadNetwork { name, geo_reference, offset_m, has_lawn, roads };
    network.turn(turn_rad);
    Ok(network)
}

fn road<'d>(source: &Source<'d>, node: Node<'d, 'd>) -> Result<Road, MapError> {
    let stated_length_m = source.number(node, "length", LENGTH)?;
    let plan = plan_view(source, node)?;
    let last = plan.last().map_or(0.0, |element| element.start_s_m + element.length_m);
    if (last - stated_length_m).abs() > 0.01 * stated_length_m.max(1.0) {
        source.warn(node, &format!("`length` is {stated_length_m} m, but its geometry is {last} m long"));
    }
    let length_m = stated_length_m.min(last);
    if length_m <= 0.0 {
        source.warn(node, "the road has no length");
    }
    let junction = node.attribute("junction").filter(|id| !id.is_empty() && *id != "-1").map(str::to_owned);
    let lateral = source.only_child(node, "lateralProfile")?;
    let elevation = source.only_child(node, "elevationProfile")?;
    let lanes = source.only_child(node, "lanes")?.ok_or_else(|| source.refuse(node, "the road has no `<lanes>`"))?;
    Ok(Road {
        id: source.text(node, "id")?.to_owned(),
        junction,
        left_hand: node.attribute("rule") == Some("LHT"),
        speed_limits: speed_limits(source, node)?,
        length_m,
        meets_junction: ["predecessor", "successor"].map(|end| {
            let mut ends = children(node, "link").flat_map(|link| children(link, end));
            ends.any(|end| end.attribute("elementType") == Some("junction"))
        }),
        plan,
        elevation: profile(source, elevation, "elevation", &|_| true)?,
        superelevation: profile(source, lateral, "superelevation", &|_| true)?,
        crossfall: crossfall(source, lateral)?,
        shapes: shapes(source, lateral)?,
        lane_offset: profile(source, Some(lanes), "laneOffset", &|_| true)?,
        sections: lane_sections(source, lanes, length_m)?,
        objects: objects(source, node, length_m)?,
        signals: signals(source, node, length_m)?,
        byte_span: source.start_tag(node),
    })
}

/// Limits of the road's types.
fn speed_limits<'d>(source: &Source<'d>, road: Node<'d, 'd>) -> Result<Vec<(f64, f64)>, MapError> {
    let mut limits = vec![];
    for node in children(road, "type") {
        if let Some(limit_mps) = speed_limit_mps(source, node) {
            let s_m = source.optional_number(node, "s", STATION)?.unwrap_or(0.0);
            if limits.iter().any(|&(other_m, other_mps)| other_m == s_m && other_mps != limit_mps) {
                source.warn(node, "a second `<type>` at the same `s` has another limit; this one counts");
            }
            limits.push((s_m, limit_mps));
        }
    }
    limits.sort_by(|a, b| a.0.total_cmp(&b.0));
    Ok(limits)
}

fn plan_view<'d>(source: &Source<'d>, road: Node<'d, 'd>) -> Result<Vec<PlanElement>, MapError> {
    let view = source.only_child(road, "planView")?;
    let view = view.ok_or_else(|| source.refuse(road, "the road has no `<planView>`"))?;
    let station = |node: Node<'d, 'd>| Ok::<_, MapError>((source.number(node, "s", STATION)?, node));
    let mut nodes = children(view, "geometry").map(station).collect::<Result<Vec<_>, _>>()?;
    if let Some(pair) = nodes.windows(2).find(|pair| pair[1].0 < pair[0].0) {
        source.warn(pair[1].1, "`s` is smaller than that of the geometry before it; the geometries are sorted");
        nodes.sort_by(|a, b| a.0.total_cmp(&b.0));
    }
    let mut plan = Vec::new();
    let mut expected_s_m = 0.0_f64;
    for (start_s_m, node) in nodes {
        let length_m = source.number(node, "length", LENGTH)?;
        if (start_s_m - expected_s_m).abs() > 0.01 {
            source.warn(node, &format!("`s` is {start_s_m} m, but the geometry before it ends at {expected_s_m} m"));
        }
        expected_s_m = start_s_m + length_m;
        let position_in_map = DVec2::new(source.number(node, "x", COORDINATE)?, source.number(node, "y", COORDINATE)?);
        let start = PlanPoint { position_in_map, heading_rad: source.number(node, "hdg", ANGLE)? };
        plan.push(PlanElement { start_s_m, length_m, start, curve: curve(source, node, length_m)? });
    }
    if plan.is_empty() {
        return Err(source.refuse(view, "the plan view has no `<geometry>`"));
    }
    Ok(plan)
}

fn curve<'d>(source: &Source<'d>, geometry: Node<'d, 'd>, length_m: f64) -> Result<Curve, MapError> {
    let is_shape = |node: &Node| node.is_element() && !unread::ANYWHERE.contains(&node.tag_name().name());
    let mut shapes = geometry.children().filter(is_shape);
    let Some(node) = shapes.next() else {
        return Err(source.refuse(geometry, "the geometry has no shape").hint(SHAPES));
    };
    if let Some(second) = shapes.next() {
        return Err(source.refuse(second, "a second shape of one geometry").hint("keep one of the two"));
    }
    match node.tag_name().name() {
        "line" => Ok(Curve::Line),
        "arc" => {
            let arc = Curve::Arc { curvature_per_m: source.number(node, "curvature", CURVATURE)? };
            check_turn(source, node, arc, length_m)
        }
        "spiral" => {
            let spiral = Curve::Spiral {
                start_per_m: source.number(node, "curvStart", CURVATURE)?,
                end_per_m: source.number(node, "curvEnd", CURVATURE)?,
            };
            check_turn(source, node, spiral, length_m)
        }
        "poly3" => Ok(Curve::poly3(source.coefficients(node, "")?, length_m)),
        "paramPoly3" => {
            let (u, v) = (source.coefficients(node, "U")?, source.coefficients(node, "V")?);
            match node.attribute("pRange").unwrap_or("normalized") {
                "arcLength" => Ok(Curve::by_arc_length(u, v, length_m)),
                "normalized" => Ok(normalized(source, node, u, v, length_m)),
                other => {
                    Err(source.refuse(node, format!("`pRange` is `{other}`; it must be `arcLength` or `normalized`")))
                }
            }
        }
        other => Err(source.refuse(node, format!("`{other}` is not a known shape of a geometry")).hint(SHAPES)),
    }
}

/// Largest turn of one geometry, radians: sixteen times round.
const MOST_TURN_RAD: f64 = 100.0;

/// Refuses curvatures that no road has.
fn check_turn<'d>(source: &Source<'d>, node: Node<'d, 'd>, curve: Curve, length_m: f64) -> Result<Curve, MapError> {
    let turn_rad = match &curve {
        Curve::Arc { curvature_per_m } => curvature_per_m.abs() * length_m,
        Curve::Spiral { start_per_m, end_per_m } => start_per_m.abs().max(end_per_m.abs()) * length_m,
        Curve::Line | Curve::Cubic { .. } => 0.0,
    };
    if turn_rad > MOST_TURN_RAD {
        let name = node.tag_name().name();
        let message = format!("the {name} turns by {turn_rad:.0} rad; a geometry turns by at most {MOST_TURN_RAD} rad");
        return Err(source.refuse(node, message));
    }
    Ok(curve)
}

const SHAPES: &str = "known shapes are line, arc, spiral, poly3 and paramPoly3";

fn normalized<'d>(source: &Source<'d>, node: Node<'d, 'd>, u: [f64; 4], v: [f64; 4], length_m: f64) -> Curve {
    let curve = Curve::normalized(u, v);
    if let Some(own_m) = curve.own_length_m()
        && (own_m - length_m).abs() > 0.01 * length_m.max(1.0)
    {
        source.warn(node, &format!("the curve is {own_m:.3} m long, but its `length` is {length_m} m"));
    }
    curve
}

/// The records called `name` that `keep` accepts; a missing `s` or `sOffset` is an error.
fn profile<'d>(
    source: &Source<'d>,
    parent: Option<Node<'d, 'd>>,
    name: &'static str,
    keep: &dyn Fn(Node) -> bool,
) -> Result<CubicProfile, MapError> {
    let nodes = parent.into_iter().flat_map(|parent| children(parent, name)).filter(|node| keep(*node));
    let records = nodes.map(|node| {
        let cubic =
            Cubic { start_s_m: source.number(node, "s", STATION)?, coefficients: source.coefficients(node, "")? };
        Ok((node, cubic))
    });
    Ok(source.profile(records.collect::<Result<_, MapError>>()?))
}

fn crossfall<'d>(source: &Source<'d>, lateral: Option<Node<'d, 'd>>) -> Result<[CubicProfile; 2], MapError> {
    let side = |wanted: &'static str| {
        profile(source, lateral, "crossfall", &|node: Node| {
            matches!(node.attribute("side"), None | Some("both")) || node.attribute("side") == Some(wanted)
        })
    };
    Ok([side("left")?, side("right")?])
}

fn shapes<'d>(source: &Source<'d>, lateral: Option<Node<'d, 'd>>) -> Result<Vec<ShapeSection>, MapError> {
    let mut records: Vec<(f64, (Node, Cubic))> = Vec::new();
    for node in lateral.into_iter().flat_map(|lateral| children(lateral, "shape")) {
        let t_m = source.number(node, "t", COEFFICIENT)?;
        let cubic = Cubic { start_s_m: t_m, coefficients: source.coefficients(node, "")? };
        records.push((source.number(node, "s", STATION)?, (node, cubic)));
    }
    records.sort_by(|a, b| a.0.total_cmp(&b.0));
    Ok(records
        .chunk_by(|a, b| a.0 == b.0)
        .map(|same| ShapeSection {
            s_m: same[0].0,
            over_t: source.profile(same.iter().map(|(_, record)| *record).collect()),
        })
        .collect())
}
