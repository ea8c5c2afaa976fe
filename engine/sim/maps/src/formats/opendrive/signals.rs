//! `<signal>`s as solid things: a plate or a light, and the pole that carries it.

use super::network::{Road, RoadSignal};
use super::objects::ObstacleBuilder;
use super::parse_objects::LARGEST_PLATE_M;
use cosfly_domain::ObstacleKind;
use cosfly_frames::{DVec2, DVec3};
use cosfly_town::world::WorldFromMap;

/// A pole of the file this close to a signal carries it, metres.
const OWN_POLE_M: f64 = 0.8;
/// Plates lower than this are paint on the road, metres.
const PAINT_M: f64 = 0.05;
/// Lower end of plates and lights whose file puts them at their pole's foot, metres.
const USUAL_LOWER_END_M: f64 = 2.3;

/// Adds the signals of a road; call after all objects. Returns how many hang at an assumed height.
pub(super) fn add_signals(builder: &mut ObstacleBuilder, road: &Road, poles: &[DVec2], world: &WorldFromMap) -> usize {
    let mut assumed = 0;
    for signal in &road.signals {
        if signal.height_m > 0.0 && signal.height_m < PAINT_M {
            continue;
        }
        let is_assumed = signal.at.z_offset_m < 1.0;
        let lower_end_m = if is_assumed { USUAL_LOWER_END_M } else { signal.at.z_offset_m };
        assumed += usize::from(is_assumed);
        add_signal(builder, road, signal, lower_end_m, poles, world);
    }
    assumed
}

fn add_signal(
    builder: &mut ObstacleBuilder,
    road: &Road,
    signal: &RoadSignal,
    lower_end_m: f64,
    poles: &[DVec2],
    world: &WorldFromMap,
) {
    let (kind, usual_m, thickness_m) = if signal.is_light {
        (ObstacleKind::TrafficLight, [0.35, 1.0], 0.3)
    } else {
        (ObstacleKind::TrafficSign, [0.6, 0.6], 0.05)
    };
    let or_usual = |given_m: f64, usual_m: f64| if given_m > 0.0 { given_m.min(LARGEST_PLATE_M) } else { usual_m };
    let (width_m, height_m) = (or_usual(signal.width_m, usual_m[0]), or_usual(signal.height_m, usual_m[1]));
    let foot = road.point(signal.at.s_m, signal.at.t_m, 0.0);
    let heading_rad = road.plan_point(signal.at.s_m).heading_rad + signal.heading_rad;
    builder.begin_object();
    let half = 0.5 * DVec2::new(thickness_m, width_m);
    builder.push_upright(kind, foot + lower_end_m * DVec3::Z, half, heading_rad, height_m, world);
    let in_world = world.point(foot).truncate();
    if !poles.iter().any(|pole| pole.distance(in_world) < OWN_POLE_M) {
        builder.push_upright(ObstacleKind::Pole, foot, DVec2::splat(0.05), heading_rad, lower_end_m, world);
    }
}
