//! Cars of a town: vehicles within their boxes, with the ids and labels of things of the town.

use cosfly_domain::{Camera, FrameImages, Obstacle, ObstacleKind, OrientedBox, Town, object_instance};
use cosfly_frames::{DVec3, Pose, Seed};
use cosfly_render::{FrameSetup, PictureLook, Renderer, Scene};

/// A town with one car of a size, turned.
fn town_with(size_m: DVec3, yaw_rad: f64) -> (Town, OrientedBox) {
    let mut town = Town::default();
    let center_in_world = DVec3::new(4.0, -3.0, 0.5 * size_m.z + 0.02);
    let shape = OrientedBox { center_in_world, half_extents_m: 0.5 * size_m, yaw_rad };
    town.obstacles.push(Obstacle { shape, kind: ObstacleKind::Car, object_id: 7, synthetic: false });
    (town, shape)
}

fn draw(scene: &Scene, look: PictureLook, pose: Pose) -> FrameImages {
    let mut renderer = Renderer::new(Camera { width: 320, height: 180, horizontal_fov_rad: 1.2 });
    renderer.set_look(look);
    let weather = cosfly_materials::presets::preset("ClearNoon").expect("a preset");
    renderer.render(scene, &FrameSetup { pose, weather: &weather, target: None, others: &[] }).images.clone()
}

const SIZES: [[f64; 3]; 6] =
    [[4.4, 1.8, 1.44], [1.85, 4.7, 1.5], [3.6, 1.7, 1.6], [5.5, 2.0, 2.4], [8.0, 2.5, 3.3], [12.0, 2.55, 3.1]];

#[test]
fn vehicles_fill_the_boxes_of_cars_and_stay_within() {
    for (number, size) in SIZES.into_iter().enumerate() {
        let (town, shape) = town_with(DVec3::from_array(size), 0.7 * number as f64 - 1.0);
        for seed in 0..6 {
            let scene = Scene::new(&town, Seed([seed; 32]));
            let triangles = scene.triangles();
            let corners: Vec<DVec3> = triangles
                .iter()
                .filter(|it| it.instance == object_instance(7))
                .flat_map(|it| it.corners_in_world)
                .collect();
            let own = corners.iter().map(|corner| {
                let away = *corner - shape.center_in_world;
                let (sin, cos) = (libm::sin(shape.yaw_rad), libm::cos(shape.yaw_rad));
                DVec3::new(cos * away.x + sin * away.y, cos * away.y - sin * away.x, away.z)
            });
            let (low, high) =
                own.fold((DVec3::INFINITY, DVec3::NEG_INFINITY), |(low, high), it| (low.min(it), high.max(it)));
            let off = (low + shape.half_extents_m).abs().max((high - shape.half_extents_m).abs());
            assert!(corners.len() > 300 && off.max_element() < 0.011, "{size:?}: {low} to {high}");
        }
    }
}

#[test]
fn pixels_of_cars_have_their_id_label_and_depth() {
    for size in SIZES {
        let (town, shape) = town_with(DVec3::from_array(size), 0.4);
        let scene = Scene::new(&town, Seed([1; 32]));
        let middle = shape.center_in_world;
        let pose = Pose::looking_at(middle + DVec3::new(-9.0, -7.0, 6.0), middle);
        for look in [PictureLook::Full, PictureLook::Simple] {
            let images = draw(&scene, look, pose);
            let of_car: Vec<usize> =
                (0..images.depth_m.len()).filter(|at| images.instance[*at] == object_instance(7)).collect();
            assert!(of_car.len() > 500, "{size:?}: {}", of_car.len());
            let label = ObstacleKind::Car.label().id();
            let reach_m = shape.half_extents_m.length();
            let away_m = (middle - pose.position_in_world).length();
            for at in of_car {
                assert_eq!(images.semantic[at], label);
                assert!((f64::from(images.depth_m[at]) - away_m).abs() < reach_m);
            }
        }
    }
}

#[test]
fn doors_are_darker_than_the_shoulder_above_them() {
    let (town, shape) = town_with(DVec3::new(4.4, 1.8, 1.44), 0.0);
    let door = shape.center_in_world + DVec3::X * 0.2;
    let pose = Pose::looking_at(door - DVec3::Y * 8.0, door);
    let ratio = |seed: u8| {
        let images = draw(&Scene::new(&town, Seed([seed; 32])), PictureLook::Full, pose);
        // 33 pixels a metre on the side, from its middle in row 90.
        let light = |z_m: f64| f64::from(images.rgb[3 * (320 * (90.0 - 33.0 * (z_m - 0.74)) as usize + 160) + 1]);
        (75..88).map(|z_cm| light(f64::from(z_cm) / 100.0)).fold(0.0, f64::max) / light(0.42)
    };
    let ratios: Vec<f64> = (0..6).map(ratio).collect();
    assert!(ratios.iter().filter(|ratio| **ratio > 1.4).count() > 3, "{ratios:?}");
}

#[test]
fn boxes_that_no_vehicle_fits_stay_boxes() {
    let (town, _) = town_with(DVec3::new(3.0, 3.0, 3.0), 0.4);
    let scene = Scene::new(&town, Seed([1; 32]));
    assert_eq!(scene.triangles().iter().filter(|it| it.instance == object_instance(7)).count(), 12);
    // Two boxes of one thing: a vehicle around both would leave them.
    let (mut town, shape) = town_with(DVec3::new(4.4, 1.8, 0.8), 0.4);
    let upper = OrientedBox { center_in_world: shape.center_in_world + DVec3::Z * 0.7, ..shape };
    town.obstacles.push(Obstacle { shape: upper, kind: ObstacleKind::Car, object_id: 7, synthetic: false });
    let scene = Scene::new(&town, Seed([1; 32]));
    assert_eq!(scene.triangles().iter().filter(|it| it.instance == object_instance(7)).count(), 24);
}
