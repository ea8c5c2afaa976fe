//! One scene in every format and encoding of point clouds; what the town of it has; files that lie about their size.

use cosfly_domain::{Obstacle, ObstacleKind, Town};
use cosfly_frames::DVec3;
use cosfly_geometry::{BoxBvh, SpatialQuery};
use cosfly_scans::cloud::CloudOptions;
use cosfly_scans::las::Las;
use cosfly_scans::pcd::Pcd;
use cosfly_scans::ply::Ply;
use cosfly_scans::up_axis::UpAxis;
use cosfly_town::{MapError, MapFormat};
use std::collections::BTreeSet;

#[path = "../examples/write_clouds.rs"]
#[expect(dead_code, reason = "the program's own `main`")]
mod write_clouds;

use write_clouds::{PCD_ENCODINGS, PLY_ENCODINGS, files, las, pcd, ply, scene};

fn read<F: MapFormat<Options = CloudOptions>>(bytes: &[u8], options: &CloudOptions) -> Result<Town, MapError> {
    assert!(F::recognises(bytes), "{}", F::NAME);
    F::read(bytes, options).map(|(town, _)| town)
}

fn of_kind(town: &Town, kind: ObstacleKind) -> Vec<&Obstacle> {
    town.obstacles.iter().filter(|one| one.kind == kind).collect()
}

fn top_m(obstacles: &[&Obstacle]) -> f64 {
    obstacles.iter().map(|one| one.shape.bounds_in_world().1.z).fold(f64::NEG_INFINITY, f64::max)
}

#[test]
fn example_files_are_what_their_program_writes() {
    for (path, bytes) in files().expect("the examples can be written") {
        let kept =
            std::fs::read(std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join(path)).expect("the example is there");
        assert!(kept == bytes, "{path} differs: run `cargo run --release -p cosfly-scans --example write_clouds`");
    }
}

/// The scene has a house 12 m by 10 m with a ridge at 8 m, a tree 7 m high, a post 3.8 m high, ground that rises to 0.8 m.
fn check_scene(name: &str, town: &Town) {
    let houses = of_kind(town, ObstacleKind::Building);
    let crowns = of_kind(town, ObstacleKind::TreeCrown);
    assert!(!houses.is_empty() && (top_m(&houses) - 8.0).abs() < 0.01, "{name}: {houses:?}");
    assert!(!crowns.is_empty() && (top_m(&crowns) - 7.0).abs() < 0.1, "{name}: {crowns:?}");
    let scene_of = |obstacles: &[&Obstacle]| BoxBvh::build(obstacles.iter().map(|one| one.shape).collect());
    let (house, all) = (scene_of(&houses), scene_of(&town.obstacles.iter().collect::<Vec<_>>()));
    let distance_m = |scene: &BoxBvh, at: DVec3| scene.nearest(at, 50.0).map_or(50.0, |near| near.distance_m);
    for ([x, y, z], class) in scene() {
        let at = DVec3::new(x, -y, z);
        match class {
            6 => assert!(distance_m(&house, at) <= 0.5, "{name}: {at}"),
            2 => assert!(distance_m(&all, at) >= 0.0, "{name}: {at}"),
            _ => {}
        }
    }
    // Boxes stand on each other: the ground under them is counted in squares of half a metre.
    let (low, high) = house.bounds().map(|all| (all.min_in_world, all.max_in_world)).expect("there are houses");
    let is_covered = |at: DVec3| {
        houses.iter().any(|one| {
            let (from, to) = one.shape.bounds_in_world();
            distance_m(&house, at.with_z(0.5 * (from.z + to.z))) <= 0.0
        })
    };
    let [columns, rows] = [high.x - low.x, high.y - low.y].map(|side_m| (2.0 * side_m).ceil() as usize);
    let squares = (0..columns * rows)
        .map(|i| low + 0.5 * DVec3::new((i % columns) as f64 + 0.5, (i / columns) as f64 + 0.5, 0.0));
    let area_m2 = 0.25 * squares.filter(|at| is_covered(*at)).count() as f64;
    assert!((120.0..=190.0).contains(&area_m2), "{name}: the house covers {area_m2} m2");
    town.walkable.iter().for_each(|plaza| assert!(plaza.synthetic && plaza.plan().len() == 4, "{name}"));
}

