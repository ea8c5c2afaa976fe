//! Lens, blur and noise: what they change, what they leave alone, and that boxes stay the boxes of the pixels.

mod small_town;

use cosfly_domain::{
    Camera, FrameImages, Lens, MotionBlur, Noise, PixelBox, RollingShutter, TARGET_INSTANCE, TargetView, Weather,
};
use cosfly_figures::{BodyFigure, BodyShape, FigureInPicture};
use cosfly_frames::{DVec3, Pose, Seed, TargetState};
use cosfly_render::{Effects, Moment, Neighbours, Renderer, Scene, Shot};
use std::cell::RefCell;

const CAMERA: Camera = Camera { width: 320, height: 180, horizontal_fov_rad: 1.4 };
const FEET: DVec3 = DVec3::new(0.0, -24.0, 0.1);

fn moment(offset_s: f64) -> Moment {
    let feet = FEET + DVec3::X * (4.0 * offset_s);
    let state = TargetState { feet_in_world: feet, heading_rad: 0.4, speed_mps: 4.0 };
    let target = BodyFigure {
        state,
        height_m: 1.8,
        radius_m: 0.3,
        clothes_seed: Seed([2; 32]),
        gait_phase_rad: 0.8,
        body: BodyShape::default(),
    };
    let pose = Pose::looking_at(FEET + DVec3::new(-6.0, 1.5 + 9.0 * offset_s, 7.5), FEET + DVec3::new(0.0, 1.0, 0.9));
    Moment { pose, target: Some(target) }
}

fn film(lens: Lens, blur: MotionBlur, noise: Noise, noise_seed: u8) -> (FrameImages, TargetView) {
    film_rolling(lens, blur, AT_ONCE, noise, noise_seed, 0.0)
}

fn film_rolling(
    lens: Lens,
    blur: MotionBlur,
    rolling: RollingShutter,
    noise: Noise,
    noise_seed: u8,
    later_s: f64,
) -> (FrameImages, TargetView) {
    let moment = |offset_s: f64| moment(later_s + offset_s);
    let scene = Scene::new(&small_town::small_town(3, 5), Seed([1; 32]));
    let weather =
        Weather { sun_azimuth_angle: 200.0, ..cosfly_materials::presets::preset("ClearNoon").expect("a preset") };
    let mut effects = Effects::new(CAMERA, lens, blur, rolling);
    effects.set_noise(noise);
    let mut renderer = Renderer::new(effects.ideal_camera());
    let shot = Shot {
        weather: &weather,
        moment: &moment,
        others: &|_, _| {},
        neighbours: Neighbours::default(),
        noise_seed: Seed([noise_seed; 32]),
    };
    let frame = effects.film(&mut renderer, &scene, &shot);
    (frame.images.clone(), frame.target_view)
}

fn box_of_pixels(images: &FrameImages) -> Option<PixelBox> {
    let pixels = images.instance.iter().enumerate().filter(|(_, id)| **id == TARGET_INSTANCE);
    let places = pixels.map(|(pixel, _)| (pixel as u32 % images.width, pixel as u32 / images.width));
    places.fold(None, |found, (u, v)| {
        let known = found.unwrap_or(PixelBox { u_min: u, v_min: v, u_max: u, v_max: v });
        Some(PixelBox {
            u_min: known.u_min.min(u),
            v_min: known.v_min.min(v),
            u_max: known.u_max.max(u),
            v_max: known.v_max.max(v),
        })
    })
}

const NO_LENS: Lens = Lens::brown(0.0, 0.0);
const NO_BLUR: MotionBlur = MotionBlur { shutter_s: 0.0, samples: 9 };
const AT_ONCE: RollingShutter = RollingShutter { readout_s: 0.0, strips: 16 };
const NO_NOISE: Noise = Noise { gaussian: 0.0, shot: 0.0 };

#[test]
fn blur_and_noise_change_colours_only() {
    let (plain, view) = film(NO_LENS, NO_BLUR, NO_NOISE, 1);
    assert!(view.pixels > 100);
    let (blurred, blurred_view) = film(NO_LENS, MotionBlur { shutter_s: 0.2, samples: 7 }, NO_NOISE, 1);
    let (noisy, noisy_view) = film(NO_LENS, NO_BLUR, Noise { gaussian: 4.0, shot: 2.0 }, 1);
    for (other, other_view) in [(&blurred, blurred_view), (&noisy, noisy_view)] {
        assert_eq!(other_view, view);
        assert!(other.depth_m == plain.depth_m && other.semantic == plain.semantic && other.instance == plain.instance);
        let changed = other.rgb.iter().zip(&plain.rgb).filter(|(a, b)| a != b).count();
        assert!(changed > plain.rgb.len() / 4, "{changed} of {}", plain.rgb.len());
    }
    // Neighbouring columns differ less in a picture that is blurred sideways.
    let roughness = |rgb: &[u8]| rgb.windows(4).map(|w| u64::from(w[0].abs_diff(w[3]))).sum::<u64>();
    assert!(roughness(&blurred.rgb) < roughness(&plain.rgb) && roughness(&noisy.rgb) > roughness(&plain.rgb));
}

