//! The channels against brute-force rays in f64, and against each other.

mod small_town;

use cosfly_domain::FrameImages;
use cosfly_domain::{
    Camera, Obstacle, ObstacleKind, OrientedBox, PixelBox, Season, SemanticLabel, SurfaceMesh, TARGET_INSTANCE,
    TargetView, Town, Weather,
};
use cosfly_figures::{BodyFigure, BodyShape, figure_triangles};
use cosfly_frames::{DVec3, Pose, RandomStream, Seed, TargetState};
use cosfly_models::{Model, ModelFit, ModelKind};
use cosfly_render::{FrameSetup, PictureLook, Renderer, Scene, SceneModel};

fn noon() -> Weather {
    Weather { sun_azimuth_angle: 200.0, ..cosfly_materials::presets::preset("ClearNoon").expect("a preset") }
}

fn camera(width: u32, height: u32) -> Camera {
    Camera { width, height, horizontal_fov_rad: 1.4 }
}

fn figure(feet: DVec3) -> BodyFigure {
    BodyFigure {
        state: TargetState { feet_in_world: feet, heading_rad: 0.4, speed_mps: 1.3 },
        height_m: 1.8,
        radius_m: 0.3,
        clothes_seed: Seed([2; 32]),
        gait_phase_rad: 0.8,
        body: BodyShape::default(),
    }
}

fn draw(scene: &Scene, camera: Camera, pose: Pose, target: Option<BodyFigure>) -> (FrameImages, TargetView) {
    let mut renderer = Renderer::new(camera);
    let frame = renderer.render(scene, &FrameSetup { pose, weather: &noon(), target, others: &[] });
    (frame.images.clone(), frame.target_view)
}

/// Planar depth, label and instance of the first triangle on a ray; the Moeller-Trumbore test in f64.
fn cast(triangles: &[([DVec3; 3], u8, u32)], origin: DVec3, ray: DVec3) -> Option<(f64, u8, u32)> {
    let mut first: Option<(f64, u8, u32)> = None;
    for &([a, b, c], label, instance) in triangles {
        let (ab, ac) = (b - a, c - a);
        let p = ray.cross(ac);
        let determinant = ab.dot(p);
        if determinant.abs() < 1e-14 {
            continue;
        }
        let s = (origin - a) / determinant;
        let (u, q) = (s.dot(p), s.cross(ab));
        let (v, t) = (ray.dot(q), ac.dot(q));
        if u >= 0.0 && v >= 0.0 && u + v <= 1.0 && t > 0.01 && first.is_none_or(|(best, ..)| t < best) {
            first = Some((t, label, instance));
        }
    }
    first
}

/// Compares every `stride`-th pixel with a ray; returns (compared, off by more than the tolerance, wrong ids).
fn compare(scene: &Scene, camera: Camera, pose: Pose, target: Option<BodyFigure>, stride: usize) -> [usize; 3] {
    let (images, _) = draw(scene, camera, pose, target);
    let mut triangles: Vec<_> = scene.triangles().iter().map(|t| (t.corners_in_world, t.label, t.instance)).collect();
    if let Some(target) = &target {
        triangles.extend(figure_triangles(target).iter().map(|corners| (*corners, 12, TARGET_INSTANCE)));
    }
    let mut counts = [0; 3];
    for pixel in (0..images.depth_m.len()).step_by(stride) {
        let (column, row) = (pixel % images.width as usize, pixel / images.width as usize);
        let ray = camera.ray_in_world(&pose, column as f64 + 0.5, row as f64 + 0.5);
        let hit = cast(&triangles, pose.position_in_world, ray);
        let (depth, label, instance) = hit.unwrap_or((f64::INFINITY, SemanticLabel::Sky.id(), 0));
        let seen = f64::from(images.depth_m[pixel]);
        counts[0] += 1;
        counts[1] += usize::from(seen != depth && (seen - depth).abs() > 1e-3 + 1e-5 * depth);
        counts[2] += usize::from(images.semantic[pixel] != label || images.instance[pixel] != instance);
    }
    counts
}

