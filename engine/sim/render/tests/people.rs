//! People beside the target: in all channels, before and behind the target, counted, the same bytes every time.

mod small_town;

use cosfly_domain::{
    BodyKind, BodyView, Camera, FrameImages, Lens, MotionBlur, PixelBox, RollingShutter, SemanticLabel, SurfaceMesh,
    TARGET_INSTANCE, TargetView, Weather,
};
use cosfly_figures::{BodyFigure, BodyShape, Clothes, FigureInPicture, figure_triangles};
use cosfly_frames::simd::Level;
use cosfly_frames::{DVec3, Pose, RandomStream, Seed, TargetState, real};
use cosfly_render::{Buildings, Effects, FrameSetup, Moment, Neighbours, Outlook, Renderer, Scene, Shot};

const CAMERA: Camera = Camera { width: 640, height: 360, horizontal_fov_rad: 1.4 };
/// Larger than all ids of the small town.
const FIRST: u32 = 40_000;

fn noon() -> Weather {
    Weather { sun_azimuth_angle: 200.0, ..cosfly_materials::presets::preset("ClearNoon").expect("a preset") }
}

fn figure(feet: DVec3, seed: u8) -> BodyFigure {
    let turn = f64::from(seed);
    BodyFigure {
        state: TargetState { feet_in_world: feet, heading_rad: turn, speed_mps: 0.2 * (turn % 8.0) },
        height_m: 1.6 + 0.01 * (turn % 30.0),
        radius_m: 0.28,
        clothes_seed: Seed([seed; 32]),
        gait_phase_rad: 0.7 * turn,
        body: BodyShape::default(),
    }
}

fn target(feet: DVec3) -> BodyFigure {
    figure(feet, 2)
}

fn crowd(random: &mut RandomStream, around: DVec3, count: u32) -> Vec<FigureInPicture> {
    let person = |k: u32| {
        let away = DVec3::new(random.uniform(-25.0, 25.0), random.uniform(-25.0, 25.0), 0.0);
        FigureInPicture { figure: figure(around + away, k as u8), instance: FIRST + k }
    };
    (0..count).map(person).collect()
}

struct Drawn {
    images: FrameImages,
    view: TargetView,
    others: Vec<BodyView>,
}

fn draw(renderer: &mut Renderer, scene: &Scene, setup: &FrameSetup<'_>) -> Drawn {
    let frame = renderer.render(scene, setup);
    Drawn { images: frame.images.clone(), view: frame.target_view, others: frame.others.to_vec() }
}

/// Pixels of an id and the box around them.
fn pixels_of(images: &FrameImages, id: u32) -> Option<(u32, PixelBox)> {
    let at = |pixel: usize| ((pixel % images.width as usize) as u32, (pixel / images.width as usize) as u32);
    let pixels: Vec<_> = (0..images.instance.len()).filter(|k| images.instance[*k] == id).map(at).collect();
    let visible_box = PixelBox {
        u_min: pixels.iter().map(|it| it.0).min()?,
        v_min: pixels.iter().map(|it| it.1).min()?,
        u_max: pixels.iter().map(|it| it.0).max()?,
        v_max: pixels.iter().map(|it| it.1).max()?,
    };
    Some((pixels.len() as u32, visible_box))
}

/// Planar depth and owner of the first triangle on a ray.
fn cast(triangles: &[([DVec3; 3], u32)], origin: DVec3, ray: DVec3) -> (f64, u32) {
    let mut first = (f64::INFINITY, 0);
    for &([a, b, c], owner) in triangles {
        let (ab, ac) = (b - a, c - a);
        let p = ray.cross(ac);
        let determinant = ab.dot(p);
        let s = (origin - a) / determinant;
        let (u, q) = (s.dot(p), s.cross(ab));
        let (v, t) = (ray.dot(q), ac.dot(q));
        if determinant.abs() > 1e-14 && u >= 0.0 && v >= 0.0 && u + v <= 1.0 && t > 0.01 && t < first.0 {
            first = (t, owner);
        }
    }
    first
}

