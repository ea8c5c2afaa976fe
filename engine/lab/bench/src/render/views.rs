//! Towns and views for measurements: a follower behind a walker, and free views of many boxes.

use cosfly_domain::{
    Camera, MapOrigin, Obstacle, ObstacleKind, OrientedBox, SemanticLabel, SimplificationReport, SurfaceMesh,
    Synthetic, Town, WalkableKind,
};
use cosfly_figures::{BodyFigure, BodyShape, gait_phase_rad};
use cosfly_frames::{DVec2, DVec3, Pose, TargetState, real};
use cosfly_geometry::{BoxBvh, SpatialQuery};
use cosfly_maps::{MapConfig, read_town};
use cosfly_places::grid::{GenerateConfig, generate_town};
use cosfly_random::Seed;
use cosfly_render::Scene;
use cosfly_town::MapError;

/// Distance from the camera to the target, metres.
const DISTANCE_M: f64 = 28.0;
const PITCH_DEG: f64 = 45.0;
const HEIGHT_M: f64 = 1.75;
/// Frames of a flight around each view: few, so that nobody walks into a house.
const STRETCH_FRAMES: usize = 12;

/// A town prepared for drawing, with its views.
pub struct Ground {
    /// Name in tables.
    pub name: String,
    /// Town.
    pub town: Town,
    /// Scene of the town for the renderer.
    pub scene: Scene,
    /// Camera of all views.
    pub camera: Camera,
    /// Poses of the camera, with their targets.
    pub views: Vec<View>,
}

/// A viewpoint.
#[derive(Clone, Copy, Debug)]
pub struct View {
    /// Pose of the camera.
    pub pose: Pose,
    /// Target in the view.
    pub target: BodyFigure,
}

impl Ground {
    /// Town of `cosfly town`, which the recipes use as well.
    pub fn downtown(camera: Camera, views: usize) -> Result<Self, MapError> {
        let map = generate_town(&GenerateConfig::default(), 1);
        Self::of_map("downtown", map.as_bytes(), camera, views)
    }

    /// Town of a map file: followers of walkers on its pavements, from the centre outwards.
    pub fn of_map(name: &str, map: &[u8], camera: Camera, views: usize) -> Result<Self, MapError> {
        let (town, _) = read_town(map, &MapConfig::default(), Seed([5; 32]))?;
        let middle = 0.5 * (town.min_in_world + town.max_in_world);
        let mut spots: Vec<DVec3> = town
            .walkable
            .iter()
            .filter(|area| area.kind == WalkableKind::Sidewalk && area.outline_in_world.len() > 2)
            .map(|area| 0.5 * (area.outline_in_world[0] + area.outline_in_world[area.outline_in_world.len() / 2]))
            .collect();
        let away = |spot: &DVec3| (*spot - middle).truncate().length_squared();
        spots.sort_by(|a, b| away(a).total_cmp(&away(b)));
        spots.truncate((8 * views).max(64));
        if spots.is_empty() {
            spots.push(middle);
        }
        let step = (spots.len() / views.max(1)).max(1);
        let spots: Vec<DVec3> = spots.into_iter().step_by(step).take(views).collect();
        Ok(Self::new(name.to_owned(), town, camera, &spots))
    }

    /// A grid of streets with about `boxes` boxes on flat ground: houses and trees.
    pub fn of_boxes(boxes: usize, camera: Camera, views: usize) -> Self {
        let town = box_town(boxes);
        let side = BLOCK_M * f64::from(blocks_of(boxes));
        let spot = |view: usize| {
            let along = (view as f64 + 0.5) / views.max(1) as f64;
            let street = BLOCK_M * (0.3 * side / BLOCK_M + (view % 5) as f64).floor() - 0.5 * side;
            DVec3::new((0.2 + 0.6 * along) * side - 0.5 * side, street + 1.0, 0.0)
        };
        let spots: Vec<DVec3> = (0..views).map(spot).collect();
        Self::new(format!("{boxes} boxes"), town, camera, &spots)
    }

    fn new(name: String, town: Town, camera: Camera, spots: &[DVec3]) -> Self {
        let tree = BoxBvh::build(town.obstacles.iter().map(|obstacle| obstacle.shape).collect());
        let views = spots.iter().enumerate().map(|(index, feet)| follower(&tree, *feet, index)).collect();
        let scene = Scene::new(&town, Seed([1; 32]));
        Self { name, town, scene, camera, views }
    }

    /// Views of these places from straight above, so many metres over the target, turned every way.
    pub fn from_above(mut self, height_m: f64) -> Self {
        for (index, view) in self.views.iter_mut().enumerate() {
            let position_in_world = view.target.state.feet_in_world + height_m * DVec3::Z;
            let yaw_rad = 0.7 * index as f64;
            view.pose = Pose { position_in_world, yaw_rad, pitch_rad: -0.5 * real::PI, roll_rad: 0.0 };
        }
        self
    }

    /// Frame `frame` of a flight from view to view, a few steps around each.
    pub fn walked(&self, frame: usize, dt_s: f64) -> View {
        self.followed(frame / STRETCH_FRAMES, frame % STRETCH_FRAMES, dt_s)
    }

