//! Prints what the reader makes of a map file, as JSON, for comparison with other software:
//! `dump_lanes FILE [STEP_M] [shoulders]`. Positions are in the map's own origin with y negated (CARLA's frame).

use cosfly_domain::SemanticLabel;
use cosfly_frames::{DVec3, Seed};
use cosfly_maps::formats::opendrive::{OpenDriveOptions, RoadMap};
use cosfly_maps::{MapConfig, read_town};
use cosfly_town::FormatOptions;
use serde_json::{Value, json};
use std::error::Error;

fn main() -> Result<(), Box<dyn Error>> {
    let mut arguments = std::env::args().skip(1);
    let path = arguments.next().ok_or("usage: dump_lanes FILE [STEP_M] [shoulders]")?;
    let step_m: f64 = arguments.next().map_or(Ok(5.0), |text| text.parse())?;
    let shoulders_as_sidewalks = arguments.next().is_some_and(|text| text == "shoulders");
    let bytes = std::fs::read(&path)?;
    let (map, _) = RoadMap::read(&bytes)?;
    let options = OpenDriveOptions { shoulders_as_sidewalks, ..OpenDriveOptions::default() };
    let config = MapConfig { options: FormatOptions::of(&options), ..MapConfig::default() };
    let town = read_town(&bytes, &config, Seed::of_item(0, "dump", "town"));
    let offset_m = map.world.offset_m;
    let point = |point: DVec3| (point + offset_m).to_array();
    let polygons: Vec<Value> = town
        .iter()
        .flat_map(|(town, _)| &town.walkable)
        .map(|polygon| {
            let outline: Vec<_> = polygon.outline_in_world.iter().map(|corner| point(*corner)).collect();
            json!({"kind": format!("{:?}", polygon.kind), "synthetic": polygon.synthetic, "outline": outline})
        })
        .collect();
    let roads: Vec<Value> = town
        .iter()
        .flat_map(|(town, _)| &town.surfaces)
        .filter(|mesh| mesh.label == SemanticLabel::Roads)
        .flat_map(|mesh| {
            mesh.triangles.iter().map(|corners| corners.map(|i| point(mesh.vertices_in_world[i as usize])))
        })
        .map(|triangle| json!(triangle))
        .collect();
    let lanes = lane_samples(&map, step_m, &point);
    let error = town.as_ref().err().map(ToString::to_string);
    println!("{}", json!({"lanes": lanes, "walkable": polygons, "road_triangles": roads, "error": error}));
    Ok(())
}

fn lane_samples(map: &RoadMap, step_m: f64, point: &dyn Fn(DVec3) -> [f64; 3]) -> Vec<Value> {
    let mut out = Vec::new();
    for road in &map.network.roads {
        for section in &road.sections {
            let length_m = section.end_s_m - section.start_s_m;
            let steps = (length_m / step_m).ceil().max(1.0) as usize;
            for lane in section.left.iter().chain(&section.right) {
                for step in 0..steps {
                    let s_m = section.start_s_m + length_m * (step as f64 + 0.5) / steps as f64;
                    let Some(found) = map.lane_point(&road.id, lane.id, s_m) else { continue };
                    out.push(json!({
                        "road": road.id, "lane": lane.id, "s": s_m, "kind": format!("{:?}", lane.kind),
                        "position": point(found.position_in_world), "yaw_deg": found.yaw_rad.to_degrees(), "width": found.width_m,
                        "drift": found.drift,
                    }));
                }
            }
        }
    }
    out
}
