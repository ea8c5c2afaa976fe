//! Frames of floating-car data of SUMO as a table: `fcd_frames MAP NET FCD DT_S FRAMES CONFIG_JSON`. The last column is the
//! distance from the front of the body to the middle of the town's nearest lane, seen from above.

use cosfly_domain::Town;
use cosfly_frames::{DVec2, Seed, real};
use cosfly_maps::{MapConfig, read_town};
use cosfly_vehicles::fcd::{FcdConfig, NetLocation, Place, read};
use cosfly_world::Clock;
use std::fs::File;
use std::io::{BufReader, Read};

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let [map, net, fcd, dt_s, frames, config] = &arguments[..] else {
        return Err("usage: fcd_frames MAP NET FCD DT_S FRAMES CONFIG_JSON".into());
    };
    let (town, _) = read_town(&std::fs::read(map)?, &MapConfig::default(), Seed([1; 32]))?;
    let config: FcdConfig = serde_json::from_str(config)?;
    let mut head = vec![];
    File::open(net)?.take(65_536).read_to_end(&mut head)?;
    let place = Place::new(&town, &NetLocation::of_net(&head)?, config.geo)?;
    let clock = Clock::new(frames.parse()?, dt_s.parse()?, 0.1);
    let recorded = read(BufReader::new(File::open(fcd)?), &place, &config, clock, Seed([1; 32]))?;
    println!("frame,source,kind,length_m,x,y,heading_rad,speed_mps,from_lane_m");
    for body in recorded.bodies() {
        for (frame, state) in (body.first_frame..).zip(&body.states) {
            let (sin, cos) = real::sin_cos(state.heading_rad);
            let at = state.feet_in_world.truncate();
            let from_lane_m = from_lane_m(&town, at + 0.5 * body.plan.size_m.x * DVec2::new(cos, sin));
            println!(
                "{frame},{},{},{},{:.4},{:.4},{:.6},{:.4},{from_lane_m:.3}",
                body.plan.source,
                body.plan.kind.name(),
                body.plan.size_m.x,
                at.x,
                at.y,
                state.heading_rad,
                state.speed_mps
            );
        }
    }
    Ok(())
}

fn from_lane_m(town: &Town, point: DVec2) -> f64 {
    let sides = town.lanes.iter().flat_map(|lane| lane.middle_in_world.windows(2));
    let away = sides.map(|pair| {
        let (from, along) = (pair[0].truncate(), (pair[1] - pair[0]).truncate());
        let share = ((point - from).dot(along) / along.length_squared().max(1e-12)).clamp(0.0, 1.0);
        point.distance(from + share * along)
    });
    away.fold(f64::INFINITY, f64::min)
}
