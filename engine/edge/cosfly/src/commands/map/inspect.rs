//! `cosfly map inspect`: the town that is read from a map file, in figures and as a plan.

use super::{areas, mesh, town};
use crate::arguments::file_ending_in;
use crate::command::{Command, Outcome};
use crate::console::Console;
use crate::exit;
use clap::Parser;
use cosfly_diagnose::{Diagnostic, counted};
use cosfly_experts::map_files::ReadMap;
use cosfly_maps::advice::why_not_compared;
use cosfly_maps::form::form;
use cosfly_town::census::{Census, census};
use serde_json::{Value, json};
use std::fmt::Write;
use std::path::{Path, PathBuf};

/// Show the town that is read from a map file: counts, heights, walkable ground, warnings, and a plan as PNG
#[derive(Debug, Parser)]
#[command(
    name = "inspect",
    after_help = "\
Examples:
  cosfly map inspect monaco.osm.pbf                        figures, and the plan monaco-plan.png
  cosfly map inspect Town01.xodr --set fill.buildings=true --plan out/town01.png
  cosfly map inspect tile.laz --set options.voxel_m=0.5 --json
  cosfly map inspect region.osm.pbf --set 'bounds_m=[-500, -500, 500, 500]'   a part of the town
  cosfly map inspect town.json --area '{ picture = \"mask.png\", min_m = [-60, -40], max_m = [60, 40] }'

`--set` takes the parameters of the stage `map`; see the page \"Recipe\" of the book."
)]
pub struct Arguments {
    /// The map file, of any format that the stage `map` reads
    #[arg(value_name = "FILE")]
    file: PathBuf,
    /// Parameter of the stage `map`, such as fill.trees=true (repeatable)
    #[arg(long = "set", value_name = "PARAMETER=VALUE")]
    parameters: Vec<String>,
    /// Area of people to draw over the plan, a table as in `areas` of the stages `pedestrians` and `traffic` (repeatable)
    #[arg(long = "area", value_name = "TABLE")]
    areas: Vec<String>,
    /// File for the plan [default: <FILE's name>-plan.png in the current folder]
    #[arg(long, value_name = "PNG", value_parser = file_ending_in(&["png"]))]
    plan: Option<PathBuf>,
    /// Print JSON; the plan is drawn where `--plan` is given
    #[arg(long)]
    json: bool,
}

impl Command for Arguments {
    fn run(&self, console: &dyn Console) -> Outcome {
        let map = town::read("map inspect", &self.file, &self.parameters)?;
        let areas = if self.areas.is_empty() { vec![] } else { areas::read("map inspect", &self.file, &self.areas)? };
        let plan = match (&self.plan, self.json) {
            (Some(path), _) => Some(path.clone()),
            (None, true) => None,
            (None, false) => Some(PathBuf::from(format!("{}-plan.png", map.town.name))),
        };
        if let Some(path) = &plan {
            let title = format!("{} ({})", map.town.name, map.format);
            let shade = (!areas.is_empty()).then(|| areas::shade(&areas));
            let picture = cosfly_preview::town_plan(&map.town, &title, shade.as_deref()).png()?;
            cosfly_whole::write_file(path, &picture)
                .map_err(|error| Diagnostic::io(format!("write the plan `{}`", path.display()), &error))?;
        }
        let mut figures = figures(&map);
        if let Some(mesh) = mesh::figures(&self.file, &map, &self.parameters) {
            figures["mesh"] = mesh;
        }
        if !areas.is_empty() {
            figures["areas"] = areas::text(&map.town, &areas)?.into();
        }
        let areas = figures["areas"].as_str().map_or_else(String::new, |areas| format!("\n{areas}\n"));
        let text = || text(&map, &figures, plan.as_deref()) + &areas;
        console.print(&if self.json { format!("{figures:#}\n") } else { text() })?;
        Ok(exit::SUCCESS)
    }
}

/// Figures of the town for programs.
fn figures(map: &ReadMap) -> Value {
    let ReadMap { town, format, warnings, advice } = map;
    let census = census(town);
    let kinds = census.kinds.iter().map(|(kind, it)| {
        let figures = json!({
            "objects": it.objects, "boxes": it.boxes, "synthetic_objects": it.synthetic_objects,
            "height_m": { "least": it.heights_m.least, "median": it.heights_m.median, "most": it.heights_m.most },
        });
        (kind.clone(), figures)
    });
    let walkable = census.walkable.iter().map(|(kind, it)| {
        (
            kind.clone(),
            json!({ "polygons": it.polygons, "area_m2": it.area_m2, "synthetic_area_m2": it.synthetic_area_m2 }),
        )
    });
    let ground = census.ground.iter().map(|(label, it)| {
        ((*label).to_owned(), json!({ "area_m2": it.area_m2, "synthetic_area_m2": it.synthetic_area_m2 }))
    });
    let [things, walkable_ground, all_ground] = shares(&census);
    let report = &town.simplification;
    json!({
        "name": town.name, "format": format,
        "min_m": town.min_in_world.to_array(), "max_m": town.max_in_world.to_array(),
        "offset_m": town.origin.offset_m.to_array(), "geo_reference": town.origin.geo_reference,
        "obstacles": kinds.collect::<serde_json::Map<_, _>>(),
        "walkable": walkable.collect::<serde_json::Map<_, _>>(),
        "ground": ground.collect::<serde_json::Map<_, _>>(),
        "invented_share": { "things": things, "walkable": walkable_ground, "ground": all_ground },
        "planning_boxes": {
            "before": report.input_boxes, "after": report.output_boxes,
            "tolerance_m": report.tolerance_m, "added_volume_share": report.added_volume_share,
            "lost_volume_share": report.lost_volume_share, "cropped": report.cropped,
        },
        "form": form(town).map(|form| json!({
            "built_share": form.built_share, "height_m": form.height_m, "tree_share": form.tree_share,
            "block_m2": form.block_m2, "free_width_m": form.free_width_m,
            "direction_entropy": form.direction_entropy, "sky_share": form.sky_share,
        })),
        "synthetic_notes": town.synthetic.notes, "warnings": warnings, "advice": advice,
    })
}

