//! The known scene: a town filmed as it is, as its own mesh and as its own splats. `--nocapture` prints the figures of the page "Scans".

#[path = "../../render/tests/small_town/mod.rs"]
mod small_town;

use cosfly_bake::{BakeProblem, BakedTown, bake};
use cosfly_domain::{Camera, FrameImages, Optics, SemanticLabel, Town, Weather};
use cosfly_figures::{BodyFigure, BodyShape};
use cosfly_frames::{DVec3, Pose, Seed, TargetState, real};
use cosfly_geometry::{BoxBvh, SpatialQuery};
use cosfly_maps::{MapConfig, read_town};
use cosfly_models::mesh::{MeshConfig, TexturedMesh};
use cosfly_render::{FrameSetup, Renderer, Scene, SceneMesh, SceneScan, SceneSplats};
use cosfly_scans::tiles::{TilesChoice, join};
use cosfly_scans::up_axis::UpAxis;
use cosfly_splats::{Splat, SplatCloud, SplatRenderer, SplatView, SplatsConfig};
use serde_json::{Value, json};
use std::collections::BTreeMap;
use std::sync::Arc;

const CAMERA: Camera = Camera { width: 320, height: 180, horizontal_fov_rad: 1.2 };
const SEED: Seed = Seed([1; 32]);
/// On the pavement.
const FEET: DVec3 = DVec3::new(-14.0, -15.5, 0.14);
const TEXEL_M: f64 = 0.2;

fn noon() -> Weather {
    Weather { sun_azimuth_angle: 140.0, ..cosfly_materials::presets::clear_noon() }
}

fn town() -> Town {
    small_town::small_town(1, 1)
}

fn baked(texel_m: f64) -> BakedTown {
    bake(&town(), SEED, &noon(), texel_m).expect("a small town")
}

fn views() -> [Pose; 3] {
    [[-8.0, -6.0, 7.0], [-9.0, 2.0, 5.0], [-5.0, -14.0, 14.0]].map(|away| {
        let middle = FEET + DVec3::Z;
        Pose::looking_at(middle + DVec3::from_array(away), middle)
    })
}

/// A frame, and the share of the target that its pixels show.
fn draw(scene: &Scene, pose: Pose) -> (FrameImages, f64) {
    let target = BodyFigure {
        state: TargetState { feet_in_world: FEET, heading_rad: 0.1, speed_mps: 1.4 },
        height_m: 1.75,
        radius_m: 0.3,
        clothes_seed: Seed([9; 32]),
        gait_phase_rad: 1.2,
        body: BodyShape::default(),
    };
    let mut renderer = Renderer::new(CAMERA);
    renderer.set_optics(Optics::IDEAL);
    let frame = renderer.render(scene, &FrameSetup { pose, weather: &noon(), target: Some(target), others: &[] });
    (frame.images.clone(), frame.target_view.visible_by_pixels)
}

/// Pixels whose neighbours have their label and id, too.
fn off_edges(images: &FrameImages) -> Vec<usize> {
    let width = images.width as usize;
    let look = |at: usize| (images.semantic[at], images.instance[at]);
    let is_inner = |at: &usize| {
        [at - 1, at + 1, at - width, at + width, at - width - 1, at + width + 1].iter().all(|it| look(*it) == look(*at))
    };
    let inner = (width + 1..images.semantic.len() - width - 1).filter(is_inner);
    inner.filter(|at| images.depth_m[*at].is_finite()).collect()
}

/// The label that the name of a thing says: readers of meshes take road marks as roads.
fn named(label: u8) -> u8 {
    if label == SemanticLabel::RoadLine.id() { SemanticLabel::Roads.id() } else { label }
}

/// Median distance between the colours of some pixels, steps of 255.
fn colours_apart(a: &FrameImages, b: &FrameImages, pixels: &[usize]) -> u8 {
    let apart = |at: &usize| (3 * at..3 * at + 3).map(|byte| a.rgb[byte].abs_diff(b.rgb[byte])).max().unwrap_or(0);
    let mut all: Vec<u8> = pixels.iter().map(apart).collect();
    all.sort_unstable();
    all[all.len() / 2]
}

