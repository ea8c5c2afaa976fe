//! One scene in every format of meshes; boxes of solids against `parry3d`, an independent library; files that lie.

use base64::Engine as _;
use base64::engine::general_purpose::STANDARD;
use cosfly_domain::{ObstacleKind, SemanticLabel, Town, WalkableKind};
use cosfly_frames::{DVec3, RandomStream, Seed, real};
use cosfly_geometry::{BoxBvh, SpatialQuery};
use cosfly_scans::gltf::document::Document;
use cosfly_scans::gltf::{GlTf, triangles};
use cosfly_scans::mesh::{MeshOptions, Part, solid};
use cosfly_scans::obj::Obj;
use cosfly_scans::up_axis::UpAxis;
use cosfly_town::{MapError, MapFormat};
use parry3d_f64::math::Vector;
use parry3d_f64::query::PointQuery;
use parry3d_f64::shape::{TriMesh, TriMeshFlags};

#[path = "../examples/write_meshes.rs"]
#[expect(dead_code, reason = "the program's own `main`")]
mod write_meshes;

use write_meshes::{HOUSE, HOUSE_CAP, files, glb, obj, prism, scene};

fn read<F: MapFormat<Options = MeshOptions>>(bytes: &[u8], options: &MeshOptions) -> Result<Town, MapError> {
    assert!(F::recognises(bytes), "{}", F::NAME);
    F::read(bytes, options).map(|(town, _)| town)
}

#[test]
fn example_files_are_what_their_program_writes() {
    for (path, bytes) in files() {
        let kept =
            std::fs::read(std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join(path)).expect("the example is there");
        assert!(kept == bytes, "{path} differs: run `cargo run --release -p cosfly-scans --example write_meshes`");
    }
}

fn check_scene(town: &Town) {
    let count = |kind| town.obstacles.iter().filter(|one| one.kind == kind).count();
    assert!((1..=12).contains(&count(ObstacleKind::Building)), "{:?}", town.obstacles);
    assert_eq!(
        (count(ObstacleKind::TreeTrunk), count(ObstacleKind::TreeCrown), count(ObstacleKind::Static)),
        (1, 1, 1)
    );
    let bench = town.obstacles.iter().find(|one| one.kind == ObstacleKind::Static).unwrap();
    assert!((bench.shape.half_extents_m - DVec3::new(0.6, 0.6, 0.25)).abs().max_element() < 0.011, "{bench:?}");
    assert!(bench.shape.center_in_world.distance(DVec3::new(-10.0, 15.0, 0.25)) < 0.02, "{bench:?}");
    let labels: Vec<_> = town.surfaces.iter().filter(|mesh| !mesh.synthetic).map(|mesh| mesh.label).collect();
    assert_eq!(labels, [SemanticLabel::SideWalks, SemanticLabel::Terrain]);
    assert!(town.walkable.iter().all(|one| one.kind == WalkableKind::Sidewalk && !one.synthetic));
    assert_eq!(town.walkable.len(), 2);
}

#[test]
fn both_formats_give_the_same_things() {
    let options = MeshOptions::default();
    let towns = [read::<Obj>(&obj(&scene()), &options).unwrap(), read::<GlTf>(&glb(&scene()), &options).unwrap()];
    towns.iter().for_each(check_scene);
    let shapes = towns.map(|town| town.obstacles.iter().map(|one| one.kind).collect::<Vec<_>>());
    assert_eq!(shapes[0], shapes[1]);
}

#[test]
fn the_axis_and_the_unit_are_the_users() {
    let mut meshes = scene();
    meshes.iter_mut().flat_map(|mesh| &mut mesh.vertices).for_each(|vertex| {
        // What the writer does to make y point up, undone; in centimetres.
        let [x, y, z] = vertex.map(|metres| 100.0 * metres);
        *vertex = [x, -z, y];
    });
    let options = MeshOptions { up_axis: Some(UpAxis::Z), unit_m: Some(0.01), ..MeshOptions::default() };
    check_scene(&read::<Obj>(&obj(&meshes), &options).unwrap());
}