/// Invented shares of the number of things, of the walkable ground and of all ground.
fn shares(census: &Census) -> [f64; 3] {
    let share = |parts: &mut dyn Iterator<Item = [f64; 2]>| {
        let [invented, all] = parts.fold([0.0, 0.0], |sum, part| [sum[0] + part[0], sum[1] + part[1]]);
        if all > 0.0 { invented / all } else { 0.0 }
    };
    [
        share(&mut census.kinds.values().map(|it| [it.synthetic_objects as f64, it.objects as f64])),
        share(&mut census.walkable.values().map(|it| [it.synthetic_area_m2, it.area_m2])),
        share(&mut census.ground.values().map(|it| [it.synthetic_area_m2, it.area_m2])),
    ]
}

fn text(map: &ReadMap, figures: &Value, plan: Option<&Path>) -> String {
    let town = &map.town;
    let extent_m = town.max_in_world - town.min_in_world;
    let mut text =
        format!("{}, {}: {:.0} x {:.0} m, {:.0} m high\n", town.name, map.format, extent_m.x, extent_m.y, extent_m.z);
    let _ = writeln!(
        text,
        "\n{:<14} {:>8} {:>8}  {:>24}  {:>8}",
        "kind", "objects", "boxes", "height m (median)", "invented"
    );
    let census = census(town);
    for (kind, it) in &census.kinds {
        let heights = &it.heights_m;
        let range = format!("{:.1} to {:.1} ({:.1})", heights.least, heights.most, heights.median);
        let _ =
            writeln!(text, "{kind:<14} {:>8} {:>8}  {range:>24}  {:>8}", it.objects, it.boxes, it.synthetic_objects);
    }
    let _ = writeln!(text, "\n{:<14} {:>8} {:>12}  {:>12}", "walkable", "polygons", "area m2", "invented m2");
    for (kind, it) in &census.walkable {
        let _ = writeln!(text, "{kind:<14} {:>8} {:>12.0}  {:>12.0}", it.polygons, it.area_m2, it.synthetic_area_m2);
    }
    let _ = writeln!(text, "\n{:<14} {:>8} {:>12}  {:>12}", "ground", "", "area m2", "invented m2");
    for (label, it) in &census.ground {
        let _ = writeln!(text, "{label:<14} {:>8} {:>12.0}  {:>12.0}", "", it.area_m2, it.synthetic_area_m2);
    }
    let [things, walkable, ground] = shares(&census).map(|share| (100.0 * share).round());
    let _ = writeln!(
        text,
        "\ninvented: {things} % of the things, {walkable} % of the walkable ground, {ground} % of the ground"
    );
    if figures["mesh"].is_object() {
        let _ = writeln!(text, "\n{}", mesh::text(&figures["mesh"]));
    }
    if figures["form"].is_object() {
        let figure = |name: &str| figures["form"][name].as_f64().unwrap_or_default();
        let _ = writeln!(
            text,
            "\nform: {:.0} % built, {:.1} m high; {:.0} % under trees; blocks of {:.0} m2; {:.0} m free between buildings; \
             street directions {:.2} of 1; {:.0} % of the sky seen from walks",
            100.0 * figure("built_share"),
            figure("height_m"),
            100.0 * figure("tree_share"),
            figure("block_m2"),
            figure("free_width_m"),
            figure("direction_entropy"),
            100.0 * figure("sky_share")
        );
    }
    let report = &town.simplification;
    let _ = writeln!(
        text,
        "\nthe planner sees {} instead of {}: within {} m, {:.1} % of the volume gained, {:.2} % lost",
        counted(report.output_boxes, "box"),
        report.input_boxes,
        report.tolerance_m,
        100.0 * report.added_volume_share,
        100.0 * report.lost_volume_share
    );
    let offset = town.origin.offset_m;
    let _ = writeln!(text, "origin: x_map = x + {}, y_map = -(y + {}), z_map = z + {}", offset.x, offset.y, offset.z);
    if let Some(projection) = figures["geo_reference"].as_str() {
        let _ = writeln!(text, "projection: {}", projection.trim());
        if let Some(why) = why_not_compared(town) {
            let _ = writeln!(text, "            not compared with those of other files: {why}");
        }
    }
    for note in &town.synthetic.notes {
        let _ = writeln!(text, "note: {note}");
    }
    for warning in &map.warnings {
        let _ = writeln!(text, "warning: {warning}");
    }
    for advice in &map.advice {
        let _ = writeln!(text, "advice: {advice}");
    }
    if let Some(path) = plan {
        let _ = writeln!(text, "\nplan: {}", path.display());
    }
    text
}