#[test]
fn a_rolling_shutter_shows_each_strip_at_its_moment_in_all_channels() {
    let rolling = RollingShutter { readout_s: 0.4, strips: 9 };
    let (rolled, view) = film_rolling(NO_LENS, NO_BLUR, rolling, NO_NOISE, 1, 0.0);
    let width = CAMERA.width as usize;
    for (rows, later_s) in rolling.strips(CAMERA.height as usize) {
        let (still, _) = film_rolling(NO_LENS, NO_BLUR, AT_ONCE, NO_NOISE, 1, later_s);
        let pixels = rows.start * width..rows.end * width;
        let colours = 3 * pixels.start..3 * pixels.end;
        assert!(rolled.rgb[colours.clone()] == still.rgb[colours], "{rows:?}");
        assert!(rolled.depth_m[pixels.clone()] == still.depth_m[pixels.clone()], "{rows:?}");
        assert!(rolled.semantic[pixels.clone()] == still.semantic[pixels.clone()], "{rows:?}");
        assert!(rolled.instance[pixels.clone()] == still.instance[pixels], "{rows:?}");
    }
    assert_eq!(view.visible_box, box_of_pixels(&rolled));
    let (_, at_once) = film(NO_LENS, NO_BLUR, NO_NOISE, 1);
    assert_ne!(view.visible_box, at_once.visible_box, "the target leans");
    // Blurred and bent as well, every pixel of the target still counts once.
    let blur = MotionBlur { shutter_s: 0.02, samples: 3 };
    let (bent, view) = film_rolling(Lens::brown(-0.2, 0.0), blur, rolling, NO_NOISE, 1, 0.0);
    assert_eq!(view.visible_box, box_of_pixels(&bent));
    assert_eq!(view.pixels as usize, bent.instance.iter().filter(|id| **id == TARGET_INSTANCE).count());
}

#[test]
fn the_same_seed_gives_the_same_grain() {
    let noise = Noise { gaussian: 4.0, shot: 0.0 };
    assert!(film(NO_LENS, NO_BLUR, noise, 1) == film(NO_LENS, NO_BLUR, noise, 1));
    assert!(film(NO_LENS, NO_BLUR, noise, 1).0.rgb != film(NO_LENS, NO_BLUR, noise, 2).0.rgb);
}

#[test]
fn through_a_lens_boxes_are_those_of_the_bent_pixels_and_labels_are_never_mixed() {
    let (plain, plain_view) = film(NO_LENS, NO_BLUR, NO_NOISE, 1);
    for lens in [Lens::brown(-0.25, 0.04), Lens::brown(0.15, 0.0)] {
        let (bent, view) = film(lens, NO_BLUR, NO_NOISE, 1);
        assert_eq!((bent.width, bent.height), (CAMERA.width, CAMERA.height));
        assert_eq!(view.visible_box, box_of_pixels(&bent));
        assert!(view.full_box.is_some() && view.pixels > 100);
        // Where an ideal camera sees the middle of the target's box is where the lens bends it to.
        let middle = |b: PixelBox| (0.5 * f64::from(b.u_min + b.u_max + 1), 0.5 * f64::from(b.v_min + b.v_max + 1));
        let expected = lens.bend(&CAMERA, middle(plain_view.full_box.expect("in view")));
        let found = middle(view.full_box.expect("in view"));
        assert!((expected.0 - found.0).abs() < 1.5 && (expected.1 - found.1).abs() < 1.5, "{expected:?} {found:?}");
        let ids: std::collections::BTreeSet<u32> = plain.instance.iter().copied().collect();
        let strange = bent.instance.iter().filter(|id| !ids.contains(*id)).count();
        assert!(lens.k1 < 0.0 || strange == 0, "a lens that narrows the view shows nothing new");
        // A pixel's depth is that of the ray that the lens sends through it, at the nearest ideal sample.
        let mut compared = 0;
        for pixel in (0..bent.depth_m.len()).step_by(97) {
            let seen = (pixel as f64 % 320.0 + 0.5, (pixel / 320) as f64 + 0.5);
            let (u, v) = lens.unbend(&CAMERA, seen).expect("in reach");
            if (1.0..319.0).contains(&u) && (1.0..179.0).contains(&v) {
                let ideal = v as usize * 320 + u as usize;
                compared += 1;
                let around = [ideal, ideal - 1, ideal + 1, ideal - 320, ideal + 320];
                assert!(
                    around.iter().any(|at| plain.depth_m[*at].to_bits().abs_diff(bent.depth_m[pixel].to_bits()) < 64)
                );
            }
        }
        assert!(compared > 100);
    }
}

#[test]
fn a_film_looks_at_its_moments_and_at_no_other() {
    let scene = Scene::new(&small_town::empty_town(), Seed([1; 32]));
    let weather = cosfly_materials::presets::preset("ClearNoon").expect("a preset");
    let camera = Camera { width: 16, height: 12, horizontal_fov_rad: 1.2 };
    let blur = MotionBlur { shutter_s: 0.1, samples: 3 };
    let rolling = RollingShutter { readout_s: 0.05, strips: 4 };
    for (blur, rolling, count) in [
        (MotionBlur::default(), AT_ONCE, 1),
        (blur, AT_ONCE, 3),
        (MotionBlur::default(), rolling, 4),
        (blur, rolling, 12),
    ] {
        let mut effects = Effects::new(camera, Lens::default(), blur, rolling);
        effects.set_noise(Noise { gaussian: 1.0, shot: 0.0 });
        let (moments_s, asked) = (effects.moments_s(), RefCell::new(vec![]));
        let others = |offset_s: f64, _: &mut Vec<FigureInPicture>| asked.borrow_mut().push(offset_s);
        let shot = Shot {
            weather: &weather,
            moment: &moment,
            others: &others,
            neighbours: Neighbours::default(),
            noise_seed: Seed([2; 32]),
        };
        effects.film(&mut Renderer::new(effects.ideal_camera()), &scene, &shot);
        assert_eq!((&asked.take(), moments_s.len()), (&moments_s, count));
    }
}
