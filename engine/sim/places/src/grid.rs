//! The kind `grid`: a downtown on a loose grid of streets.
//!
//! The way: [`streets`] draws the network, [`turns`] the ways through its junctions, [`blocks`] and [`furniture`] put
//! things on the land and the pavements, [`opendrive_text`] writes.

mod blocks;
pub mod config;
mod furniture;
mod opendrive_text;
mod street_space;
pub mod streets;
pub mod turns;

pub use config::GenerateConfig;

use cosfly_frames::Seed;

/// OpenDRIVE 1.6 text of a town; the same config and seed give the same bytes. Values of `config` outside their
/// ranges are moved to the nearest allowed one.
pub fn generate_town(config: &GenerateConfig, seed: u64) -> String {
    let config = config.clamped();
    let town_seed = Seed::of_item(seed, "town", "downtown");
    let network = streets::Network::draw(&config, town_seed);
    let turns = turns::all_turns(&network);
    let space = street_space::StreetSpace::new(&network, &turns);
    let mut things = blocks::build_blocks(&network, &space, &config, town_seed);
    things.extend(furniture::furnish(&network, &config, town_seed));
    let comment = format!(
        "A town made by cosfly (generate_town, seed {seed}); no survey, nobody else's data. Lengths in metres. \
         Objects of type tree: radius is the trunk's; our own userData give the crown: crown_radius, and crown_base, \
         its lower edge above the ground; its top is the object's height."
    );
    opendrive_text::write_opendrive(&network, &turns, &things, &comment)
}
