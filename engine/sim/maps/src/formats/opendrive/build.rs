//! From the network to a town: surfaces, walkable ground, obstacles.

use super::crossings::{Crosswalk, crosswalks, unmarked_crossings};
use super::document::with_source;
use super::gaps::{self, JunctionArea};
use super::inner_lanes::{self, InnerStrip};
use super::joining::joining_strips;
use super::kerb_stones::{self, Kerb};
use super::lanes::lanes_of;
use super::line_ends::LineFree;
use super::network::{Road, RoadLaneKind, RoadNetwork};
use super::objects::{MOST_OBSTACLES, ObstacleBuilder, ROOF_PITCH_DEG};
use super::options::Roofs;
use super::refuges::Walkway;
use super::road_ends::{self, LaneEnd};
use super::road_marks::{LinePainter, MOST_STROKES};
use super::slits::{self, Edge};
use super::stations::{StationBudget, cross_sections};
use super::surfaces::{self, DEFAULT_KERB_M};
use super::{OpenDriveOptions, ground_patches, islands, parse_road, signals, verges, walkable};
use cosfly_diagnose::counted;
use cosfly_domain::{Lane, Obstacle, ObstacleKind, Synthetic, Town, WalkablePolygon};
use cosfly_frames::{DVec2, DVec3};
use cosfly_town::mesh::MeshBuilder;
use cosfly_town::polygons::PolygonIndex;
use cosfly_town::text::LineStarts;
use cosfly_town::world::WorldFromMap;
use cosfly_town::{GroundIndex, MapError, terrain};
use std::collections::BTreeMap;

/// Reads a file into a town without planning boxes and bounds.
pub(super) fn town(bytes: &[u8], options: &OpenDriveOptions) -> Result<(Town, Vec<String>), MapError> {
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
    options: &OpenDriveOptions,
    lines: &LineStarts<'_>,
    notes: Vec<String>,
) -> Result<(Town, Vec<String>), MapError> {
    let mut parts = Parts { world: WorldFromMap::around(network.plan_points()), notes, ..Parts::default() };
    parts.obstacles.guess_roofs = match options.roofs {
        Roofs::Auto => network.geo_reference.is_some(),
        Roofs::Flat => false,
        Roofs::Pitched => true,
    };
    let has = |kind: RoadLaneKind| network.lanes().any(|lane| lane.kind == kind);
    let assumes_shoulders = options.assume_ground && !options.shoulders_as_sidewalks && !has(RoadLaneKind::Sidewalk);
    let options = &OpenDriveOptions {
        shoulders_as_sidewalks: options.shoulders_as_sidewalks || assumes_shoulders,
        ..options.clone()
    };
    let world = parts.world;
    parts.crosswalks = network.roads.iter().flat_map(|road| crosswalks(road, &world)).collect();
    parts.painter.free = LineFree::within(parts.crosswalks.iter().map(Crosswalk::line_free_outline).collect());
    for road in &network.roads {
        parts.warnings.extend(ground_patches::add(road, &world, &mut parts.meshes, &mut parts.walkable));
        parts.add_lanes(road, options).map_err(|error| match error.place {
            Some(_) => error,
            None => error.at(lines.place(road.byte_span.clone(), format!("<road> `{}`", road.id))),
        })?;
        for object in &road.objects {
            parts.obstacles.add(road, object, &parts.world);
        }
    }
    if !parts.walkable.is_empty() && assumes_shoulders {
        parts.notes.push("pedestrians use the road shoulders: the file has no lane of type `sidewalk`".to_owned());
    }
    if parts.walkable.is_empty() && options.assume_ground {
        parts.add_verges(&network)?;
    }
    if parts.walkable.is_empty() {
        return Err(no_walkable_ground(options));
    }
    if options.signals {
        parts.add_signals(&network);
    }
    if options.unmarked_crossings {
        let arms = |road| unmarked_crossings(road, &parts.crosswalks, options.shoulders_as_sidewalks, &world);
        parts.arms = network.roads.iter().flat_map(arms).collect();
    }
    parts.pave_between_lanes();
    parts.add_crossings(options);
    let coarseness = terrain::add_terrain(&mut parts.meshes, &parts.obstacles.obstacles, terrain::USUAL_MARGIN_M)?;
    parts.warnings.extend(coarseness);
    parts.finish(network)
}