/// Vehicles of all kinds and drones in the air around a place.
fn traffic(random: &mut RandomStream, around: DVec3, count: u32) -> Vec<FigureInPicture> {
    let kinds = [
        (BodyKind::Bicycle, [1.8, 0.65, 1.75]),
        (BodyKind::Motorcycle, [2.1, 0.8, 1.6]),
        (BodyKind::Car, [4.5, 1.8, 1.5]),
        (BodyKind::Van, [5.2, 2.0, 2.3]),
        (BodyKind::Truck, [8.0, 2.5, 3.4]),
        (BodyKind::Bus, [12.0, 2.5, 3.1]),
        (BodyKind::Drone, [0.6, 0.6, 0.2]),
    ];
    let vehicle = |k: u32| {
        let (kind, size_m) = kinds[k as usize % kinds.len()];
        let height_m = if kind == BodyKind::Drone { 5.0 + f64::from(k % 5) } else { 0.0 };
        let away = DVec3::new(random.uniform(-25.0, 25.0), random.uniform(-25.0, 25.0), height_m);
        let body = BodyShape::of(kind, DVec3::from_array(size_m));
        FigureInPicture { figure: BodyFigure { body, ..figure(around + away, k as u8) }, instance: FIRST + k }
    };
    (0..count).map(vehicle).collect()
}

#[test]
fn vehicles_and_riders_are_where_rays_meet_them_with_the_labels_of_their_kinds() {
    let scene = Scene::new(&small_town::empty_town(), Seed([1; 32]));
    let mut random = Seed([8; 32]).stream("traffic");
    for round in 0..4u32 {
        let others = traffic(&mut random, DVec3::ZERO, 15);
        let turn = 1.3 * f64::from(round);
        let away = DVec3::new(24.0 * real::cos(turn), 24.0 * real::sin(turn), 7.0 + 5.0 * f64::from(round));
        let followed = BodyFigure { body: others[round as usize].figure.body, ..target(DVec3::ZERO) };
        let pose = Pose::looking_at(away, DVec3::ZERO);
        let setup = FrameSetup { pose, weather: &noon(), target: Some(followed), others: &others };
        let Drawn { images, view, others: views } = draw(&mut Renderer::new(CAMERA), &scene, &setup);
        let mut drawn: Vec<_> = vec![(followed, TARGET_INSTANCE)];
        drawn.extend(others.iter().map(|other| (other.figure, other.instance)));
        let (mut triangles, mut labels) = (vec![], vec![]);
        for (figure, instance) in &drawn {
            let mut surface = vec![];
            cosfly_figures::add_figure(figure, &Clothes::draw(&figure.clothes_seed), 0, &mut surface);
            for triangle in surface {
                triangles.push((triangle.corners_in_world, labels.len() as u32));
                labels.push((figure.body.label(triangle.region), *instance));
            }
        }
        labels.push((SemanticLabel::Sky, 0));
        let (mut vehicles, mut wrong) = (0, 0);
        let worth_a_ray = |pixel: &usize| pixel.is_multiple_of(if images.instance[*pixel] == 0 { 501 } else { 7 });
        for pixel in (0..images.instance.len()).filter(worth_a_ray) {
            let ray = CAMERA.ray_in_world(&pose, (pixel % 640) as f64 + 0.5, (pixel / 640) as f64 + 0.5);
            let (depth, first) = cast(&triangles, pose.position_in_world, ray);
            let (label, owner) = labels[if depth.is_finite() { first as usize } else { labels.len() - 1 }];
            let seen = f64::from(images.depth_m[pixel]);
            let is_deep = seen != depth && (seen - depth).abs() > 6e-3 + 1e-5 * depth;
            vehicles += usize::from(owner != 0);
            wrong += usize::from(is_deep || images.instance[pixel] != owner || images.semantic[pixel] != label.id());
        }
        assert!(vehicles > 1000 && wrong * 400 < vehicles, "round {round}: {wrong} of {vehicles}");
        assert!(view.in_view && view.pixels > 0 && views.len() > 5, "round {round}");
    }
}

