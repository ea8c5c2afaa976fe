//! Rows of the tables with their places, schemas and finiteness checked first.

use super::figures::Figures;
use arrow_array::Array;
use arrow_array::cast::AsArray;
use arrow_array::types::{Float32Type, Float64Type};
use arrow_schema::DataType;
use cosfly_diagnose::Diagnostic;
use cosfly_domain::MapOrigin;
use cosfly_frames::{DVec3, Pose, action};
use cosfly_read::{FrameRow, PublishedFlight, Rows, Shared, TableFile};
use cosfly_schema::tables::{self, DatasetItem, FileRecord, Files, Frames, Kind, Table, Trajectories, Waypoints};
use cosfly_sensors::GeoOrigin;
use std::ops::Deref;
use std::path::Path;
use std::sync::Arc;

/// A value read, or the damage of a file, in words.
pub type ReadResult<T> = Result<T, String>;

/// Gives the rows of a file of `table` to `visit`, row group by row group.
///
/// # Errors
/// Columns that are not those of the table, a number that is not finite, or what `visit` says.
pub fn read<S>(
    path: &Path,
    table: &Table<S>,
    visit: &mut dyn FnMut(&Rows<'_>) -> cosfly_diagnose::Result<()>,
) -> ReadResult<()> {
    let file = TableFile::open(path).map_err(|refusal| in_words(&refusal))?;
    check_schema(&file, table)?;
    let split = path.file_name().and_then(|name| name.to_str()).map_or("", split_of);
    let mut first = 0;
    for group in 0..file.groups() {
        let rows = file.group(group).map_err(|refusal| in_words(&refusal))?;
        for (place, column) in table.columns.iter().enumerate().filter(|(_, column)| column.kind() != Kind::Image) {
            if !is_finite(rows.array(place).map_err(|refusal| in_words(&refusal))?.as_ref()) {
                let name = column.name();
                return Err(format!("column `{name}` has a number that is not finite, in row {first} or after it"));
            }
            if column.name() == "split" && !is_all(rows.array(place).map_err(|it| in_words(&it))?.as_ref(), split) {
                return Err(format!("column `split` is not `{split}`, in row {first} or after it"));
            }
        }
        visit(&rows).map_err(|refusal| in_words(&refusal))?;
        first += rows.len();
    }
    Ok(())
}

/// Checks the columns of a file alone.
///
/// # Errors
/// Columns that are not those of the table.
pub fn check_columns<S>(path: &Path, table: &Table<S>) -> ReadResult<()> {
    check_schema(&TableFile::open(path).map_err(|refusal| in_words(&refusal))?, table)
}

fn check_schema<S>(file: &TableFile<'_>, table: &Table<S>) -> ReadResult<()> {
    let expected = tables::schema(table);
    if file.schema().fields() == expected.fields() {
        return Ok(());
    }
    let found = file.schema();
    let differs = expected.fields().iter().find(|field| found.field_with_name(field.name()).ok() != Some(&***field));
    let column = differs.map_or("the order of its columns".to_owned(), |field| format!("column `{}`", field.name()));
    Err(format!("{column} is not as table `{}` has it", table.name))
}

/// The split that a file belongs to.
pub fn split_of(path: &str) -> &str {
    path.rsplit('/').next().and_then(|name| name.split('-').next()).unwrap_or_default()
}

/// Whether all texts of a column are `text`.
fn is_all(column: &dyn Array, text: &str) -> bool {
    column.as_string_opt::<i32>().is_some_and(|texts| texts.iter().all(|it| it == Some(text)))
}

/// The table over the trajectories called `name`.
pub fn table(name: &str) -> Table<DatasetItem> {
    tables::of_trajectories().into_iter().find(|table| table.name == name).expect("the schema has the table")
}

fn in_words(refusal: &Diagnostic) -> String {
    [std::slice::from_ref(&refusal.message), &refusal.causes].concat().join(": ")
}

/// Whether no number of a column, in lists or not, is NaN or infinite.
fn is_finite(column: &dyn Array) -> bool {
    match column.data_type() {
        DataType::Float64 => column.as_primitive::<Float64Type>().iter().flatten().all(f64::is_finite),
        DataType::Float32 => column.as_primitive::<Float32Type>().iter().flatten().all(f32::is_finite),
        DataType::List(_) => is_finite(column.as_list::<i32>().values().as_ref()),
        DataType::FixedSizeList(..) => is_finite(column.as_fixed_size_list().values().as_ref()),
        _ => true,
    }
}

/// The rows of `files.parquet`.
pub fn files(path: &Path) -> ReadResult<Vec<FileRecord>> {
    let mut files = vec![];
    read(path, &tables::of_files(), &mut |rows| {
        for row in 0..rows.len() {
            files.push(FileRecord {
                path: rows.get(Files::path, row)?,
                bytes: rows.get(Files::bytes, row)?,
                sha256: rows.get(Files::sha256, row)?,
            });
        }
        Ok(())
    })?;
    Ok(files)
}

/// A row of table `trajectories` and its place.
#[derive(Clone, Debug, PartialEq)]
pub struct PlacedFlight {
    /// File and row.
    pub place: (Arc<str>, usize),
    /// Number of messages in the log.
    pub mcap_messages: u64,
    /// Sums over the frames, and limits.
    pub figures: Figures,
    /// Place of its world on the globe.
    pub origin: GeoOrigin,
    flight: PublishedFlight,
}

impl Deref for PlacedFlight {
    type Target = PublishedFlight;

    fn deref(&self) -> &PublishedFlight {
        &self.flight
    }
}

impl PlacedFlight {
    /// Pixel coordinates and depth of a world point through camera and lens; `None` where no picture shows it.
    pub fn project(&self, camera_pose: &Pose, point_in_world: DVec3) -> Option<(f64, f64, f64)> {
        self.lens.project(&self.camera, camera_pose.body_from_world_point(point_in_world))
    }

    /// Whether the picture shows a world point at a pixel, if anywhere: a lens's curve may turn and lead back.
    pub fn shows(&self, camera_pose: &Pose, point_in_world: DVec3, pixel: (f64, f64)) -> bool {
        self.lens.shows(&self.camera, camera_pose.body_from_world_point(point_in_world), pixel)
    }
}

/// Gives the rows of a file of `trajectories` with size and SHA-256 of their logs to `visit`; `name` is the file's path from
/// the dataset's folder.
pub fn flights(
    path: &Path,
    name: &str,
    shared: &mut Shared,
    visit: &mut dyn FnMut(PlacedFlight, (u64, String)),
) -> ReadResult<()> {
    let (name, mut number): (Arc<str>, usize) = (name.into(), 0);
    read(path, &table("trajectories"), &mut |rows| {
        for row in 0..rows.len() {
            let mut flight = PublishedFlight::read(rows, row, "")?;
            shared.share(&mut flight);
            let placed = PlacedFlight {
                place: (Arc::clone(&name), number),
                mcap_messages: rows.get(Trajectories::mcap_messages, row)?,
                figures: Figures::read(rows, row)?,
                origin: GeoOrigin::of(&MapOrigin {
                    offset_m: flight.town_offset_m,
                    geo_reference: rows.get(Trajectories::town_geo_reference, row)?,
                    added_by_file_m: DVec3::ZERO,
                }),
                flight,
            };
            visit(placed, (rows.get(Trajectories::mcap_bytes, row)?, rows.get(Trajectories::mcap_sha256, row)?));
            number += 1;
        }
        Ok(())
    })
}

/// A row of table `frames` and its place.
#[derive(Clone, Debug, PartialEq)]
pub struct PlacedFrame {
    /// Row in its file.
    pub row: usize,
    /// Trajectory that the frame belongs to.
    pub trajectory_id: String,
    /// Angles of the drone as stored: pitch, yaw, roll, degrees.
    pub angles_deg: [f64; 3],
    /// The row as it is stored.
    pub stored: FrameRow,
}

impl Deref for PlacedFrame {
    type Target = FrameRow;

    fn deref(&self) -> &FrameRow {
        &self.stored
    }
}

impl PlacedFrame {
    /// The pose and actions as bytes, to compare with table `waypoints`.
    pub fn motion_bytes(&self) -> Vec<u8> {
        let p = self.pose.position_in_world;
        let pose = [p.x, p.y, p.z, self.angles_deg[0], self.angles_deg[1], self.angles_deg[2]];
        let expert_frame = self.disturbance.as_ref().map_or(self.frame, |it| it.expert_frame);
        let target = self.target.feet_in_world.to_array();
        motion_bytes(&pose, target, expert_frame, self.action_in_world.as_ref(), self.action_in_body.as_ref())
    }

    /// The largest difference between the stored actions and those from this pose to `next`.
    pub fn action_error(&self, next: &Self) -> Option<f64> {
        let largest = |stored: [f64; 6], computed: [f64; 6]| {
            stored.iter().zip(computed).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max)
        };
        let world = largest(self.action_in_world?, action::in_world(&self.pose, &next.pose));
        Some(world.max(largest(self.action_in_body?, action::in_body(&self.pose, &next.pose))))
    }

    /// Edges around the visible pixels, as 64-bit floats.
    pub fn visible_box(&self) -> Option<[f64; 4]> {
        self.visible_box_px.map(|edges| edges.map(f64::from))
    }

    /// Edges around the pixels without obstacles, as 64-bit floats.
    pub fn full_box(&self) -> Option<[f64; 4]> {
        self.full_box_px.map(|edges| edges.map(f64::from))
    }
}