/// The town while it grows.
#[derive(Default)]
struct Parts {
    world: WorldFromMap,
    meshes: MeshBuilder,
    crosswalks: Vec<Crosswalk>,
    /// Crossings at junction arms that the file does not mark.
    arms: Vec<WalkablePolygon>,
    /// Places on medians.
    medians: Vec<DVec3>,
    painter: LinePainter,
    walkable: Vec<WalkablePolygon>,
    lanes: Vec<Lane>,
    obstacles: ObstacleBuilder,
    budget: StationBudget,
    junctions: BTreeMap<String, JunctionArea>,
    inner_strips: Vec<InnerStrip>,
    edges: Vec<Edge>,
    lane_ends: Vec<LaneEnd>,
    kerbs: Vec<Kerb>,
    notes: Vec<String>,
    warnings: Vec<String>,
}

impl Parts {
    /// Surfaces, lane lines and pavements of a road.
    fn add_lanes(&mut self, road: &Road, options: &OpenDriveOptions) -> Result<(), MapError> {
        let longest_m = options.sample_step_m.clamp(0.5, 1000.0);
        let world = self.world;
        for (index, section) in road.sections.iter().enumerate() {
            let rows = cross_sections(road, section, longest_m, &mut self.budget)?;
            self.lanes.extend(lanes_of(road, section, &rows, &world));
            if let Some(junction) = &road.junction {
                let area = self.junctions.entry(junction.clone()).or_insert(JunctionArea::EMPTY);
                rows.iter()
                    .flat_map(|row| row.points.iter().flatten().flatten())
                    .for_each(|it| area.add(world.point(*it)));
                let lanes = section.sides().map(|(_, lanes)| lanes);
                self.inner_strips.extend(inner_lanes::strips(lanes, &rows, &world));
            }
            let lanes = section.sides().map(|(_, lanes)| lanes);
            self.edges.extend(slits::edges(lanes, &rows, &world));
            self.kerbs.extend(kerb_stones::kerbs(section, &rows, &world));
            self.lane_ends.extend(road_ends::ends(lanes, &rows, &world));
            self.medians.extend(islands::places_on_medians(section, &rows, &world));
            surfaces::add_section(&mut self.meshes, lanes, &rows, &world);
            if options.road_marks {
                self.painter.paint_section(&mut self.meshes, road, section, &rows, &world);
            }
            if walkable::has_walkable(section, options.shoulders_as_sidewalks) {
                let rows = cross_sections(road, section, walkable::LONGEST_PIECE_M, &mut self.budget)?;
                walkable::add_section(&mut self.walkable, road, index, &rows, options.shoulders_as_sidewalks, &world);
            }
        }
        Ok(())
    }

    /// Pavements beside the carriageways of a file without ground for pedestrians.
    fn add_verges(&mut self, network: &RoadNetwork) -> Result<(), MapError> {
        let ground = self.ground();
        let (invented, length_m) = verges::verges(network, &ground, &self.world, &mut self.budget, &mut self.meshes)?;
        if !invented.is_empty() {
            self.notes.push(format!(
                "{length_m:.0} m of pavements, {} m wide, beside the carriageways: the file has no ground for \
                 pedestrians",
                verges::WIDTH_M
            ));
        }
        self.walkable = invented;
        Ok(())
    }

