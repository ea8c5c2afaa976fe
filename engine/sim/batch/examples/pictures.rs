//! Time of pictures of a batch by what they show: `pictures PIXELS none|depth|simple|full ROUNDS nothing|boxes|ground|people`.
//! Made for profilers, which see little else than drawing in it when the rounds are many. `none` makes no channels. The last
//! word ends the drawing after a stage: what the next one adds is what it costs, as stages change nothing of those before.

#[path = "../tests/towns/mod.rs"]
mod towns;

use cosfly_batch::{BatchRenderer, BatchScene, BatchView, Outputs};
use cosfly_frames::Seed;
use cosfly_render::PictureLook;
use std::time::Instant;

/// Places of the town, and people around each.
const PLACES: usize = 40;
const PEOPLE: u32 = 50;

fn main() {
    let words: Vec<String> = std::env::args().skip(1).collect();
    let number = |at: usize, otherwise: u32| words.get(at).map_or(otherwise, |word| word.parse().expect("a number"));
    let (side, rounds) = (number(0, 84), number(2, 50));
    let content = words.get(1).map_or("depth", String::as_str);
    let last = words.get(3).map_or("people", String::as_str);
    let mut town = towns::shipped("downtown.xodr");
    let mut places = towns::places(&town, PLACES, PEOPLE);
    if last != "people" {
        places.iter_mut().for_each(|place| place.others.clear());
    }
    match last {
        "nothing" => (town.obstacles, town.surfaces) = (vec![], vec![]),
        "boxes" => town.surfaces.clear(),
        _ => {}
    }
    let scene = if matches!(content, "none" | "depth") {
        BatchScene::without_colours(&town, &cosfly_town::GroundIndex::new(&town))
    } else {
        BatchScene::new(&town, Seed([1; 32]))
    };
    let look = if content == "full" { PictureLook::Full } else { PictureLook::Simple };
    let views: Vec<BatchView<'_>> = places
        .iter()
        .map(|place| BatchView {
            scene: &scene,
            pose: place.pose,
            horizontal_fov_rad: core::f64::consts::FRAC_PI_2,
            target: Some(place.target).filter(|_| last == "people"),
            others: &place.others,
            weather: None,
            look,
        })
        .collect();
    let mut renderer = BatchRenderer::new(side, side);
    let pixels = PLACES * renderer.pixels();
    let (mut depth_m, mut semantic, mut instance) = (vec![0.0f32; pixels], vec![0u8; pixels], vec![0u32; pixels]);
    let mut rgb = vec![0u8; 3 * pixels];
    let mut fastest_s = f64::INFINITY;
    for _ in 0..rounds {
        let began = Instant::now();
        let outputs = if content == "none" {
            Outputs::default()
        } else if content == "depth" {
            Outputs {
                depth_m: Some(&mut depth_m),
                semantic: Some(&mut semantic),
                instance: Some(&mut instance),
                ..Outputs::default()
            }
        } else {
            Outputs { rgb: Some(&mut rgb), ..Outputs::default() }
        };
        renderer.render(&views, outputs);
        fastest_s = fastest_s.min(began.elapsed().as_secs_f64());
    }
    let sum = depth_m
        .iter()
        .map(|depth| depth.to_bits())
        .chain(instance.iter().copied())
        .chain(semantic.iter().chain(&rgb).map(|byte| u32::from(*byte)));
    println!("sum of bytes: {:016x}", sum.fold(0u64, |sum, bits| sum.wrapping_mul(0x100_0000_01b3) ^ u64::from(bits)));
    println!("{content} at {side} pixels: {:.3} ms a picture", 1e3 * fastest_s / PLACES as f64);
}