    /// View `view` (modulo their number) after `step` steps of `dt_s` seconds: the walker moves away from the follower
    /// and passes the view's position halfway through the flight.
    pub fn followed(&self, view: usize, step: usize, dt_s: f64) -> View {
        let mut view = self.views[view % self.views.len()];
        let away = view.target.state.feet_in_world - view.pose.position_in_world;
        let way_m = (step as f64 - 0.5 * STRETCH_FRAMES as f64) * dt_s * view.target.state.speed_mps;
        let moved = way_m * DVec3::new(away.x, away.y, 0.0).normalize_or_zero();
        view.pose.position_in_world += moved;
        view.target.state.feet_in_world += moved;
        view.target.state.heading_rad = real::atan2(away.y, away.x);
        view.target.gait_phase_rad = gait_phase_rad(way_m, HEIGHT_M);
        view
    }
}

/// Follower of a target at `feet`: the first of eight directions without an occluder.
fn follower(tree: &BoxBvh, feet: DVec3, index: usize) -> View {
    let (sin, cos) = real::sin_cos(PITCH_DEG.to_radians());
    let from = |turn: usize| {
        let (across, along) = real::sin_cos(real::TAU * (turn as f64 + 0.3) / 8.0);
        feet + DISTANCE_M * DVec3::new(cos * along, cos * across, sin)
    };
    let chest = feet + DVec3::new(0.0, 0.0, 0.7 * HEIGHT_M);
    let turn = (0..8).map(|i| i + index).find(|turn| !tree.blocked(from(*turn), chest)).unwrap_or(index);
    let state = TargetState { feet_in_world: feet, heading_rad: 0.6 * index as f64, speed_mps: 1.4 };
    let target = BodyFigure {
        state,
        height_m: HEIGHT_M,
        radius_m: 0.3,
        clothes_seed: Seed([9; 32]),
        gait_phase_rad: gait_phase_rad(0.7 * index as f64, HEIGHT_M),
        body: BodyShape::default(),
    };
    View { pose: Pose::looking_at(from(turn), chest), target }
}

/// Side of a block with its streets, metres.
const BLOCK_M: f64 = 40.0;
const BOXES_PER_BLOCK: usize = 5;

fn blocks_of(boxes: usize) -> u32 {
    let mut side = 1;
    while BOXES_PER_BLOCK * (side * side) as usize <= boxes.saturating_sub(BOXES_PER_BLOCK) {
        side += 1;
    }
    side
}

/// Town of `boxes` boxes: per block three houses and a tree of two boxes.
fn box_town(boxes: usize) -> Town {
    let side = blocks_of(boxes);
    let mut random = Seed([7; 32]).stream("boxes");
    let half = 0.5 * BLOCK_M * f64::from(side);
    let mut obstacles = vec![];
    for block in 0..side * side {
        let corner = DVec2::new(f64::from(block % side), f64::from(block / side)) * BLOCK_M - half;
        let mut add = |x: [f64; 2], y: [f64; 2], z: [f64; 2], kind| {
            let low = DVec3::new(corner.x + x[0], corner.y + y[0], z[0]);
            let shape = OrientedBox::from_corners(low, DVec3::new(corner.x + x[1], corner.y + y[1], z[1]));
            let object_id = obstacles.len() as u32;
            obstacles.push(Obstacle { shape, kind, object_id, synthetic: true });
        };
        let mut storeys = || 3.3 * random.uniform(2.0, 9.0).floor();
        add([9.0, 22.0], [9.0, 31.0], [0.0, storeys()], ObstacleKind::Building);
        add([22.0, 31.0], [9.0, 21.0], [0.0, storeys()], ObstacleKind::Building);
        add([23.0, 31.0], [23.0, 31.0], [0.0, storeys()], ObstacleKind::Building);
        add([5.8, 6.2], [19.8, 20.2], [0.0, 2.6], ObstacleKind::TreeTrunk);
        add([4.2, 7.8], [18.2, 21.8], [2.6, 6.0], ObstacleKind::TreeCrown);
    }
    obstacles.truncate(boxes);
    let corners = [[-half, -half], [half, -half], [half, half], [-half, half]];
    let ground = SurfaceMesh {
        label: SemanticLabel::Roads,
        vertices_in_world: corners.map(|[x, y]| DVec3::new(x, y, 0.0)).to_vec(),
        along_across_m: corners.map(|[x, y]| DVec2::new(x, y)).to_vec(),
        triangles: vec![[0, 1, 2], [0, 2, 3]],
        synthetic: true,
    };
    Town {
        name: "boxes".into(),
        origin: MapOrigin::default(),
        obstacles,
        planning_boxes: vec![],
        simplification: SimplificationReport::default(),
        lanes: vec![],
        walkable: vec![],
        surfaces: vec![ground],
        synthetic: Synthetic::default(),
        min_in_world: DVec3::new(-half, -half, 0.0),
        max_in_world: DVec3::new(half, half, 40.0),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_box_town_has_as_many_boxes_as_asked_and_every_view_is_free() {
        let camera = Camera { width: 64, height: 48, horizontal_fov_rad: 1.2 };
        for boxes in [1, 5, 1728, 2000] {
            let ground = Ground::of_boxes(boxes, camera, 4);
            assert_eq!((ground.town.obstacles.len(), ground.views.len()), (boxes, 4));
        }
        let ground = Ground::of_boxes(2000, camera, 20);
        let tree = BoxBvh::build(ground.town.obstacles.iter().map(|obstacle| obstacle.shape).collect());
        for view in &ground.views {
            let (eye, feet) = (view.pose.position_in_world, view.target.state.feet_in_world);
            assert!(!tree.blocked(eye, feet + DVec3::Z), "{eye}");
        }
        for view in &ground.from_above(60.0).views {
            let ahead = view.pose.world_from_body() * DVec3::X;
            let feet = view.pose.position_in_world + 60.0 * ahead;
            assert!((feet - view.target.state.feet_in_world).length() < 1e-9, "{feet}");
        }
    }
}