    /// Paves what lies between the lanes where crossings and junctions are, and raises medians and islands.
    fn pave_between_lanes(&mut self) {
        let arms = self.arms.iter().map(|arm| {
            let [first, second] = [0, 1].map(|corner| arm.outline_in_world[corner].truncate());
            Walkway::new(&arm.outline_in_world, (second - first).normalize_or(DVec2::X))
        });
        let walkways: Vec<Walkway> = self.crosswalks.iter().map(Crosswalk::walkway).chain(arms).collect();
        let outlines = self.crosswalks.iter().map(Crosswalk::plan).chain(self.arms.iter().map(WalkablePolygon::plan));
        let outlines = PolygonIndex::new(outlines.collect());
        let ground = self.ground();
        let refuges: usize = walkways.iter().map(|walkway| walkway.pave(&mut self.meshes, &ground)).sum();
        slits::close(&mut self.meshes, &ground, &self.edges);
        road_ends::join(&mut self.meshes, &ground, &self.lane_ends);
        let ground = self.ground();
        let things = self.obstacles.obstacles.iter().map(|thing| thing.shape.center_in_world.truncate());
        let things: Vec<DVec2> = things.collect();
        let (mut gaps, mut islands) = (0, core::mem::take(&mut self.medians));
        for area in self.junctions.values() {
            let (count, places) = gaps::pave(&mut self.meshes, &ground, area, &things);
            gaps += count;
            islands.extend(places);
        }
        let strips = inner_lanes::pave(&mut self.meshes, &ground, &self.inner_strips);
        let ground = self.ground();
        let islands = islands::raise(&mut self.meshes, &ground, &outlines, &islands);
        let ground = self.ground();
        let kerbs_m = kerb_stones::lay(&mut self.meshes, &ground, &self.kerbs);
        for (count, what) in [
            (kerbs_m as usize, "m of kerbs without a pavement behind them".to_owned()),
            (refuges, "pieces of medians on crossings are paved".to_owned()),
            (gaps, "gaps between the lanes of junctions are paved".to_owned()),
            (strips, "pieces of lanes without a kind between carriageways of junctions are paved".to_owned()),
            (islands, format!("islands and medians are raised by {DEFAULT_KERB_M} m, with kerbs")),
        ] {
            if count > 0 {
                self.notes.push(format!("{count} {what}"));
            }
        }
    }

    /// All ground so far.
    fn ground(&mut self) -> GroundIndex {
        let surfaces = core::mem::take(&mut self.meshes).finish();
        let ground = GroundIndex::of_surfaces(&surfaces, |_| true);
        self.meshes = MeshBuilder::from_meshes(surfaces);
        ground
    }

    /// Marked crossings with their paint and joints; then what pedestrians need to get across where the file has none.
    fn add_crossings(&mut self, options: &OpenDriveOptions) {
        let marked = core::mem::take(&mut self.crosswalks);
        let outlines = self.walkable.iter().map(WalkablePolygon::plan).collect();
        let heights_m: Vec<f64> = self.walkable.iter().map(WalkablePolygon::mean_height_m).collect();
        let pavements = PolygonIndex::new(outlines);
        let ground = self.ground();
        for crosswalk in &marked {
            if options.road_marks {
                crosswalk.paint(&mut self.meshes, &ground);
            }
            self.walkable.push(crosswalk.polygon());
            self.walkable.extend(crosswalk.joints(&pavements, &heights_m));
        }
        if options.unmarked_crossings {
            self.add_unmarked_crossings(&ground);
        }
    }

    fn add_unmarked_crossings(&mut self, ground: &GroundIndex) {
        let arms = core::mem::take(&mut self.arms);
        if !arms.is_empty() {
            let count = arms.len();
            self.notes.push(format!("{count} unmarked crossings at junction arms without a crosswalk in the file"));
        }
        self.walkable.extend(arms);
        let strips = joining_strips(&self.walkable, &self.obstacles.obstacles, ground, &mut self.meshes);
        if !strips.is_empty() {
            let count = strips.len();
            self.notes
                .push(format!("{count} strips of ground join parts of the walkable ground that the file leaves apart"));
        }
        self.walkable.extend(strips);
    }

    fn add_signals(&mut self, network: &RoadNetwork) {
        let is_pole = |kind| matches!(kind, ObstacleKind::Pole | ObstacleKind::Lamp | ObstacleKind::TrafficLight);
        let own = self.obstacles.obstacles.iter().filter(|obstacle| is_pole(obstacle.kind));
        let poles: Vec<DVec2> = own.map(|obstacle| obstacle.shape.center_in_world.truncate()).collect();
        let mut assumed = self.obstacles.bare_signs;
        for road in &network.roads {
            assumed += signals::add_signals(&mut self.obstacles, road, &poles, &self.world);
        }
        if assumed > 0 {
            self.notes
                .push(format!("{assumed} signs and lights hang at an assumed height: the file gives their foot only"));
        }
    }

