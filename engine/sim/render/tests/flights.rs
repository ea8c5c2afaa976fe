//! Flights through the default town: labels by rays and by pixels, boxes, and depth carried from frame to frame.

use cosfly_domain::{Camera, FrameImages, TARGET_INSTANCE, TargetView, Town, WalkableKind, Weather};
use cosfly_figures::{BodyFigure, BodyShape, figure_triangles};
use cosfly_frames::{DVec3, Pose, RandomStream, Seed, TargetState, real};
use cosfly_geometry::{BoxBvh, SpatialQuery};
use cosfly_maps::MapConfig;
use cosfly_render::{FrameParts, FrameSetup, Renderer, Scene};

const CAMERA: Camera = Camera { width: 640, height: 360, horizontal_fov_rad: 1.2 };
const DT_S: f64 = 0.5;

fn default_town() -> Town {
    let path = concat!(env!("CARGO_MANIFEST_DIR"), "/../../../recipes/towns/downtown.xodr");
    let bytes = std::fs::read(path).expect("the default town is in the repository");
    cosfly_maps::read_town(&bytes, &MapConfig::default(), Seed([5; 32])).expect("it is sound").0
}

/// A walk along a pavement with a drone that flies behind it, `frames` long, anywhere in the town.
fn flight(town: &Town, random: &mut RandomStream, frames: usize) -> Vec<(Pose, BodyFigure)> {
    let pavements: Vec<_> = town.walkable.iter().filter(|area| area.kind == WalkableKind::Sidewalk).collect();
    let outline = &pavements[random.index(pavements.len())].outline_in_world;
    let start = outline[random.index(outline.len())];
    let heading_rad = random.uniform(-real::PI, real::PI);
    let (sin, cos) = real::sin_cos(heading_rad);
    let behind = heading_rad + random.uniform(-0.8, 0.8);
    let (rear_sin, rear_cos) = real::sin_cos(behind);
    let (back_m, up_m) = (random.uniform(9.0, 24.0), random.uniform(7.0, 20.0));
    let frame = |number: usize| {
        let walked_m = 1.3 * DT_S * number as f64;
        let feet = start + DVec3::new(cos, sin, 0.0) * walked_m;
        let target = BodyFigure {
            state: TargetState { feet_in_world: feet, heading_rad, speed_mps: 1.3 },
            height_m: 1.75,
            radius_m: 0.3,
            clothes_seed: Seed([2; 32]),
            gait_phase_rad: walked_m,
            body: BodyShape::default(),
        };
        let position = feet + DVec3::new(-back_m * rear_cos, -back_m * rear_sin, up_m);
        (Pose::looking_at(position, feet + DVec3::Z * 0.9), target)
    };
    (0..frames).map(frame).collect()
}

fn draw(renderer: &mut Renderer, scene: &Scene, pose: Pose, target: BodyFigure) -> (FrameImages, TargetView, Vec<u32>) {
    let weather = cosfly_materials::presets::preset("ClearNoon").expect("a preset");
    let setup = FrameSetup { pose, weather: &weather, target: Some(target), others: &[] };
    let frame = renderer.render_parts(scene, &setup, FrameParts::Ids);
    (frame.images.clone(), frame.target_view, frame.target_pixels.to_vec())
}

/// Share of the body that rays reach, cast 3 x 3 per pixel through the box of the whole body, independent of the
/// renderer: against the triangles of the body, then against the boxes of the town.
fn visible_by_dense_rays(boxes: &BoxBvh, pose: &Pose, target: &BodyFigure, view: &TargetView) -> Option<f64> {
    let full = view.full_box?;
    let triangles = figure_triangles(target);
    let (mut hit, mut free) = (0u32, 0u32);
    for row in 3 * full.v_min..3 * (full.v_max + 1) {
        for column in 3 * full.u_min..3 * (full.u_max + 1) {
            let ray = CAMERA.ray_in_world(pose, (f64::from(column) + 0.5) / 3.0, (f64::from(row) + 0.5) / 3.0);
            let nearest =
                triangles.iter().filter_map(|it| meet(it, pose.position_in_world, ray)).fold(f64::MAX, f64::min);
            if nearest < f64::MAX {
                hit += 1;
                let point = pose.position_in_world + ray * (nearest * (1.0 - 1e-9));
                let mut blocked = [false];
                boxes.blocked_batch(pose.position_in_world, &[point], &mut blocked);
                free += u32::from(!blocked[0]);
            }
        }
    }
    (hit > 0).then(|| f64::from(free) / f64::from(hit))
}