fn motion_bytes(
    pose: &[f64; 6],
    target: [f64; 3],
    expert_frame: u32,
    in_world: Option<&[f64; 6]>,
    in_body: Option<&[f64; 6]>,
) -> Vec<u8> {
    let (none, expert_frame) = ([f64::MAX; 6], f64::from(expert_frame));
    let numbers = pose
        .iter()
        .chain(&target)
        .chain([&expert_frame])
        .chain(in_world.unwrap_or(&none))
        .chain(in_body.unwrap_or(&none));
    numbers.flat_map(|number| number.to_bits().to_le_bytes()).collect()
}

/// Reads a file of `frames`, giving the rows of one trajectory after the other to `visit`.
pub fn frames(path: &Path, visit: &mut dyn FnMut(Vec<PlacedFrame>)) -> ReadResult<()> {
    let mut together: Vec<PlacedFrame> = vec![];
    let mut row_in_file = 0;
    read(path, &table("frames"), &mut |rows| {
        for row in 0..rows.len() {
            let trajectory_id = rows.get(Frames::trajectory_id, row)?;
            if together.first().is_some_and(|first| first.trajectory_id != trajectory_id) {
                visit(std::mem::take(&mut together));
            }
            let angles_deg = [
                rows.get(Frames::drone_pitch_deg, row)?,
                rows.get(Frames::drone_yaw_deg, row)?,
                rows.get(Frames::drone_roll_deg, row)?,
            ];
            let stored = FrameRow::read(rows, row)?;
            together.push(PlacedFrame { row: row_in_file, trajectory_id, angles_deg, stored });
            row_in_file += 1;
        }
        Ok(())
    })?;
    if !together.is_empty() {
        visit(together);
    }
    Ok(())
}

