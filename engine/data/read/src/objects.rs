//! Boxes of the objects in the towns of a dataset, from table `objects`.

use super::dataset::PublishedDataset;
use cosfly_diagnose::Result;
use cosfly_frames::DVec3;
use cosfly_schema::tables::Objects;
use std::collections::BTreeMap;

/// A box of an object.
#[derive(Clone, Debug, PartialEq)]
pub struct PublishedObject {
    /// Name of the town.
    pub town: String,
    /// Id in instance images.
    pub instance: u32,
    /// Kind of object, such as `building`.
    pub kind: String,
    /// Shape of the box.
    pub shape: BoxInWorld,
}

/// Centre, half lengths along the box's own axes (metres) and yaw (radians) of a box in the world frame.
pub type BoxInWorld = (DVec3, DVec3, f64);

impl PublishedDataset {
    /// Places of all objects by town: x and y of their middles, metres.
    ///
    /// # Errors
    /// Damage of the table.
    pub fn object_places(&self) -> Result<BTreeMap<String, Vec<[f64; 2]>>> {
        let mut found: BTreeMap<String, Vec<[f64; 2]>> = BTreeMap::new();
        self.each_row("objects", &mut |rows, row| {
            let [x, y, _] = rows.get(Objects::center_in_world_m, row)?;
            found.entry(rows.get(Objects::town, row)?).or_default().push([x, y]);
            Ok(())
        })?;
        Ok(found)
    }

    /// The largest instance id of an object in each town.
    ///
    /// # Errors
    /// Damage of the table.
    pub fn largest_objects(&self) -> Result<BTreeMap<String, u32>> {
        let mut largest: BTreeMap<String, u32> = BTreeMap::new();
        self.each_row("objects", &mut |rows, row| {
            let (towns, id) = (rows.values(Objects::town)?, rows.get(Objects::instance, row)?);
            match largest.get_mut(towns.text(row)) {
                Some(known) => *known = id.max(*known),
                None => drop(largest.insert(towns.text(row).to_owned(), id)),
            }
            Ok(())
        })?;
        Ok(largest)
    }

    /// Boxes of all objects of these kinds, in the order of the table.
    ///
    /// # Errors
    /// Damage of the table.
    pub fn objects(&self, kinds: &[&str]) -> Result<Vec<PublishedObject>> {
        let mut found = vec![];
        self.each_row("objects", &mut |rows, row| {
            let of_rows = rows.values(Objects::kind)?;
            let kind = of_rows.text(row);
            if kinds.contains(&kind) {
                found.push(PublishedObject {
                    town: rows.get(Objects::town, row)?,
                    instance: rows.get(Objects::instance, row)?,
                    kind: kind.to_owned(),
                    shape: (
                        DVec3::from_array(rows.get(Objects::center_in_world_m, row)?),
                        0.5 * DVec3::from_array(rows.get(Objects::size_m, row)?),
                        rows.get(Objects::yaw_deg, row)?.to_radians(),
                    ),
                });
            }
            Ok(())
        })?;
        Ok(found)
    }
}
