//! Walls and roofs leave work out where sixteen pixels have no need of it: the look of a pixel must not follow from the pixels
//! beside it, on any processor.

use cosfly_frames::Seed;
use cosfly_frames::simd::Level;
use cosfly_materials::building_form::BuildingForm;
use cosfly_materials::facade::{BoxFace, Facade, Roof, facade, roofs};
use cosfly_materials::lanes::{Block, FOUR, Shared, WIDE, get, set};
use cosfly_materials::light::Light;
use cosfly_materials::pattern::noise_texture;
use cosfly_materials::vector::Vec3;

/// A face that is seen with pixels of one size.
#[derive(Clone, Copy)]
struct Face {
    normal: Vec3,
    size_m: f32,
}

/// Albedo, light of its own, share of a mirror, share of sunlight.
type Answer = (Vec3, Vec3, f32, f32);

impl Face {
    /// Answers of a kernel for sixteen places.
    fn looks(self, places: [Vec3; WIDE], kernel: impl Fn(&[Shared], &mut [Block])) -> [Answer; WIDE] {
        let (mut shared, mut four) = (Shared::EMPTY, [const { Block::EMPTY }; FOUR]);
        for (k, place) in places.into_iter().enumerate() {
            set(&mut shared.middle, k, place);
            set(&mut shared.normal, k, self.normal);
            set(&mut shared.ray, k, Vec3::new(0.3, 0.8, -0.5));
        }
        (shared.along_m, shared.up_m) = ([self.size_m; WIDE], [1.3 * self.size_m; WIDE]);
        shared.footprint_m = [1.1 * self.size_m; WIDE];
        for block in &mut four {
            (block.world, block.normal, block.sunlight) = (shared.middle, shared.normal, [1.0; WIDE]);
        }
        kernel(&[shared], &mut four);
        let block = &four[2];
        core::array::from_fn(|k| (get(&block.albedo, k), get(&block.emission, k), block.mirror[k], block.sunlight[k]))
    }

    /// Compares sixteen places together with each of them alone.
    fn check(self, places: [Vec3; WIDE], kernel: impl Fn(Level, &[Shared], &mut [Block])) {
        for level in Level::available() {
            let kernel = |shared: &[Shared], blocks: &mut [Block]| kernel(level, shared, blocks);
            let together = self.looks(places, kernel);
            for (k, place) in places.into_iter().enumerate() {
                let alone = self.looks([place; WIDE], kernel);
                assert_eq!(together[k], alone[k], "{}, {place:?}, pixels of {} m", level.name(), self.size_m);
            }
        }
    }
}

#[test]
fn looks_of_walls_and_roofs_do_not_follow_from_the_pixels_beside() {
    let noise = noise_texture(3);
    let mut random = Seed([4; 32]).stream("places");
    for seed in 0..60u32 {
        let preset = if seed % 2 == 0 { "ClearNoon" } else { "ClearNight" };
        let light = Light::new(&cosfly_materials::presets::preset(preset).unwrap());
        let size_m = random.uniform(0.01, 0.4) as f32;
        let [width_m, height_m] = [random.uniform(6.0, 40.0), random.uniform(3.0, 50.0)].map(|length| length as f32);
        // A wall that looks along y, and a roof above it.
        let wall =
            Facade::new(seed.wrapping_mul(0x9e37_79b1), 7, 0, [width_m, height_m], (BuildingForm::Block, height_m));
        let place = BoxFace { along: Vec3::new(1.0, 0.0, 0.0), edge_m: 0.0, foot_m: 0.0 };
        let places =
            core::array::from_fn(|_| Vec3::new(width_m * random.unit() as f32, 0.0, height_m * random.unit() as f32));
        let face = Face { normal: Vec3::new(0.0, -1.0, 0.0), size_m };
        face.check(places, |level, shared, blocks| facade(level, shared, blocks, &wall, &place, &light, &noise));
        let axes = [Vec3::new(1.0, 0.0, 0.0), Vec3::new(0.0, 1.0, 0.0)];
        let middle = Vec3::new(0.5 * width_m, 8.0, height_m);
        let roof = Roof::new(seed, middle, axes, [0.5 * width_m, 8.0], [false, seed % 3 == 0, false, false]);
        let places =
            core::array::from_fn(|_| Vec3::new(width_m * random.unit() as f32, 16.0 * random.unit() as f32, height_m));
        let face = Face { normal: Vec3::new(0.0, 0.0, 1.0), size_m };
        face.check(places, |level, shared, blocks| roofs(level, shared, blocks, &roof, &light, &noise));
    }
}
