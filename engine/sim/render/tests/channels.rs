//! Channels on request: they change nothing else, hold values at every pixel, and go through lens and strips of rows.

mod small_town;

use cosfly_domain::channels::{depth_stereo, disparity, flow, normals};
use cosfly_domain::{
    BodyKind, Camera, Channel, ChannelSet, FrameImages, Lens, LensModel, MotionBlur, Mount, RollingShutter,
    SemanticLabel, StereoEye, TARGET_INSTANCE, Weather,
};
use cosfly_figures::{BodyFigure, BodyShape, FigureInPicture};
use cosfly_frames::{DMat3, DVec3, Pose, Seed, TargetState, real};
use cosfly_render::{Effects, FrameBeside, FrameParts, FrameSetup, Moment, Neighbours, Renderer, Scene, Shot};

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
    let lens = Lens::brown(-0.1, 0.0);
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
        let shot = Shot {
            weather: &noon(),
            moment: &moment,
            others: &|_, _| {},
            neighbours: Neighbours::default(),
            noise_seed,
        };
        let images = effects.film(&mut renderer, &scene, &shot).images;
        let pixels = normals_of(images).iter().zip(&images.depth_m);
        assert_eq!(pixels.len(), (CAMERA.width * CAMERA.height) as usize);
        pixels.for_each(|(normal, depth_m)| assert_eq!(*normal == [0; 3], depth_m.is_infinite()));
    }
}

/// A moment of a flight past a car and a person that move, `frame` frames of a tenth of a second later.
fn moving(frame: f64) -> (Moment, Vec<FigureInPicture>) {
    let mut camera = pose();
    camera.position_in_world += DVec3::new(0.35, -0.12, 0.05) * frame;
    camera.yaw_rad += 0.01 * frame;
    let feet_in_world = DVec3::new(2.0 + 0.14 * frame, -22.0, 0.0);
    let figure = |state: TargetState, body: BodyShape, height_m: f64| BodyFigure {
        state,
        height_m,
        radius_m: 0.3,
        clothes_seed: Seed([4; 32]),
        gait_phase_rad: 0.6 * frame,
        body,
    };
    let target = figure(TargetState { feet_in_world, heading_rad: 0.0, speed_mps: 1.4 }, BodyShape::default(), 1.8);
    let heading_rad = 0.5 + 0.04 * frame;
    let state = TargetState { feet_in_world: DVec3::new(5.0 + 0.5 * frame, -24.5, 0.0), heading_rad, speed_mps: 5.0 };
    let car = figure(state, BodyShape::of(BodyKind::Car, DVec3::new(4.4, 1.8, 1.5)), 1.5);
    (Moment { pose: camera, target: Some(target) }, vec![FigureInPicture { figure: car, instance: CAR }])
}

const CAR: u32 = 900;

fn filmed(frame: i32, lens: Lens, rolling: RollingShutter) -> FrameImages {
    let at = |frame: i32| {
        let seconds = move |offset_s: f64| f64::from(frame) + 10.0 * offset_s;
        let others = move |offset_s: f64, list: &mut Vec<FigureInPicture>| list.extend(moving(seconds(offset_s)).1);
        (move |offset_s: f64| moving(seconds(offset_s)).0, others)
    };
    let (before, now, after) = (at(frame - 1), at(frame), at(frame + 1));
    let neighbours = Neighbours {
        previous: (frame > 0).then_some(FrameBeside { moment: &before.0, others: &before.1 }),
        next: Some(FrameBeside { moment: &after.0, others: &after.1 }),
    };
    let noise_seed = Seed([1; 32]);
    let shot = Shot { weather: &noon(), moment: &now.0, others: &now.1, neighbours, noise_seed };
    let mut effects = Effects::new(CAMERA, lens, MotionBlur::default(), rolling);
    let mut renderer = Renderer::new(effects.ideal_camera());
    renderer.set_channels(&ChannelSet::of(|_| true));
    effects.film(&mut renderer, &scene(), &shot).images.clone()
}

