//! Models in pictures: colours of their textures, labels and ids of the things whose places they take.

mod small_town;

use cosfly_domain::{Camera, FrameImages, ObstacleKind, Town, Weather, object_instance};
use cosfly_frames::{DVec3, Pose, Seed};
use cosfly_models::{Model, ModelFit, ModelKind};
use cosfly_render::{FrameSetup, PictureLook, Renderer, Scene, SceneModel};

fn example(fit: ModelFit) -> SceneModel {
    let model = Model::read(Model::EXAMPLE).expect("a model");
    SceneModel { kind: ModelKind::Car, fit, turn_rad: 0.0, model }
}

fn draw(scene: &Scene, look: PictureLook, pose: Pose) -> FrameImages {
    let mut renderer = Renderer::new(Camera { width: 320, height: 180, horizontal_fov_rad: 1.2 });
    renderer.set_look(look);
    let weather = Weather::preset("ClearNoon").expect("a preset");
    renderer.render(scene, &FrameSetup { pose, weather: &weather, target: None, others: &[] }).images.clone()
}

/// The town's first car: its object id, and the middle of it.
fn car(town: &Town) -> (u32, DVec3) {
    let car = town.obstacles.iter().find(|it| it.kind == ObstacleKind::Car).expect("a car");
    (car.object_id, car.shape.center_in_world)
}

#[test]
fn textures_show_and_labels_stay_those_of_the_things() {
    let town = small_town::small_town(1, 3);
    let (object_id, middle) = car(&town);
    let scene = Scene::with_models(&town, Seed([1; 32]), &[example(ModelFit::Fill)]);
    let pose = Pose::looking_at(middle + DVec3::new(-5.0, -4.0, 6.0), middle);
    for look in [PictureLook::Full, PictureLook::Simple] {
        let images = draw(&scene, look, pose);
        let label = ObstacleKind::Car.label().id();
        let of_car = |at: &usize| images.instance[*at] == object_instance(object_id);
        let pixels: Vec<usize> = (0..images.depth_m.len()).filter(of_car).collect();
        assert!(pixels.len() > 500 && pixels.iter().all(|at| images.semantic[*at] == label), "{}", pixels.len());
        // The example is orange and blue.
        let colour = |at: &usize| [0, 1, 2].map(|k| i32::from(images.rgb[3 * at + k]));
        let blue = pixels.iter().map(colour).filter(|[red, _, blue]| blue - red > 20).count();
        let orange = pixels.iter().map(colour).filter(|[red, _, blue]| red - blue > 40).count();
        match look {
            PictureLook::Full => assert!(blue > pixels.len() / 8 && orange > pixels.len() / 8, "{blue} {orange}"),
            PictureLook::Simple => assert!(pixels.iter().map(colour).any(|[red, ..]| red > 0)),
        }
    }
}

#[test]
fn models_lie_within_the_boxes_of_their_things() {
    let town = small_town::small_town(2, 5);
    for fit in [ModelFit::Fill, ModelFit::Within] {
        let scene = Scene::with_models(&town, Seed([1; 32]), &[example(fit)]);
        let label = ObstacleKind::Car.label().id();
        let triangles = scene.triangles();
        let of_cars = triangles.iter().filter(|it| it.label == label);
        let mut counted = 0;
        for triangle in of_cars {
            let is_part = |it: &&cosfly_domain::Obstacle| object_instance(it.object_id) == triangle.instance;
            let parts = || town.obstacles.iter().filter(is_part).map(|it| it.shape.bounds_in_world());
            let low = parts().map(|it| it.0).fold(DVec3::INFINITY, DVec3::min);
            let high = parts().map(|it| it.1).fold(DVec3::NEG_INFINITY, DVec3::max);
            for corner in triangle.corners_in_world {
                assert!(corner.cmpge(low - 1e-6).all() && corner.cmple(high + 1e-6).all(), "{corner} {low} {high}");
            }
            counted += 1;
        }
        let cars: std::collections::BTreeSet<u32> =
            town.obstacles.iter().filter(|it| it.kind == ObstacleKind::Car).map(|it| it.object_id).collect();
        assert_eq!(counted, cars.len() * example(fit).model.triangles.len());
    }
}

#[test]
fn a_scene_without_models_is_as_ever() {
    let town = small_town::small_town(1, 3);
    let pose = Pose::looking_at(DVec3::new(-20.0, -30.0, 25.0), DVec3::ZERO);
    let plain = draw(&Scene::new(&town, Seed([1; 32])), PictureLook::Full, pose);
    let unused = SceneModel { kind: ModelKind::TrafficSign, ..example(ModelFit::Fill) };
    assert_eq!(draw(&Scene::with_models(&town, Seed([1; 32]), &[unused]), PictureLook::Full, pose), plain);
}
