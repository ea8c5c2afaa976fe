//! Table `objects`: the objects behind the instance ids of images, box by box.

use super::Table;
use super::column::columns;
use super::value::class_value;
use cosfly_domain::{Obstacle, ObstacleKind, SemanticLabel, Town, object_instance};

/// One box of an object of a town.
#[derive(Clone, Debug, PartialEq)]
pub struct ObjectRecord {
    /// Name of the town.
    pub town: String,
    /// Number of the box among those of its object, from 0.
    pub part: u32,
    /// Obstacle with its shape and kind.
    pub obstacle: Obstacle,
}

impl ObjectRecord {
    /// All boxes of a town, by instance id.
    pub fn of(town: &Town) -> Vec<Self> {
        let mut obstacles: Vec<&Obstacle> = town.obstacles.iter().collect();
        obstacles.sort_by_key(|obstacle| obstacle.object_id);
        let groups = obstacles.chunk_by(|a, b| a.object_id == b.object_id);
        let record = |(part, obstacle): (usize, &&Obstacle)| Self {
            town: town.name.clone(),
            part: part as u32,
            obstacle: (*obstacle).clone(),
        };
        groups.flat_map(|group| group.iter().enumerate().map(record)).collect()
    }

    /// Id in instance images.
    pub fn instance(&self) -> u32 {
        object_instance(self.obstacle.object_id)
    }

    /// Kind of the object as text.
    pub fn kind(&self) -> &'static str {
        kind_name(self.obstacle.kind)
    }
}

/// Name of a kind in tables.
pub fn kind_name(kind: ObstacleKind) -> &'static str {
    match kind {
        ObstacleKind::Building => "building",
        ObstacleKind::Wall => "wall",
        ObstacleKind::Fence => "fence",
        ObstacleKind::TreeTrunk => "tree_trunk",
        ObstacleKind::TreeCrown => "tree_crown",
        ObstacleKind::Bush => "bush",
        ObstacleKind::Pole => "pole",
        ObstacleKind::Lamp => "lamp",
        ObstacleKind::TrafficLight => "traffic_light",
        ObstacleKind::TrafficSign => "traffic_sign",
        ObstacleKind::GuardRail => "guard_rail",
        ObstacleKind::Bridge => "bridge",
        ObstacleKind::Car => "car",
        ObstacleKind::Static => "static",
        ObstacleKind::Bench => "bench",
        ObstacleKind::Stall => "stall",
    }
}

/// Names of all CARLA labels, indexed by label id.
const LABELS: [&str; SemanticLabel::ALL.len()] = {
    let mut names = [""; SemanticLabel::ALL.len()];
    let mut i = 0;
    while i < names.len() {
        names[i] = SemanticLabel::ALL[i].name();
        i += 1;
    }
    names
};

/// Definition of the table.
pub fn table() -> Table<ObjectRecord> {
    let doc = "The boxes behind the instance ids of images and of `frames.occluder_instance`: all obstacles of the town. \
               Id 0 is ground and sky, 1 the target; ids after those of all objects are of people, vehicles and drones, see table `bodies`.";
    Table::new("objects", doc, &["town", "instance", "part"], |_: &ObjectRecord| 1, Objects::COLUMNS)
}

/// Columns of table `objects`.
pub struct Objects;

columns! { Objects::COLUMNS of ObjectRecord;
    /// Name of the town.
    town: String = |it, _| it.town.clone();
    /// Id in instance images.
    instance: u32 = |it, _| it.instance();
    /// Number of the box among those with this id, from 0.
    part: u32 = |it, _| it.part;
    /// Kind of object, such as `building` or `tree_crown`.
    kind: String = |it, _| it.kind().to_owned();
    /// CARLA's label id in semantic images.
    label: SemanticLabel = |it, _| it.obstacle.kind.label();
    /// Centre of the box, world frame: x, y, z.
    center_in_world_m: [f64; 3] = |it, _| it.obstacle.shape.center_in_world.to_array();
    /// Size of the box along its own x, y and z axis.
    size_m: [f64; 3] = |it, _| (2.0 * it.obstacle.shape.half_extents_m).to_array();
    /// Rotation of the box around z; positive: x towards y.
    yaw_deg: f64 = |it, _| it.obstacle.shape.yaw_rad.to_degrees();
    /// Whether the object was generated, not read from the map file.
    synthetic: bool = |it, _| it.obstacle.synthetic;
}

class_value!(SemanticLabel, SemanticLabel::ALL, LABELS);

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_box_has_its_row_and_parts_are_counted_per_object() {
        let town = cosfly_sample::town();
        let objects = ObjectRecord::of(&town);
        assert_eq!(objects.len(), town.obstacles.len());
        for pair in objects.windows(2) {
            let same = pair[0].instance() == pair[1].instance();
            assert_eq!(pair[1].part, if same { pair[0].part + 1 } else { 0 });
        }
        assert_eq!(LABELS[12], "Pedestrian");
    }
}
