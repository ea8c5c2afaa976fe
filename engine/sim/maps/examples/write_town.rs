//! Prints a generated town: `write_town [SEED]`, default seed 1.

use cosfly_places::grid::{GenerateConfig, generate_town};

fn main() {
    let seed = std::env::args().nth(1).and_then(|text| text.parse().ok()).unwrap_or(1);
    print!("{}", generate_town(&GenerateConfig::default(), seed));
}