#[test]
fn people_are_where_rays_meet_them_and_all_channels_agree() {
    let scene = Scene::new(&small_town::empty_town(), Seed([1; 32]));
    let mut random = Seed([7; 32]).stream("crowd");
    let feet = DVec3::new(0.0, 0.0, 0.0);
    for round in 0..4u32 {
        let others = crowd(&mut random, feet, 25);
        let turn = 1.3 * f64::from(round);
        let away = DVec3::new(22.0 * real::cos(turn), 22.0 * real::sin(turn), 6.0 + 5.0 * f64::from(round));
        let setup = FrameSetup {
            pose: Pose::looking_at(feet + away, feet),
            weather: &noon(),
            target: Some(target(feet)),
            others: &others,
        };
        let Drawn { images, others: views, .. } = draw(&mut Renderer::new(CAMERA), &scene, &setup);
        let mut triangles: Vec<_> =
            figure_triangles(&target(feet)).into_iter().map(|corners| (corners, TARGET_INSTANCE)).collect();
        for other in &others {
            triangles.extend(figure_triangles(&other.figure).into_iter().map(|corners| (corners, other.instance)));
        }
        let (mut people, mut wrong) = (0, 0);
        // Where somebody is drawn, and some of all other places.
        let worth_a_ray = |pixel: &usize| pixel.is_multiple_of(if images.instance[*pixel] == 0 { 501 } else { 5 });
        for pixel in (0..images.instance.len()).filter(worth_a_ray) {
            let (column, row) = (pixel % 640, pixel / 640);
            let ray = CAMERA.ray_in_world(&setup.pose, column as f64 + 0.5, row as f64 + 0.5);
            let (depth, owner) = cast(&triangles, setup.pose.position_in_world, ray);
            let label = if owner == 0 { SemanticLabel::Sky } else { SemanticLabel::Pedestrian };
            let seen = f64::from(images.depth_m[pixel]);
            people += usize::from(owner != 0);
            let is_deep = seen != depth && (seen - depth).abs() > 1e-3 + 1e-5 * depth;
            wrong += usize::from(is_deep || images.instance[pixel] != owner || images.semantic[pixel] != label.id());
        }
        assert!(people > 150 && wrong * 500 <= people, "{wrong} of {people}");
        let counted: Vec<_> = others
            .iter()
            .filter_map(|other| {
                let (pixels, visible_box) = pixels_of(&images, other.instance)?;
                Some(BodyView { instance: other.instance, pixels, visible_box })
            })
            .collect();
        assert!(views == counted && counted.len() > 8);
    }
}

#[test]
fn somebody_before_the_target_hides_it_and_somebody_behind_does_not() {
    let scene = Scene::new(&small_town::empty_town(), Seed([1; 32]));
    let feet = DVec3::new(10.0, 0.0, 0.0);
    let pose = Pose::looking_at(DVec3::new(0.0, 0.0, 1.4), DVec3::new(10.0, 0.0, 1.0));
    let mut renderer = Renderer::new(CAMERA);
    let mut view = |others: &[FigureInPicture]| {
        let setup = FrameSetup { pose, weather: &noon(), target: Some(target(feet)), others };
        draw(&mut renderer, &scene, &setup).view
    };
    let at = |x: f64, instance: u32| FigureInPicture { figure: figure(DVec3::new(x, 0.05, 0.0), 9), instance };
    let alone = view(&[]);
    assert_eq!((alone.visible_by_pixels, alone.occluder_instance), (1.0, 0));
    let hidden = view(&[at(6.0, FIRST + 3), at(14.0, FIRST + 8)]);
    assert!(hidden.visible_by_pixels < 0.7, "{hidden:?}");
    assert_eq!((hidden.occluder_instance, hidden.full_box), (FIRST + 3, alone.full_box));
    assert_eq!(view(&[at(14.0, FIRST + 8)]), alone);
    assert_eq!(view(&[at(-3.0, FIRST)]), alone, "somebody behind the camera is not seen");
}

#[test]
fn people_throw_shadows_like_the_target_also_from_outside_of_the_picture() {
    let mut town = small_town::empty_town();
    let corner = |x: f64, y: f64| DVec3::new(x, y, 0.0);
    town.surfaces.push(SurfaceMesh {
        label: SemanticLabel::SideWalks,
        vertices_in_world: vec![corner(-60.0, -60.0), corner(60.0, -60.0), corner(60.0, 60.0), corner(-60.0, 60.0)],
        along_across_m: vec![],
        triangles: vec![[0, 1, 2], [0, 2, 3]],
        synthetic: true,
    });
    let scene = Scene::new(&town, Seed([1; 32]));
    let weather = Weather { sun_altitude_angle: 18.0, sun_azimuth_angle: 0.0, ..noon() };
    let feet = DVec3::new(3.0, -16.0, 0.0);
    let shadow_middle = feet - DVec3::new(2.5, 0.0, 0.0);
    let mut renderer = Renderer::new(CAMERA);
    // Straight down on the end of the shadow: the body itself is beyond the edge.
    for (height_m, is_body_seen) in [(3.0, false), (12.0, true)] {
        let pose = Pose {
            position_in_world: shadow_middle + DVec3::new(-1.5, 0.0, height_m),
            pitch_rad: -1.5,
            yaw_rad: 1.57,
            roll_rad: 0.0,
        };
        let somebody = target(feet);
        let other = [FigureInPicture { figure: somebody, instance: FIRST }];
        let mut picture = |target: Option<BodyFigure>, others: &[FigureInPicture]| {
            draw(&mut renderer, &scene, &FrameSetup { pose, weather: &weather, target, others })
        };
        let (nobody, as_target, as_other) = (picture(None, &[]), picture(Some(somebody), &[]), picture(None, &other));
        assert!(as_target.images.rgb == as_other.images.rgb && as_target.images.rgb != nobody.images.rgb, "{height_m}");
        assert_eq!(!as_other.others.is_empty(), is_body_seen);
        let dark = nobody.images.rgb.iter().zip(&as_other.images.rgb).filter(|(a, b)| *a > *b).count();
        assert!(dark > 300, "{dark}");
    }
}

