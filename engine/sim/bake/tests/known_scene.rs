//! The known scene: a town filmed as it is, as its own mesh and as its own splats. `--nocapture` prints the figures of the page "Scans".

#[path = "../../render/tests/small_town/mod.rs"]
mod small_town;

use cosfly_bake::{BakeProblem, BakedTown, bake};
use cosfly_domain::{Camera, FrameImages, Optics, SemanticLabel, Town, Weather};
use cosfly_figures::{BodyShape, Walker};
use cosfly_frames::{DVec3, Pose, Seed, TargetState};
use cosfly_geometry::{BoxBvh, SpatialQuery};
use cosfly_maps::{MapConfig, read_town};
use cosfly_models::mesh::{MeshConfig, TexturedMesh};
use cosfly_render::{FrameSetup, Renderer, Scene, SceneMesh, SceneScan, SceneSplats};
use cosfly_splats::{Splat, SplatCloud, SplatRenderer, SplatUpAxis, SplatView, SplatsConfig};
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
    let target = Walker {
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
    let bytes = baked(TEXEL_M).to_glb().expect("a file");
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
    let config = SplatsConfig::new("town.ply", SplatUpAxis::Z);
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
    let coarse = || baked(1.0).to_glb().expect("a file");
    assert_eq!(coarse(), coarse(), "the same bytes twice");
    let refused = bake(&town(), SEED, &noon(), 0.002).err();
    assert!(refused.is_some_and(|BakeProblem { texels }| texels > 60_000_000));
}