/// Flow and mask of each pixel.
fn flow_of(images: &FrameImages, [flow, mask]: [&Channel; 2]) -> Vec<([f64; 2], bool)> {
    let bytes =
        |channel: &Channel| &images.on_request.iter().find(|it| it.channel == channel).expect("asked for").bytes;
    let pairs = bytes(flow).as_chunks::<4>().0.as_chunks::<2>().0;
    let pairs = pairs.iter().map(|pair| pair.map(|number| f64::from(f32::from_le_bytes(number))));
    pairs.zip(bytes(mask)).map(|(pair, mask)| (pair, *mask == 1)).collect()
}

const FORWARD: [&Channel; 2] = [&flow::FORWARD, &flow::FORWARD_VALID];
const BACK: [&Channel; 2] = [&flow::BACK, &flow::BACK_VALID];

#[test]
fn flow_is_the_way_of_the_point_through_depth_poses_and_lens() {
    let none = RollingShutter::default();
    for lens in [Lens::default(), Lens::brown(-0.12, 0.01), Lens::fisheye([-0.02, 0.004, 0.0, 0.0])] {
        let (images, next) = (filmed(1, lens, none), filmed(2, lens, none));
        let (mut counts, mut hidden, mut landed) = ([0; 3], 0, 0);
        for (channels, other, away) in [(FORWARD, 2.0, 1.0), (BACK, 0.0, -1.0)] {
            for (at, (way, is_seen)) in flow_of(&images, channels).into_iter().enumerate() {
                let centre = [at as u32 % CAMERA.width, at as u32 / CAMERA.width].map(|place| f64::from(place) + 0.5);
                let seen = lens.unbend(&CAMERA, (centre[0], centre[1])).expect("in reach");
                let [u, v] =
                    [seen.0, seen.1].map(|place| (((place - 0.5) * 256.0).round() / 256.0 + 0.5).floor() + 0.5);
                let depth_m = f64::from(images.depth_m[at]).min(1e9);
                let mut point =
                    moving(1.0).0.pose.position_in_world + depth_m * CAMERA.ray_in_world(&moving(1.0).0.pose, u, v);
                let kind = match images.instance[at] {
                    TARGET_INSTANCE => 2,
                    CAR => 1,
                    _ => 0,
                };
                if kind == 1 {
                    let [from, to] = [1.0, other].map(|frame| moving(frame).1[0].figure.state);
                    let turn = DMat3::from_rotation_z(to.heading_rad - from.heading_rad);
                    point = to.feet_in_world + turn * (point - from.feet_in_world);
                }
                let to = CAMERA.project(&moving(other).0.pose, point).expect("before the camera");
                let (from, bent) = (lens.bend(&CAMERA, (u, v)), lens.bend(&CAMERA, (to.0, to.1)));
                let error = ((bent.0 - from.0 - way[0]).powi(2) + (bent.1 - from.1 - way[1]).powi(2)).sqrt();
                // Limbs move by less than a step, at some metres.
                let most = if kind == 2 { 12.0 } else { 0.01 };
                assert!(error < most, "{lens:?} pixel {at} kind {kind} is off by {error} px, {way:?}");
                counts[kind] += 1;
                if away > 0.0 && lens.is_none() {
                    let (column, row) = (bent.0.floor(), bent.1.floor());
                    let is_inside = (0.0..160.0).contains(&bent.0) && (0.0..90.0).contains(&bent.1);
                    assert!(is_inside || kind == 2 || !is_seen, "pixel {at} leaves the picture");
                    if is_inside && kind < 2 {
                        let there_m = f64::from(next.depth_m[row as usize * 160 + column as usize]);
                        hidden += usize::from(!is_seen && there_m < 0.99 * to.2);
                        landed += usize::from(is_seen == (there_m > 0.98 * to.2 - 0.05));
                    }
                }
            }
        }
        assert!(counts[0] > 20_000 && counts[1] > 200 && counts[2] > 60, "{counts:?}");
        if lens.is_none() {
            assert!(hidden > 20 && landed > 12_500, "{hidden} {landed}");
        }
    }
}

