//! Where drone and target are, flight by flight, off the small table `waypoints`.

use super::columns::{self, Rows, damaged};
use super::flights::{PublishedDataset, table_files};
use cosfly_diagnose::Result;
use cosfly_frames::{DVec3, Pose};
use std::path::Path;

const COLUMNS: [&str; 4] = ["trajectory_id", "step", "pose_in_world", "target_feet_in_world"];

/// A flight's id, the drone's poses and the target's feet; world frame, metres, radians.
type Visit<'a> = &'a mut dyn FnMut(&str, &[Pose], &[DVec3]);

impl PublishedDataset {
    /// Gives every flight of table `waypoints` to `visit`; one flight is in memory at a time.
    ///
    /// # Errors
    /// What is wrong with the table.
    pub fn ways(&self, visit: Visit<'_>) -> Result<()> {
        for (_, path) in table_files(&self.folder().join("data/waypoints"))? {
            let mut way = Way::default();
            columns::read(&path, &|name| COLUMNS.contains(&name), &mut |rows| {
                for row in 0..rows.len() {
                    way.push(rows, row, &path, visit)?;
                }
                Ok(())
            })?;
            way.finish(visit);
        }
        Ok(())
    }
}

/// The flight that is being read.
#[derive(Default)]
struct Way {
    id: String,
    poses: Vec<Pose>,
    feet: Vec<DVec3>,
}

impl Way {
    fn push(&mut self, rows: &Rows<'_>, row: usize, path: &Path, visit: Visit<'_>) -> Result<()> {
        let id = rows.text_at("trajectory_id", row)?;
        if id != self.id {
            self.finish(visit);
            self.id = id.to_owned();
        }
        let step = rows.count("step", row)? as usize;
        if step != self.poses.len() {
            let what = format!("step {step} of `{id}` is out of order");
            return Err(damaged(path, &what, format!("step {} should be there", self.poses.len())));
        }
        let [x, y, z, pitch, yaw, roll] = rows.vector("pose_in_world", row)?;
        self.poses.push(Pose {
            position_in_world: DVec3::new(x, y, z),
            pitch_rad: pitch.to_radians(),
            yaw_rad: yaw.to_radians(),
            roll_rad: roll.to_radians(),
        });
        self.feet.push(DVec3::from_array(rows.vector("target_feet_in_world", row)?));
        Ok(())
    }

    fn finish(&mut self, visit: Visit<'_>) {
        if !self.poses.is_empty() {
            visit(&self.id, &self.poses, &self.feet);
        }
        self.poses.clear();
        self.feet.clear();
    }
}