fn random_scene(random: &mut RandomStream) -> Town {
    let mut town = small_town::empty_town();
    for object_id in 0..40 {
        let shape = OrientedBox {
            center_in_world: DVec3::new(
                random.uniform(5.0, 60.0),
                random.uniform(-30.0, 30.0),
                random.uniform(0.0, 9.0),
            ),
            half_extents_m: DVec3::new(random.uniform(0.05, 5.0), random.uniform(0.05, 5.0), random.uniform(0.05, 7.0)),
            yaw_rad: random.uniform(-3.2, 3.2),
        };
        // Crowns are cut round.
        let kind = if object_id % 4 == 0 { ObstacleKind::TreeCrown } else { ObstacleKind::Building };
        town.obstacles.push(Obstacle { shape, kind, object_id, synthetic: true });
    }
    let mut terrain = SurfaceMesh {
        label: SemanticLabel::Terrain,
        vertices_in_world: vec![],
        along_across_m: vec![],
        triangles: vec![],
        synthetic: true,
    };
    for row in 0..20u32 {
        for column in 0..20u32 {
            let z = random.uniform(-2.5, 0.5);
            terrain.vertices_in_world.push(DVec3::new(6.0 * f64::from(column) - 30.0, 6.0 * f64::from(row) - 60.0, z));
            if row > 0 && column > 0 {
                let at = row * 20 + column;
                terrain.triangles.extend([[at, at - 1, at - 20], [at - 21, at - 20, at - 1]]);
            }
        }
    }
    town.surfaces.push(terrain);
    town
}

/// Level ground with nine trees on it, each a trunk below a crown.
fn trees_on(ground: SemanticLabel) -> Town {
    let mut town = small_town::empty_town();
    let mut put = |kind, object_id, center_in_world, half_extents_m| {
        let shape = OrientedBox { center_in_world, half_extents_m, yaw_rad: 0.3 };
        town.obstacles.push(Obstacle { shape, kind, object_id, synthetic: true });
    };
    for tree in 0..9u32 {
        let at = DVec3::new(12.0 * f64::from(tree % 3) - 12.0, 12.0 * f64::from(tree / 3) - 12.0, 0.0);
        put(ObstacleKind::TreeTrunk, 2 * tree, at + DVec3::new(0.0, 0.0, 1.5), DVec3::new(0.2, 0.2, 1.5));
        put(ObstacleKind::TreeCrown, 2 * tree + 1, at + DVec3::new(0.0, 0.0, 5.5), DVec3::new(2.5, 2.5, 2.5));
    }
    let corners = [[-200.0, -200.0], [200.0, -200.0], [200.0, 200.0], [-200.0, 200.0]];
    town.surfaces.push(SurfaceMesh {
        label: ground,
        vertices_in_world: corners.map(|[x, y]| DVec3::new(x, y, 0.0)).to_vec(),
        along_across_m: vec![],
        triangles: vec![[0, 1, 2], [0, 2, 3]],
        synthetic: true,
    });
    town
}

