//! Pavements that are solids: people stand on their tops, and nowhere without headroom.

use cosfly_domain::{ObstacleKind, SemanticLabel, Town};
use cosfly_frames::{DVec2, DVec3};
use cosfly_scans::mesh::MeshOptions;
use cosfly_scans::obj::Obj;
use cosfly_town::MapFormat;
use cosfly_town::polygons::twice_area_m2;
use std::fmt::Write;

/// Text of an OBJ file: one box for each name, from corner to corner (x, y up, z).
#[derive(Default)]
struct Scene {
    text: String,
    corners: usize,
}

impl Scene {
    fn add(mut self, name: &str, low: [f64; 3], high: [f64; 3]) -> Self {
        self.text.push_str(&format!("o {name}\n"));
        self.add_box(|x, z| [low[1] + 0.0 * (x + z), high[1]], low, high)
    }

    /// A box whose lower and upper side have the heights of `ends_at` over a corner.
    fn add_box(mut self, ends_at: impl Fn(f64, f64) -> [f64; 2], low: [f64; 3], high: [f64; 3]) -> Self {
        for end in 0..2 {
            for [x, z] in [[low[0], low[2]], [high[0], low[2]], [high[0], high[2]], [low[0], high[2]]] {
                writeln!(self.text, "v {x} {} {z}", ends_at(x, z)[end]).unwrap();
            }
        }
        for side in [[1, 2, 3, 4], [5, 8, 7, 6], [1, 5, 6, 2], [2, 6, 7, 3], [3, 7, 8, 4], [4, 8, 5, 1]] {
            let [a, b, c, d] = side.map(|corner: usize| corner + self.corners);
            writeln!(self.text, "f {a} {b} {c} {d}").unwrap();
        }
        self.corners += 8;
        self
    }

    fn flipped(&self) -> String {
        let line = |line: &str| match line.strip_prefix("f ") {
            Some(corners) => format!("f {}\n", corners.split(' ').rev().collect::<Vec<_>>().join(" ")),
            None => format!("{line}\n"),
        };
        self.text.lines().map(line).collect()
    }
}

fn read(text: &str) -> Town {
    Obj::read(text.as_bytes(), &MeshOptions::default()).unwrap().0
}

fn street(height_m: f64) -> Scene {
    Scene::default()
        .add("ground", [-60.0, -0.1, -40.0], [60.0, 0.0, 40.0])
        .add("pavement_north", [-60.0, 0.0, -8.0], [60.0, height_m, -4.0])
        .add("pavement_south", [-60.0, 0.0, 4.0], [60.0, height_m, 8.0])
        .add("building", [-50.0, 0.0, -30.0], [-20.0, 12.0, -10.0])
}

fn area_m2(town: &Town) -> f64 {
    town.walkable.iter().map(|polygon| 0.5 * twice_area_m2(&polygon.plan()).abs()).sum()
}

/// Least and greatest height to stand on.
fn heights_m(town: &Town) -> [f64; 2] {
    let corners = || town.walkable.iter().flat_map(|polygon| &polygon.outline_in_world).map(|corner| corner.z);
    [corners().fold(f64::INFINITY, f64::min), corners().fold(f64::NEG_INFINITY, f64::max)]
}

#[test]
fn people_stand_on_top_of_slabs_whatever_their_height_and_winding() {
    for height_m in [0.02, 0.15, 0.5, 3.0] {
        let scene = street(height_m);
        for text in [scene.text.clone(), scene.flipped()] {
            let town = read(&text);
            assert!((area_m2(&town) - 960.0).abs() < 1e-6, "{height_m}: {}", area_m2(&town));
            assert_eq!(heights_m(&town), [height_m; 2]);
            let pavement = town.census().ground["SideWalks"].area_m2;
            assert!((pavement - 960.0).abs() < 1e-6, "{height_m}: {pavement} m2 are drawn");
        }
    }
}

#[test]
fn sloped_slabs_keep_their_slope() {
    let rise = |x: f64, _| [0.1 * x, 0.1 * x + 0.4];
    let mut scene = Scene::default().add("ground", [0.0, -9.0, -9.0], [40.0, -8.0, 9.0]);
    scene.text.push_str("o sidewalk\n");
    let town = read(&scene.add_box(rise, [0.0, 0.0, 0.0], [40.0, 0.0, 4.0]).text);
    assert!((area_m2(&town) - 160.0).abs() < 1e-6);
    assert_eq!(heights_m(&town), [0.4, 4.4]);
}

#[test]
fn of_stacked_slabs_and_steps_what_is_covered_is_cut_away() {
    let stacked = street(0.5).add("sidewalk_upper", [-60.0, 0.5, 4.0], [60.0, 1.0, 8.0]);
    let town = read(&stacked.text);
    assert!((area_m2(&town) - 960.0).abs() < 0.1, "{}", area_m2(&town));
    assert_eq!(heights_m(&town), [0.5, 1.0]);
    // Three steps, each a slab from the ground up, the upper ones on the lower.
    let mut steps = Scene::default().add("ground", [-30.0, -0.2, -30.0], [30.0, -0.1, 30.0]);
    for step in 0..3 {
        let low = [f64::from(step), 0.15 * f64::from(step), -5.0];
        steps = steps.add("plaza", low, [20.0, low[1] + 0.15, 5.0]);
    }
    let town = read(&steps.text);
    assert!((area_m2(&town) - 200.0).abs() < 0.1, "{}", area_m2(&town));
    let highest_at = |x: f64| {
        let at = DVec2::new(x, 0.3) - town.origin.offset_m.truncate();
        let over = town.walkable.iter().filter(|one| cosfly_town::polygons::contains(&one.plan(), at));
        over.map(|one| one.outline_in_world[0].z).collect::<Vec<f64>>()
    };
    for (x, height_m) in [(0.5, 0.15), (1.5, 0.3), (2.5, 0.45), (15.0, 0.45)] {
        let found = highest_at(x);
        assert!(found.len() == 1 && (found[0] - height_m).abs() < 1e-9, "{x}: {found:?}");
    }
}