#[test]
fn a_town_as_its_own_mesh_has_its_depth_labels_visibility_and_colours() {
    let bytes = baked(TEXEL_M).to_glb("a town").expect("a file");
    let (read, _) = read_town(&bytes, &MapConfig::default(), Seed([5; 32])).expect("a map");
    let config = MeshConfig::new("town.glb");
    let mesh = || TexturedMesh::read(&bytes, &[], &config.place(DVec3::ZERO).expect("a place")).expect("a mesh");
    let known = Scene::new(&town(), SEED);
    for of in [&read, &town()] {
        let mesh = SceneMesh::new(mesh(), &config, of);
        assert!(mesh.known_share() > 0.98, "{}", mesh.known_share());
        let meshed = Scene::new(of, SEED).with_scan(SceneScan { mesh: Some(Arc::new(mesh)), ..SceneScan::default() });
        for pose in views() {
            let ((truth, visible), (drawn, as_mesh)) = (draw(&known, pose), draw(&meshed, pose));
            let pixels = off_edges(&truth);
            let count = |is_off: &dyn Fn(usize) -> bool| pixels.iter().filter(|at| is_off(**at)).count();
            let deep = count(&|at| (truth.depth_m[at] - drawn.depth_m[at]).abs() > 0.02);
            let other = count(&|at| named(truth.semantic[at]) != named(drawn.semantic[at]));
            let colours = colours_apart(&truth, &drawn, &pixels);
            println!(
                "mesh: {deep} of {} pixels more than 2 cm off, {other} with another label; visible {visible:.3} and \
                 {as_mesh:.3}; colours {colours} of 255 apart in the median",
                pixels.len()
            );
            assert!(pixels.len() > 10_000, "{}", pixels.len());
            // Layers of ground in one place may change their order along their edges.
            assert!(1000 * deep <= pixels.len() && 200 * other <= pixels.len());
            assert!(visible > 0.5 && (visible - as_mesh).abs() < 0.02, "{visible} {as_mesh}");
            assert!(colours < 20);
        }
    }
    // What is solid in the mesh lies in the boxes that the planner keeps away from.
    let boxes = BoxBvh::build(read.obstacles.iter().map(|obstacle| obstacle.shape).collect());
    let ground = SceneMesh::new(mesh(), &config, &read);
    for at in 0..200 {
        let from = DVec3::new(f64::from(at % 20) * 2.5 - 25.0, f64::from(at / 20) * 5.0 - 25.0, 6.0);
        let (to, within_m) = (from + DVec3::X, 3.0);
        let [of_mesh, of_boxes] =
            [ground.clearance_m(&[from, to], within_m), boxes.segment_clearance(from, to, within_m)];
        assert!(of_mesh > of_boxes - 0.01, "{from}: {of_mesh} m from the mesh, {of_boxes} m from the boxes");
    }
}

#[test]
fn a_town_as_its_own_splats_has_its_depth_and_colours() {
    let splats: Vec<Splat> = baked(TEXEL_M).splats();
    let mut cloud = SplatCloud::new(0);
    splats.iter().for_each(|splat| cloud.push(splat));
    let config = SplatsConfig::new("town.ply", UpAxis::Z);
    let placement = config.placement(DVec3::ZERO).expect("a place");
    let known = Scene::new(&town(), SEED);
    let placed = SceneSplats::new(cloud.clone(), &config, DVec3::ZERO).expect("a place");
    let scanned =
        Scene::new(&town(), SEED).with_scan(SceneScan { splats: Some(Arc::new(placed)), ..SceneScan::default() });
    for pose in views() {
        let ((truth, visible), (drawn, as_splats)) = (draw(&known, pose), draw(&scanned, pose));
        assert!(truth.depth_m == drawn.depth_m && truth.semantic == drawn.semantic && visible == as_splats);
        let pixels = off_edges(&truth);
        let view = SplatView::new(&CAMERA, &pose, &placement, false);
        let mut renderer = SplatRenderer::default();
        let picture = renderer.draw(&cloud, &view, None);
        let both = pixels.iter().filter(|at| picture.depth_m[**at].is_finite());
        let mut off: Vec<f32> = both.map(|at| (picture.depth_m[*at] - truth.depth_m[*at]).abs()).collect();
        off.sort_by(f32::total_cmp);
        let colours = colours_apart(&truth, &drawn, &pixels);
        println!(
            "splats: {} of {} pixels, off by {:.3} m in the median; colours {colours} of 255 apart in the median",
            off.len(),
            pixels.len(),
            off[off.len() / 2]
        );
        assert!(20 * off.len() > 19 * pixels.len() && off[off.len() / 2] < 0.05);
        assert!(colours < 20);
    }
}