#[test]
fn bare_crowns_are_open_in_colours_and_whole_in_depth_and_labels() {
    let camera = camera(480, 300);
    let scene = |ground, season| Scene::new(&trees_on(ground), Seed([1; 32])).in_season(Some(season));
    let [road, pavement] = [SemanticLabel::Roads, SemanticLabel::SideWalks]
        .map(|ground| [Season::Summer, Season::Winter].map(|season| scene(ground, season)));
    let images = |scene: &Scene, pose, look| {
        let mut renderer = Renderer::new(camera);
        renderer.set_look(look);
        renderer.render(scene, &FrameSetup { pose, weather: &noon(), target: None, others: &[] }).images.clone()
    };
    for far_m in [14.0, 24.0, 40.0] {
        let pose = Pose {
            position_in_world: DVec3::new(-far_m, 0.0, 5.0 + 0.7 * far_m),
            pitch_rad: -0.61,
            yaw_rad: 0.0,
            roll_rad: 0.0,
        };
        // Rays of visibility meet the whole crown, as depth and labels do.
        let [compared, off, wrong] = compare(&road[1], camera, pose, None, 7);
        assert!(off <= compared / 500 && wrong <= compared / 500, "{off} and {wrong} of {compared}");
        let drawn = |scenes: &[Scene; 2], season: usize, look| images(&scenes[season], pose, look);
        // How much of the ground's colour crowns let through.
        let open = |season, look| {
            let [one, other] = [&road, &pavement].map(|scenes| drawn(scenes, season, look));
            let change = |is_crown: bool| {
                let label = |at: &usize| (one.semantic[*at] == SemanticLabel::Vegetation.id()) == is_crown;
                let pixels = (0..one.semantic.len()).filter(|at| one.semantic[*at] != SemanticLabel::Sky.id());
                let changes =
                    pixels.filter(label).map(|at| f64::from(one.rgb[3 * at + 1].abs_diff(other.rgb[3 * at + 1])));
                let (sum, count) = changes.fold((0.0, 0.0), |(sum, count), change| (sum + change, count + 1.0));
                sum / count
            };
            (change(true) / change(false), one)
        };
        let [(leaves, summer), (bare, winter)] = [0, 1].map(|season| open(season, PictureLook::Full));
        let (simple, simple_winter) = open(1, PictureLook::Simple);
        for other in [&summer, &simple_winter] {
            let same = winter.semantic == other.semantic && winter.instance == other.instance;
            assert!(same && winter.depth_m == other.depth_m, "{far_m} m away");
        }
        assert!((0.2..0.7).contains(&bare), "{bare} of a bare crown is open, {far_m} m away");
        assert!(leaves < 0.5 * bare, "{leaves} of a crown with leaves is open, {bare} of a bare one, {far_m} m away");
        // The simple look has crowns of one colour each.
        assert!(simple < 0.02, "{simple}");
    }
}

#[test]
fn streets_of_a_town_whose_map_has_no_lamps_are_not_dark_at_night() {
    let mut town = trees_on(SemanticLabel::Roads);
    let mut put = |kind, object_id, center_in_world, half_extents_m| {
        let shape = OrientedBox { center_in_world, half_extents_m, yaw_rad: 0.0 };
        town.obstacles.push(Obstacle { shape, kind, object_id, synthetic: true });
    };
    put(ObstacleKind::Building, 90, DVec3::new(35.0, 0.0, 4.0), DVec3::new(10.0, 40.0, 4.0));
    let unlit = town.clone();
    let roads_alone = trees_on(SemanticLabel::Roads);
    // One lamp far away: the map tells of lamps, and there is none here.
    town.obstacles.push(Obstacle {
        shape: OrientedBox {
            center_in_world: DVec3::new(-190.0, 190.0, 3.0),
            half_extents_m: DVec3::new(0.1, 0.1, 3.0),
            yaw_rad: 0.0,
        },
        kind: ObstacleKind::Lamp,
        object_id: 91,
        synthetic: true,
    });
    let night = cosfly_materials::presets::preset("ClearNight").expect("a preset");
    let pose = Pose { position_in_world: DVec3::new(-20.0, 0.0, 30.0), pitch_rad: -0.8, yaw_rad: 0.0, roll_rad: 0.0 };
    let [without, elsewhere, alone] = [&unlit, &town, &roads_alone].map(|town| {
        let mut renderer = Renderer::new(camera(320, 200));
        let setup = FrameSetup { pose, weather: &night, target: None, others: &[] };
        let images = &renderer.render(&Scene::new(town, Seed([1; 32])), &setup).images;
        let road = (0..images.semantic.len()).filter(|at| images.semantic[*at] == SemanticLabel::Roads.id());
        let mut light: Vec<u8> = road.map(|at| images.rgb[3 * at + 1]).collect();
        light.sort_unstable();
        f64::from(light[light.len() * 9 / 10])
    });
    assert!(without > 1.3 * elsewhere, "{without} in a town without lamps, {elsewhere} far from the lamp of another");
    assert!(
        alone > 1.25 * elsewhere && alone > 40.0,
        "{alone} where no house is, {elsewhere} far from the lamp of another"
    );
}

