//! Pictures of a scan: those of the large renderer, in all channels.

use cosfly_batch::{BatchRenderer, BatchScene, BatchView, OnRequest, Outputs};
use cosfly_domain::channels::SeenPoint;
use cosfly_domain::{Camera, TARGET_INSTANCE};
use cosfly_figures::{BodyFigure, BodyShape};
use cosfly_frames::{DVec3, Pose, Seed, TargetState};
use cosfly_maps::{MapConfig, read_town};
use cosfly_models::mesh::{MeshConfig, TexturedMesh};
use cosfly_render::{FrameSetup, PictureLook, Renderer, Scene, SceneMesh, SceneScan};
use cosfly_town::GroundIndex;
use std::sync::Arc;

const SEED: Seed = Seed([1; 32]);
const SIDE: u32 = 96;
const FOV_RAD: f64 = 1.2;

#[test]
fn small_pictures_of_a_mesh_are_those_of_the_large_renderer() {
    let (town, _) = read_town(TexturedMesh::EXAMPLE, &MapConfig::default(), Seed([5; 32])).expect("a town");
    let config = MeshConfig::new("scan.glb");
    let place = config.place(town.origin.offset_m).expect("a place");
    let mesh = TexturedMesh::read(TexturedMesh::EXAMPLE, &[], &place).expect("a mesh");
    let scan = SceneScan { mesh: Some(Arc::new(SceneMesh::new(mesh, &config, &town))), ..SceneScan::default() };
    let scene = BatchScene::without_colours(&town, &GroundIndex::new(&town)).with_scan(&town, SEED, scan.clone());
    let target = BodyFigure {
        state: TargetState { feet_in_world: DVec3::new(-4.0, 4.0, 0.12), heading_rad: 0.1, speed_mps: 1.4 },
        height_m: 1.75,
        radius_m: 0.3,
        clothes_seed: Seed([9; 32]),
        gait_phase_rad: 1.2,
        body: BodyShape::default(),
    };
    let feet = target.state.feet_in_world;
    let pose = Pose::looking_at(feet + DVec3::new(3.0, 6.0, 2.0), feet + DVec3::Z);
    let view = BatchView {
        scene: &scene,
        pose,
        horizontal_fov_rad: FOV_RAD,
        target: Some(target),
        others: &[],
        weather: None,
        look: PictureLook::Full,
    };
    let pixels = (SIDE * SIDE) as usize;
    let (mut rgb, mut depth_m, mut mask, mut up) =
        (vec![0; 3 * pixels], vec![0.0; pixels], vec![9; pixels], vec![9.0; pixels]);
    let height = |point: &SeenPoint| point.normal_in_world.z as f32;
    let outputs = Outputs {
        rgb: Some(&mut rgb),
        depth_m: Some(&mut depth_m),
        target_mask: Some(&mut mask),
        on_request: vec![OnRequest::Numbers(height, &mut up)],
        ..Outputs::default()
    };
    BatchRenderer::new(SIDE, SIDE).render(&[view], outputs);
    let mut renderer = Renderer::new(Camera { width: SIDE, height: SIDE, horizontal_fov_rad: FOV_RAD });
    let weather = cosfly_materials::presets::clear_noon();
    let large = Scene::new(&town, SEED).with_scan(scan);
    let images =
        renderer.render(&large, &FrameSetup { pose, weather: &weather, target: Some(target), others: &[] }).images;
    assert!(rgb == images.rgb && depth_m == images.depth_m);
    let of_target: Vec<u8> = images.instance.iter().map(|id| u8::from(*id == TARGET_INSTANCE)).collect();
    assert!(mask == of_target && of_target.contains(&1));
    assert!(up.iter().all(|up| up.abs() <= 1.001) && up.iter().any(|up| *up > 0.99), "normals");
    // Not the map's boxes.
    let boxes =
        renderer.render(&Scene::new(&town, SEED), &FrameSetup { pose, weather: &weather, target: None, others: &[] });
    assert!(boxes.images.depth_m != depth_m);
}