#[test]
fn limbs_move_with_their_parts_and_frames_without_a_neighbour_have_no_flow() {
    let none = RollingShutter::default();
    let (images, next) = (filmed(0, Lens::default(), none), filmed(1, Lens::default(), none));
    assert!(flow_of(&images, BACK).iter().all(|pixel| *pixel == ([0.0; 2], false)));
    let (mut on_target, mut all, mut ways) = (0, 0, vec![]);
    for (at, (way, is_seen)) in flow_of(&images, FORWARD).into_iter().enumerate() {
        if images.instance[at] == TARGET_INSTANCE && is_seen {
            let column = (at as u32 % CAMERA.width) as f64 + 0.5 + way[0];
            let row = (at as u32 / CAMERA.width) as f64 + 0.5 + way[1];
            all += 1;
            on_target += usize::from(next.instance[row as usize * 160 + column as usize] == TARGET_INSTANCE);
            ways.push(way[0]);
        }
    }
    assert!(all > 30 && on_target * 10 > all * 9, "{on_target} of {all}");
    let (least, most) = ways.iter().fold((f64::MAX, f64::MIN), |(low, high), way| (low.min(*way), high.max(*way)));
    assert!(most - least > 0.05, "legs and trunk move apart: {least} to {most}");
}

#[test]
fn through_a_rolling_shutter_a_point_is_looked_for_when_its_row_is_taken() {
    let rolling = RollingShutter { readout_s: 0.03, strips: 6 };
    let images = filmed(1, Lens::default(), rolling);
    let (mut compared, strips) = (0, rolling.strips(90).collect::<Vec<_>>());
    let moment_of =
        |row: f64| strips.iter().find(|(rows, _)| rows.contains(&(row as usize))).map(|(_, moment_s)| 10.0 * moment_s);
    for (at, (way, is_seen)) in flow_of(&images, FORWARD).into_iter().enumerate() {
        if !is_seen || [CAR, TARGET_INSTANCE].contains(&images.instance[at]) || images.depth_m[at].is_infinite() {
            continue;
        }
        let (u, v) = ((at as u32 % CAMERA.width) as f64 + 0.5, (at as u32 / CAMERA.width) as f64 + 0.5);
        let here = moving(1.0 + moment_of(v).expect("a row")).0.pose;
        let point = here.position_in_world + f64::from(images.depth_m[at]) * CAMERA.ray_in_world(&here, u, v);
        let there = moving(2.0 + moment_of(v + way[1]).expect("it is seen")).0.pose;
        let to = CAMERA.project(&there, point).expect("before the camera");
        assert!((to.0 - u - way[0]).abs() < 0.01 && (to.1 - v - way[1]).abs() < 0.01, "pixel {at}");
        compared += 1;
    }
    assert!(compared > 5_000, "{compared}");
}

/// A picture of a pose by a camera with this lens, one of a pair 0.3 m apart.
fn taken(pose: Pose, lens: Lens, is_right: bool) -> FrameImages {
    let mut effects = Effects::new(CAMERA, lens, MotionBlur::default(), RollingShutter::default())
        .of_pair(Some(StereoEye { base_line_m: 0.3, is_right }));
    let mut renderer = Renderer::new(effects.ideal_camera());
    renderer.set_channels(&ChannelSet::of(|channel| {
        ["depth_stereo", "disparity"].contains(&channel.name) || !channel.is_on_request()
    }));
    let moment = move |_: f64| Moment { pose, target: None };
    let (neighbours, noise_seed) = (Neighbours::default(), Seed([1; 32]));
    let shot = Shot { weather: &noon(), moment: &moment, others: &|_, _| {}, neighbours, noise_seed };
    effects.film(&mut renderer, &scene(), &shot).images.clone()
}