#[test]
fn depth_and_ids_are_those_of_rays_on_random_scenes() {
    let mut random = Seed([4; 32]).stream("scenes");
    for _ in 0..6 {
        let scene = Scene::new(&random_scene(&mut random), Seed([1; 32]));
        let pose = Pose {
            position_in_world: DVec3::new(
                random.uniform(-20.0, 0.0),
                random.uniform(-9.0, 9.0),
                random.uniform(8.0, 25.0),
            ),
            pitch_rad: random.uniform(-0.9, 0.1),
            yaw_rad: random.uniform(-0.4, 0.4),
            roll_rad: random.uniform(-0.3, 0.3),
        };
        let target = figure(DVec3::new(random.uniform(2.0, 12.0), random.uniform(-5.0, 5.0), 1.0));
        let [compared, off, wrong] = compare(&scene, camera(320, 200), pose, Some(target), 17);
        // A ray may differ on the very edge of a triangle, where both answers are right.
        assert!(off <= compared / 1500 && wrong <= compared / 1500, "{off} and {wrong} of {compared}");
    }
}

#[test]
fn models_are_where_rays_find_them() {
    let mut random = Seed([9; 32]).stream("scenes");
    for fit in [ModelFit::Fill, ModelFit::Within] {
        let mut town = random_scene(&mut random);
        for obstacle in town.obstacles.iter_mut().step_by(2) {
            obstacle.kind = ObstacleKind::Car;
        }
        let model = Model::read(Model::EXAMPLE).expect("a model");
        let model = SceneModel { kind: ModelKind::Car, fit, turn_rad: random.uniform(-3.0, 3.0), model };
        let scene = Scene::with_models(&town, Seed([1; 32]), &[model]);
        let pose = Pose::looking_at(DVec3::new(-12.0, 4.0, 14.0), DVec3::new(20.0, 0.0, 3.0));
        let [compared, off, wrong] = compare(&scene, camera(320, 200), pose, None, 17);
        assert!(off <= compared / 1500 && wrong <= compared / 1500, "{off} and {wrong} of {compared}");
    }
}

#[test]
fn depth_is_exact_on_walls_that_graze_the_view() {
    let mut town = small_town::empty_town();
    let wall = OrientedBox::from_corners(DVec3::new(-20.0, 0.01, -5.0), DVec3::new(280.0, 1.0, 9.0));
    town.obstacles.push(Obstacle { shape: wall, kind: ObstacleKind::Wall, object_id: 0, synthetic: false });
    let scene = Scene::new(&town, Seed([1; 32]));
    let pose = Pose { yaw_rad: 0.02, ..Pose::looking_at(DVec3::new(0.0, -0.04, 1.0), DVec3::new(9.0, -0.04, 1.0)) };
    let [compared, off, wrong] = compare(&scene, camera(640, 360), pose, None, 13);
    assert!(off <= 2 && wrong <= 2, "{off} and {wrong} of {compared}");
}

#[test]
fn a_camera_inside_an_obstacle_looks_out_of_it() {
    let mut town = small_town::small_town(2, 3);
    let around = OrientedBox::from_corners(DVec3::splat(-3.0), DVec3::splat(3.0));
    town.obstacles.push(Obstacle { shape: around, kind: ObstacleKind::Building, object_id: 9999, synthetic: true });
    let scene = Scene::new(&town, Seed([1; 32]));
    let pose = Pose::looking_at(DVec3::ZERO, DVec3::new(10.0, 5.0, -2.0));
    let (images, _) = draw(&scene, camera(160, 90), pose, None);
    assert!(!images.instance.contains(&10_001));
}