/// A solid by an outline, turned about z, as a part and as parry's mesh.
fn turned(outline: &[[f64; 2]], cap: &[[u32; 3]], height_m: f64, yaw_rad: f64) -> (Part, TriMesh) {
    let mesh = prism("solid", outline, 0.0, height_m, cap);
    let (sin, cos) = real::sin_cos(yaw_rad);
    let turn = |[x, y, z]: &[f64; 3]| DVec3::new(cos * x - sin * y, sin * x + cos * y, *z);
    let vertices: Vec<DVec3> = mesh.vertices.iter().map(turn).collect();
    let theirs = vertices.iter().map(|at| Vector::new(at.x, at.y, at.z)).collect();
    let solid = TriMesh::with_flags(theirs, mesh.triangles.clone(), TriMeshFlags::ORIENTED).expect("a closed mesh");
    (Part { name: "solid".into(), owner: 0, vertices, triangles: mesh.triangles }, solid)
}

fn check_cover(name: &str, outline: &[[f64; 2]], cap: &[[u32; 3]], stream: &mut RandomStream) {
    for (round, voxel_m) in [(0, 0.5), (1, 0.5), (2, 1.0), (3, 0.25)] {
        let yaw_rad = if round == 0 { 0.0 } else { stream.uniform(-3.0, 3.0) };
        let (part, solid) = turned(outline, cap, 7.0, yaw_rad);
        let boxes = solid::boxes(&part, voxel_m);
        let cover = BoxBvh::build(boxes.clone());
        for _ in 0..3000 {
            let at = DVec3::new(stream.uniform(-25.0, 25.0), stream.uniform(-25.0, 25.0), stream.uniform(-1.0, 8.0));
            let point = Vector::new(at.x, at.y, at.z);
            let is_covered = cover.nearest(at, 50.0).is_some_and(|near| near.distance_m <= 1e-6);
            let is_solid = solid.contains_local_point(point);
            assert!(!is_solid || is_covered, "{name}, yaw {yaw_rad}: {at} is solid but not covered");
            let far_m = if is_solid { 0.0 } else { solid.distance_to_local_point(point, true) };
            assert!(!is_covered || far_m <= 1.5 * voxel_m, "{name}, yaw {yaw_rad}: {at} is covered but {far_m} m away");
        }
    }
}

#[test]
fn boxes_hold_every_solid_point_and_stay_near() {
    let mut stream = Seed::of_item(3, "meshes", "cover").stream("points");
    check_cover("L", &HOUSE, &HOUSE_CAP, &mut stream);
    check_cover("rectangle", &[[0.0, 0.0], [16.0, 0.0], [16.0, 9.0], [0.0, 9.0]], &[[0, 1, 2], [0, 2, 3]], &mut stream);
    let bent = [[0.0, 0.0], [12.0, 0.0], [20.0, 8.0], [19.8, 8.3], [11.9, 0.3], [0.0, 0.3]];
    check_cover("bent wall", &bent, &[[0, 1, 5], [1, 4, 5], [1, 2, 4], [2, 3, 4]], &mut stream);
}

#[test]
fn a_turned_block_is_one_exact_box() {
    let (part, _) = turned(&[[0.0, 0.0], [16.0, 0.0], [16.0, 9.0], [0.0, 9.0]], &[[0, 1, 2], [0, 2, 3]], 7.0, 0.7);
    let boxes = solid::boxes(&part, 0.5);
    assert_eq!(boxes.len(), 1, "{boxes:?}");
    let mut half = boxes[0].half_extents_m.to_array();
    half.sort_by(f64::total_cmp);
    assert!(half.iter().zip([3.5, 4.5, 8.0]).all(|(own, expected)| (own - expected).abs() < 0.02), "{half:?}");
}