#[test]
fn a_crowd_has_the_same_bytes_in_any_order_after_any_frame_on_all_processors() {
    let scene = Scene::new(&small_town::small_town(4, 5), Seed([1; 32]));
    let feet = DVec3::new(5.0, -16.0, 0.1);
    let mut random = Seed([8; 32]).stream("crowd");
    let mut others = crowd(&mut random, feet, 60);
    let pose = Pose::looking_at(feet + DVec3::new(-12.0, 3.0, 9.0), feet);
    for preset in ["ClearSunset", "WetNight"] {
        let weather =
            Weather { sun_azimuth_angle: 40.0, ..cosfly_materials::presets::preset(preset).expect("a preset") };
        let setup = FrameSetup { pose, weather: &weather, target: Some(target(feet)), others: &others };
        let once = draw(&mut Renderer::new(CAMERA), &scene, &setup);
        assert!(once.others.len() > 10);
        let mut used = Renderer::new(CAMERA);
        let elsewhere = Pose::looking_at(DVec3::new(70.0, 60.0, 9.0), DVec3::ZERO);
        used.render(&scene, &FrameSetup { pose: elsewhere, ..setup });
        for level in Level::available() {
            used.set_level(level);
            let again = draw(&mut used, &scene, &setup);
            assert!(again.images == once.images && again.others == once.others, "{}", level.name());
        }
        let pool = rayon::ThreadPoolBuilder::new().num_threads(3).build().expect("threads");
        used.set_parallel(true);
        assert!(pool.install(|| draw(&mut used, &scene, &setup)).images == once.images);
        others.reverse();
    }
}

#[test]
fn people_without_a_body_and_far_away_draw_nothing() {
    let scene = Scene::new(&small_town::small_town(2, 5), Seed([1; 32]));
    let feet = DVec3::new(5.0, -16.0, 0.1);
    let pose = Pose::looking_at(feet + DVec3::new(-12.0, 3.0, 9.0), feet);
    let mut renderer = Renderer::new(CAMERA);
    let mut picture = |others: &[FigureInPicture]| {
        draw(&mut renderer, &scene, &FrameSetup { pose, weather: &noon(), target: None, others })
    };
    let nobody = picture(&[]);
    let mut odd = [figure(feet, 1); 4];
    odd[0].height_m = f64::NAN;
    odd[1].state.feet_in_world.x = f64::INFINITY;
    odd[2].height_m = 0.0;
    odd[3].state.feet_in_world = feet + DVec3::new(900.0, 0.0, 0.0);
    let odd = odd.map(|figure| FigureInPicture { figure, instance: FIRST });
    let drawn = picture(&odd);
    assert!(drawn.images == nobody.images && drawn.others.is_empty());
}

#[test]
fn people_whom_the_outlook_or_a_building_excludes_change_no_byte() {
    let town = small_town::small_town(4, 5);
    let (scene, buildings) = (Scene::new(&town, Seed([1; 32])), Buildings::of(&town));
    let mut random = Seed([3; 32]).stream("views");
    let (mut renderer, mut left_out, mut hidden) = (Renderer::new(CAMERA), 0, 0);
    for (round, preset) in ["ClearNoon", "ClearSunset", "WetNight", "WetSunset"].iter().cycle().take(24).enumerate() {
        let weather = Weather {
            sun_azimuth_angle: 50.0 * round as f64,
            ..cosfly_materials::presets::preset(preset).expect("a preset")
        };
        let mut place = |height_m: f64| DVec3::new(random.uniform(-90.0, 90.0), random.uniform(-90.0, 90.0), height_m);
        let (eye, feet) = (place(3.0 + round as f64), place(0.14));
        let pose = Pose::looking_at(eye, eye + (feet - eye).normalize());
        let others: Vec<FigureInPicture> =
            (0..150).map(|k| FigureInPicture { figure: figure(place(0.14), k as u8), instance: FIRST + k }).collect();
        let outlook = Outlook::new(&CAMERA, &weather, &pose);
        let is_near = |other: &&FigureInPicture| {
            let is_hidden = buildings.hide(eye, &outlook.hull(&other.figure, town.min_in_world.z));
            outlook.may_show(&other.figure) && !is_hidden
        };
        let near: Vec<FigureInPicture> = others.iter().filter(is_near).copied().collect();
        left_out += others.len() - near.len();
        hidden += others.iter().filter(|other| outlook.may_show(&other.figure)).count() - near.len();
        let mut picture = |others: &[FigureInPicture]| {
            draw(&mut renderer, &scene, &FrameSetup { pose, weather: &weather, target: None, others })
        };
        let (all, some) = (picture(&others), picture(&near));
        assert!(all.images == some.images && all.others == some.others, "round {round}");
    }
    assert!(left_out > 1500 && hidden > 150, "{left_out} {hidden}");
}

