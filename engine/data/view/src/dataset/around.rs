//! Surroundings of a flight: bodies, crossings and the boxes of the town.

use super::opened::Opened;
use crate::subject::short;
use cosfly_diagnose::Result;
use cosfly_read::{PublishedDataset, Rows, read};
use cosfly_schema::tables::{Bodies, Crossings, Objects};
use serde_json::{Value, json};
use std::collections::BTreeMap;

/// Most rows of bodies of a flight.
const MOST_BODIES: usize = 200_000;
/// Most boxes of a town.
const MOST_BOXES: usize = 100_000;

/// Bodies around a flight: for each kind numbers in groups of seven: frame, x, y, heading (degrees), length, width (metres), instance id.
///
/// # Errors
/// `view-unknown`, damage of table `bodies`.
pub fn bodies(opened: &Opened, number: usize) -> Result<Value> {
    let mut kinds: BTreeMap<String, Vec<f64>> = BTreeMap::new();
    let (mut boxes, mut count): (Vec<(u32, u32, [f64; 4])>, usize) = (vec![], 0);
    own_rows(opened, "bodies", number, &mut |rows, row| {
        count += 1;
        if count > MOST_BODIES {
            return Ok(());
        }
        let (frame, instance) = (rows.get(Bodies::frame, row)?, rows.get(Bodies::instance, row)?.unwrap_or(0));
        let [x, y, _] = rows.get(Bodies::feet_in_world_m, row)?;
        let [length, width, _] = rows.get(Bodies::size_m, row)?;
        let heading = rows.get(Bodies::heading_deg, row)?;
        let numbers = [f64::from(frame), x, y, heading, length, width, f64::from(instance)];
        kinds.entry(rows.get(Bodies::kind, row)?).or_default().extend(numbers.map(short));
        if let Some(edges) = rows.get(Bodies::visible_box_px, row)? {
            boxes.push((frame, instance, edges.map(|edge| short(f64::from(edge)))));
        }
        Ok(())
    })?;
    Ok(json!({ "kinds": kinds, "boxes": boxes, "left_out": count.saturating_sub(MOST_BODIES) }))
}

/// Outlines of the crossings around a flight: x and y by turns.
///
/// # Errors
/// Damage of table `crossings`.
pub fn crossings(opened: &Opened, number: usize) -> Result<Vec<Vec<f64>>> {
    let mut outlines = vec![];
    own_rows(opened, "crossings", number, &mut |rows, row| {
        let (xs, ys) = (rows.get(Crossings::outline_x_m, row)?, rows.get(Crossings::outline_y_m, row)?);
        outlines.push(xs.into_iter().zip(ys).flat_map(|(x, y)| [short(x), short(y)]).collect());
        Ok(())
    })?;
    Ok(outlines)
}

/// Calls `visit` for each row of a flight in a table whose rows name their trajectory.
///
/// # Errors
/// Damage of the table, or an error of `visit`.
pub fn own_rows(
    opened: &Opened,
    table: &'static str,
    number: usize,
    visit: &mut dyn FnMut(&Rows<'_>, usize) -> Result<()>,
) -> Result<()> {
    let id = &opened.at(number)?.trajectory_id;
    opened.rows(table)?.visit(&[number].into(), &mut |rows, _| {
        let ids = rows.values(Bodies::trajectory_id)?;
        (0..rows.len()).filter(|row| ids.text(*row) == id).try_for_each(|row| visit(rows, row))
    })
}

/// Boxes of a town: for each kind numbers in groups of seven: x, y, half lengths, yaw (degrees), height and bottom (metres).
///
/// # Errors
/// Damage of table `objects`.
pub fn town(dataset: &PublishedDataset, town: &str) -> Result<Value> {
    let (mut kinds, mut count): (BTreeMap<String, Vec<f64>>, usize) = (BTreeMap::new(), 0);
    for (_, path) in dataset.files("objects")? {
        read(&path, &mut |rows| {
            let (towns, of_rows) = (rows.values(Objects::town)?, rows.values(Objects::kind)?);
            for row in (0..rows.len()).filter(|row| towns.text(*row) == town) {
                count += 1;
                if count <= MOST_BOXES {
                    let [x, y, z] = rows.get(Objects::center_in_world_m, row)?;
                    let [length, width, height] = rows.get(Objects::size_m, row)?;
                    let yaw_deg = rows.get(Objects::yaw_deg, row)?;
                    let numbers = [x, y, 0.5 * length, 0.5 * width, yaw_deg, height, z - 0.5 * height];
                    kinds.entry(of_rows.text(row).to_owned()).or_default().extend(numbers.map(short));
                }
            }
            Ok(())
        })?;
    }
    Ok(json!({ "name": town, "kinds": kinds, "left_out": count.saturating_sub(MOST_BOXES) }))
}