#[test]
fn odd_boxes_and_sizes_do_no_harm() {
    let mut town = small_town::small_town(1, 3);
    for half in [DVec3::ZERO, DVec3::new(2.0, 0.0, 1.0), DVec3::new(0.0, 0.0, 4.0), DVec3::new(f64::NAN, 1.0, 1.0)] {
        let shape = OrientedBox { center_in_world: DVec3::new(3.0, 0.0, 1.0), half_extents_m: half, yaw_rad: 0.5 };
        town.obstacles.push(Obstacle { shape, kind: ObstacleKind::Static, object_id: u32::MAX, synthetic: true });
    }
    let mut broken = town.surfaces[0].clone();
    broken.triangles.push([0, 1, 4_000_000]);
    broken.vertices_in_world[0] = DVec3::new(f64::INFINITY, 0.0, 0.0);
    town.surfaces.push(broken);
    let scene = Scene::new(&town, Seed([1; 32]));
    let target = Some(figure(DVec3::new(4.0, 1.0, 0.0)));
    for (width, height) in [(64, 48), (1, 1), (0, 0), (17, 3), (3840, 2160)] {
        for position in [DVec3::new(-9.0, 0.0, 6.0), DVec3::new(4.0, 1.0, 1.0), DVec3::new(1e9, -1e12, 1e300)] {
            let pose = Pose::looking_at(position, DVec3::ZERO);
            let (images, _) = draw(&scene, camera(width, height), pose, target);
            assert_eq!(images.rgb.len(), 3 * (width * height) as usize);
            if width > 1000 {
                break;
            }
        }
    }
}

#[test]
fn a_target_behind_the_camera_is_not_in_view() {
    let scene = Scene::new(&small_town::small_town(1, 3), Seed([1; 32]));
    let pose = Pose::looking_at(DVec3::new(0.0, 0.0, 5.0), DVec3::new(10.0, 0.0, 5.0));
    let (_, view) = draw(&scene, camera(320, 180), pose, Some(figure(DVec3::new(-8.0, 0.0, 0.0))));
    assert!(!view.in_view && view.pixels == 0 && view.full_box.is_none() && view.visible_box.is_none());
    assert_eq!(view.visible_by_pixels, 0.0);
}

#[test]
fn the_visible_box_is_the_box_of_the_instance_pixels() {
    let mut town = small_town::empty_town();
    let low_wall = OrientedBox::from_corners(DVec3::new(9.0, -5.0, 0.0), DVec3::new(9.3, 5.0, 0.9));
    town.obstacles.push(Obstacle { shape: low_wall, kind: ObstacleKind::Wall, object_id: 40, synthetic: false });
    let scene = Scene::new(&town, Seed([1; 32]));
    let pose = Pose::looking_at(DVec3::new(0.0, 0.0, 1.2), DVec3::new(12.0, 0.0, 1.0));
    let (images, view) = draw(&scene, camera(640, 480), pose, Some(figure(DVec3::new(12.0, 0.0, 0.0))));
    let pixels = images.instance.iter().enumerate().filter(|(_, id)| **id == TARGET_INSTANCE);
    let places: Vec<(u32, u32)> = pixels.map(|(i, _)| (i as u32 % 640, i as u32 / 640)).collect();
    let by = |pick: fn(&(u32, u32)) -> u32| (places.iter().map(pick).min(), places.iter().map(pick).max());
    let ((u_min, u_max), (v_min, v_max)) = (by(|p| p.0), by(|p| p.1));
    let expected = PixelBox {
        u_min: u_min.expect("seen"),
        v_min: v_min.expect("seen"),
        u_max: u_max.expect("seen"),
        v_max: v_max.expect("seen"),
    };
    assert_eq!(view.visible_box, Some(expected));
    assert_eq!(view.pixels as usize, places.len());
    let full = view.full_box.expect("in view");
    assert!(full.v_max > expected.v_max && full.v_min == expected.v_min);
    assert!(view.in_view && view.occluder_instance == 42 && (0.3..0.8).contains(&view.visible_by_pixels));
    for (&semantic, &instance) in images.semantic.iter().zip(&images.instance) {
        assert_eq!(semantic == SemanticLabel::Pedestrian.id(), instance == TARGET_INSTANCE);
    }
}