#[test]
fn through_a_lens_and_blurred_people_move_and_keep_their_ids() {
    let scene = Scene::new(&small_town::small_town(3, 5), Seed([1; 32]));
    let feet = DVec3::new(5.0, -16.0, 0.1);
    let moment =
        |_: f64| Moment { pose: Pose::looking_at(feet + DVec3::new(-9.0, 3.0, 4.0), feet), target: Some(target(feet)) };
    let others = |speed_mps: f64| {
        move |offset_s: f64, list: &mut Vec<FigureInPicture>| {
            let at = feet + DVec3::new(-2.0, 1.5 + speed_mps * offset_s, 0.0);
            list.push(FigureInPicture { figure: figure(at, 5), instance: FIRST });
        }
    };
    let blur = MotionBlur { shutter_s: 0.1, samples: 5 };
    let film = |lens: Lens, blur: MotionBlur, speed_mps: f64| {
        let mut effects = Effects::new(CAMERA, lens, blur, RollingShutter::default());
        let mut renderer = Renderer::new(effects.ideal_camera());
        let weather = noon();
        let shot = Shot {
            weather: &weather,
            moment: &moment,
            others: &others(speed_mps),
            neighbours: Neighbours::default(),
            noise_seed: Seed([1; 32]),
        };
        let frame = effects.film(&mut renderer, &scene, &shot);
        Drawn { images: frame.images.clone(), view: frame.target_view, others: frame.others.to_vec() }
    };
    for lens in [Lens::default(), Lens::brown(-0.1, 0.0)] {
        let sharp = film(lens, MotionBlur::default(), 3.0);
        let [still, moved] = [0.0, 3.0].map(|speed_mps| film(lens, blur, speed_mps));
        let (pixels, visible_box) = pixels_of(&sharp.images, FIRST).expect("in view");
        assert_eq!(sharp.others, [BodyView { instance: FIRST, pixels, visible_box }]);
        assert!(sharp.images.instance == moved.images.instance && sharp.others == moved.others);
        assert!(still.images.rgb != moved.images.rgb && still.view == moved.view);
    }
}

#[test]
fn every_weather_has_the_same_depth_and_ids() {
    let scene = Scene::new(&small_town::small_town(3, 5), Seed([1; 32]));
    let feet = DVec3::new(5.0, -16.0, 0.1);
    let others = crowd(&mut Seed([9; 32]).stream("crowd"), feet, 40);
    let pose = Pose::looking_at(feet + DVec3::new(-12.0, 3.0, 9.0), feet);
    let mut renderer = Renderer::new(CAMERA);
    let mut first: Option<Drawn> = None;
    for name in cosfly_materials::presets::PRESETS {
        let weather = cosfly_materials::presets::preset(name).expect("a preset");
        let setup = FrameSetup { pose, weather: &weather, target: Some(target(feet)), others: &others };
        let drawn = draw(&mut renderer, &scene, &setup);
        let known = first.get_or_insert(Drawn { images: drawn.images.clone(), others: drawn.others.clone(), ..drawn });
        let bits = |images: &FrameImages| images.depth_m.iter().map(|depth| depth.to_bits()).collect::<Vec<_>>();
        assert!(bits(&known.images) == bits(&drawn.images), "{name}");
        assert!(known.images.semantic == drawn.images.semantic, "{name}");
        assert!(known.images.instance == drawn.images.instance, "{name}");
        assert!(known.view == drawn.view && known.others == drawn.others && !known.others.is_empty(), "{name}");
    }
}
