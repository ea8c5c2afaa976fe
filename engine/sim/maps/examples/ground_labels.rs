//! Writes the labels of the ground as it is seen from above to standard output, one byte per cell, row by row, for comparison
//! with rasters of other software: `ground_labels FILE LOW_X LOW_Y COLUMNS ROWS CELL_M`. Metres in the map's own origin with y
//! negated (CARLA's frame); 0 where there is no ground.

use cosfly_frames::{DVec3, Seed};
use cosfly_maps::formats::opendrive::OpenDriveOptions;
use cosfly_maps::{MapConfig, read_town};
use cosfly_town::{FormatOptions, GroundIndex};
use std::error::Error;
use std::io::Write;

fn main() -> Result<(), Box<dyn Error>> {
    let mut arguments = std::env::args().skip(1);
    let path = arguments.next().ok_or("usage: ground_labels FILE LOW_X LOW_Y COLUMNS ROWS CELL_M")?;
    let numbers: Vec<f64> = arguments.map(|text| text.parse()).collect::<Result<_, _>>()?;
    let [low_x, low_y, columns, rows, cell_m] = numbers[..] else { return Err("five numbers".into()) };
    // Towns without pavements need ground to walk on.
    let options = OpenDriveOptions { shoulders_as_sidewalks: true, ..OpenDriveOptions::default() };
    let config = MapConfig { options: FormatOptions::of(&options), ..MapConfig::default() };
    let (town, _) = read_town(&std::fs::read(&path)?, &config, Seed::of_item(0, "dump", "town"))?;
    let ground = GroundIndex::new(&town);
    let label = |row: usize, column: usize| {
        let at = DVec3::new(low_x + cell_m * (column as f64 + 0.5), low_y + cell_m * (row as f64 + 0.5), 0.0);
        let at = (at - town.origin.offset_m).with_z(town.max_in_world.z + 1.0);
        ground.ground_below(at, 0.0).map_or(0, |found| found.label.id())
    };
    let mut output = std::io::stdout().lock();
    for row in 0..rows as usize {
        let labels: Vec<u8> = (0..columns as usize).map(|column| label(row, column)).collect();
        output.write_all(&labels)?;
    }
    Ok(())
}