#[test]
fn the_target_stands_where_the_camera_projects_it() {
    let scene = Scene::new(&small_town::empty_town(), Seed([1; 32]));
    for (x, y) in [(14.0, 0.0), (20.0, 9.0), (11.0, -6.0)] {
        let target = figure(DVec3::new(x, y, 0.0));
        let pose = Pose::looking_at(DVec3::new(0.0, 0.0, 12.0), DVec3::new(14.0, 0.0, 0.0));
        let camera = camera(1280, 720);
        let (_, view) = draw(&scene, camera, pose, Some(target));
        let seen = view.full_box.expect("in view");
        assert_eq!((view.visible_by_pixels, view.visible_box), (1.0, view.full_box));
        let middle = DVec3::new(x, y, 0.9);
        let (u, v, depth) = camera.project(&pose, middle).expect("ahead");
        let reach = 0.35 * camera.focal_px() / depth;
        assert!((0.5 * f64::from(seen.u_min + seen.u_max + 1) - u).abs() < reach);
        assert!((0.5 * f64::from(seen.v_min + seen.v_max + 1) - v).abs() < reach);
    }
}

#[test]
fn the_same_frame_has_the_same_bytes_after_any_other_frame_and_on_any_thread() {
    let scene = Scene::new(&small_town::small_town(3, 5), Seed([1; 32]));
    let rain =
        Weather { sun_azimuth_angle: 40.0, ..cosfly_materials::presets::preset("HardRainSunset").expect("a preset") };
    let feet = DVec3::new(5.0, -16.0, 0.1);
    let pose = Pose::looking_at(feet + DVec3::new(-12.0, 3.0, 15.0), feet);
    let setup = FrameSetup { pose, weather: &rain, target: Some(figure(feet)), others: &[] };
    let once = Renderer::new(camera(320, 180)).render(&scene, &setup).images.clone();
    let mut used = Renderer::new(camera(320, 180));
    let elsewhere = Pose::looking_at(DVec3::new(70.0, 60.0, 9.0), DVec3::ZERO);
    used.render(&scene, &FrameSetup { pose: elsewhere, weather: &noon(), target: None, others: &[] });
    assert!(used.render(&scene, &setup).images == &once);
    std::thread::scope(|scope| {
        let workers: Vec<_> = (0..2)
            .map(|_| scope.spawn(|| Renderer::new(camera(320, 180)).render(&scene, &setup).images.clone()))
            .collect();
        for worker in workers {
            assert!(worker.join().expect("no panic") == once);
        }
    });
}

#[test]
fn the_largest_and_the_smallest_pictures_have_all_their_pixels() {
    let scene = Scene::new(&small_town::small_town(2, 3), Seed([1; 32]));
    let target = Some(figure(DVec3::new(6.0, 0.0, 0.1)));
    let pose = Pose::looking_at(DVec3::new(-14.0, 3.0, 12.0), DVec3::new(6.0, 0.0, 1.0));
    for (width, height) in [(7680u32, 4320u32), (64, 48), (16, 16)] {
        let mut renderer = Renderer::new(camera(width, height));
        let setup = FrameSetup { pose, weather: &noon(), target, others: &[] };
        let frame = renderer.render_parts(&scene, &setup, cosfly_render::FrameParts::Ids);
        assert_eq!(frame.images.depth_m.len(), width as usize * height as usize);
        assert!(frame.target_view.in_view || width < 100);
        assert!(frame.images.depth_m.iter().all(|depth| *depth > 0.0));
        let pixels = frame.images.instance.iter().filter(|id| **id == TARGET_INSTANCE).count();
        assert_eq!(frame.target_view.pixels as usize, pixels);
    }
}
