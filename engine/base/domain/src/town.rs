//! The town every stage works in: solid obstacles, ground surfaces, walkable polygons, all in one local world frame.

use crate::{Lane, OrientedBox, SemanticLabel};
use cosfly_frames::{DVec2, DVec3};
use serde::{Deserialize, Serialize};

/// A town. World frame: CARLA's (left-handed, x forward, y right, z up, metres), shifted by [`MapOrigin`].
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Town {
    /// Short name, from the recipe or the file.
    pub name: String,
    /// Place of the world frame in the map file's frame.
    pub origin: MapOrigin,
    /// Every solid thing, exact. Certificates and pictures use these. Index = primitive index of queries.
    pub obstacles: Vec<Obstacle>,
    /// A conservative simplification of `obstacles` for planning: every point of an obstacle lies in one
    /// of these boxes or within the tolerance in `simplification` of one.
    pub planning_boxes: Vec<OrientedBox>,
    /// Outcome of the simplification.
    pub simplification: SimplificationReport,
    /// Ground the pedestrians may use.
    pub walkable: Vec<WalkablePolygon>,
    /// Lanes of vehicles, where the map has them.
    #[serde(default)]
    pub lanes: Vec<Lane>,
    /// Roads, pavements, crossings, road marks, terrain: thin, not obstacles, but visible and hit by depth rays.
    pub surfaces: Vec<SurfaceMesh>,
    /// Parts of this town that were invented and are not in the file.
    pub synthetic: Synthetic,
    /// Smallest corner of everything, metres.
    pub min_in_world: DVec3,
    /// Largest corner of everything, metres.
    pub max_in_world: DVec3,
}

/// `x_world = x_map - offset.x`, `y_world = -y_map - offset.y`, `z_world = z_map - offset.z`
/// (OpenDRIVE and other map files are right-handed, so y changes sign).
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct MapOrigin {
    /// Offset after the sign change: whole metres for files far from their own origin, and what the file adds to its
    /// own coordinates before the projection.
    pub offset_m: DVec3,
    /// The file's projection text, if it has one.
    pub geo_reference: Option<String>,
    /// The part of `offset_m` that the file adds to its own coordinates (`<offset>` of OpenDRIVE). Known while maps are
    /// read only.
    #[serde(skip)]
    pub added_by_file_m: DVec3,
}

impl MapOrigin {
    /// Origin where the file adds a vector, map frame, to its coordinates.
    #[must_use]
    pub fn beyond(mut self, added_in_map_m: DVec3) -> Self {
        let added_m = DVec3::new(added_in_map_m.x, -added_in_map_m.y, added_in_map_m.z);
        self.offset_m += added_m;
        self.added_by_file_m += added_m;
        self
    }
}

/// One solid box of the town. A tree, a lamp or a building of several wings is several boxes with one `object_id`.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Obstacle {
    /// Space of the box.
    pub shape: OrientedBox,
    /// Kind of the thing.
    pub kind: ObstacleKind,
    /// Boxes of one thing share this; instance ids of pictures come from it.
    pub object_id: u32,
    /// True when it was invented (a fill option), false when the file has it.
    pub synthetic: bool,
}

/// Kinds of solid things; the renderer dresses them, [`ObstacleKind::label`] gives their CARLA label.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
pub enum ObstacleKind {
    /// A building or a wing of it.
    Building,
    /// A free-standing wall.
    Wall,
    /// A fence or railing.
    Fence,
    /// Trunk of a tree.
    TreeTrunk,
    /// Crown of a tree.
    TreeCrown,
    /// Bush or hedge.
    Bush,
    /// A plain pole.
    Pole,
    /// A street lamp.
    Lamp,
    /// Signal head or mast of a traffic light.
    TrafficLight,
    /// A sign plate.
    TrafficSign,
    /// Guard rail or crash barrier.
    GuardRail,
    /// A bridge deck or pier.
    Bridge,
    /// A parked car.
    Car,
    /// A bin, stop, box or anything else that does not move.
    Static,
    /// A bench.
    Bench,
    /// A market stall.
    Stall,
}

