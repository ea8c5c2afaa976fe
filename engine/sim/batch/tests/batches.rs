//! Bytes of batches do not depend on batch, order, number of threads or vector instructions.

mod towns;

use cosfly_batch::{BatchRenderer, BatchScene, BatchView, Outputs};
use cosfly_frames::Seed;
use cosfly_frames::simd::Level;
use cosfly_render::PictureLook;
use towns::Place;

const SIZE: u32 = 84;
const PIXELS: usize = (SIZE * SIZE) as usize;

#[derive(Clone, PartialEq)]
struct Pictures {
    depth_m: Vec<u32>,
    semantic: Vec<u8>,
    instance: Vec<u32>,
    target_mask: Vec<u8>,
    rgb: Vec<u8>,
}

fn view<'a>(scene: &'a BatchScene, place: &'a Place) -> BatchView<'a> {
    BatchView {
        scene,
        pose: place.pose,
        horizontal_fov_rad: 1.4,
        target: Some(place.target),
        others: &place.others,
        weather: None,
        look: PictureLook::Simple,
    }
}

fn draw(renderer: &mut BatchRenderer, views: &[BatchView<'_>]) -> Pictures {
    let mut depth_m = vec![-1.0f32; views.len() * PIXELS];
    let mut semantic = vec![99; views.len() * PIXELS];
    let mut instance = vec![99; views.len() * PIXELS];
    let mut target_mask = vec![99; views.len() * PIXELS];
    let mut rgb = vec![99; 3 * views.len() * PIXELS];
    let outputs = Outputs {
        depth_m: Some(&mut depth_m),
        semantic: Some(&mut semantic),
        instance: Some(&mut instance),
        target_mask: Some(&mut target_mask),
        rgb: Some(&mut rgb),
        ..Outputs::default()
    };
    renderer.render(views, outputs);
    Pictures { depth_m: depth_m.into_iter().map(f32::to_bits).collect(), semantic, instance, target_mask, rgb }
}

/// One picture of a batch.
fn picture(all: &Pictures, number: usize) -> Pictures {
    let range = number * PIXELS..(number + 1) * PIXELS;
    Pictures {
        depth_m: all.depth_m[range.clone()].to_vec(),
        semantic: all.semantic[range.clone()].to_vec(),
        instance: all.instance[range.clone()].to_vec(),
        target_mask: all.target_mask[range.clone()].to_vec(),
        rgb: all.rgb[3 * range.start..3 * range.end].to_vec(),
    }
}

#[test]
fn a_picture_depends_on_its_view_only() {
    let town = towns::shipped("downtown.xodr");
    let scene = BatchScene::new(&town, Seed([1; 32]));
    let places = towns::places(&town, 64, 12);
    let views: Vec<BatchView<'_>> = places.iter().map(|place| view(&scene, place)).collect();
    let all = draw(&mut BatchRenderer::new(SIZE, SIZE), &views);
    // Alone, by a renderer that draws nothing else.
    for number in [0, 1, 31, 63] {
        let alone = draw(&mut BatchRenderer::new(SIZE, SIZE), &views[number..number + 1]);
        assert!(alone == picture(&all, number), "picture {number}");
    }
    // On threads, twice by the same renderer.
    for threads in [2, 3] {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("threads");
        let mut renderer = BatchRenderer::on_threads(SIZE, SIZE, threads);
        for _ in 0..2 {
            assert!(pool.install(|| draw(&mut renderer, &views)) == all, "{threads} threads");
        }
    }
    // In another order.
    let order: Vec<usize> = (0..views.len()).map(|k| (k * 37 + 5) % views.len()).collect();
    let shuffled: Vec<BatchView<'_>> = order.iter().map(|number| views[*number]).collect();
    let shuffled = draw(&mut BatchRenderer::new(SIZE, SIZE), &shuffled);
    for (place, number) in order.iter().enumerate() {
        assert!(picture(&shuffled, place) == picture(&all, *number), "picture {number}");
    }
    // With every set of vector instructions.
    for level in Level::available() {
        let mut renderer = BatchRenderer::new(SIZE, SIZE);
        renderer.set_level(level);
        assert!(draw(&mut renderer, &views[..8]) == draw(&mut BatchRenderer::new(SIZE, SIZE), &views[..8]));
    }
}

#[test]
fn channels_that_nobody_asks_for_change_nothing() {
    let town = towns::shipped("uptown.xodr");
    let scene = BatchScene::new(&town, Seed([1; 32]));
    let places = towns::places(&town, 3, 5);
    let views: Vec<BatchView<'_>> = places.iter().map(|place| view(&scene, place)).collect();
    let mut renderer = BatchRenderer::new(SIZE, SIZE);
    let all = draw(&mut renderer, &views);
    let mut mask = vec![7; 3 * PIXELS];
    renderer.render(&views, Outputs { target_mask: Some(&mut mask), ..Outputs::default() });
    assert!(mask == all.target_mask && mask.contains(&1));
    let mut rgb = vec![7; 9 * PIXELS];
    renderer.render(&views, Outputs { rgb: Some(&mut rgb), ..Outputs::default() });
    assert!(rgb == all.rgb);
    renderer.render(&views, Outputs::default());
    renderer.render(&[], Outputs::default());
}

#[test]
#[should_panic(expected = "the buffer `semantic` has 5 elements")]
fn a_buffer_of_another_size_is_refused_by_name() {
    let town = towns::shipped("uptown.xodr");
    let scene = BatchScene::new(&town, Seed([1; 32]));
    let places = towns::places(&town, 1, 0);
    let mut semantic = [0; 5];
    let outputs = Outputs { semantic: Some(&mut semantic), ..Outputs::default() };
    BatchRenderer::new(SIZE, SIZE).render(&[view(&scene, &places[0])], outputs);
}