/// Gives trajectory, step and motion of each row of a file of `waypoints` to `visit`; of `wanted` trajectories only.
pub fn waypoints(
    path: &Path,
    wanted: &dyn Fn(&str) -> bool,
    visit: &mut dyn FnMut(&str, u32, Vec<u8>),
) -> ReadResult<()> {
    read(path, &table("waypoints"), &mut |rows| {
        let ids = rows.values(Waypoints::trajectory_id)?;
        for row in (0..rows.len()).filter(|row| wanted(ids.text(*row))) {
            let world = rows.get(Waypoints::action_in_world, row)?;
            let body = rows.get(Waypoints::action_in_body, row)?;
            let (pose, target) =
                (rows.get(Waypoints::pose_in_world, row)?, rows.get(Waypoints::target_feet_in_world, row)?);
            let expert_step = rows.get(Waypoints::expert_step, row)?;
            let motion = motion_bytes(&pose, target, expert_step, world.as_ref(), body.as_ref());
            visit(ids.text(row), rows.get(Waypoints::step, row)?, motion);
        }
        Ok(())
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use arrow_array::{Float32Array, Float64Array, Int64Array, ListArray};

    #[test]
    fn numbers_that_are_not_finite_are_seen_in_columns_and_lists() {
        assert!(is_finite(&Float64Array::from(vec![Some(1.0), None])) && is_finite(&Int64Array::from(vec![1])));
        assert!(!is_finite(&Float64Array::from(vec![1.0, f64::NAN])));
        assert!(!is_finite(&Float32Array::from(vec![f32::INFINITY])));
        let lists = [Some(vec![Some(1.0), Some(f64::NEG_INFINITY)])];
        assert!(!is_finite(&ListArray::from_iter_primitive::<Float64Type, _, _>(lists)));
    }
}
