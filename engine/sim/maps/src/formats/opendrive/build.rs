//! The order of work: text, XML, network, then surfaces, walkable ground and obstacles.

use super::attributes::Source;
use super::network::RoadNetwork;
use super::objects::{MOST_OBSTACLES, ObstacleBuilder};
use super::parse_road;
use super::stations::{StationBudget, cross_sections};
use super::surfaces::{self, DEFAULT_KERB_M, MeshBuilder};
use super::text::{Lines, decoded};
use super::walkable;
use super::world::WorldFromMap;
use crate::{MapConfig, MapError, SimplificationReport, Synthetic, Town};
use cosfly_frames::DVec3;
use roxmltree::{Document, ParsingOptions};

/// Most XML nodes of one file.
const MOST_NODES: u32 = 30_000_000;

/// A parsed road network in the world frame; answers questions about lanes.
#[derive(Clone, Debug, PartialEq)]
pub struct RoadMap {
    /// The network, in the file's frame.
    pub network: RoadNetwork,
    /// From the file's frame to the world.
    pub world: WorldFromMap,
}

/// The middle of a lane.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LanePoint {
    /// World frame, metres.
    pub position_in_world: DVec3,
    /// Yaw in the world frame of the direction in which s grows, radians.
    pub yaw_rad: f64,
    /// Width of the lane, metres.
    pub width_m: f64,
}

impl RoadMap {
    /// Reads the network only; the second value holds warnings.
    pub fn read(bytes: &[u8]) -> Result<(Self, Vec<String>), MapError> {
        with_source(bytes, |source, _| {
            let network = parse_road::network(source)?;
            let world = WorldFromMap::of(&network);
            Ok(Self { network, world })
        })
    }

    /// The middle of lane `lane_id` of road `road_id` at `s_m`; `None` when there is no such road or lane.
    pub fn lane_point(&self, road_id: &str, lane_id: i32, s_m: f64) -> Option<LanePoint> {
        let road = self.network.roads.iter().find(|road| road.id == road_id)?;
        let (position_in_map, heading_rad, width_m) = road.lane_middle(lane_id, s_m)?;
        let position_in_world = self.world.point(position_in_map);
        Some(LanePoint { position_in_world, yaw_rad: self.world.yaw_rad(heading_rad), width_m })
    }
}

/// Parses the XML and hands it on; collects the warnings.
fn with_source<T>(
    bytes: &[u8],
    work: impl FnOnce(&Source<'_>, &Lines<'_>) -> Result<T, MapError>,
) -> Result<(T, Vec<String>), MapError> {
    let text = decoded(bytes)?;
    let lines = Lines::new(&text);
    let options = ParsingOptions { allow_dtd: false, nodes_limit: MOST_NODES, ..ParsingOptions::default() };
    let document = Document::parse_with_options(&text, options).map_err(|error| broken_xml(&error, &text, &lines))?;
    let source = Source::new(&document, &lines);
    let done = work(&source, &lines)?;
    Ok((done, source.into_warnings()))
}

fn broken_xml(error: &roxmltree::Error, text: &str, lines: &Lines<'_>) -> MapError {
    let position = error.pos();
    let at = lines.byte_at(position.row, position.col);
    // The parser's own text ends with the position, which the place says better.
    let reason = error.to_string();
    let reason = reason.rsplit_once(" at ").map_or(reason.as_str(), |(before, _)| before);
    let truncated = at + 1 >= text.trim_end().len() || matches!(error, roxmltree::Error::UnclosedRootNode);
    let hint = if truncated {
        "the file seems to be cut off: fetch or export it again"
    } else {
        "repair the XML at this place, or export the map again"
    };
    let place = lines.place(at..at + 1, String::new());
    MapError::new(format!("broken XML: {reason}")).at(place).hint(hint)
}

/// Reads a file into a town without planning boxes and bounds.
pub(super) fn town(bytes: &[u8], options: &MapConfig) -> Result<(Town, Vec<String>), MapError> {
    let mut notes = Vec::new();
    let ((town, more), mut warnings) = with_source(bytes, |source, lines| {
        let mut network = parse_road::network(source)?;
        let raised = network.roads.iter_mut().map(surfaces::raise_default_kerbs).fold(false, |a, b| a | b);
        if raised {
            notes.push(format!("pavements without a height in the file are raised by {DEFAULT_KERB_M} m"));
        }
        build(network, options, lines, notes)
    })?;
    warnings.extend(more);
    Ok((town, warnings))
}

fn build(
    network: RoadNetwork,
    options: &MapConfig,
    lines: &Lines<'_>,
    mut notes: Vec<String>,
) -> Result<(Town, Vec<String>), MapError> {
    let world = WorldFromMap::of(&network);
    let mut meshes = MeshBuilder::default();
    let mut walkable = Vec::new();
    let mut obstacles = ObstacleBuilder::default();
    let mut budget = StationBudget::default();
    let mut warnings = Vec::new();
    let longest_m = options.sample_step_m.clamp(0.5, 1000.0);
    for road in &network.roads {
        for (index, section) in road.sections.iter().enumerate() {
            let placed = |error: MapError| match error.place {
                Some(_) => error,
                None => error.at(lines.place(road.byte_span.clone(), format!("<road> `{}`", road.id))),
            };
            let rows = cross_sections(road, section, longest_m, &mut budget).map_err(placed)?;
            surfaces::add_section(&mut meshes, section.sides().map(|(_, lanes)| lanes), &rows, &world);
            let rows = cross_sections(road, section, walkable::LONGEST_PIECE_M, &mut budget).map_err(placed)?;
            walkable::add_section(&mut walkable, road, index, &rows, options.shoulders_as_sidewalks, &world);
        }
        for object in &road.objects {
            obstacles.add(road, object, &world);
        }
    }
    if obstacles.without_size > 0 {
        warnings.push(format!("{} objects without a usable size or height are left out", obstacles.without_size));
    }
    if obstacles.left_out > 0 {
        let message = format!("the map has more than {MOST_OBSTACLES} solid boxes");
        return Err(MapError::new(message).hint("a `repeat` with a tiny `distance` may be the cause"));
    }
    if obstacles.assumed_crowns > 0 {
        notes.push(format!(
            "crowns of {} trees are assumed (radius 0.2 of the height within 1 to 4.5 m, from 0.35 of the height up): \
             the file gives trunks only",
            obstacles.assumed_crowns
        ));
    }
    if walkable.is_empty() {
        return Err(no_walkable_ground(&network));
    }
    let town = Town {
        name: network.name.clone().unwrap_or_else(|| "town".to_owned()),
        origin: world.origin(network.geo_reference.clone()),
        obstacles: obstacles.obstacles,
        planning_boxes: Vec::new(),
        simplification: SimplificationReport::default(),
        walkable,
        surfaces: meshes.finish(),
        synthetic: Synthetic { notes, ..Synthetic::default() },
        min_in_world: DVec3::ZERO,
        max_in_world: DVec3::ZERO,
    };
    Ok((town, warnings))
}

fn no_walkable_ground(network: &RoadNetwork) -> MapError {
    let has_shoulders = network.roads.iter().flat_map(|road| &road.sections).any(|section| {
        section.left.iter().chain(&section.right).any(|lane| lane.kind == super::network::LaneKind::Shoulder)
    });
    let error = MapError::new("the map has no walkable ground: no lane of type `sidewalk` and no crosswalk");
    if has_shoulders {
        error.hint("set `shoulders_as_sidewalks = true` in this stage to let pedestrians use the road shoulders")
    } else {
        error.hint("add lanes of type `sidewalk` to the map, or use another map")
    }
}