#[test]
fn the_right_picture_of_a_pair_shows_each_point_a_disparity_to_the_left_in_the_same_row() {
    let right = Mount { right_m: 0.3, ..Mount::default() }.camera_pose(&pose());
    let [left, right] = [(pose(), false), (right, true)].map(|(pose, is_right)| taken(pose, Lens::default(), is_right));
    let (disparities, _) = on_request(&left, &disparity::CHANNEL).as_chunks::<4>();
    let (mut found, mut all) = (0, 0);
    for (at, four) in disparities.iter().enumerate() {
        let (disparity_px, depth_m) = (f64::from(f32::from_le_bytes(*four)), f64::from(left.depth_m[at]));
        let (column, row) = (at % 160, at / 160);
        let there = column as f64 + 0.5 - disparity_px;
        // Half the width is f times the tangent of half the field of view.
        assert!((disparity_px - 80.0 / real::tan(0.7) * 0.3 / depth_m).abs() < 1e-4, "pixel {at}");
        if there >= 0.0 {
            all += 1;
            let there = 160 * row + there as usize;
            found += usize::from((f64::from(right.depth_m[there]) / depth_m - 1.0).abs() < 0.03 || depth_m > 1e6);
        }
    }
    assert!(all > 12_000 && found * 100 > all * 95, "{found} of {all}");
}

/// Stored bytes of a channel.
fn on_request<'a>(images: &'a FrameImages, channel: &Channel) -> &'a [u8] {
    &images.on_request.iter().find(|image| image.channel == channel).expect("it was asked for").bytes
}

#[test]
fn depths_matched_in_both_pictures_of_a_pair_are_those_of_the_scene_with_holes() {
    let right = Mount { right_m: 0.3, ..Mount::default() }.camera_pose(&pose());
    let scale = 80.0 / real::tan(0.7) * 0.3;
    for (pose, is_right) in [(pose(), false), (right, true)] {
        let images = taken(pose, Lens::default(), is_right);
        let (measured, _) = on_request(&images, &depth_stereo::CHANNEL).as_chunks::<4>();
        let pairs = measured.iter().zip(&images.depth_m).map(|(four, exact_m)| (f32::from_le_bytes(*four), *exact_m));
        let found = pairs.filter(|(depth_m, _)| !depth_m.is_nan());
        let mut errors_px: Vec<f64> =
            found.map(|(depth_m, exact_m)| (scale / f64::from(depth_m) - scale / f64::from(exact_m)).abs()).collect();
        errors_px.sort_by(f64::total_cmp);
        let (median, share) = (errors_px[errors_px.len() / 2], errors_px.len() as f64 / images.depth_m.len() as f64);
        assert!(median < 0.25 && (0.3..0.99).contains(&share), "right {is_right}: {median} px, {share}");
    }
}

#[test]
fn a_fisheye_shows_every_point_at_the_angle_of_its_ray() {
    let [k1, k2, k3, k4] = [-0.03, 0.01, -0.004, 0.001];
    let [plain, wide] = [Lens::default(), Lens::fisheye([k1, k2, k3, k4])].map(|lens| taken(pose(), lens, false));
    let focal = 80.0 / real::tan(0.7);
    let (mut same, mut all) = (0, 0);
    for at in 0..160 * 90 {
        // The direction of the ray of the pinhole's pixel, then the angle's polynomial.
        let (x, y) = ((at % 160) as f64 + 0.5 - 80.0, (at / 160) as f64 + 0.5 - 45.0);
        let off = real::hypot(x, y);
        let angle = real::atan2(off, focal);
        let square = angle * angle;
        let bent = angle * (1.0 + square * (k1 + square * (k2 + square * (k3 + square * k4))));
        let (u, v) = (80.0 + x / off * focal * bent, 45.0 + y / off * focal * bent);
        let there = 160 * v as usize + u as usize;
        let ratio = f64::from(wide.depth_m[there]) / f64::from(plain.depth_m[at]);
        all += 1;
        same +=
            usize::from((ratio.is_nan() || (ratio - 1.0).abs() < 0.04) && wide.semantic[there] == plain.semantic[at]);
    }
    assert!(same * 100 > all * 93, "{same} of {all}");
    // Its corners show more than the pinhole's.
    assert!(wide.rgb != plain.rgb);
}

