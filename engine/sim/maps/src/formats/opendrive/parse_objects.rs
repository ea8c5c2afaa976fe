//! `<object>` and `<signal>` into the model.

use super::attributes::{ANGLE, LENGTH, LOOSE_SIZE, OFFSET, STATION, Source, children};
use super::network::{Corner, Crown, ObjectSize, Outline, Repeat, RoadObject, RoadPosition, RoadSignal};
use cosfly_town::error::MapError;
use cosfly_town::solids::Roof;
use roxmltree::Node;

/// Widest and highest plate or light of a signal, metres; larger ones are made as large.
pub(super) const LARGEST_PLATE_M: f64 = 5.0;
/// Highest roof above the walls that a file may state, metres; a higher one is made as high.
const HIGHEST_ROOF_M: f64 = 60.0;

/// The objects of a road; `<objectReference>`s, tunnels and bridges are not things of their own.
pub(super) fn objects<'d>(
    source: &Source<'d>,
    road: Node<'d, 'd>,
    road_length_m: f64,
) -> Result<Vec<RoadObject>, MapError> {
    let nodes = children(road, "objects").flat_map(|objects| children(objects, "object"));
    nodes.map(|node| object(source, node, road_length_m)).collect()
}

fn object<'d>(source: &Source<'d>, node: Node<'d, 'd>, road_length_m: f64) -> Result<RoadObject, MapError> {
    let at = position(source, node, "zOffset", road_length_m)?;
    let size = |name| Ok::<_, MapError>(loose_size_m(source, node, name)?.unwrap_or(0.0));
    let size = ObjectSize {
        length_m: size("length")?,
        width_m: size("width")?,
        height_m: size("height")?,
        radius_m: size("radius")?,
    };
    let lower = |name| node.attribute(name).unwrap_or_default().to_ascii_lowercase();
    let repeats =
        children(node, "repeat").map(|repeat| self::repeat(source, repeat, &at, &size)).collect::<Result<_, _>>()?;
    let nested = children(node, "outlines").flat_map(|outlines| children(outlines, "outline"));
    let outlines = children(node, "outline")
        .chain(nested)
        .map(|outline| self::outline(source, outline, size.height_m, road_length_m))
        .collect::<Result<Vec<_>, _>>()?;
    Ok(RoadObject {
        id: node.attribute("id").unwrap_or_default().to_owned(),
        type_name: lower("type"),
        name: format!("{} {}", lower("name"), lower("subtype")).trim().to_owned(),
        at,
        heading_rad: source.optional_number(node, "hdg", ANGLE)?.unwrap_or(0.0),
        size,
        repeats,
        outlines,
        crown: Crown {
            radius_m: user_data(source, node, "crown_radius")?,
            base_m: user_data(source, node, "crown_base")?,
        },
        roof: roof(source, node)?,
        surface: user_word(node, "surface").map(str::to_owned),
        is_walkable: user_word(node, "walkable") == Some("yes"),
        byte_span: source.start_tag(node),
    })
}

/// `s`, `t` and a height above the road; `s` beyond the road's end is held to it.
fn position<'d>(
    source: &Source<'d>,
    node: Node<'d, 'd>,
    height_name: &str,
    road_length_m: f64,
) -> Result<RoadPosition, MapError> {
    let s_m = source.number(node, "s", STATION)?;
    if s_m > road_length_m + 1.0 {
        source.warn(node, &format!("`s` is {s_m} m, but the road ends at {road_length_m} m; its end is used"));
    }
    Ok(RoadPosition {
        s_m: s_m.clamp(0.0, road_length_m),
        t_m: source.number(node, "t", OFFSET)?,
        z_offset_m: source.optional_number(node, height_name, OFFSET)?.unwrap_or(0.0),
    })
}

/// A size that may be missing, metres. Below 0 it is unknown and counts as 0; other numbers than -1 are a warning then.
fn loose_size_m<'d>(source: &Source<'d>, node: Node<'d, 'd>, name: &str) -> Result<Option<f64>, MapError> {
    let size_m = source.optional_number(node, name, LOOSE_SIZE)?;
    if let Some(size_m) = size_m.filter(|size_m| *size_m < 0.0 && *size_m != -1.0) {
        source.warn(node, &format!("`{name}` is {size_m} m; a size below 0 counts as unknown"));
    }
    Ok(size_m.map(|size_m| size_m.max(0.0)))
}

fn user_data<'d>(source: &Source<'d>, node: Node<'d, 'd>, code: &str) -> Result<Option<f64>, MapError> {
    let found = children(node, "userData").find(|data| data.attribute("code") == Some(code));
    found.map_or(Ok(None), |data| source.optional_number(data, "value", OFFSET))
}

