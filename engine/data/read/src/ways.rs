//! Poses of the drone and positions of the target, trajectory by trajectory, from the small table `waypoints`.

use super::damage::damaged;
use super::dataset::PublishedDataset;
use super::rows::{Rows, read};
use cosfly_diagnose::Result;
use cosfly_frames::{DVec3, Pose};
use cosfly_schema::tables::Waypoints;
use std::path::Path;

/// Callback for a trajectory's id, the drone's poses and the target's feet; world frame, metres, radians.
type Visit<'a> = &'a mut dyn FnMut(&str, &[Pose], &[DVec3]) -> Result<()>;

impl PublishedDataset {
    /// Calls `visit` with every trajectory of table `waypoints`; one is in memory at a time.
    ///
    /// # Errors
    /// Damage of the table, or an error of `visit`.
    pub fn ways(&self, visit: Visit<'_>) -> Result<()> {
        for (_, path) in self.files("waypoints")? {
            let mut way = Way::default();
            read(&path, &mut |rows| {
                for row in 0..rows.len() {
                    way.push(rows, row, &path, visit)?;
                }
                Ok(())
            })?;
            way.finish(visit)?;
        }
        Ok(())
    }
}

/// Trajectory that is being read.
#[derive(Default)]
struct Way {
    id: String,
    poses: Vec<Pose>,
    feet: Vec<DVec3>,
}

impl Way {
    fn push(&mut self, rows: &Rows<'_>, row: usize, path: &Path, visit: Visit<'_>) -> Result<()> {
        let ids = rows.values(Waypoints::trajectory_id)?;
        let id = ids.text(row);
        if id != self.id {
            self.finish(visit)?;
            self.id = id.to_owned();
        }
        let step = rows.get(Waypoints::step, row)? as usize;
        if step != self.poses.len() {
            let what = format!("step {step} of `{id}` is out of order");
            return Err(damaged(path, &what, format!("step {} was expected", self.poses.len())));
        }
        let [x, y, z, pitch, yaw, roll] = rows.get(Waypoints::pose_in_world, row)?;
        self.poses.push(Pose {
            position_in_world: DVec3::new(x, y, z),
            pitch_rad: pitch.to_radians(),
            yaw_rad: yaw.to_radians(),
            roll_rad: roll.to_radians(),
        });
        self.feet.push(DVec3::from_array(rows.get(Waypoints::target_feet_in_world, row)?));
        Ok(())
    }

    fn finish(&mut self, visit: Visit<'_>) -> Result<()> {
        if !self.poses.is_empty() {
            visit(&self.id, &self.poses, &self.feet)?;
        }
        self.poses.clear();
        self.feet.clear();
        Ok(())
    }
}
