//! Towns, places and people for tests.

use cosfly_domain::{Town, WalkableKind};
use cosfly_figures::{BodyFigure, FigureInPicture};
use cosfly_frames::{DVec3, Pose, Seed, TargetState, real};
use cosfly_geometry::{BoxBvh, SpatialQuery};
use cosfly_maps::{MapConfig, read_town};
use cosfly_places::kinds::ALL;
use cosfly_town::GroundIndex;
use std::collections::BTreeMap;
use std::path::Path;

/// A town of the shipped recipes.
pub fn shipped(name: &str) -> Town {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../../recipes/towns").join(name);
    of_file(&path)
}

/// The town of a map file.
pub fn of_file(path: &Path) -> Town {
    let map = std::fs::read(path).unwrap_or_else(|error| panic!("{}: {error}", path.display()));
    read_town(&map, &MapConfig::default(), Seed([5; 32])).expect("a map").0
}

/// A generated town of a kind of place.
#[allow(dead_code, reason = "each test file uses some of these towns")]
pub fn generated(place: &str, seed: u64) -> Town {
    let kind = ALL.iter().find(|kind| kind.name == place).expect("a kind of place");
    let settings = kind.settings(&BTreeMap::new()).expect("its usual settings");
    let map = kind.open_drive(&settings, seed);
    read_town(map.as_bytes(), &MapConfig::default(), Seed([5; 32])).expect("a map").0
}

/// A camera, the target that it looks at, and other people around.
#[derive(Clone)]
pub struct Place {
    pub pose: Pose,
    pub target: BodyFigure,
    pub others: Vec<FigureInPicture>,
}

/// Places of a town: on pavements, from 8 to 35 m away and 3 to 30 m above, the target in free sight; `people` of them stand
/// and walk around it.
pub fn places(town: &Town, count: usize, people: u32) -> Vec<Place> {
    let index = GroundIndex::new(town);
    let tree = BoxBvh::build(town.obstacles.iter().map(|obstacle| obstacle.shape).collect());
    let pavements: Vec<_> = town.walkable.iter().filter(|area| area.kind == WalkableKind::Sidewalk).collect();
    let mut random = Seed([8; 32]).stream("places");
    let mut places = Vec::new();
    while places.len() < count {
        let area = pavements[random.index(pavements.len())];
        let feet = area.outline_in_world[random.index(area.outline_in_world.len())];
        let (across, along) = real::sin_cos(random.uniform(0.0, real::TAU));
        let away_m = random.uniform(8.0, 35.0);
        let eye = feet + DVec3::new(away_m * along, away_m * across, random.uniform(3.0, 30.0));
        if tree.blocked(eye, feet + DVec3::Z * 1.2) {
            continue;
        }
        let mut pose = Pose::looking_at(eye, feet + DVec3::Z);
        pose.roll_rad = random.uniform(-0.2, 0.2);
        let mut figure = |feet: DVec3, number: u64| BodyFigure {
            state: TargetState {
                feet_in_world: feet,
                heading_rad: random.uniform(-3.1, 3.1),
                speed_mps: random.uniform(0.0, 1.8),
            },
            height_m: random.uniform(1.5, 1.95),
            radius_m: random.uniform(0.24, 0.34),
            clothes_seed: Seed([6; 32]).child("clothes", number),
            gait_phase_rad: random.uniform(-3.1, 3.1),
            body: cosfly_figures::BodyShape::default(),
        };
        let target = figure(feet, 0);
        let mut scatter = Seed([9; 32]).child("crowd", places.len() as u64).stream("crowd");
        let others = (0..people).map(|number| {
            let mut at = feet + DVec3::new(scatter.uniform(-30.0, 30.0), scatter.uniform(-30.0, 30.0), 0.0);
            at.z = index.ground_height_m(at.x, at.y).unwrap_or(feet.z);
            FigureInPicture { figure: figure(at, 1 + u64::from(number)), instance: 50_000 + number }
        });
        let others = others.collect();
        places.push(Place { pose, target, others });
    }
    places
}