#[test]
fn files_that_lie_are_refused_or_read_without_what_is_missing() {
    let options = MeshOptions::default();
    for (from, to, expected) in [
        ("f 1 2 3", "f 1 2 99999", "has corner 99999"),
        ("f 1 2 3", "f 1 2 -9", "corner"),
        ("f 1 2 3", "f 1 2", "three corners"),
        ("v 40 0 40", "v 40 0", "three numbers"),
    ] {
        let text = String::from_utf8(obj(&scene())).unwrap();
        assert!(text.contains(from));
        let error = read::<Obj>(text.replacen(from, to, 1).as_bytes(), &options).unwrap_err();
        assert!(error.message.contains(expected), "{error}");
    }
    let file = glb(&scene());
    let patched = |from: &str, to: &str| {
        assert_eq!(from.len(), to.len());
        let at = file.windows(from.len()).position(|window| window == from.as_bytes()).unwrap();
        [&file[..at], to.as_bytes(), &file[at + from.len()..]].concat()
    };
    let (_, warnings) = GlTf::read(&patched(r#""count":8,"#, r#""count":9,"#), &options).unwrap();
    assert!(warnings.iter().any(|warning| warning.contains("left out")), "{warnings:?}");
    assert!(read::<GlTf>(&file[..file.len() - 9], &options).is_err());
}

/// A GLB file: text, then data.
fn glb_of(json: &str, data: &[u8]) -> Vec<u8> {
    let mut text = json.as_bytes().to_vec();
    text.resize(text.len().next_multiple_of(4), b' ');
    let chunk = |kind: &[u8; 4], content: &[u8]| [&(content.len() as u32).to_le_bytes(), &kind[..], content].concat();
    let chunks = [chunk(b"JSON", &text), chunk(b"BIN\0", data)].concat();
    [&b"glTF"[..], &2_u32.to_le_bytes(), &(12 + chunks.len() as u32).to_le_bytes(), &chunks].concat()
}

/// A house of 8 m by 6 m and 5 m high at four places, as packed or as sparse corners.
fn houses(is_sparse: bool, required: &str) -> Vec<u8> {
    let corner = |at: usize| [8 * (at & 1) as i16, 5 * (at >> 1 & 1) as i16, 6 * (at >> 2) as i16];
    let sides = [[0, 1, 3, 2], [4, 6, 7, 5], [0, 4, 5, 1], [2, 3, 7, 6], [0, 2, 6, 4], [1, 5, 7, 3]];
    let mut data: Vec<u8> = sides.iter().flat_map(|[a, b, c, d]| [*a, *b, *c, *a, *c, *d]).collect();
    let places = [[0.0_f32, 0.0, 0.0], [40.0, 0.0, 0.0], [0.0, 0.0, 40.0], [40.0, 0.0, 40.0]];
    data.extend(places.iter().flatten().flat_map(|number| number.to_le_bytes()));
    data.extend(0..8_u8);
    let start = data.len();
    for corner in (0..8).map(corner) {
        if is_sparse {
            data.extend(corner.iter().flat_map(|number| f32::from(*number).to_le_bytes()));
        } else {
            data.extend([corner[0], corner[1], corner[2], 0].iter().flat_map(|number| number.to_le_bytes()));
        }
    }
    let length = data.len() - start;
    let (corners, stride) = if is_sparse {
        let indices = r#""indices":{"bufferView":2,"componentType":5121},"values":{"bufferView":3}"#;
        (format!(r#""componentType":5126,"sparse":{{"count":8,{indices}}}"#), "")
    } else {
        (r#""bufferView":3,"componentType":5122"#.to_owned(), r#","byteStride":8"#)
    };
    let json = format!(
        r#"{{"asset":{{"version":"2.0"}},{required}"nodes":[{{"name":"House","mesh":0,"extensions":{{"EXT_mesh_gpu_instancing":{{"attributes":{{"TRANSLATION":2}}}}}}}}],
        "meshes":[{{"primitives":[{{"attributes":{{"POSITION":1}},"indices":0}}]}}],
        "accessors":[{{"bufferView":0,"componentType":5121,"count":36,"type":"SCALAR"}},{{{corners},"count":8,"type":"VEC3"}},
        {{"bufferView":1,"componentType":5126,"count":4,"type":"VEC3"}}],
        "bufferViews":[{{"buffer":0,"byteOffset":0,"byteLength":36}},{{"buffer":0,"byteOffset":36,"byteLength":48}},
        {{"buffer":0,"byteOffset":84,"byteLength":8}},{{"buffer":0,"byteOffset":{start},"byteLength":{length}{stride}}}],
        "buffers":[{{"byteLength":{}}}]}}"#,
        data.len()
    );
    glb_of(&json, &data)
}

#[test]
fn packed_and_sparse_corners_and_repeated_meshes_are_read() {
    let options = MeshOptions::default();
    for is_sparse in [false, true] {
        let town = read::<GlTf>(&houses(is_sparse, ""), &options).unwrap();
        assert_eq!(town.obstacles.len(), 4, "{:?}", town.obstacles);
        let size = |one: &cosfly_domain::Obstacle| (2.0 * one.shape.half_extents_m - DVec3::new(8.0, 6.0, 5.0)).abs();
        assert!(town.obstacles.iter().all(|one| size(one).max_element() < 0.02), "{:?}", town.obstacles);
    }
    let required = r#""extensionsRequired":["ACME_compression"],"#;
    let refused = read::<GlTf>(&houses(false, required), &options).unwrap_err();
    assert!(refused.message.contains("ACME_compression"), "{refused}");
}

#[test]
fn streams_that_say_more_than_a_file_of_their_size_holds_are_refused() {
    // A thousand of equal elements are a few bytes: the widths of a block's differences, and one element.
    let packed = [&[0xa1, 0xaa][..], &[0xaa; 3], &[0; 24]].concat();
    let times = |views: usize, count: usize, length: usize| {
        let view = format!(
            r#"{{"buffer":1,"byteStride":4,"extensions":{{"EXT_meshopt_compression":
            {{"buffer":0,"byteLength":{length},"byteStride":4,"count":{count},"mode":"ATTRIBUTES"}}}}}}"#
        );
        let json = format!(
            r#"{{"asset":{{"version":"2.0"}},"extensionsRequired":["EXT_meshopt_compression"],"bufferViews":[{}],
            "buffers":[{{"byteLength":{}}},{{"byteLength":1099511627776}}]}}"#,
            vec![view; views].join(","),
            packed.len()
        );
        Document::read(&glb_of(&json, &packed)).map(|_| ())
    };
    times(1, 1000, packed.len()).expect("a file");
    for (views, count, length, words) in [
        (1, 1001, packed.len() - 1, "its stream or its filter"),
        (1, 1 << 40, packed.len(), "more than a file of this size"),
        (1, usize::MAX, packed.len(), "more than a file of this size"),
        (6000, 1000, packed.len(), "more than a file of this size"),
        (1, 1000, packed.len() + 4, "are not in the file"),
    ] {
        let error = times(views, count, length).unwrap_err();
        assert!(error.message.contains(words) && !error.hints.is_empty(), "{error:?}");
    }
}

