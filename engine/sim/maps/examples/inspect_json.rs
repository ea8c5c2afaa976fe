//! Prints a map file's town as JSON, for checks by programs of others: `inspect_json FILE [OPTIONS.json]`.
//!
//! World frame, metres, radians: counts of boxes by kind, boxes, walkable polygons, surfaces (triangles only with
//! `--surfaces` as last argument), origin, notes, warnings. Nothing is filled in.

use cosfly_domain::Town;
use cosfly_frames::Seed;
use cosfly_maps::{MapConfig, read_town, recognise};
use cosfly_town::FormatOptions;
use serde_json::{Map, Value, json};
use std::collections::BTreeMap;
use std::error::Error;

fn main() -> Result<(), Box<dyn Error>> {
    let mut arguments: Vec<String> = std::env::args().skip(1).collect();
    let with_surfaces = arguments.pop_if(|last| last == "--surfaces").is_some();
    let file = arguments.first().ok_or("usage: inspect_json FILE [OPTIONS.json] [--surfaces]")?;
    let bytes = std::fs::read(file)?;
    let options: Map<String, Value> = match arguments.get(1) {
        Some(path) => serde_json::from_slice(&std::fs::read(path)?)?,
        None => Map::new(),
    };
    let config = MapConfig { options: FormatOptions::from(options), ..MapConfig::default() };
    let (town, warnings) = read_town(&bytes, &config, Seed::of_item(1, "town", "town"))?;
    println!("{}", report(recognise(&bytes)?.name(), &town, &warnings, with_surfaces));
    Ok(())
}

fn report(format: &str, town: &Town, warnings: &[String], with_surfaces: bool) -> Value {
    let mut counts: BTreeMap<String, usize> = BTreeMap::new();
    for obstacle in &town.obstacles {
        *counts.entry(format!("{:?}", obstacle.kind)).or_default() += 1;
    }
    let boxes = town.obstacles.iter().map(|one| {
        json!({
            "kind": format!("{:?}", one.kind), "object": one.object_id, "synthetic": one.synthetic,
            "center_m": one.shape.center_in_world.to_array(),
            "half_m": one.shape.half_extents_m.to_array(), "yaw_rad": one.shape.yaw_rad,
        })
    });
    let walkable = town.walkable.iter().map(|one| {
        let outline: Vec<[f64; 3]> = one.outline_in_world.iter().map(|corner| corner.to_array()).collect();
        json!({ "kind": format!("{:?}", one.kind), "synthetic": one.synthetic, "outline_m": outline })
    });
    let surfaces = town.surfaces.iter().map(|one| {
        let mut surface = json!({
            "label": format!("{:?}", one.label), "synthetic": one.synthetic,
            "vertex_count": one.vertices_in_world.len(), "triangle_count": one.triangles.len(),
        });
        if with_surfaces {
            let vertices: Vec<[f64; 3]> = one.vertices_in_world.iter().map(|vertex| vertex.to_array()).collect();
            surface["vertices_m"] = json!(vertices);
            surface["triangles"] = json!(one.triangles);
        }
        surface
    });
    json!({
        "format": format,
        "offset_m": town.origin.offset_m.to_array(),
        "geo_reference": town.origin.geo_reference,
        "min_m": town.min_in_world.to_array(),
        "max_m": town.max_in_world.to_array(),
        "counts": counts,
        "planning_boxes": town.planning_boxes.len(),
        "boxes": boxes.collect::<Vec<_>>(),
        "walkable": walkable.collect::<Vec<_>>(),
        "surfaces": surfaces.collect::<Vec<_>>(),
        "notes": town.synthetic.notes,
        "warnings": warnings,
    })
}