#[test]
fn nobody_walks_under_a_deck_without_headroom_or_on_a_fountain() {
    let scene = street(0.2)
        .add("road_deck", [-10.0, 1.5, 3.0], [10.0, 1.8, 9.0])
        .add("road_bridge_high", [30.0, 5.0, 3.0], [40.0, 5.4, 9.0])
        .add("pavement-fountain", [-40.0, 0.2, 4.0], [-37.0, 0.9, 7.0]);
    let town = read(&scene.text);
    assert!((area_m2(&town) - (960.0 - 80.0)).abs() < 0.1, "{}", area_m2(&town));
    assert!(town.obstacles.iter().any(|one| one.kind == ObstacleKind::Static), "the fountain is solid");
    assert!(town.synthetic.notes.iter().any(|note| note.contains("without headroom")), "{:?}", town.synthetic.notes);
}

#[test]
fn blocks_are_one_box_of_their_exact_size() {
    for size in [[10.0, 8.0, 6.0], [10.3, 2.71, 6.9], [70.0, 30.0, 55.0], [0.4, 3.0, 0.4]] {
        let low = [20.0, 0.0, 10.0];
        let high = [0, 1, 2].map(|axis| low[axis] + size[axis]);
        let scene = Scene::default().add("ground", [-60.0, -0.1, -60.0], [90.0, 0.0, 90.0]).add("house", low, high);
        // Houses of some programs have no floor.
        let open = scene.text.replace("f 9 10 11 12\n", "");
        for text in [&scene.text, &open] {
            let town = read(text);
            assert_eq!(town.obstacles.len(), 1, "{:?}", town.obstacles);
            let mut found = (2.0 * town.obstacles[0].shape.half_extents_m).to_array();
            let mut expected = size;
            found.sort_by(f64::total_cmp);
            expected.sort_by(f64::total_cmp);
            let differs = DVec3::from_array(found) - DVec3::from_array(expected);
            assert!(differs.abs().max_element() < 1e-6, "{found:?} for {expected:?}");
        }
    }
}

#[test]
fn walls_along_cells_leave_no_slivers() {
    // An L of whole cells: none of its boxes leaves its outline.
    let l = "o house\nv 0 0 0\nv 12 0 0\nv 12 0 -5\nv 5 0 -5\nv 5 0 -12\nv 0 0 -12\nv 0 6 0\nv 12 6 0\nv 12 6 -5\nv 5 6 -5\nv 5 6 -12\nv 0 6 -12\n\
             f 6 5 4 3 2 1\nf 7 8 9 10 11 12\n";
    let walls: String = (1..=6).map(|at| format!("f {at} {} {} {}\n", at % 6 + 1, at % 6 + 7, at + 6)).collect();
    let town = read(&format!("{l}{walls}"));
    let narrowest =
        town.obstacles.iter().map(|one| one.shape.half_extents_m.min_element()).fold(f64::INFINITY, f64::min);
    assert!(town.obstacles.len() <= 4 && narrowest > 0.2, "{:?}", town.obstacles);
}

#[test]
fn a_named_object_is_one_thing_and_a_plural_is_many() {
    let house = |name: &str, x: f64| {
        Scene::default().add(name, [x, 0.0, 0.0], [x + 8.0, 6.0, 8.0]).text.replace("o ", &format!("# {name}\no "))
    };
    let pieces = |name: &str| {
        let scene = Scene::default().add("ground", [-60.0, -0.1, -60.0], [90.0, 0.0, 90.0]).add(
            name,
            [0.0, 0.0, 0.0],
            [8.0, 6.0, 8.0],
        );
        // Loose pieces: a door, a chimney, a sign that hangs free.
        let bare = |scene: Scene, low, high| {
            let scene = scene.add("LOOSE", low, high);
            Scene { text: scene.text.replace("o LOOSE\n", ""), ..scene }
        };
        let scene = bare(scene, [3.0, 0.0, 8.0], [4.0, 2.0, 8.1]);
        let scene = bare(scene, [6.0, 6.0, 6.0], [6.5, 7.5, 6.5]);
        bare(scene, [9.0, 3.0, 3.0], [9.1, 4.0, 4.0])
    };
    let ids = |town: &Town| {
        let mut ids: Vec<u32> = town.obstacles.iter().map(|one| one.object_id).collect();
        ids.dedup();
        ids
    };
    let one = read(&pieces("building-type-a").text);
    assert_eq!((ids(&one).len(), one.obstacles.len()), (1, 4));
    assert_eq!(ids(&read(&pieces("buildings").text)).len(), 4);
    // Without a telling name, what touches is one thing.
    assert_eq!(ids(&read(&pieces("kit-piece-7").text)).len(), 2);
    let town = read(&house("house", 0.0));
    assert_eq!(ids(&town).len(), 1);
    assert!(town.surfaces.iter().any(|mesh| mesh.label == SemanticLabel::Terrain));
}