/// The house of [`houses`] with its places in a picture, packed by Google's encoder (DracoPy 2.2, level 7, 14 bits).
const PACKED_HOUSE: &str = "RFJBQ08CAgEBAAAACAwCCwAAA19LFQEBEP8CNUH/AjVBAwAAAAEAAP8AAAECAgQBAAEBAwkCAQEAAQAJAwACAgEBAQEDzwEBLAEE/4sBBAMBBP+PAQIBAgEECQC3suYSHzutjQAAAAD/AAAAAAAAAAAAgD8AAIA/AAAAAAAAgD8AAIA/AACAPwAAgD8AAIA/AAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAACAPwEBAQAPAwEQLwEwAwAklwAAABAABgABMAAAAAjAAAAAIAALgBAA/l8BEAAAACAAAgAAAAD/PwAAAAAAAAAAAAAAAAAAAAAAQQ4=";

#[test]
fn shapes_that_draco_packed_are_read_and_damaged_ones_refused() {
    let packed = STANDARD.decode(PACKED_HOUSE).unwrap();
    let times = |shapes: usize, packed: &[u8]| {
        let shape = r#"{"attributes":{"POSITION":1,"TEXCOORD_0":2,"COLOR_0":3},"indices":0,"material":0,
            "extensions":{"KHR_draco_mesh_compression":{"bufferView":0,"attributes":{"POSITION":2,"COLOR_0":0,"TEXCOORD_0":1}}}}"#;
        let json = format!(
            r#"{{"asset":{{"version":"2.0"}},"extensionsRequired":["KHR_draco_mesh_compression"],"nodes":[{{"name":"House","mesh":0}}],
            "materials":[{{"pbrMetallicRoughness":{{"baseColorTexture":{{"index":0}}}}}}],
            "meshes":[{{"primitives":[{1}]}}],
            "accessors":[{{"componentType":5123,"count":36,"type":"SCALAR"}},{{"componentType":5126,"count":8,"type":"VEC3"}},
            {{"componentType":5126,"count":8,"type":"VEC2"}},{{"componentType":5121,"normalized":true,"count":8,"type":"VEC3"}}],
            "bufferViews":[{{"buffer":0,"byteLength":{0}}}],"buffers":[{{"byteLength":{0}}}]}}"#,
            packed.len(),
            vec![shape; shapes].join(",")
        );
        glb_of(&json, packed)
    };
    let file = |packed: &[u8]| times(1, packed);
    let options = MeshOptions::default();
    let town = read::<GlTf>(&file(&packed), &options).unwrap();
    let size = 2.0 * town.obstacles[0].shape.half_extents_m - DVec3::new(8.0, 6.0, 5.0);
    assert!(town.obstacles.len() == 1 && size.abs().max_element() < 0.02, "{:?}", town.obstacles);
    let document = Document::read(&file(&packed)).unwrap();
    let shape = &document.mesh(0).unwrap().primitives[0];
    let (points, corners) = triangles(&document, shape).unwrap();
    assert_eq!((points.len(), corners.len()), (8, 12));
    let texture = document.material(0).unwrap().base().1.unwrap();
    for (point, place) in points.iter().zip(document.texture_places(shape, texture).unwrap()) {
        let expected = [point.x / 8.0, 1.0 - point.y / 5.0].map(|at| at as f32);
        assert!((0..2).all(|k| (place[k] - expected[k]).abs() < 1e-3), "{place:?} {expected:?}");
    }
    let colours = document.colours(shape.attributes["COLOR_0"]).unwrap();
    assert!(colours.iter().all(|colour| (colour[1] - 0.4).abs() < 1e-6 && colour[2] == 1.0), "{colours:?}");
    // A few bytes that stand for many shapes are refused before all of them are unpacked.
    let error = Document::read(&times(40_000, &packed)).unwrap_err();
    assert!(error.message.contains("Draco") && error.message.contains("ceiling"), "{error}");
    // Each layer of seams takes memory for all 200,000 triangles that a head promises.
    let promised = |layers: u8| {
        let count = &[0xc0, 0x9a, 0x0c][..];
        let head = [&b"DRACO\x02\x02\x01\x01\0\0\0"[..], count, count, &[layers], count, &[0]].concat();
        Document::read(&file(&head)).unwrap_err().message
    };
    assert!(promised(200).contains("ceiling") && !promised(1).contains("ceiling"), "{} {}", promised(200), promised(1));
    // Cut, it is refused by name; with any bit turned it is read or refused, and nothing hangs.
    for length in 0..packed.len() - 1 {
        let error = Document::read(&file(&packed[..length])).unwrap_err();
        assert!(error.message.contains("Draco") && !error.hints.is_empty(), "{length}: {error}");
    }
    for bit in 0..8 * packed.len() {
        let mut turned = packed.clone();
        turned[bit / 8] ^= 1 << (bit % 8);
        drop(Document::read(&file(&turned)));
    }
}

