//! 3-D boxes and key points of single trajectories; those of neighbouring trajectories are read together and kept until others are
//! asked for.

use super::dataset::PublishedDataset;
use super::kept_rows::KeptRows;
use super::rows::Rows;
use cosfly_diagnose::Result;
use cosfly_frames::DVec3;
use cosfly_schema::tables::Bodies3d;

/// A row of table `bodies_3d`. World frame: CARLA's, metres.
#[derive(Clone, Debug, PartialEq)]
pub struct SpaceRow {
    /// Number of the frame, from 0.
    pub frame: u32,
    /// Id in instance images.
    pub instance: u32,
    /// Middle of the box.
    pub centre_in_world: DVec3,
    /// Length along the heading, width and height.
    pub size_m: DVec3,
    /// Heading, degrees.
    pub yaw_in_world_deg: f64,
    /// Middle of the box along the camera's axes: ahead, right, up.
    pub centre_in_camera: DVec3,
    /// Heading against the camera's yaw, degrees.
    pub yaw_in_camera_deg: f64,
    /// Key points in COCO's order; none of vehicles and drones.
    pub key_points: Vec<SeenKeyPoint>,
}

/// A key point as the table has it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SeenKeyPoint {
    /// Pixel coordinates, right and down; 0 out of the picture.
    pub pixel: [f64; 2],
    /// Planar depth, metres.
    pub depth_m: f64,
    /// Place in the world.
    pub point_in_world: DVec3,
    /// 2: seen; 1: in the picture; 0: out of it.
    pub shown: u8,
}

impl SpaceRow {
    /// Reads a row.
    ///
    /// # Errors
    /// A missing column, or lists of other lengths than the points have.
    pub fn read(rows: &Rows<'_>, row: usize) -> Result<Self> {
        let pixels = rows.get(Bodies3d::key_points_px, row)?;
        let depths_m = rows.get(Bodies3d::key_points_depth_m, row)?;
        let places = rows.get(Bodies3d::key_points_in_world_m, row)?;
        let shown = rows.get(Bodies3d::key_points_shown, row)?;
        let points = pixels.as_chunks::<2>().0.iter().zip(depths_m).zip(places.as_chunks::<3>().0).zip(shown);
        let points = points.map(|(((pixel, depth_m), place), shown)| SeenKeyPoint {
            pixel: *pixel,
            depth_m,
            point_in_world: DVec3::from_array(*place),
            shown: shown as u8,
        });
        Ok(Self {
            frame: rows.get(Bodies3d::frame, row)?,
            instance: rows.get(Bodies3d::instance, row)?,
            centre_in_world: DVec3::from_array(rows.get(Bodies3d::centre_in_world_m, row)?),
            size_m: DVec3::from_array(rows.get(Bodies3d::size_m, row)?),
            yaw_in_world_deg: rows.get(Bodies3d::yaw_in_world_deg, row)?,
            centre_in_camera: DVec3::from_array(rows.get(Bodies3d::centre_in_camera_m, row)?),
            yaw_in_camera_deg: rows.get(Bodies3d::yaw_in_camera_deg, row)?,
            key_points: points.collect(),
        })
    }
}

/// Reads the rows of table `bodies_3d` trajectory by trajectory.
pub struct SpaceReader {
    rows: KeptRows<SpaceRow>,
}

impl SpaceReader {
    /// A reader of the table, which datasets from before it do not have.
    ///
    /// # Errors
    /// Damage of the table.
    pub fn of(dataset: &PublishedDataset) -> Result<Self> {
        Ok(Self { rows: KeptRows::of(dataset, "bodies_3d")? })
    }

    /// Rows of the trajectory at a place in [`PublishedDataset::flights`] of the same dataset, by frame and id.
    ///
    /// # Errors
    /// Damage of the table.
    pub fn at(&mut self, dataset: &PublishedDataset, place: usize) -> Result<&[SpaceRow]> {
        let read = |rows: &Rows<'_>, row: usize| SpaceRow::read(rows, row).map(Some);
        self.rows.at(dataset, place, Bodies3d::trajectory_id, read, |row| (row.frame, row.instance))
    }
}