#[test]
fn every_encoding_of_a_classified_scene_gives_its_house_tree_and_ground() {
    let options = CloudOptions::default();
    let plain = read::<Las>(&las(&scene(), false).unwrap(), &options).unwrap();
    check_scene("LAS", &plain);
    assert_eq!(of_kind(&plain, ObstacleKind::Static).len(), 1);
    assert_eq!(read::<Las>(&las(&scene(), true).unwrap(), &options).unwrap(), plain, "LAZ");
    let towns = PLY_ENCODINGS.map(|encoding| read::<Ply>(&ply(&scene(), encoding), &options).unwrap());
    check_scene("PLY", &towns[1]);
    // Text has three digits.
    check_scene("PLY as text", &towns[0]);
    assert_eq!(towns[1], towns[2]);
}

#[test]
fn ground_house_and_tree_are_found_without_classes() {
    let towns = PCD_ENCODINGS.map(|encoding| read::<Pcd>(&pcd(&scene(), encoding), &CloudOptions::default()).unwrap());
    check_scene("PCD as text", &towns[0]);
    check_scene("PCD", &towns[1]);
    assert_eq!(towns[1], towns[2], "compressed");
    let notes = &towns[1].synthetic.notes;
    assert!(notes.iter().any(|note| note.contains("ground is estimated")), "{notes:?}");
}