#[test]
fn drawings_of_other_programs_are_the_same_house() {
    let corners = "v 0 0 0\nv 20 0 0\nv 20 0 -8\nv 8 0 -8\nv 8 0 -20\nv 0 0 -20\nv 0 9 0\nv 20 9 0\nv 20 9 -8\nv 8 9 -8\nv 8 9 -20\nv 0 9 -20\n";
    // The first corner of the floor and of the roof is one from which a fan of triangles leaves the house.
    let walls: String = (1..=6).map(|at| format!("f {at} {} {} {}\n", at % 6 + 1, at % 6 + 7, at + 6)).collect();
    let house = format!("o House\n{corners}f 6 5 4 3 2 1\nf 8 9 10 11 12 7\n{walls}");
    let solid = |text: &str| {
        let town = read::<Obj>(text.as_bytes(), &MeshOptions::default()).unwrap();
        let cover = BoxBvh::build(town.obstacles.iter().map(|one| one.shape).collect());
        let is_in = |x: f64, y: f64| {
            let at = town.origin.offset_m;
            let point = DVec3::new(x - at.x, -y - at.y, 4.5);
            cover.nearest(point, 50.0).is_some_and(|near| near.distance_m <= 1e-6)
        };
        assert!(town.obstacles.iter().all(|one| one.kind == ObstacleKind::Building));
        [(4.0, 4.0), (16.0, 4.0), (4.0, 16.0), (14.0, 14.0), (10.0, 10.0)].map(|(x, y)| is_in(x, y))
    };
    let expected = [true, true, true, false, false];
    for (name, text) in [
        ("plain", house.clone()),
        ("tabs", house.replace(' ', "\t")),
        ("indented", format!("  {}", house.replace('\n', "\n  "))),
        ("continued", house.replace("f 6 5", "f 6 \\\n5")),
        ("coordinates of pictures first", format!("vt 0 0\nusemtl walls\n{house}")),
        ("groups", house.replace("o House", "# drawn\ns off\no House\ng Cube")),
    ] {
        assert_eq!(solid(&text), expected, "{name}");
    }
}

