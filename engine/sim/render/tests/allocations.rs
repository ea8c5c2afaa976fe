//! Drawing a frame allocates nothing once buffers have grown.

mod crowd;
mod small_town;
mod traffic;

use cosfly_domain::Camera;
use cosfly_figures::{BodyFigure, BodyShape};
use cosfly_frames::{DVec3, Pose, Seed, TargetState, real};
use cosfly_render::{FrameSetup, Renderer, Scene};
use std::alloc::{GlobalAlloc, Layout, System};
use std::cell::Cell;

thread_local! {
    static ALLOCATIONS: Cell<u64> = const { Cell::new(0) };
}

/// The system's allocator, which counts what each thread asks for.
struct Counting;

// SAFETY: everything is the system's; counting touches a thread's own number, which needs no memory.
unsafe impl GlobalAlloc for Counting {
    unsafe fn alloc(&self, layout: Layout) -> *mut u8 {
        ALLOCATIONS.with(|count| count.set(count.get() + 1));
        // SAFETY: the caller keeps the contract, which is the same.
        unsafe { System.alloc(layout) }
    }

    unsafe fn dealloc(&self, at: *mut u8, layout: Layout) {
        // SAFETY: as above.
        unsafe { System.dealloc(at, layout) }
    }

    unsafe fn realloc(&self, at: *mut u8, layout: Layout, size: usize) -> *mut u8 {
        ALLOCATIONS.with(|count| count.set(count.get() + 1));
        // SAFETY: as above.
        unsafe { System.realloc(at, layout, size) }
    }
}

#[global_allocator]
static COUNTING: Counting = Counting;

#[test]
fn the_second_pass_over_a_flight_with_people_and_vehicles_allocates_nothing() {
    let scene = Scene::new(&small_town::small_town(4, 5), Seed([1; 32]));
    let mut renderer = Renderer::new(Camera { width: 320, height: 180, horizontal_fov_rad: 1.4 });
    let mut others = crowd::crowd(DVec3::new(5.0, -16.0, 0.1), 30);
    let place = |number: u32| DVec3::new(5.0 * f64::from(number), -14.0, 0.1);
    others.extend((0..12).map(|number| traffic::vehicle(number, place(number), 0.4 * f64::from(number))));
    let weathers = ["ClearNoon", "HardRainSunset", "WetNight"]
        .map(|name| cosfly_materials::presets::preset(name).expect("a preset"));
    let mut pass = || {
        let before = ALLOCATIONS.with(Cell::get);
        for frame in 0..30 {
            let (sin, cos) = real::sin_cos(0.1 * f64::from(frame));
            let feet = DVec3::new(5.0 + 0.4 * f64::from(frame), -16.0, 0.1);
            let target = BodyFigure {
                state: TargetState { feet_in_world: feet, heading_rad: 0.0, speed_mps: 1.3 },
                height_m: 1.8,
                radius_m: 0.3,
                clothes_seed: Seed([2; 32]),
                gait_phase_rad: 0.4 * f64::from(frame),
                body: BodyShape::default(),
            };
            let setup = FrameSetup {
                pose: Pose::looking_at(feet + DVec3::new(-12.0 * cos, 12.0 * sin, 9.0), feet),
                weather: &weathers[frame as usize % 3],
                target: Some(target),
                others: &others,
            };
            assert_eq!(renderer.render(&scene, &setup).images.width, 320);
        }
        ALLOCATIONS.with(Cell::get) - before
    };
    assert!(pass() > 0, "the first pass grows the buffers");
    assert_eq!(pass(), 0);
}
