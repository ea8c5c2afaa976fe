//! Table `objects`: what the instance ids of the images stand for, box by box.

use super::{Cell, Column, Kind, Table};
use cosfly_maps::{Obstacle, ObstacleKind, SemanticLabel, Town};
use cosfly_render::frame::object_instance;

/// One box of an object of a town.
#[derive(Clone, Debug, PartialEq)]
pub struct ObjectRecord {
    /// The town's name.
    pub town: String,
    /// Number of the box among those of its object, from 0.
    pub part: u32,
    /// The box.
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

    /// The id in instance images.
    pub fn instance(&self) -> u32 {
        object_instance(self.obstacle.object_id)
    }

    /// What kind of thing it is, as text.
    pub fn kind(&self) -> &'static str {
        kind_name(self.obstacle.kind)
    }
}

/// The name of a kind in tables.
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
    }
}

/// The names of all CARLA labels; a label's id is its place.
const LABELS: [&str; SemanticLabel::ALL.len()] = {
    let mut names = [""; SemanticLabel::ALL.len()];
    let mut i = 0;
    while i < names.len() {
        names[i] = SemanticLabel::ALL[i].name();
        i += 1;
    }
    names
};

/// The table.
pub fn table() -> Table<ObjectRecord> {
    Table {
        name: "objects",
        doc: "The boxes behind the instance ids of images and of `frames.occluder_instance`: all obstacles of the town. \
              Id 0 is ground and sky, 1 the target; ids after those of all objects are people, see table `people`.",
        key: &["town", "instance", "part"],
        rows: |_| 1,
        per_frame: false,
        rows_per_group: 50_000,
        reads_previews: false,
        reads_expert: false,
        columns: vec![
            Column::new("town", Kind::Text, "name of the town", |it, _| (&it.town).into()),
            Column::new("instance", Kind::Integer, "id in instance images", |it, _| it.instance().into()),
            Column::new("part", Kind::Integer, "number of the box among those with this id, from 0", |it, _| {
                it.part.into()
            }),
            Column::new("kind", Kind::Text, "what it is, such as `building` or `tree_crown`", |it, _| it.kind().into()),
            Column::new("label", Kind::Label(&LABELS), "CARLA's label id in semantic images", |it, _| {
                u32::from(it.obstacle.kind.label().id()).into()
            }),
            Column::new("center_in_world_m", Kind::Reals(3), "middle of the box, CARLA's frame", |it, _| {
                it.obstacle.shape.center_in_world.into()
            }),
            Column::new("size_m", Kind::Reals(3), "length along its own x, y and z axis", |it, _| {
                Cell::from(2.0 * it.obstacle.shape.half_extents_m)
            }),
            Column::new("yaw_deg", Kind::Real, "turn around z, positive: x towards y", |it, _| {
                it.obstacle.shape.yaw_rad.to_degrees().into()
            }),
            Column::new("synthetic", Kind::Flag, "it was invented, not in the map file", |it, _| {
                it.obstacle.synthetic.into()
            }),
        ],
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_box_has_its_row_and_parts_are_counted_per_object() {
        let town = crate::sample::town();
        let objects = ObjectRecord::of(&town);
        assert_eq!(objects.len(), town.obstacles.len());
        for pair in objects.windows(2) {
            let same = pair[0].instance() == pair[1].instance();
            assert_eq!(pair[1].part, if same { pair[0].part + 1 } else { 0 });
        }
        assert_eq!(LABELS[12], "Pedestrian");
    }
}