fn meet([a, b, c]: &[DVec3; 3], origin: DVec3, ray: DVec3) -> Option<f64> {
    let (ab, ac) = (*b - *a, *c - *a);
    let p = ray.cross(ac);
    let determinant = ab.dot(p);
    if determinant.abs() < 1e-14 {
        return None;
    }
    let s = (origin - *a) / determinant;
    let (u, q) = (s.dot(p), s.cross(ab));
    let (v, t) = (ray.dot(q), ac.dot(q));
    (u >= 0.0 && v >= 0.0 && u + v <= 1.0 && t > 0.0).then_some(t)
}

#[test]
fn labels_by_rays_and_by_pixels_agree_and_boxes_are_those_of_the_pixels() {
    let town = default_town();
    let scene = Scene::new(&town, Seed([1; 32]));
    let boxes = BoxBvh::build(town.obstacles.iter().map(|obstacle| obstacle.shape).collect());
    let mut renderer = Renderer::new(CAMERA);
    let mut random = Seed([8; 32]).stream("flights");
    let (mut frames, mut inside, mut partly, mut far_apart) = (0, 0, 0, vec![]);
    for number in 0..100 {
        for (pose, target) in flight(&town, &mut random, 4) {
            let (images, view, covered) = draw(&mut renderer, &scene, pose, target);
            frames += 1;
            let pixels: Vec<usize> =
                (0..images.instance.len()).filter(|pixel| images.instance[*pixel] == TARGET_INSTANCE).collect();
            let edges = |at: &dyn Fn(usize) -> usize| {
                let values = pixels.iter().map(|pixel| at(*pixel) as u32);
                (values.clone().min(), values.max())
            };
            let (columns, rows) = (edges(&|pixel| pixel % 640), edges(&|pixel| pixel / 640));
            let stored = view.visible_box;
            assert_eq!((columns.0, columns.1), (stored.map(|it| it.u_min), stored.map(|it| it.u_max)));
            assert_eq!((rows.0, rows.1), (stored.map(|it| it.v_min), stored.map(|it| it.v_max)));
            assert_eq!(view.pixels as usize, pixels.len());
            assert!(pixels.iter().all(|pixel| covered.binary_search(&(*pixel as u32)).is_ok()));
            // Inside of an obstacle no ray gets out, but the picture shows what is behind its walls.
            if boxes.nearest(pose.position_in_world, 0.3).is_some() {
                inside += 1;
                continue;
            }
            let Some(by_rays) = visible_by_dense_rays(&boxes, &pose, &target, &view) else { continue };
            partly += u32::from(view.visible_by_pixels > 0.02 && view.visible_by_pixels < 0.98);
            if (by_rays - view.visible_by_pixels).abs() > 0.05 {
                far_apart.push(format!(
                    "flight {number}: {by_rays:.3} by rays, {:.3} by pixels, {} pixels alone",
                    view.visible_by_pixels,
                    covered.len()
                ));
            }
        }
    }
    println!(
        "{frames} frames, {inside} of them inside of an obstacle, {partly} partly hidden, more than 5 points apart: {far_apart:#?}"
    );
    assert!(frames == 400 && inside < 120 && partly >= 15, "{partly} of {frames}");
    // A body of 150 pixels whose half is hidden has an edge of some 20 pixels: one row of them is 5 points.
    assert!(100 * far_apart.len() <= frames - inside, "{far_apart:#?}");
}

