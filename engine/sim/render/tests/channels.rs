//! Channels on request: they change nothing else, hold values at every pixel, and go through lens and strips of rows.

mod small_town;

use cosfly_domain::channels::normals;
use cosfly_domain::{Camera, ChannelSet, FrameImages, Lens, MotionBlur, RollingShutter, SemanticLabel, Weather};
use cosfly_frames::{DVec3, Pose, Seed};
use cosfly_render::{Effects, FrameSetup, Moment, Renderer, Scene, Shot};

const CAMERA: Camera = Camera { width: 160, height: 90, horizontal_fov_rad: 1.4 };

fn pose() -> Pose {
    Pose::looking_at(DVec3::new(-6.0, -22.5, 7.5), DVec3::new(0.0, -23.0, 1.0))
}

fn noon() -> Weather {
    Weather { sun_azimuth_angle: 200.0, ..cosfly_materials::presets::preset("ClearNoon").expect("a preset") }
}

fn scene() -> Scene {
    Scene::new(&small_town::small_town(3, 5), Seed([1; 32]))
}

fn draw(channels: &ChannelSet) -> FrameImages {
    let mut renderer = Renderer::new(CAMERA);
    renderer.set_channels(channels);
    let setup = FrameSetup { pose: pose(), weather: &noon(), target: None, others: &[] };
    renderer.render(&scene(), &setup).images.clone()
}

/// Pixels of the normals, three bytes each.
fn normals_of(images: &FrameImages) -> &[[u8; 3]] {
    let image = images.on_request.iter().find(|image| *image.channel == normals::CHANNEL).expect("it was asked for");
    image.bytes.as_chunks::<3>().0
}

#[test]
fn channels_on_request_change_no_other_and_hold_a_value_at_every_pixel() {
    let all = ChannelSet::of(|_| true);
    let (plain, mut drawn) = (draw(&ChannelSet::default()), draw(&all));
    assert!(plain.on_request.is_empty());
    let on_request = std::mem::take(&mut drawn.on_request);
    assert!(drawn == plain);
    assert!(on_request.iter().map(|image| image.channel).eq(all.iter().filter(|channel| channel.is_on_request())));
    for image in &on_request {
        let mut pixels = image.bytes.chunks_exact(image.channel.bytes_on_request());
        assert_eq!(pixels.len(), plain.depth_m.len());
        assert!(pixels.all(|pixel| (image.channel.is_value)(pixel)), "{}", image.channel.name);
    }
}

#[test]
fn normals_face_the_camera_and_roads_face_up() {
    let images = draw(&ChannelSet::of(|_| true));
    let (mut walls, mut roads) = (0, 0);
    for (at, normal) in normals_of(&images).iter().enumerate() {
        assert_eq!(*normal == [0; 3], images.depth_m[at].is_infinite());
        if *normal == [0; 3] {
            continue;
        }
        let [x, y, z] = normal.map(|byte| (f64::from(byte) - 128.0) / 127.0);
        let (column, row) = (at as u32 % CAMERA.width, at as u32 / CAMERA.width);
        let ray = CAMERA.ray_in_world(&pose(), f64::from(column) + 0.5, f64::from(row) + 0.5);
        assert!(DVec3::new(x, y, z).dot(ray) < 0.01 * ray.length(), "{normal:?}");
        roads += usize::from(images.semantic[at] == SemanticLabel::Roads.id() && *normal == [128, 128, 255]);
        walls += usize::from(images.semantic[at] == SemanticLabel::Building.id() && normal[2] == 128);
    }
    assert!(roads > 100 && walls > 100, "{roads} {walls}");
}

#[test]
fn lens_and_rolling_shutter_carry_the_channels_along() {
    let scene = scene();
    let lens = Lens { k1: -0.1, k2: 0.0 };
    let rolling = RollingShutter { readout_s: 0.02, strips: 5 };
    let moment = |offset_s: f64| {
        let mut pose = pose();
        pose.position_in_world.x += 5.0 * offset_s;
        Moment { pose, target: None }
    };
    let mut effects = Effects::new(CAMERA, lens, MotionBlur::default(), rolling);
    let mut renderer = Renderer::new(effects.ideal_camera());
    renderer.set_channels(&ChannelSet::of(|_| true));
    for noise_seed in [Seed([1; 32]), Seed([2; 32])] {
        let shot = Shot { weather: &noon(), moment: &moment, others: &|_, _| {}, noise_seed };
        let images = effects.film(&mut renderer, &scene, &shot).images;
        let pixels = normals_of(images).iter().zip(&images.depth_m);
        assert_eq!(pixels.len(), (CAMERA.width * CAMERA.height) as usize);
        pixels.for_each(|(normal, depth_m)| assert_eq!(*normal == [0; 3], depth_m.is_infinite()));
    }
}
