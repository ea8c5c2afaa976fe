//! What examinations need beside the flights: steps and limits that are told, vehicles, and whether files can be read at all.

use super::columns;
use super::flights::{PublishedDataset, table_files};
use crate::verify;
use cosfly_diagnose::Result;
use cosfly_frames::DVec3;
use std::collections::BTreeMap;
use std::fs::File;
use std::io::BufReader;
use std::path::Path;

/// What the tables tell of a flight beside its poses.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct FlightFacts {
    /// Limits of clearance (m), speed (m/s), acceleration (m/s^2) and jerk (m/s^3), where it has them.
    pub limits: [Option<f64>; 4],
    /// Time from the top row to the bottom row of its images, seconds.
    pub readout_s: f64,
    /// Time and action of each frame: dx, dy, dz, dpitch, dyaw, droll along the world's axes, metres and degrees.
    pub steps: Vec<(f64, Option<[f64; 6]>)>,
}

/// Middle, half lengths and yaw (radians) of a box.
pub type BoxInWorld = (DVec3, DVec3, f64);

impl PublishedDataset {
    /// Limits and steps of all flights, by trajectory id.
    ///
    /// # Errors
    /// What is wrong with the tables.
    pub fn facts(&self) -> Result<BTreeMap<String, FlightFacts>> {
        const LIMITS: [&str; 4] =
            ["limit_clearance_m", "limit_speed_mps", "limit_acceleration_mps2", "limit_jerk_mps3"];
        const READOUT: &str = "camera_readout_s";
        let mut facts: BTreeMap<String, FlightFacts> = BTreeMap::new();
        for (_, path) in table_files(&self.folder().join("data/trajectories"))? {
            columns::read(
                &path,
                &|name| ["trajectory_id", READOUT].contains(&name) || LIMITS.contains(&name),
                &mut |rows| {
                    for row in 0..rows.len() {
                        let limits = LIMITS.map(|name| rows.numbers(name, row).and_then(|it| it.first().copied()));
                        let flight = facts.entry(rows.text_at("trajectory_id", row)?.to_owned()).or_default();
                        flight.limits = limits;
                        flight.readout_s = rows.real_or(READOUT, row, 0.0)?;
                    }
                    Ok(())
                },
            )?;
        }
        for (_, path) in table_files(&self.folder().join("data/frames"))? {
            columns::read(
                &path,
                &|name| ["trajectory_id", "time_s", "action_in_world"].contains(&name),
                &mut |rows| {
                    for row in 0..rows.len() {
                        let action = rows.numbers("action_in_world", row).and_then(|it| it.try_into().ok());
                        let flight = facts.entry(rows.text_at("trajectory_id", row)?.to_owned()).or_default();
                        flight.steps.push((rows.real("time_s", row)?, action));
                    }
                    Ok(())
                },
            )?;
        }
        Ok(facts)
    }

    /// The cars among the obstacles, by town.
    ///
    /// # Errors
    /// What is wrong with the table.
    pub fn vehicles(&self) -> Result<BTreeMap<String, Vec<BoxInWorld>>> {
        const COLUMNS: [&str; 5] = ["town", "kind", "center_in_world_m", "size_m", "yaw_deg"];
        let mut vehicles: BTreeMap<String, Vec<BoxInWorld>> = BTreeMap::new();
        let folder = self.folder().join("data/objects");
        for (_, path) in if folder.is_dir() { table_files(&folder)? } else { vec![] } {
            columns::read(&path, &|name| COLUMNS.contains(&name), &mut |rows| {
                for row in (0..rows.len()).filter(|row| rows.text_at("kind", *row).is_ok_and(|kind| kind == "car")) {
                    let shape = (
                        DVec3::from_array(rows.vector("center_in_world_m", row)?),
                        0.5 * DVec3::from_array(rows.vector("size_m", row)?),
                        rows.real("yaw_deg", row)?.to_radians(),
                    );
                    vehicles.entry(rows.text_at("town", row)?.to_owned()).or_default().push(shape);
                }
                Ok(())
            })?;
        }
        Ok(vehicles)
    }
}

impl PublishedDataset {
    /// Boxes of buildings and walls by their instance ids, by town.
    ///
    /// # Errors
    /// What is wrong with the table.
    pub fn walls(&self) -> Result<BTreeMap<String, BTreeMap<u32, Vec<BoxInWorld>>>> {
        const COLUMNS: [&str; 6] = ["town", "instance", "kind", "center_in_world_m", "size_m", "yaw_deg"];
        let mut walls: BTreeMap<String, BTreeMap<u32, Vec<BoxInWorld>>> = BTreeMap::new();
        let folder = self.folder().join("data/objects");
        for (_, path) in if folder.is_dir() { table_files(&folder)? } else { vec![] } {
            columns::read(&path, &|name| COLUMNS.contains(&name), &mut |rows| {
                for row in 0..rows.len() {
                    if !["building", "wall"].contains(&rows.text_at("kind", row)?) {
                        continue;
                    }
                    let shape = (
                        DVec3::from_array(rows.vector("center_in_world_m", row)?),
                        0.5 * DVec3::from_array(rows.vector("size_m", row)?),
                        rows.real("yaw_deg", row)?.to_radians(),
                    );
                    let of_town = walls.entry(rows.text_at("town", row)?.to_owned()).or_default();
                    of_town.entry(rows.count("instance", row)?).or_default().push(shape);
                }
                Ok(())
            })?;
        }
        Ok(walls)
    }
}

/// Why a Parquet file cannot be read to its end, if so.
pub fn parquet_problem(path: &Path) -> Option<String> {
    let outcome = columns::read(path, &|_| true, &mut |_| Ok(()));
    outcome.err().map(|refusal| [vec![refusal.message], refusal.causes].concat().join(": "))
}

/// Why an MCAP file cannot be read to its end with all its checksums, if so.
pub fn log_problem(path: &Path) -> Option<String> {
    let file = match File::open(path) {
        Ok(file) => file,
        Err(error) => return Some(error.to_string()),
    };
    verify::read_log(&mut BufReader::new(file)).err()
}