#[test]
fn places_on_the_earth_that_are_not_applied_are_said_or_refused() {
    let options = MeshOptions::default();
    let remark = "# Global shift: -393706 -5815132 0\n";
    let text = format!("{remark}{}", String::from_utf8(obj(&scene())).unwrap());
    let (_, warnings) = Obj::read(text.as_bytes(), &options).unwrap();
    assert!(warnings.iter().any(|it| it.contains(remark.trim()) && it.contains("not applied")), "{warnings:?}");
    let json = |center: &str| {
        let extensions = format!("{{\"CESIUM_RTC\":{{\"center\":{center}}}}}");
        glb_of(&format!("{{\"asset\":{{\"version\":\"2.0\"}},\"meshes\":[],\"extensions\":{extensions}}}"), &[])
    };
    let error = read::<GlTf>(&json("[3783000, 898000, 5035000]"), &options).unwrap_err();
    assert!(error.message.contains("`CESIUM_RTC`") && error.hints[0].contains("axes of a plan"), "{error}");
    assert!(read::<GlTf>(&json("[0, 0, 0]"), &options).unwrap_err().message.contains("no triangles"));
    // A scene whose corners count from the Earth's centre.
    let mut meshes = scene();
    meshes.iter_mut().flat_map(|mesh| &mut mesh.vertices).for_each(|vertex| vertex[2] += 5_035_000.0);
    let error = read::<Obj>(&obj(&meshes), &options).unwrap_err();
    assert!(error.message.contains("centre of the Earth"), "{error}");
}