fn user_word<'d>(node: Node<'d, 'd>, code: &str) -> Option<&'d str> {
    children(node, "userData")
        .find(|data| data.attribute("code") == Some(code))
        .and_then(|data| data.attribute("value"))
}

/// The roof above the object's height; level where the file says nothing.
fn roof<'d>(source: &Source<'d>, node: Node<'d, 'd>) -> Result<Roof, MapError> {
    let rise_m = user_data(source, node, "roof_rise")?.unwrap_or(0.0).clamp(0.0, HIGHEST_ROOF_M);
    Ok(match user_word(node, "roof") {
        Some("gabled") => Roof::Gabled { rise_m, ridge_yaw_rad: None },
        Some("hipped") => Roof::Hipped { rise_m },
        Some("flat") | None => Roof::Flat,
        Some(other) => {
            source.warn(
                node,
                &format!("`roof` is `{other}`; it must be `flat`, `gabled` or `hipped`; it is taken as flat"),
            );
            Roof::Flat
        }
    })
}

fn repeat<'d>(
    source: &Source<'d>,
    node: Node<'d, 'd>,
    at: &RoadPosition,
    size: &ObjectSize,
) -> Result<Repeat, MapError> {
    let start_s_m = source.optional_number(node, "s", STATION)?.unwrap_or(at.s_m).max(0.0);
    let length_m = source.number(node, "length", LENGTH)?;
    let either = |[first, last]: [Option<f64>; 2], default: f64| {
        [first.or(last).unwrap_or(default), last.or(first).unwrap_or(default)]
    };
    let offset_m = |name| source.optional_number(node, name, OFFSET);
    let size_m = |name| loose_size_m(source, node, name);
    Ok(Repeat {
        s_m: [start_s_m, start_s_m + length_m],
        distance_m: source.optional_number(node, "distance", LENGTH)?.unwrap_or(0.0),
        t_m: either([offset_m("tStart")?, offset_m("tEnd")?], at.t_m),
        z_offset_m: either([offset_m("zOffsetStart")?, offset_m("zOffsetEnd")?], at.z_offset_m),
        width_m: either([size_m("widthStart")?, size_m("widthEnd")?], size.width_m),
        height_m: either([size_m("heightStart")?, size_m("heightEnd")?], size.height_m),
    })
}

fn outline<'d>(
    source: &Source<'d>,
    node: Node<'d, 'd>,
    object_height_m: f64,
    road_length_m: f64,
) -> Result<Outline, MapError> {
    let mut corners = Vec::new();
    for corner in node.children().filter(Node::is_element) {
        let height_m = || loose_size_m(source, corner, "height").map(|height| height.unwrap_or(object_height_m));
        corners.push(match corner.tag_name().name() {
            "cornerRoad" => Corner::Road { at: position(source, corner, "dz", road_length_m)?, height_m: height_m()? },
            "cornerLocal" => Corner::Local {
                u_m: source.number(corner, "u", OFFSET)?,
                v_m: source.number(corner, "v", OFFSET)?,
                z_m: source.optional_number(corner, "z", OFFSET)?.unwrap_or(0.0),
                height_m: height_m()?,
            },
            _ => continue,
        });
    }
    let is_hole = node.attribute("outer") == Some("false");
    Ok(Outline { closed: node.attribute("closed") != Some("false"), is_hole, corners })
}

/// The signals of a road that stand beside it; painted ones have no height.
pub(super) fn signals<'d>(
    source: &Source<'d>,
    road: Node<'d, 'd>,
    road_length_m: f64,
) -> Result<Vec<RoadSignal>, MapError> {
    let nodes = children(road, "signals").flat_map(|signals| children(signals, "signal"));
    nodes.map(|node| signal(source, node, road_length_m)).collect()
}

fn signal<'d>(source: &Source<'d>, node: Node<'d, 'd>, road_length_m: f64) -> Result<RoadSignal, MapError> {
    let at = position(source, node, "zOffset", road_length_m)?;
    let size = |name| {
        let size_m = loose_size_m(source, node, name)?.unwrap_or(0.0);
        if size_m > LARGEST_PLATE_M {
            source.warn(node, &format!("`{name}` is {size_m} m; a plate or light is at most {LARGEST_PLATE_M} m"));
        }
        Ok::<_, MapError>(size_m)
    };
    let turned = if node.attribute("orientation") == Some("-") { cosfly_frames::real::PI } else { 0.0 };
    Ok(RoadSignal {
        id: node.attribute("id").unwrap_or_default().to_owned(),
        at,
        heading_rad: turned + source.optional_number(node, "hOffset", ANGLE)?.unwrap_or(0.0),
        width_m: size("width")?,
        height_m: size("height")?,
        is_light: node.attribute("dynamic") == Some("yes"),
    })
}