#[test]
fn feet_are_told_from_metres_by_the_file_or_by_the_user() {
    let in_feet: Vec<_> = scene().into_iter().map(|(at, class)| (at.map(|metres| metres / 0.3048), class)).collect();
    let told = CloudOptions { unit_m: Some(0.3048), ..CloudOptions::default() };
    check_scene("PLY in feet", &read::<Ply>(&ply(&in_feet, "binary_little_endian"), &told).unwrap());
    let mut file = las(&in_feet, false).unwrap();
    let (metres, feet) = (br#"UNIT["metre",1]"#, br#"UNIT["f",0.3048]"#);
    let at = file.windows(metres.len()).position(|window| window == metres).unwrap();
    // One byte longer: the name of the projection gives it.
    let name = file.windows(4).position(|window| window == b"test").unwrap();
    file.splice(at..at + metres.len(), feet.iter().copied());
    file.remove(name);
    check_scene("LAS in feet", &read::<Las>(&file, &CloudOptions::default()).unwrap());
}

#[test]
fn files_that_lie_about_their_size_are_refused() {
    let put = |bytes: &[u8], at: usize, value: &[u8]| [&bytes[..at], value, &bytes[at + value.len()..]].concat();
    let options = CloudOptions::default();
    let (plain, packed) = (las(&scene(), false).unwrap(), las(&scene(), true).unwrap());
    for file in [&plain, &packed] {
        for count in [scene().len() as u64 + 1, 1 << 40, u64::MAX] {
            let refused = read::<Las>(&put(file, 247, &count.to_le_bytes()), &options).unwrap_err();
            assert!(!refused.hints.is_empty(), "{refused}");
        }
    }
    let table = u64::from_le_bytes(*packed[points_start(&packed)..].first_chunk().unwrap());
    let many = put(&packed, table as usize + 4, &u32::MAX.to_le_bytes());
    assert!(read::<Las>(&many, &options).unwrap_err().message.contains("chunks"));
    for (from, to) in [("vertex ", "vertex 99999999999"), ("vertex ", "vertex 9")] {
        let text = String::from_utf8(ply(&scene(), "ascii")).unwrap().replace(from, to);
        assert!(read::<Ply>(text.as_bytes(), &options).is_err());
    }
    let text = String::from_utf8(pcd(&scene(), "ascii")).unwrap().replace("POINTS ", "POINTS 9");
    assert!(read::<Pcd>(text.as_bytes(), &options).unwrap_err().message.contains("`POINTS`, but `WIDTH`"));
    let text = text.replace("WIDTH ", "WIDTH 9");
    assert!(read::<Pcd>(text.as_bytes(), &options).unwrap_err().message.contains("file ends"));
    let text = String::from_utf8(ply(&scene(), "ascii")).unwrap().replace(" 8.000 ", " nan ");
    check_ply_with_gaps(text.as_bytes());
}

fn points_start(file: &[u8]) -> usize {
    u32::from_le_bytes(*file[96..].first_chunk().unwrap()) as usize
}

#[test]
fn splats_are_a_map_only_where_the_user_says_so_and_the_card_does() {
    let text = String::from_utf8(ply(&scene(), "ascii")).unwrap();
    let (head, rows) = text.split_once("end_header\n").unwrap();
    let rows: String = rows.lines().map(|row| format!("{row} 0 0 0\n")).collect();
    let further = "property float f_dc_0\nproperty float scale_0\nproperty float rot_0\n";
    let splats = format!("{head}{further}end_header\n{rows}");
    let refused = read::<Ply>(splats.as_bytes(), &CloudOptions::default()).unwrap_err();
    assert!(refused.message.contains("Gaussian splats") && refused.hints[0].contains("splats = {"), "{refused}");
    let options = CloudOptions { splats_as_points: true, ..CloudOptions::default() };
    let (town, warnings) = Ply::read(splats.as_bytes(), &options).unwrap();
    assert!(town.synthetic.notes.iter().any(|note| note.contains("Gaussian splats")), "{:?}", town.synthetic);
    assert!(warnings.iter().any(|warning| warning.contains("Gaussian splats")), "{warnings:?}");
}

fn check_ply_with_gaps(bytes: &[u8]) {
    let (_, warnings) = Ply::read(bytes, &CloudOptions::default()).unwrap();
    assert!(warnings.iter().any(|warning| warning.contains("without finite coordinates")), "{warnings:?}");
}

/// The scene with the points of a class told as unclassified.
fn without(class: u8) -> Vec<write_clouds::Point> {
    scene().into_iter().map(|(at, own)| (at, if own == class { 1 } else { own })).collect()
}

#[test]
fn a_class_that_a_survey_does_not_tell_is_found_by_shape() {
    for class in [5, 6] {
        let town = read::<Las>(&las(&without(class), false).unwrap(), &CloudOptions::default()).unwrap();
        check_scene(&format!("class {class} untold"), &town);
        assert!(town.synthetic.notes.iter().any(|note| note.starts_with("unclassified points")), "{class}");
    }
}

#[test]
fn feet_of_walls_are_parts_of_houses_where_no_class_tells_them() {
    let roof: Vec<[f64; 3]> = scene().into_iter().filter(|(_, class)| *class == 6).map(|(at, _)| at).collect();
    let end = |axis: usize, pick: fn(f64, f64) -> f64| roof.iter().map(|at| at[axis]).reduce(pick).expect("a house");
    let [[west, east], [south, north]] = [0, 1].map(|axis| [end(axis, f64::min), end(axis, f64::max)]);
    let eaves_m = end(2, f64::min).max(4.0);
    let mut walls: Vec<[f64; 3]> = vec![];
    for [from, to] in [
        [[west, south], [east, south]],
        [[east, south], [east, north]],
        [[west, north], [east, north]],
        [[west, south], [west, north]],
    ] {
        for (along, up) in
            (0..80).flat_map(|along| (0..40).map(move |up| (f64::from(along) / 79.0, f64::from(up) / 39.0)))
        {
            let at = [0, 1].map(|axis| from[axis] + along * (to[axis] - from[axis]));
            walls.push([at[0], at[1], 0.8 + up * (eaves_m - 0.8)]);
        }
    }
    let points = scene().into_iter().map(|(at, class)| (at, if class == 2 { 2 } else { 1 }));
    let points: Vec<_> = points.chain(walls.iter().map(|at| (*at, 1))).collect();
    let town = read::<Las>(&las(&points, false).unwrap(), &CloudOptions::default()).unwrap();
    let house = BoxBvh::build(of_kind(&town, ObstacleKind::Building).iter().map(|one| one.shape).collect());
    for [x, y, z] in walls {
        assert!(house.nearest(DVec3::new(x, -y, z), 0.5).is_some(), "{x} {y} {z}");
    }
    let beside = |one: &&Obstacle| house.nearest(one.shape.center_in_world, 1.5).is_some();
    let low =
        [ObstacleKind::Bush, ObstacleKind::Static].map(|kind| of_kind(&town, kind).into_iter().filter(beside).count());
    assert_eq!(low, [0, 0], "{:?}", town.obstacles);
}

#[test]
fn a_cloud_is_the_same_town_whichever_of_its_axes_points_up() {
    let turned = |turn: fn([f64; 3]) -> [f64; 3], up_axis: UpAxis| {
        let points: Vec<write_clouds::Point> = scene().into_iter().map(|(at, class)| (turn(at), class)).collect();
        let options = CloudOptions { up_axis: Some(up_axis), ..CloudOptions::default() };
        let files = [
            read::<Ply>(&ply(&points, PLY_ENCODINGS[1]), &options),
            read::<Pcd>(&pcd(&points, PCD_ENCODINGS[1]), &options),
            read::<Las>(&las(&points, false).unwrap(), &options),
        ];
        files.map(|town| format!("{:?}", town.unwrap().obstacles))
    };
    let upright = turned(|at| at, UpAxis::Z);
    assert_eq!(turned(|[x, y, z]| [x, z, -y], UpAxis::Y), upright);
    assert_eq!(turned(|[x, y, z]| [x, -z, y], UpAxis::MinusY), upright);
}

#[test]
fn a_cloud_whose_y_axis_points_up_is_a_warning() {
    // A street of 60 m by 12 m; before it stands its copy, upended.
    let ground = || (0..6000).map(|i| [0.5 * f64::from(i % 120), 0.24 * f64::from(i / 120), 0.01 * f64::from(i % 7)]);
    let warned = |points: Vec<write_clouds::Point>| {
        let (_, warnings) = Las::read(&las(&points, false).unwrap(), &CloudOptions::default()).unwrap();
        warnings.iter().any(|warning| warning.contains("check `options.up_axis`"))
    };
    assert!(!warned(ground().map(|at| (at, 1)).collect()));
    assert!(warned(ground().flat_map(|[x, y, z]| [([x, y, z], 1), ([y, 12.0 + z, x], 1)]).collect()));
}

#[test]
fn narrow_plants_on_a_wall_are_parts_of_the_house() {
    let mut points = scene();
    // Bushes before and behind it in the order of the plan.
    points.extend((0..240).map(|i| {
        let [x, y] = [[4.0, 3.0], [4.0, 27.0], [26.0, 3.0], [26.0, 27.0]][i % 4];
        ([x + 0.1 * (i / 4 % 6) as f64, y + 0.1 * (i / 24) as f64, 1.8 + 0.002 * i as f64], 4)
    }));
    let plain = read::<Las>(&las(&points, false).unwrap(), &CloudOptions::default()).unwrap();
    points.extend((0..60).map(|i| {
        let aside_m = 0.2 * f64::from(i % 5) - 0.4;
        ([14.0 + aside_m, 17.5 + 0.1 * f64::from(i % 3), 3.4 + 0.02 * f64::from(i)], 5)
    }));
    let town = read::<Las>(&las(&points, false).unwrap(), &CloudOptions::default()).unwrap();
    let trees = |town: &Town| of_kind(town, ObstacleKind::TreeTrunk).len();
    assert_eq!(trees(&town), trees(&plain), "no tree stands on the wall");
    let things = |town: &Town| town.obstacles.iter().map(|one| one.object_id).collect::<BTreeSet<_>>().len();
    assert_eq!(things(&town), things(&plain), "each thing has an id of its own");
    let houses = of_kind(&town, ObstacleKind::Building);
    let house = BoxBvh::build(houses.iter().map(|one| one.shape).collect());
    let near = house.nearest(DVec3::new(14.0, -17.5, 4.0), 0.3).expect("the plant is solid");
    assert_eq!(houses[near.primitive as usize].object_id, houses[0].object_id, "a part of the house");
}

#[test]
fn a_wall_at_a_slant_is_one_box_around_its_points() {
    // 10 m at 30 degrees, 1.6 m high.
    let wall = (0..50).flat_map(|i| (0..9).map(move |j| [0.2 * f64::from(i), 0.2 * f64::from(j)]));
    let wall: Vec<_> = wall.map(|[along, up]| [26.0 + 0.866 * along, 8.0 + 0.5 * along, 1.0 + up]).collect();
    let points: Vec<_> = scene().into_iter().chain(wall.iter().map(|at| (*at, 64))).collect();
    let statics = |points: &[write_clouds::Point]| {
        let town = read::<Las>(&las(points, false).unwrap(), &CloudOptions::default()).unwrap();
        of_kind(&town, ObstacleKind::Static).into_iter().map(|one| one.shape).collect::<Vec<_>>()
    };
    let shapes = statics(&points);
    assert_eq!(shapes.len(), statics(&scene()).len() + 1, "{shapes:?}");
    let boxes = BoxBvh::build(shapes);
    for [x, y, z] in wall {
        assert!(boxes.nearest(DVec3::new(x, -y, z), 0.01).is_some(), "{x} {y} {z}");
    }
}

/// Points of a board of 0.9 m by 0.9 m.
fn board([x, y, z]: [f64; 3]) -> impl Iterator<Item = write_clouds::Point> {
    (0..16).map(move |i| ([x + 0.3 * f64::from(i % 4), y + 0.3 * f64::from(i / 4), z], 64))
}

#[test]
fn what_hangs_is_a_part_of_a_house_or_has_a_mast() {
    let town = |more: [f64; 3]| {
        let points: Vec<_> = scene().into_iter().chain(board(more)).collect();
        read::<Las>(&las(&points, false).unwrap(), &CloudOptions::default()).unwrap()
    };
    let free = town([35.0, 8.0, 6.0]);
    let masts: Vec<_> = of_kind(&free, ObstacleKind::Pole).into_iter().filter(|one| one.synthetic).collect();
    let [mast] = masts[..] else { panic!("{masts:?}") };
    let (low, high) = mast.shape.bounds_in_world();
    assert!(low.z < 1.0 && high.z > 5.5 && high.z < 6.1, "{mast:?}");
    assert_eq!(of_kind(&free, ObstacleKind::Static).iter().filter(|one| one.object_id == mast.object_id).count(), 1);
    let at_wall = town([14.0, 17.2, 4.0]);
    assert!(of_kind(&at_wall, ObstacleKind::Pole).is_empty());
    let houses = of_kind(&at_wall, ObstacleKind::Building);
    assert!(houses.iter().all(|one| one.object_id == houses[0].object_id), "the board is a part of the house");
    assert_eq!(of_kind(&at_wall, ObstacleKind::Static).len(), of_kind(&free, ObstacleKind::Static).len() - 1);
}

#[test]
fn low_things_larger_than_vehicles_are_bushes_where_the_file_tells_no_plants() {
    let low = |i: u32| {
        let [x, y] = [f64::from(i % 20), f64::from(i / 20)];
        ([2.0 + 0.3 * x, 22.0 + 0.3 * y, 1.2 + 0.05 * f64::from(i * 7 % 11)], 1)
    };
    let patch = || (0..400).map(low);
    let bushes = |points: Vec<write_clouds::Point>| {
        let town = read::<Las>(&las(&points, false).unwrap(), &CloudOptions::default()).unwrap();
        let all = BoxBvh::build(town.obstacles.iter().map(|one| one.shape).collect());
        let is_held = |([x, y, z], _): write_clouds::Point| all.nearest(DVec3::new(x, -y, z), 0.01).is_some();
        assert!(patch().all(is_held), "all points are solid");
        of_kind(&town, ObstacleKind::Bush).len()
    };
    assert_eq!(bushes(scene().into_iter().chain(patch()).collect()), 0);
    assert!(bushes(without(5).into_iter().chain(patch()).collect()) > 0);
}

#[test]
fn degrees_and_corners_of_drawings_are_no_clouds() {
    let options = CloudOptions::default();
    let degrees = |([x, y, z], class): write_clouds::Point| ([2.0 + 1e-5 * x, 48.0 + 1e-5 * y, z], class);
    let text: Vec<_> = scene().into_iter().map(degrees).collect();
    let refused = read::<Ply>(&ply(&text, "binary_little_endian"), &options).unwrap_err();
    assert!(refused.message.contains("degrees"), "{refused}");
    let mesh = "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\nproperty float z\nelement face 1\n\
                property list uchar int vertex_indices\nend_header\n0 0 0\n40 0 0\n40 40 0\n0 40 9\n4 0 1 2 3\n";
    assert!(read::<Ply>(mesh.as_bytes(), &options).unwrap_err().message.contains("mesh"));
}

#[test]
fn what_a_head_says_of_a_place_is_a_warning_and_nothing_is_said_twice() {
    let options = CloudOptions { unit_m: Some(1.0), ..CloudOptions::default() };
    let ply_with = |line: &str| {
        String::from_utf8(ply(&scene(), "ascii")).unwrap().replacen("element", &format!("{line}\nelement"), 1)
    };
    let pcd_with =
        |line: &str| String::from_utf8(pcd(&scene(), "ascii")).unwrap().replacen("WIDTH", &format!("{line}\nWIDTH"), 1);
    let of_ply = |line: &str| Ply::read(ply_with(line).as_bytes(), &options).map(|(_, warnings)| warnings);
    let of_pcd = |line: &str| Pcd::read(pcd_with(line).as_bytes(), &options).map(|(_, warnings)| warnings);
    let is_said =
        |warnings: Vec<String>, line: &str| warnings.iter().any(|it| it.contains(line) && it.contains("not applied"));
    for line in ["comment global shift -393706 -5815132 0", "obj_info epsg 25833"] {
        assert!(is_said(of_ply(line).unwrap(), line), "{line}");
    }
    assert!(!is_said(of_ply("comment made by a program 2").unwrap(), "comment"));
    for line in ["# offset 393706 5815132 0", "#VERSION 7, EPSG:25833"] {
        assert!(is_said(of_pcd(line).unwrap(), line), "{line}");
    }
    let moved = String::from_utf8(pcd(&scene(), "ascii")).unwrap();
    assert!(moved.contains("VIEWPOINT 0 0 0 1 0 0 0"));
    let moved = moved.replace("VIEWPOINT 0 0 0", "VIEWPOINT 9 0 0");
    assert!(is_said(Pcd::read(moved.as_bytes(), &options).unwrap().1, "VIEWPOINT 9 0 0"));
    assert!(of_pcd("SIZE 4 4 4 4").unwrap_err().message.contains("there is such a line before"));
    assert!(of_ply("format ascii 1.0").unwrap_err().message.contains("there is a line `format` before"));
}
