//! Bodies below drawn ground: what pictures show of the ground around feet, against the feet of the tables.

use super::body::PlacedBody;
use super::rows::{PlacedFlight, PlacedFrame};
use cosfly_domain::TARGET_INSTANCE;
use cosfly_frames::DVec3;
use cosfly_metrics::drawn_ground::{BELOW_GROUND_M, DrawnGround, is_below};
use std::collections::BTreeMap;

/// Bodies of one flight by their ids in instance images.
#[derive(Default)]
pub struct BodiesOnGround {
    bodies: BTreeMap<u32, Rises>,
}

/// Rises of the ground around the feet of one body, as the frames show it.
#[derive(Default)]
struct Rises {
    seen: usize,
    below: usize,
    first_below: u32,
    most_m: f64,
}

impl BodiesOnGround {
    /// Takes depths and labels of a frame: bytes of a 32-bit number and a byte a pixel.
    pub fn add(
        &mut self,
        flight: &PlacedFlight,
        row: &PlacedFrame,
        others: &[PlacedBody],
        [depths, labels]: [&[u8]; 2],
    ) {
        // Lenses that bend and rows that are taken one after the other show places elsewhere.
        if !flight.lens.is_none() || flight.readout_s > 0.0 {
            return;
        }
        let depths = depths.as_chunks::<4>().0;
        let ground = DrawnGround {
            camera: &flight.camera,
            pose: &row.camera_pose,
            depth_m: &|at| depths.get(at).map(|depth| f64::from(f32::from_le_bytes(*depth))),
            label: &|at| labels.get(at).copied(),
        };
        let mut add = |instance, feet: DVec3, height_m| {
            let Some(rise_m) = ground.rise_m(feet, height_m) else { return };
            let rises = self.bodies.entry(instance).or_default();
            rises.seen += 1;
            if rise_m > BELOW_GROUND_M {
                if rises.below == 0 {
                    rises.first_below = row.frame;
                }
                rises.below += 1;
                rises.most_m = rises.most_m.max(rise_m);
            }
        };
        add(TARGET_INSTANCE, row.target.feet_in_world, flight.target_height_m);
        for body in others.iter().filter(|body| body.pixels > 0) {
            if let Some(instance) = body.instance {
                add(instance, body.space.feet, body.space.height_m);
            }
        }
    }

    /// Place and problem of each body that stands below drawn ground.
    pub fn problems(&self) -> impl Iterator<Item = (String, String)> {
        let below = self.bodies.iter().filter(|(_, rises)| is_below(rises.below, rises.seen));
        below.map(|(instance, Rises { seen, below, first_below, most_m })| {
            let who = if *instance == TARGET_INSTANCE { "the target".to_owned() } else { format!("body {instance}") };
            let message = format!(
                "{who} stands below drawn ground in {below} of {seen} frames that show the ground at its feet, by up to {most_m:.2} m"
            );
            (format!("frame {first_below}"), message)
        })
    }
}
