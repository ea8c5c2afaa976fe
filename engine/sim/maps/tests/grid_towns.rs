//! Towns of the kind `grid`, as the reader of OpenDRIVE sees them.

use cosfly_domain::{ObstacleKind, Town, WalkableKind};
use cosfly_frames::{DVec2, DVec3, Seed, real};
use cosfly_geometry::{BoxBvh, SpatialQuery};
use cosfly_maps::{MapConfig, read_town};
use cosfly_places::grid::{GenerateConfig, generate_town, streets, turns};

fn read(config: &GenerateConfig, seed: u64) -> Town {
    let text = generate_town(config, seed);
    assert!(text.len() < 2_000_000, "{} bytes", text.len());
    let (town, warnings) =
        read_town(text.as_bytes(), &MapConfig::default(), Seed::of_item(1, "map", "town")).expect("it reads");
    assert_eq!(warnings, Vec::<String>::new(), "seed {seed}");
    town
}

#[test]
fn the_same_seed_gives_the_same_bytes_and_another_seed_another_town() {
    let config = GenerateConfig::default();
    assert_eq!(generate_town(&config, 1), generate_town(&config, 1));
    assert_ne!(generate_town(&config, 1), generate_town(&config, 2));
}

#[test]
fn the_shipped_town_is_what_seed_1_gives() {
    let path = concat!(env!("CARGO_MANIFEST_DIR"), "/../../../recipes/towns/downtown.xodr");
    let shipped = std::fs::read_to_string(path).expect("the shipped town");
    let current = shipped == generate_town(&GenerateConfig::default(), 1);
    assert!(current, "recipes/towns/downtown.xodr is not current; write it again with `cosfly town --seed 1`");
}

#[test]
fn towns_of_any_seed_and_config_read_without_warning() {
    for seed in 0..12 {
        read(&GenerateConfig::default(), seed);
    }
    let absurd = GenerateConfig {
        columns: 0,
        rows: 9,
        min_spacing_m: f64::NAN,
        max_spacing_m: -1.0,
        building_density: 7.0,
        tree_density: f64::INFINITY,
        min_height_m: 90.0,
        max_height_m: 2.0,
    };
    read(&absurd, 3);
}

#[test]
fn turns_begin_and_end_where_lanes_do() {
    for seed in 0..20 {
        let network = streets::Network::draw(&GenerateConfig::default(), Seed::of_item(seed, "town", "t"));
        for turn in turns::all_turns(&network) {
            let ends = [(turn.from, turn.line.pose_at(0.0), 1.0), (turn.to, turn.line.end(), -1.0)];
            for ((arm, pose, inward), skipped) in ends.into_iter().zip(turn.skipped_lanes) {
                let line = &network.streets[arm.street].line;
                let (mouth, outward) = match arm.contact {
                    streets::RoadEnd::Start => (line.pose_at(0.0), 1.0),
                    streets::RoadEnd::End => (line.end(), -1.0),
                };
                assert!((pose.ahead() + mouth.ahead() * outward * inward).length() < 1e-9, "{turn:?}");
                let offset_m = f64::from(skipped) * streets::LANE_WIDTH_M;
                assert!((pose.moved(0.0, offset_m).at - mouth.at).length() < 1e-7, "{turn:?}");
            }
        }
    }
}

#[test]
fn a_town_has_streets_to_walk_and_nothing_solid_but_furniture_on_its_pavements() {
    let town = read(&GenerateConfig::default(), 1);
    let count = |kind| town.obstacles.iter().filter(|obstacle| obstacle.kind == kind).count();
    assert!(count(ObstacleKind::Building) > 150 && count(ObstacleKind::TreeCrown) > 250);
    let furniture = count(ObstacleKind::Static) + count(ObstacleKind::Bench);
    assert!(count(ObstacleKind::Lamp) > 80 && count(ObstacleKind::Wall) > 4 && furniture > 20);
    assert!(town.walkable.iter().filter(|area| area.kind == WalkableKind::Crossing).count() >= 60);
    let size = town.max_in_world - town.min_in_world;
    assert!(size.x > 300.0 && size.x < 520.0 && size.y > 300.0 && size.y < 520.0, "{size}");
    for obstacle in town.obstacles.iter().filter(|o| matches!(o.kind, ObstacleKind::Building | ObstacleKind::Wall)) {
        let corners = obstacle.shape.corners_in_world();
        for share in 0..=20 {
            for (a, b) in [(0, 1), (1, 3), (3, 2), (2, 0)] {
                let at = corners[a].lerp(corners[b], f64::from(share) / 20.0).truncate();
                let is_on_pavement = town.walkable.iter().any(|area| is_inside(&area.outline_in_world, at));
                assert!(!is_on_pavement, "{obstacle:?} stands on walkable ground at {at}");
            }
        }
    }
}

fn is_inside(outline: &[DVec3], at: DVec2) -> bool {
    let mut inside = false;
    for (i, a) in outline.iter().enumerate() {
        let b = outline[(i + 1) % outline.len()];
        if (a.y > at.y) != (b.y > at.y) && at.x < (b.x - a.x) * (at.y - a.y) / (b.y - a.y) + a.x {
            inside = !inside;
        }
    }
    inside
}

#[test]
fn a_drone_20_m_up_and_20_m_behind_often_loses_a_walker() {
    let town = read(&GenerateConfig::default(), 1);
    let scene = BoxBvh::build(town.obstacles.iter().map(|obstacle| obstacle.shape).collect());
    let (mut hidden, mut asked) = (0, 0);
    for area in town.walkable.iter().filter(|area| area.kind == WalkableKind::Sidewalk) {
        let outline = &area.outline_in_world;
        let chest = outline.iter().sum::<DVec3>() / outline.len() as f64 + DVec3::Z;
        let longest = (0..outline.len())
            .map(|i| outline[(i + 1) % outline.len()] - outline[i])
            .reduce(|best, edge| if edge.length() > best.length() { edge } else { best })
            .expect("an outline has edges");
        let heading_rad = real::atan2(longest.y, longest.x);
        for turn in [0.0, real::PI] {
            let (sin, cos) = real::sin_cos(heading_rad + turn);
            let drone = chest - 20.0 * DVec3::new(cos, sin, 0.0) + 20.0 * DVec3::Z;
            hidden += usize::from(scene.blocked(drone, chest));
            asked += 1;
        }
    }
    let share = hidden as f64 / asked as f64;
    println!("a drone straight behind loses the walker in {:.0} % of {asked} places", 100.0 * share);
    assert!(share > 0.25 && share < 0.8, "hidden in {share}");
}