#[test]
fn wide_lenses_show_every_point_in_the_direction_and_at_the_distance_of_its_ray() {
    let all_around = Lens { model: LensModel::Equirectangular, ..Lens::default() };
    let around = Camera { width: 400, height: 200, horizontal_fov_rad: Camera::ALL_AROUND_FOV_RAD };
    let wide = Camera { width: 200, height: 200, horizontal_fov_rad: 115f64.to_radians() };
    let (scene, eye) = (scene(), Pose { roll_rad: 0.1, ..pose() });
    let mut pinhole = Renderer::new(CAMERA);
    for (camera, lens) in [(around, all_around), (wide, Lens::fisheye([-0.01, 0.0, 0.0, 0.0]))] {
        let mut effects = Effects::new(camera, lens, MotionBlur::default(), RollingShutter::default());
        let mut renderer = Renderer::new(effects.ideal_camera());
        renderer.set_channels(&ChannelSet::of(|channel| *channel == normals::CHANNEL || !channel.is_on_request()));
        let moment = move |_: f64| Moment { pose: eye, target: moving(0.0).0.target };
        let (neighbours, noise_seed) = (Neighbours::default(), Seed([1; 32]));
        let shot = Shot { weather: &noon(), moment: &moment, others: &|_, _| {}, neighbours, noise_seed };
        let images = effects.film(&mut renderer, &scene, &shot).images.clone();
        assert_eq!((images.width, images.height), (camera.width, camera.height));
        assert!(
            normals_of(&images)
                .iter()
                .zip(&images.depth_m)
                .all(|(it, depth_m)| (*it == [0; 3]) == depth_m.is_infinite())
        );
        // Pinholes that look in directions of their own meet the same points.
        let (mut same, mut all, mut behind) = (0, 0, 0);
        for yaw in 0..8 {
            let turned = Pose { yaw_rad: 0.8 * f64::from(yaw), pitch_rad: 0.5 - 0.15 * f64::from(yaw), ..eye };
            let target = moving(0.0).0.target;
            let setup = FrameSetup { pose: turned, weather: &noon(), target, others: &[] };
            let plain = pinhole.render_parts(&scene, &setup, FrameParts::Ids).images.clone();
            for at in (0..160 * 90).step_by(7) {
                let ray = CAMERA.ray_in_world(&turned, (at % 160) as f64 + 0.5, (at / 160) as f64 + 0.5);
                let before = eye.world_from_body().transpose() * ray;
                let Some((u, v, _)) = lens.project(&camera, before) else { continue };
                if !((0.0..f64::from(camera.width)).contains(&u) && (0.0..f64::from(camera.height)).contains(&v)) {
                    continue;
                }
                let there = camera.width as usize * v as usize + u as usize;
                let distance_m = f64::from(plain.depth_m[at]) * ray.length();
                let ratio = f64::from(images.depth_m[there]) / distance_m;
                let is_same =
                    plain.semantic[at] == images.semantic[there] && plain.instance[at] == images.instance[there];
                all += 1;
                behind += usize::from(before.x < 0.0);
                same += usize::from((ratio.is_nan() || (ratio - 1.0).abs() < 0.05) && is_same);
            }
        }
        assert!(same * 100 > all * 92 && behind * 4 > all, "{camera:?}: {same} of {all}, {behind} behind");
    }
}