#[test]
fn one_town_gives_the_same_bytes_and_too_many_pixels_are_refused() {
    let coarse = || baked(1.0).to_glb("a town").expect("a file");
    assert_eq!(coarse(), coarse(), "the same bytes twice");
    let refused = bake(&town(), SEED, &noon(), 0.002).err();
    assert!(refused.is_some_and(|BakeProblem { texels }| texels > 60_000_000));
}

/// Files of a tileset by their paths.
type Tiles = BTreeMap<String, Vec<u8>>;

/// A place on the Earth: latitude and longitude, degrees, height, metres.
const PLACE: [f64; 3] = [48.2, 16.37, 171.0];

/// From a frame at [`PLACE`], x to the east and z up, to the one that counts from the Earth's centre, column by column.
fn earth_from_here() -> [f64; 16] {
    let [(sin, cos), (east, north)] = [PLACE[0], PLACE[1]].map(|it| real::sin_cos(it.to_radians()));
    let (radius, squared) = (6_378_137.0, 0.006_694_379_990_141_33);
    let across = radius / (1.0 - squared * sin * sin).sqrt() + PLACE[2];
    let up = (across - squared * (across - PLACE[2])) * sin;
    [
        [-east, north, 0.0, 0.0],
        [-sin * north, -sin * east, cos, 0.0],
        [cos * north, cos * east, sin, 0.0],
        [across * cos * north, across * cos * east, up, 1.0],
    ]
    .concat()
    .try_into()
    .expect("sixteen numbers")
}

/// A GLB file with some of the nodes of another one, moved by `shift_m` (y up).
fn part_of(glb: &[u8], is_kept: &dyn Fn(usize) -> bool, shift_m: [f64; 3]) -> Vec<u8> {
    let length = u32::from_le_bytes(glb[12..16].try_into().expect("four bytes")) as usize;
    let (text, data) = (&glb[20..20 + length], &glb[20 + length..]);
    let mut document: Value = serde_json::from_slice(text).expect("JSON");
    let nodes = document["nodes"].as_array_mut().expect("nodes");
    nodes.iter_mut().for_each(|node| node["translation"] = json!(shift_m));
    document["scenes"][0]["nodes"] = (0..nodes.len()).filter(|at| is_kept(*at)).collect();
    let mut text = document.to_string().into_bytes();
    text.resize(text.len().next_multiple_of(4), b' ');
    let number = |of: usize| (of as u32).to_le_bytes();
    [&glb[..8], &number(20 + text.len() + data.len()), &number(text.len()), b"JSON", &text, data].concat()
}

/// A tile of 3D Tiles 1.0 whose corners count from `center`.
fn batched(glb: &[u8], center: [f64; 3]) -> Vec<u8> {
    let mut table = json!({ "BATCH_LENGTH": 0, "RTC_CENTER": center }).to_string().into_bytes();
    table.resize((28 + table.len()).next_multiple_of(8) - 28, b' ');
    let number = |of: usize| (of as u32).to_le_bytes();
    let head =
        [&b"b3dm"[..], &number(1), &number(28 + table.len() + glb.len()), &number(table.len()), &number(0)].concat();
    [&head[..], &number(0), &number(0), &table, glb].concat()
}

