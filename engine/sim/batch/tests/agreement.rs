//! Depth, labels and ids against the large renderer and against rays in f64.

#[path = "../../../../tests/shared.rs"]
mod shared;
mod towns;

use cosfly_batch::{BatchRenderer, BatchScene, BatchView, Outputs};
use cosfly_domain::{BodyKind, Camera, ObstacleKind, Town, Weather, object_instance};
use cosfly_figures::{BodyFigure, BodyShape};
use cosfly_frames::{DVec3, Seed};
use cosfly_geometry::{BoxBvh, SpatialQuery};
use cosfly_render::{FrameParts, FrameSetup, PictureLook, Renderer, Scene};
use cosfly_town::GroundIndex;
use towns::Place;

const FOV_RAD: f64 = 1.4;

/// Every eighth of the people becomes a vehicle, a kind after the other; the first target is a car.
fn with_vehicles(mut places: Vec<Place>) -> Vec<Place> {
    let kinds = [
        (BodyKind::Car, DVec3::new(4.4, 1.8, 1.5)),
        (BodyKind::Bus, DVec3::new(11.5, 2.5, 3.2)),
        (BodyKind::Bicycle, DVec3::new(1.8, 0.6, 1.75)),
        (BodyKind::Truck, DVec3::new(8.0, 2.4, 3.3)),
        (BodyKind::Motorcycle, DVec3::new(2.1, 0.8, 1.7)),
        (BodyKind::Van, DVec3::new(5.4, 2.0, 2.3)),
    ];
    let mut next = kinds.iter().cycle();
    let mut turn = |figure: &mut BodyFigure| {
        let Some((kind, size_m)) = next.next() else { return };
        figure.body = BodyShape::of(*kind, *size_m);
        (figure.height_m, figure.radius_m) = (size_m.z, 0.5 * size_m.truncate().length());
    };
    if let Some(first) = places.first_mut() {
        turn(&mut first.target);
    }
    places.iter_mut().for_each(|place| place.others.iter_mut().step_by(8).for_each(|other| turn(&mut other.figure)));
    places
}

/// Depths agree within a millimetre and a hundred-thousandth, the bound of the large renderer against rays.
fn is_same_depth(a: f64, b: f64) -> bool {
    a == b || (a - b).abs() <= 1e-3 + 1e-5 * b
}

struct Pictures {
    depth_m: Vec<f32>,
    semantic: Vec<u8>,
    instance: Vec<u32>,
    target_mask: Vec<u8>,
}

fn small(scene: &BatchScene, place: &Place, size: u32) -> Pictures {
    let pixels = (size * size) as usize;
    let mut pictures = Pictures {
        depth_m: vec![-1.0; pixels],
        semantic: vec![99; pixels],
        instance: vec![99; pixels],
        target_mask: vec![99; pixels],
    };
    let view = BatchView {
        scene,
        pose: place.pose,
        horizontal_fov_rad: FOV_RAD,
        target: Some(place.target),
        others: &place.others,
        weather: None,
        look: PictureLook::Simple,
    };
    let outputs = Outputs {
        depth_m: Some(&mut pictures.depth_m),
        semantic: Some(&mut pictures.semantic),
        instance: Some(&mut pictures.instance),
        target_mask: Some(&mut pictures.target_mask),
        ..Outputs::default()
    };
    BatchRenderer::new(size, size).render(&[view], outputs);
    pictures
}

/// Compares all pixels of places of a town with the large renderer's; at most one in `rare` may differ, on edges, where a
/// rounding decides.
fn agrees_with_large(town: &Town, count: usize, people: u32, rare: usize) {
    let scene = Scene::new(town, Seed([1; 32]));
    let batch = BatchScene::without_colours(town, &GroundIndex::new(town));
    let weather =
        Weather { sun_azimuth_angle: 200.0, ..cosfly_materials::presets::preset("ClearNoon").expect("a preset") };
    for (number, place) in with_vehicles(towns::places(town, count, people)).iter().enumerate() {
        for size in [64u32, 84, 128, 224] {
            let ours = small(&batch, place, size);
            let mut large = Renderer::new(Camera { width: size, height: size, horizontal_fov_rad: FOV_RAD });
            let setup =
                FrameSetup { pose: place.pose, weather: &weather, target: Some(place.target), others: &place.others };
            let images = large.render_parts(&scene, &setup, FrameParts::Ids).images;
            let pixels = images.depth_m.len();
            let count = |differs: &dyn Fn(usize) -> bool| (0..pixels).filter(|pixel| differs(*pixel)).count();
            let depths = count(&|p| !is_same_depth(f64::from(ours.depth_m[p]), f64::from(images.depth_m[p])));
            let labels = count(&|p| ours.semantic[p] != images.semantic[p]);
            let ids = count(&|p| ours.instance[p] != images.instance[p]);
            let most = pixels.div_ceil(rare);
            assert!(
                depths <= most && labels <= most && ids <= most,
                "place {number}, {size} px: {depths} depths, {labels} labels, {ids} ids of {pixels} differ"
            );
            assert!(ours.target_mask.iter().zip(&ours.instance).all(|(mask, id)| *mask == u8::from(*id == 1)));
        }
    }
}

