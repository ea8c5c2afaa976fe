//! A small invented crowd for tests and pictures.

use cosfly_figures::{BodyFigure, BodyShape, FigureInPicture};
use cosfly_frames::{DVec3, Seed, TargetState};

/// People who walk and stand within 30 m of a place, on its height.
pub fn crowd(around: DVec3, count: u32) -> Vec<FigureInPicture> {
    let mut random = Seed([6; 32]).stream("crowd");
    let mut person = |number: u32| {
        let away = DVec3::new(random.uniform(-30.0, 30.0), random.uniform(-30.0, 30.0), 0.0);
        let speed_mps = if random.chance(0.2) { 0.0 } else { random.uniform(0.8, 1.8) };
        let heading_rad = random.uniform(-3.1, 3.1);
        let figure = BodyFigure {
            state: TargetState { feet_in_world: around + away, heading_rad, speed_mps },
            height_m: random.uniform(1.5, 1.95),
            radius_m: random.uniform(0.24, 0.34),
            clothes_seed: Seed([6; 32]).child("clothes", u64::from(number)),
            gait_phase_rad: random.uniform(-3.1, 3.1),
            body: BodyShape::default(),
        };
        FigureInPicture { figure, instance: 50_000 + number }
    };
    (0..count).map(&mut person).collect()
}