    fn finish(mut self, network: RoadNetwork) -> Result<(Town, Vec<String>), MapError> {
        if self.obstacles.left_out > 0 {
            let message = format!("the map has more than {MOST_OBSTACLES} solid boxes");
            return Err(MapError::new(message).hint("a `repeat` with a tiny `distance` may be the cause"));
        }
        if self.obstacles.without_size > 0 {
            let count = self.obstacles.without_size;
            self.warnings.push(format!("{} without a usable size or height left out", counted(count, "object")));
        }
        self.warnings.extend(self.obstacles.coarse.warnings());
        if self.painter.strokes >= MOST_STROKES {
            self.warnings.push(format!("only the first {MOST_STROKES} painted line pieces are kept"));
        }
        if self.obstacles.assumed_crowns > 0 {
            self.notes.push(format!(
                "crowns of {} trees are assumed (radius 0.2 of the height within 1 to 4.5 m, from 0.35 of the \
                 height up): the file gives trunks only",
                self.obstacles.assumed_crowns
            ));
        }
        if self.obstacles.guessed_roofs > 0 {
            self.notes.push(format!(
                "roofs of {} buildings are guessed (gables of {ROOF_PITCH_DEG} degrees above the stated height, which \
                 is taken for the eaves'): the format has no roofs; `roofs = \"flat\"` leaves them out",
                self.obstacles.guessed_roofs
            ));
        }
        let mut surfaces = self.meshes.finish();
        // What the file states is no invention.
        for mesh in surfaces.iter_mut().filter(|mesh| mesh.label == cosfly_domain::SemanticLabel::Terrain) {
            mesh.synthetic &= !network.has_lawn;
        }
        let mut obstacles = self.obstacles.obstacles;
        settle(&mut obstacles, &GroundIndex::of_surfaces(&surfaces, |_| true));
        let town = Town {
            name: network.name.unwrap_or_else(|| "town".to_owned()),
            origin: self.world.origin(network.geo_reference).beyond(network.offset_m),
            obstacles,
            walkable: self.walkable,
            lanes: self.lanes,
            surfaces,
            synthetic: Synthetic { notes: self.notes, ..Synthetic::default() },
            ..Town::default()
        };
        Ok((town, self.warnings))
    }
}

/// Things that hover a little over the terrain, which is our own, reach down to it.
fn settle(obstacles: &mut [Obstacle], ground: &GroundIndex) {
    const HIGHEST_GAP_M: f64 = 3.0;
    let standing = terrain::standing(obstacles);
    for (obstacle, _) in obstacles.iter_mut().zip(standing).filter(|(_, stands)| *stands) {
        let shape = &mut obstacle.shape;
        let foot_m = shape.center_in_world.z - shape.half_extents_m.z;
        let corners = shape.corners_in_world();
        let lowest_m = corners[..4]
            .iter()
            .chain([&shape.center_in_world])
            .filter_map(|corner| ground.ground_below(corner.truncate().extend(foot_m), 0.0))
            .map(|ground| ground.height_m)
            .fold(foot_m, f64::min);
        let gap_m = (foot_m - lowest_m).min(HIGHEST_GAP_M);
        shape.half_extents_m.z += 0.5 * gap_m;
        shape.center_in_world.z -= 0.5 * gap_m;
    }
}

fn no_walkable_ground(options: &OpenDriveOptions) -> MapError {
    let error = MapError::new("the map has no walkable ground: it has no lane of type `sidewalk`");
    if options.assume_ground {
        error.hint("add lanes of type `sidewalk` to the map, or use another map: it has no carriageway, either")
    } else {
        error.hint("leave out `options.assume_ground = false` to let pedestrians walk beside the carriageways")
    }
}