#[test]
fn downtown_is_as_in_large_pictures() {
    agrees_with_large(&towns::shipped("downtown.xodr"), 24, 40, 1500);
}

#[test]
fn round_crowns_are_as_in_large_pictures() {
    let mut town = towns::shipped("downtown.xodr");
    let mut crowned = None;
    // One box a crown, some longer than wide.
    town.obstacles.retain_mut(|one| {
        let is_crown = one.kind == ObstacleKind::TreeCrown;
        if is_crown {
            one.shape.half_extents_m *= DVec3::new(if one.object_id % 3 == 0 { 4.0 } else { 1.7 }, 1.7, 1.0);
        }
        !is_crown || crowned.replace(one.object_id) != Some(one.object_id)
    });
    agrees_with_large(&town, 12, 20, 800);
}

/// Hulls and slides have faces that lean, and containers stand back from the ends of their stacks, under any seed of looks.
#[test]
fn boats_containers_and_things_to_play_on_are_as_in_large_pictures() {
    for (place, seed) in [("waterfront", 4), ("industrial", 4), ("campus", 5)] {
        let mut town = towns::generated(place, seed);
        // Cars of maps are boxes in small pictures.
        town.obstacles.retain(|one| one.kind != ObstacleKind::Car);
        agrees_with_large(&town, 8, 10, 800);
    }
}

#[test]
fn uptown_is_as_in_large_pictures() {
    agrees_with_large(&towns::shipped("uptown.xodr"), 8, 20, 1500);
}

#[test]
fn sloped_towns_are_as_in_large_pictures() {
    for name in ["carla_xodr/Town07.xodr", "xodr_city/Ingolstadt_CityHall.xodr"] {
        if let Some(path) = shared::shared_input(name) {
            // One camera looks along a kerb and along the end of a line beside it, which are a thousandth of a pixel wide then.
            agrees_with_large(&towns::of_file(&path), 8, 20, 800);
        }
    }
}

#[test]
fn boxes_are_where_rays_in_full_precision_hit_them() {
    let mut town = towns::shipped("downtown.xodr");
    // Benches and shelters are drawn of parts within their boxes.
    town.obstacles.retain(|one| !matches!(one.kind, ObstacleKind::Bench | ObstacleKind::Static));
    let batch = BatchScene::new(&town, Seed([1; 32]));
    let tree = BoxBvh::build(town.obstacles.iter().map(|obstacle| obstacle.shape).collect());
    let (mut compared, mut wrong) = (0, 0);
    for place in towns::places(&town, 12, 0) {
        for size in [64, 84, 128, 224u32] {
            let camera = Camera { width: size, height: size, horizontal_fov_rad: FOV_RAD };
            let ours = small(&batch, &place, size);
            for pixel in (0..ours.depth_m.len()).step_by(7) {
                let (column, row) = (pixel as u32 % size, pixel as u32 / size);
                let ray = camera.ray_in_world(&place.pose, f64::from(column) + 0.5, f64::from(row) + 0.5);
                let hit = tree.closest_hit(place.pose.position_in_world, ray, 1e9);
                let seen = f64::from(ours.depth_m[pixel]);
                let is_box = ours.instance[pixel] > 1;
                compared += 1;
                wrong += usize::from(match hit {
                    Some(hit) if is_box => {
                        let id = object_instance(town.obstacles[hit.primitive as usize].object_id);
                        !is_same_depth(seen, hit.t) || ours.instance[pixel] != id
                    }
                    // Ground or the target may lie before it.
                    Some(hit) => seen > hit.t,
                    None => is_box,
                });
            }
        }
    }
    // Boxes of different things share planes here and there.
    assert!(wrong <= compared / 1500, "{wrong} of {compared}");
}
