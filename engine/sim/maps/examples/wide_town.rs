//! Prints a made-up region of villages and a tower of 540 m: `wide_town osm|cityjson [VILLAGES]`, default 90, which are 9,001
//! buildings over 9 x 20 km.

#[path = "../tests/wide_town/mod.rs"]
mod wide_town;

use wide_town::WideTown;

fn main() -> Result<(), String> {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let villages = arguments.get(1).and_then(|text| text.parse().ok()).unwrap_or(90);
    let region = WideTown::new(villages);
    match arguments.first().map(String::as_str) {
        Some("osm") => print!("{}", region.osm()),
        Some("cityjson") => print!("{}", region.city_json()),
        _ => return Err("usage: wide_town osm|cityjson [VILLAGES]".into()),
    }
    Ok(())
}