/// The town as 3D Tiles in two levels: one coarse tile, and four fine ones of all kinds.
fn tiled(fine: &[u8], coarse: &[u8]) -> Tiles {
    let quarter = |of: usize, shift_m| part_of(fine, &move |at| at % 4 == of, shift_m);
    let bounds = json!({ "box": [0, 0, 10, 40, 0, 0, 0, 40, 0, 0, 0, 40] });
    let leaf = |uri: &str| json!({ "boundingVolume": bounds, "geometricError": 0, "content": { "uri": uri } });
    let moved = [1.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0, 20.0, 0.0, 0.0, 1.0];
    let mut second = leaf("1.glb");
    second["transform"] = json!(moved);
    let root = json!({
        "boundingVolume": { "box": [0, 0, 0, 60, 0, 0, 0, 60, 0, 0, 0, 60] }, "geometricError": 1.5, "refine": "REPLACE",
        "transform": earth_from_here(), "content": { "url": "coarse.glb" },
        "children": [leaf("0.b3dm"), second, leaf("more/tileset.json")],
    });
    let further = leaf("both%20parts.cmpt");
    let whole = |root: &Value| {
        json!({ "asset": { "version": "1.0" }, "geometricError": 9, "root": root }).to_string().into_bytes()
    };
    let parts =
        [batched(&quarter(2, [0.0; 3]), [0.0; 3]), batched(&quarter(3, [0.0, 0.0, 5.0]), [0.0, 5.0, 0.0])].concat();
    let number = |of: usize| (of as u32).to_le_bytes();
    let several = [&b"cmpt"[..], &number(1), &number(16 + parts.len()), &number(2)].concat();
    Tiles::from([
        ("tileset.json".to_owned(), whole(&root)),
        ("coarse.glb".to_owned(), coarse.to_vec()),
        // The tile's frame has z up: 7 m to the east and 3 m down are (7, -3, 0) of a file.
        ("0.b3dm".to_owned(), batched(&quarter(0, [-7.0, 3.0, 0.0]), [7.0, 0.0, -3.0])),
        ("1.glb".to_owned(), quarter(1, [-20.0, 0.0, 0.0])),
        ("more/tileset.json".to_owned(), whole(&further)),
        ("more/both parts.cmpt".to_owned(), [several, parts].concat()),
    ])
}

#[test]
fn a_town_in_tiles_films_like_its_whole_mesh() {
    let (fine, coarse) =
        (baked(TEXEL_M).to_glb("a town").expect("a file"), baked(1.0).to_glb("a town").expect("a file"));
    let tiles = tiled(&fine, &coarse);
    let joined = |choice: &TilesChoice| {
        join("tileset.json", choice, &mut |path| Ok(tiles.get(path).unwrap_or_else(|| panic!("`{path}`")).clone()))
    };
    let here = TilesChoice { origin: Some(PLACE), ..TilesChoice::default() };
    let finest = joined(&here).expect("a mesh");
    assert_eq!((finest.tiles, finest.tilesets, finest.geometric_error_m), (3, 2, 0.0));
    assert!(finest == joined(&here).expect("a mesh"), "the same bytes twice");
    // Without an origin, it is the middle of the first tile.
    let own = joined(&TilesChoice::default()).expect("a mesh").origin.expect("a place");
    assert!(own.iter().zip(PLACE).all(|(own, given)| (own - given).abs() < 1e-6), "{own:?}");
    let config = MeshConfig::new("town.glb");
    let read =
        |bytes: &[u8]| TexturedMesh::read(bytes, &[], &config.place(DVec3::ZERO).expect("a place")).expect("a mesh");
    let drawn = |bytes: &[u8]| {
        let mesh = Some(Arc::new(SceneMesh::new(read(bytes), &config, &town())));
        let scene = Scene::new(&town(), SEED).with_scan(SceneScan { mesh, ..SceneScan::default() });
        views().map(|pose| draw(&scene, pose).0)
    };
    let (whole, of_tiles) = (drawn(&fine), drawn(&finest.glb));
    assert_eq!(read(&fine).triangles.len(), read(&finest.glb).triangles.len());
    for (whole, of_tiles) in whole.iter().zip(&of_tiles) {
        let pixels = off_edges(whole);
        let off = pixels.iter().filter(|at| (whole.depth_m[**at] - of_tiles.depth_m[**at]).abs() > 0.002).count();
        println!(
            "tiles: {off} of {} pixels more than 2 mm off; colours {}",
            pixels.len(),
            colours_apart(whole, of_tiles, &pixels)
        );
        assert!(pixels.len() > 10_000 && 1000 * off <= pixels.len(), "{off}");
        assert_eq!(colours_apart(whole, of_tiles, &pixels), 0);
    }
    // One level above, the coarse tile alone; farther away, nothing.
    let level = joined(&TilesChoice { geometric_error_m: 1.5, ..here }).expect("a mesh");
    assert_eq!((level.tiles, level.tilesets, level.geometric_error_m), (1, 1, 1.5));
    let away = joined(&TilesChoice { area_m: Some([100.0, 0.0, 200.0, 50.0]), ..here }).expect_err("nothing");
    assert!(away.message.contains("no tile") && !away.hints.is_empty(), "{away:?}");
}