impl ObstacleKind {
    /// CARLA's label of the kind.
    pub fn label(self) -> SemanticLabel {
        match self {
            Self::Building => SemanticLabel::Building,
            Self::Wall => SemanticLabel::Wall,
            Self::Fence => SemanticLabel::Fence,
            Self::TreeTrunk | Self::TreeCrown | Self::Bush => SemanticLabel::Vegetation,
            Self::Pole | Self::Lamp => SemanticLabel::Pole,
            Self::TrafficLight => SemanticLabel::TrafficLight,
            Self::TrafficSign => SemanticLabel::TrafficSign,
            Self::GuardRail => SemanticLabel::GuardRail,
            Self::Bridge => SemanticLabel::Bridge,
            Self::Car => SemanticLabel::Car,
            Self::Static | Self::Bench | Self::Stall => SemanticLabel::Static,
        }
    }
}

/// Outcome of merging, cropping and pruning the boxes (the paper: 65 K -> 2 K).
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct SimplificationReport {
    /// Boxes before.
    pub input_boxes: usize,
    /// Boxes gone because they lie inside or were merged with others.
    pub merged: usize,
    /// Boxes gone because they lie outside the flown region.
    pub cropped: usize,
    /// Boxes gone because they are smaller than the tolerance.
    pub pruned: usize,
    /// Boxes after.
    pub output_boxes: usize,
    /// No point of an original box within the region is farther than this from a box that is kept, metres.
    pub tolerance_m: f64,
    /// Space the kept boxes cover beyond the originals, as a share of the originals' volume.
    pub added_volume_share: f64,
    /// Space of the pruned boxes, as a share of the originals' volume: joined boxes lose none.
    #[serde(default)]
    pub lost_volume_share: f64,
}

/// Kind of ground that a pedestrian walks on.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
pub enum WalkableKind {
    /// Pavement beside a road.
    Sidewalk,
    /// Marked crossing.
    Crossing,
    /// Shoulder used as a documented fallback where a town has no pavement.
    Shoulder,
    /// Open pedestrian ground.
    Plaza,
    /// Carriageway; only joined in where a route must cross it.
    Road,
}

/// A simple polygon of walkable ground; z varies along it.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct WalkablePolygon {
    /// Kind of the ground.
    pub kind: WalkableKind,
    /// Corners in order, not repeated at the end.
    pub outline_in_world: Vec<DVec3>,
    /// True when it was invented.
    pub synthetic: bool,
}

/// A triangle mesh of ground with one label.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct SurfaceMesh {
    /// CARLA's label.
    pub label: SemanticLabel,
    /// Corners.
    pub vertices_in_world: Vec<DVec3>,
    /// Along and across the road at each corner, metres (for textures).
    pub along_across_m: Vec<DVec2>,
    /// Corner indices, both sides visible.
    pub triangles: Vec<[u32; 3]>,
    /// True when it was invented (terrain between roads always is).
    pub synthetic: bool,
}

/// Parts of a town that its file does not have. Every dataset's metadata states them.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Synthetic {
    /// Buildings were filled in.
    pub buildings: bool,
    /// Trees were filled in.
    pub trees: bool,
    /// Street furniture was filled in.
    pub furniture: bool,
    /// In words, for the card: option, seed, counts; and assumptions such as crown sizes of surveyed trunks.
    pub notes: Vec<String>,
}

impl WalkablePolygon {
    /// Corners in plan, metres.
    pub fn plan(&self) -> Vec<DVec2> {
        self.outline_in_world.iter().map(|corner| corner.truncate()).collect()
    }

    /// Mean height of the corners, metres.
    pub fn mean_height_m(&self) -> f64 {
        self.outline_in_world.iter().map(|corner| corner.z).sum::<f64>() / self.outline_in_world.len().max(1) as f64
    }
}

impl Town {
    /// Sets `min_in_world` and `max_in_world` from obstacles, walkable ground and surfaces.
    pub fn update_bounds(&mut self) {
        let mut low = DVec3::INFINITY;
        let mut high = DVec3::NEG_INFINITY;
        let mut grow = |a: DVec3, b: DVec3| (low, high) = (low.min(a), high.max(b));
        for obstacle in &self.obstacles {
            let (a, b) = obstacle.shape.bounds_in_world();
            grow(a, b);
        }
        for point in self.walkable.iter().flat_map(|polygon| &polygon.outline_in_world) {
            grow(*point, *point);
        }
        for point in self.surfaces.iter().flat_map(|mesh| &mesh.vertices_in_world) {
            grow(*point, *point);
        }
        if low.is_finite() && high.is_finite() {
            (self.min_in_world, self.max_in_world) = (low, high);
        }
    }
}