#[test]
fn depth_carried_into_the_next_frame_agrees_but_where_something_comes_between() {
    let town = default_town();
    let scene = Scene::new(&town, Seed([1; 32]));
    let mut renderer = Renderer::new(CAMERA);
    let mut random = Seed([9; 32]).stream("flights");
    let (mut compared, mut agreed, mut hidden, mut contradicted, mut other_id) = (0u32, 0u32, 0u32, 0u32, 0u32);
    for _ in 0..12 {
        let frames: Vec<_> = flight(&town, &mut random, 3);
        let drawn: Vec<FrameImages> =
            frames.iter().map(|(pose, target)| draw(&mut renderer, &scene, *pose, *target).0).collect();
        for now in 0..frames.len() - 1 {
            let (images, next) = (&drawn[now], &drawn[now + 1]);
            for pixel in (0..images.depth_m.len()).step_by(7) {
                let depth_m = f64::from(images.depth_m[pixel]);
                if !depth_m.is_finite() || images.instance[pixel] == TARGET_INSTANCE {
                    continue;
                }
                let (u, v) = ((pixel % 640) as f64 + 0.5, (pixel / 640) as f64 + 0.5);
                let point = frames[now].0.position_in_world + CAMERA.ray_in_world(&frames[now].0, u, v) * depth_m;
                let Some((u, v, expected_m)) = CAMERA.project(&frames[now + 1].0, point) else { continue };
                if !(1.0..639.0).contains(&u) || !(1.0..359.0).contains(&v) {
                    continue;
                }
                let at = v as usize * 640 + u as usize;
                let around = [at - 641, at - 640, at - 639, at - 1, at, at + 1, at + 639, at + 640, at + 641];
                let depths = around.map(|at| f64::from(next.depth_m[at]));
                let (near, far) =
                    (depths.iter().copied().fold(f64::MAX, f64::min), depths.into_iter().fold(0.0, f64::max));
                let slack_m = 0.01 + 1e-4 * expected_m;
                compared += 1;
                if expected_m < near - slack_m {
                    // The point should hide what the next frame shows there.
                    contradicted += 1;
                } else if expected_m > far + slack_m {
                    hidden += 1;
                } else {
                    agreed += 1;
                    other_id += u32::from(around.iter().all(|at| next.instance[*at] != images.instance[pixel]));
                }
            }
        }
    }
    println!(
        "{compared} points: {agreed} agree, {hidden} are hidden, {contradicted} contradict, {other_id} have other ids"
    );
    assert!(compared > 100_000 && f64::from(agreed) > 0.95 * f64::from(compared));
    // Leaves and posts thinner than a pixel may fall between the samples of one frame.
    assert!(f64::from(contradicted) < 2e-3 * f64::from(compared), "{contradicted} of {compared}");
    assert!(f64::from(other_id) < 2e-3 * f64::from(compared), "{other_id} of {compared}");
}

#[test]
fn colours_do_not_depend_on_what_other_cameras_of_the_town_saw_before() {
    let town = default_town();
    let scene = |_: u32| Scene::new(&town, Seed([1; 32]));
    let flown = flight(&town, &mut Seed([8; 32]).stream("shadows"), 30);
    let mut weather = cosfly_materials::presets::preset("ClearSunset").expect("a preset");
    let colours = |renderer: &mut Renderer, scene: &Scene, weather: &Weather, frame: usize| {
        let (pose, target) = flown[frame];
        let setup = FrameSetup { pose, weather, target: Some(target), others: &[] };
        renderer.render(scene, &setup).images.rgb.clone()
    };
    let shared = scene(0);
    let mut follower = Renderer::new(CAMERA);
    let mut turned = weather.clone();
    turned.sun_azimuth_angle = 100.0;
    for frame in 0..29 {
        colours(&mut follower, &shared, if frame % 7 == 3 { &turned } else { &weather }, frame);
    }
    let followed = colours(&mut follower, &shared, &weather, 29);
    let alone = colours(&mut Renderer::new(CAMERA), &scene(1), &weather, 29);
    assert!(followed == alone, "a flight's last frame differs from the same frame alone");
    assert!(colours(&mut Renderer::new(CAMERA), &shared, &weather, 29) == alone);
    weather.sun_azimuth_angle += 1.0;
    assert!(colours(&mut follower, &shared, &weather, 29) != alone, "the sun moved");
}
