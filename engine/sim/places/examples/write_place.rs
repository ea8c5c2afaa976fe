//! Prints a place with its usual numbers: `write_place KIND [SEED]`, default seed 1.

use cosfly_places::kinds::ALL;
use std::collections::BTreeMap;

fn main() -> Result<(), String> {
    let mut arguments = std::env::args().skip(1);
    let name = arguments.next().unwrap_or_default();
    let seed = arguments.next().and_then(|text| text.parse().ok()).unwrap_or(1);
    let kind = ALL.iter().find(|kind| kind.name == name).ok_or("usage: write_place KIND [SEED]")?;
    let settings = kind.settings(&BTreeMap::new()).map_err(|refused| refused.message)?;
    print!("{}", kind.open_drive(&settings, seed));
    Ok(())
}
