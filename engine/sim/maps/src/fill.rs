//! Seeded buildings, street trees and lamps for towns whose files have none.
//!
//! [`land`] knows what ground is taken, [`frontage`] where streets border open land, [`buildings`] and [`greenery`]
//! use both. Everything stands off roads, pavements, crossings and what the file has.

pub mod buildings;
pub mod config;
pub mod frontage;
pub mod greenery;
pub mod land;
pub mod site;

pub use config::FillConfig;

use cosfly_domain::Town;
use cosfly_frames::Seed;

/// Adds to `town` what `config` asks for, flags it in `town.synthetic`, and gives warnings for the user. Reads the
/// town's walkable polygons, surfaces and obstacles; leaves `planning_boxes` to be computed afterwards.
pub fn fill(town: &mut Town, config: &FillConfig, seed: Seed) -> Vec<String> {
    if !config.is_on() {
        return Vec::new();
    }
    let mut land = land::Land::of_town(town);
    let fronts = frontage::pavement_fronts(town, &land);
    let road_fronts = frontage::road_fronts(town, &land);
    let mut site = site::FillSite::new(town);
    let mut counts = [0; 3];
    // Greenery first: it takes little, and buildings stand back from it.
    if config.lamps {
        counts[2] = greenery::put_up_lamps(&mut site, &mut land, &fronts, config);
    }
    if config.trees {
        counts[1] = greenery::plant_trees(&mut site, &mut land, &fronts, config, seed);
    }
    if config.buildings {
        for (fronts, purpose) in [(&fronts, "fill pavements"), (&road_fronts, "fill roads")] {
            counts[0] += buildings::put_up_buildings(&mut site, &mut land, fronts, config, seed.stream(purpose));
        }
    }
    let warnings = note_what_was_made(site.town, config, seed, counts);
    if land.is_coarse() {
        site.town
            .synthetic
            .notes
            .push(format!("open land for `fill` is looked for in cells of {:.2} m: the town is wide", land.cell_m()));
    }
    warnings
}

fn note_what_was_made(town: &mut Town, config: &FillConfig, seed: Seed, counts: [usize; 3]) -> Vec<String> {
    let asked = [config.buildings, config.trees, config.lamps];
    let names = ["buildings", "trees", "lamps"];
    town.synthetic.buildings |= counts[0] > 0;
    town.synthetic.trees |= counts[1] > 0;
    town.synthetic.furniture |= counts[2] > 0;
    let mut warnings = Vec::new();
    for ((name, is_asked), count) in names.into_iter().zip(asked).zip(counts) {
        if is_asked && count > 0 {
            town.synthetic.notes.push(format!(
                "{count} {name} are invented (`fill.{name} = true`, item seed {:016x}); the map file has none of them",
                seed.as_u64()
            ));
        } else if is_asked {
            warnings
                .push(format!("`fill.{name}` is on, but no open land beside a pavement was found to put {name} on"));
        }
    }
    warnings
}

#[cfg(test)]
mod tests;
