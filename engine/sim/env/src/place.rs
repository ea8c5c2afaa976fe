//! [`FlightSite`]: the surroundings of a flight, ready for queries.

use cosfly_batch::BatchScene;
use cosfly_domain::{BodyId, OrientedBox, Town, largest_object_instance};
use cosfly_frames::{DVec3, Seed};
use cosfly_geometry::{BoxBvh, SpatialQuery};
use cosfly_render::SceneScan;
use cosfly_sensors::GeoOrigin;
use cosfly_town::GroundIndex;
use std::sync::{Arc, OnceLock};

/// The surroundings of a flight, ready for queries; shared by all episodes of a town.
pub struct FlightSite {
    /// All unsimplified boxes.
    pub exact: BoxBvh,
    /// Boxes for planning.
    pub planning_boxes: Vec<OrientedBox>,
    ground: GroundIndex,
    lowest_m: f64,
    largest_object: u32,
    looks: Seed,
    /// The scan that pictures show.
    scan: SceneScan,
    /// The town as pictures show it.
    town: Arc<Town>,
    without_colours: OnceLock<BatchScene>,
    with_colours: OnceLock<BatchScene>,
}

impl FlightSite {
    /// The surroundings in a town; `looks` draws the look of its buildings.
    pub fn new(town: Arc<Town>, looks: Seed) -> Self {
        Self {
            exact: BoxBvh::build(town.obstacles.iter().map(|obstacle| obstacle.shape).collect()),
            planning_boxes: town.planning_boxes.clone(),
            ground: GroundIndex::new(&town),
            lowest_m: town.min_in_world.z.min(0.0),
            largest_object: largest_object_instance(&town),
            looks,
            scan: SceneScan::default(),
            town,
            without_colours: OnceLock::new(),
            with_colours: OnceLock::new(),
        }
    }

    /// The surroundings, with pictures of a scan.
    #[must_use]
    pub fn with_scan(self, scan: SceneScan) -> Self {
        Self { scan, ..self }
    }

    /// Boxes on flat ground at height 0.
    pub fn on_flat_ground(boxes: Vec<OrientedBox>) -> Self {
        Self {
            exact: BoxBvh::build(boxes.clone()),
            planning_boxes: boxes,
            ground: GroundIndex::of_surfaces(&[], |_| true),
            lowest_m: 0.0,
            ..Self::new(Arc::default(), Seed([0; 32]))
        }
    }

    /// The surroundings prepared for pictures, at the first call, which takes about a second in a town. Boxes on flat ground are not
    /// in pictures. What colours need is prepared where they are asked for only: it is most of the memory.
    pub fn scene(&self, has_colours: bool) -> &BatchScene {
        if !self.scan.is_empty() {
            let scanned = || self.prepared().with_scan(&self.town, self.looks, self.scan.clone());
            return self.with_colours.get_or_init(scanned);
        }
        if has_colours {
            return self.with_colours.get_or_init(|| self.prepared().with_colours(&self.town, self.looks));
        }
        self.without_colours.get_or_init(|| self.prepared())
    }

    fn prepared(&self) -> BatchScene {
        BatchScene::without_colours(&self.town, &self.ground)
    }

    /// Place of the town on the globe.
    pub fn origin(&self) -> GeoOrigin {
        GeoOrigin::of(&self.town.origin)
    }

    /// Instance id of a body in pictures.
    pub fn instance(&self, body: Option<BodyId>) -> u32 {
        body.and_then(|id| id.instance(self.largest_object)).unwrap_or(u32::MAX)
    }

    /// Height of the ground.
    pub fn ground(&self) -> &GroundIndex {
        &self.ground
    }

    /// Height of the ground, metres; the town's lowest point (at most 0) where there is none.
    pub fn ground_m(&self, x: f64, y: f64) -> f64 {
        self.ground.ground_height_m(x, y).unwrap_or(self.lowest_m)
    }

    /// Height of a point above the ground, metres.
    pub fn above_ground_m(&self, point_in_world: DVec3) -> f64 {
        point_in_world.z - self.ground_m(point_in_world.x, point_in_world.y)
    }

    /// Whether a sphere that moves from one point to another, `above_m` over the ground at its end, touches a box or the ground there.
    pub fn collides(&self, [from_in_world, to_in_world]: [DVec3; 2], above_m: f64, radius_m: f64) -> bool {
        above_m < radius_m || self.exact.segment_clearance(from_in_world, to_in_world, radius_m) < radius_m
    }
}
