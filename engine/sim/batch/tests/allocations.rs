//! Drawing a batch allocates nothing once buffers have grown, and the memory stays within its bounds.

mod towns;

use cosfly_batch::{BatchRenderer, BatchScene, BatchView, Outputs};
use cosfly_frames::Seed;
use cosfly_render::PictureLook;
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
fn the_second_batch_allocates_nothing() {
    let town = towns::shipped("downtown.xodr");
    let scene = BatchScene::new(&town, Seed([1; 32]));
    assert!(scene.bytes() < 50_000_000, "{} bytes", scene.bytes());
    let places = towns::places(&town, 12, 30);
    let views: Vec<BatchView<'_>> = places
        .iter()
        .map(|place| BatchView {
            scene: &scene,
            pose: place.pose,
            horizontal_fov_rad: 1.4,
            target: Some(place.target),
            others: &place.others,
            weather: None,
            look: PictureLook::Simple,
        })
        .collect();
    let mut renderer = BatchRenderer::new(84, 84);
    let pixels = views.len() * renderer.pixels();
    let (mut depth_m, mut instance, mut rgb) = (vec![0.0f32; pixels], vec![0; pixels], vec![0; 3 * pixels]);
    let mut pass = |look: Option<PictureLook>| {
        let views: Vec<BatchView<'_>> =
            views.iter().map(|view| BatchView { look: look.unwrap_or(view.look), ..*view }).collect();
        let before = ALLOCATIONS.with(Cell::get);
        let outputs = match look {
            Some(_) => Outputs { rgb: Some(&mut rgb), ..Outputs::default() },
            None => Outputs { depth_m: Some(&mut depth_m), instance: Some(&mut instance), ..Outputs::default() },
        };
        renderer.render(&views, outputs);
        ALLOCATIONS.with(Cell::get) - before
    };
    for look in [None, Some(PictureLook::Simple), Some(PictureLook::Full)] {
        assert!(pass(look) > 0, "{look:?}: the first pass grows the buffers");
        assert_eq!(pass(look), 0, "{look:?}");
    }
}
