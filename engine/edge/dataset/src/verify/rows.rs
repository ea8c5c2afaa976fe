//! Reads the rows of published tables back, schemas checked first.

use super::figures::Figures;
use crate::action;
use crate::tables::{self, FileRecord, Table};
use arrow::array::{Array, AsArray, RecordBatch};
use arrow::datatypes::{DataType, Float32Type, Float64Type, Int64Type};
use cosfly_frames::{DVec3, Pose};
use parquet::arrow::ProjectionMask;
use parquet::arrow::arrow_reader::ParquetRecordBatchReaderBuilder;
use std::fs::File;
use std::path::Path;

/// What is wrong with a file, in words.
pub type ReadResult<T> = std::result::Result<T, String>;

/// Reads the batches of a file of `table`, without the images.
pub fn batches<S>(path: &Path, table: &Table<S>, visit: &mut dyn FnMut(&Batch)) -> ReadResult<()> {
    let file = File::open(path).map_err(|error| format!("it cannot be opened: {error}"))?;
    let builder = ParquetRecordBatchReaderBuilder::try_new(file).map_err(|error| format!("not Parquet: {error}"))?;
    let expected = tables::schema(table);
    if builder.schema().fields() != expected.fields() {
        let found = builder.schema();
        let differs =
            expected.fields().iter().find(|field| found.field_with_name(field.name()).ok() != Some(&***field));
        let column =
            differs.map_or("the order of its columns".to_owned(), |field| format!("column `{}`", field.name()));
        return Err(format!("{column} is not as table `{}` has it", table.name));
    }
    let kept = (0..table.columns.len()).filter(|i| table.columns[*i].kind != tables::Kind::Image);
    let mask = ProjectionMask::roots(builder.parquet_schema(), kept);
    let reader = builder.with_projection(mask).build().map_err(|error| error.to_string())?;
    let (mut rows, mut endless) = (0, None);
    for batch in reader {
        let batch = batch.map_err(|error| format!("it cannot be read: {error}"))?;
        let column = (0..batch.num_columns()).find(|at| !is_finite(batch.column(*at).as_ref()));
        endless = endless.or(column.map(|at| {
            let name = batch.schema_ref().field(at).name().clone();
            format!("column `{name}` has a number that is not finite, in row {rows} or after it")
        }));
        rows += batch.num_rows();
        visit(&Batch(batch));
    }
    endless.map_or(Ok(()), Err)
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

/// Rows of a table whose schema was checked.
pub struct Batch(RecordBatch);

impl Batch {
    /// Number of rows.
    pub fn rows(&self) -> usize {
        self.0.num_rows()
    }

    fn column(&self, name: &str) -> &dyn Array {
        self.0.column_by_name(name).expect("the schema was checked").as_ref()
    }

    /// A text; empty for null.
    pub fn text(&self, name: &str, row: usize) -> String {
        let column = self.column(name).as_string::<i32>();
        if column.is_null(row) { String::new() } else { column.value(row).to_owned() }
    }

    /// A number; `None` for null.
    pub fn real(&self, name: &str, row: usize) -> Option<f64> {
        let column = self.column(name).as_primitive::<Float64Type>();
        column.is_valid(row).then(|| column.value(row))
    }

    /// An integer; `None` for null.
    pub fn integer(&self, name: &str, row: usize) -> Option<i64> {
        let column = self.column(name).as_primitive::<Int64Type>();
        column.is_valid(row).then(|| column.value(row))
    }

    /// The integers of a list; empty for null.
    pub fn integers(&self, name: &str, row: usize) -> Vec<i64> {
        let column = self.column(name).as_list::<i32>();
        if column.is_null(row) { vec![] } else { column.value(row).as_primitive::<Int64Type>().values().to_vec() }
    }

    /// The 32-bit floats of a list; empty for null.
    pub fn floats(&self, name: &str, row: usize) -> Vec<f32> {
        let column = self.column(name).as_list::<i32>();
        if column.is_null(row) { vec![] } else { column.value(row).as_primitive::<Float32Type>().values().to_vec() }
    }

    /// A flag; `None` for null.
    pub fn flag(&self, name: &str, row: usize) -> Option<bool> {
        let column = self.column(name).as_boolean();
        column.is_valid(row).then(|| column.value(row))
    }

    /// `N` numbers; `None` for null.
    pub fn reals<const N: usize>(&self, name: &str, row: usize) -> Option<[f64; N]> {
        let column = self.column(name).as_fixed_size_list();
        if column.is_null(row) {
            return None;
        }
        column.value(row).as_primitive::<Float64Type>().values()[..].try_into().ok()
    }

    /// A pixel box; `None` for null.
    pub fn pixel_box(&self, name: &str, row: usize) -> Option<[f64; 4]> {
        let column = self.column(name).as_fixed_size_list();
        if column.is_null(row) {
            return None;
        }
        let edges: [f32; 4] = column.value(row).as_primitive::<Float32Type>().values()[..].try_into().ok()?;
        Some(edges.map(f64::from))
    }
}

/// The rows of `files.parquet`.
pub fn files(path: &Path) -> ReadResult<Vec<FileRecord>> {
    let mut files = vec![];
    batches(path, &tables::of_files(), &mut |batch| {
        files.extend((0..batch.rows()).map(|row| FileRecord {
            path: batch.text("path", row),
            bytes: batch.integer("bytes", row).and_then(|bytes| u64::try_from(bytes).ok()).unwrap_or(0),
            sha256: batch.text("sha256", row),
        }));
    })?;
    Ok(files)
}

/// What the checks need of a flight.
#[derive(Clone, Debug, PartialEq)]
pub struct FlightRow {
    /// File and row it stands in.
    pub place: (String, usize),
    /// Its name.
    pub trajectory_id: String,
    /// What is flown; the same for all weathers of a paired rendering.
    pub flight_id: String,
    /// Preset of its weather.
    pub weather: String,
    /// Its expert; empty for experts.
    pub expert_id: String,
    /// Its pedestrian.
    pub pedestrian_id: String,
    /// Its town.
    pub town: String,
    /// Number of frames.
    pub frames: i64,
    /// Time between frames, seconds.
    pub dt_s: f64,
    /// Its camera without the lens.
    pub camera: cosfly_render::Camera,
    /// Its lens.
    pub lens: cosfly_render::Lens,
    /// The camera's turn against the drone.
    pub mount: cosfly_render::Mount,
    /// Body height, metres.
    pub target_height_m: f64,
    /// Body radius, metres.
    pub target_radius_m: f64,
    /// Its log.
    pub mcap_path: String,
    /// Size and hash of the log.
    pub mcap: (i64, String),
    /// Messages in the log.
    pub mcap_messages: i64,
    /// What it says about its frames and limits.
    pub figures: Figures,
}

impl FlightRow {
    /// Pixel coordinates and planar depth of a world point through camera and lens; `None` behind the camera.
    pub fn project(&self, camera_pose: &Pose, point_in_world: DVec3) -> Option<(f64, f64, f64)> {
        let (u, v, depth_m) = self.camera.project(camera_pose, point_in_world)?;
        let (u, v) = self.lens.bend(&self.camera, (u, v));
        Some((u, v, depth_m))
    }
}

/// The rows of a file of `trajectories`.
pub fn flights(path: &Path, name: &str) -> ReadResult<Vec<FlightRow>> {
    let mut flights = vec![];
    let table = tables::of_trajectories().into_iter().find(|table| table.name == "trajectories").expect("it exists");
    batches(path, &table, &mut |batch| {
        for row in 0..batch.rows() {
            let side = |name| batch.integer(name, row).and_then(|side| u32::try_from(side).ok()).unwrap_or(0);
            let real = |name| batch.real(name, row).unwrap_or(f64::NAN);
            flights.push(FlightRow {
                place: (name.to_owned(), flights.len()),
                trajectory_id: batch.text("trajectory_id", row),
                expert_id: batch.text("expert_id", row),
                pedestrian_id: batch.text("pedestrian_id", row),
                town: batch.text("town", row),
                frames: batch.integer("frames", row).unwrap_or(-1),
                dt_s: real("dt_s"),
                camera: cosfly_render::Camera {
                    width: side("camera_width_px"),
                    height: side("camera_height_px"),
                    horizontal_fov_rad: real("camera_fov_deg").to_radians(),
                },
                lens: cosfly_render::Lens { k1: real("camera_k1"), k2: real("camera_k2") },
                mount: cosfly_render::Mount {
                    pitch_rad: real("camera_mount_pitch_deg").to_radians(),
                    yaw_rad: real("camera_mount_yaw_deg").to_radians(),
                },
                flight_id: batch.text("flight_id", row),
                weather: batch.text("weather_preset", row),
                target_height_m: real("target_height_m"),
                target_radius_m: real("target_radius_m"),
                mcap_path: batch.text("mcap_path", row),
                mcap: (batch.integer("mcap_bytes", row).unwrap_or(-1), batch.text("mcap_sha256", row)),
                mcap_messages: batch.integer("mcap_messages", row).unwrap_or(-1),
                figures: Figures::read(batch, row),
            });
        }
    })?;
    Ok(flights)
}

/// What the checks need of a frame.
#[derive(Clone, Debug, PartialEq)]
pub struct FrameRow {
    /// Row in its file.
    pub row: usize,
    /// Its flight.
    pub trajectory_id: String,
    /// Its number.
    pub frame: i64,
    /// Its time, seconds.
    pub time_s: f64,
    /// The drone's pose.
    pub pose: Pose,
    /// The camera's pose, at the same position.
    pub camera_pose: Pose,
    /// Angles as stored: pitch, yaw, roll, degrees.
    pub angles_deg: [f64; 3],
    /// Feet of the target.
    pub feet_in_world: DVec3,
    /// Stored distance.
    pub distance_m: f64,
    /// Stored distance from obstacles.
    pub clearance_m: f64,
    /// Stored flags and shares.
    pub in_view: bool,
    /// Visible share by rays and by pixels.
    pub visible: [f64; 2],
    /// Visible share by hundreds of rays.
    pub visible_by_dense_rays: Option<f64>,
    /// Visible pixels.
    pub visible_pixels: i64,
    /// Edges of the visible pixels.
    pub visible_box: Option<[f64; 4]>,
    /// Edges without obstacles.
    pub full_box: Option<[f64; 4]>,
    /// Action along the world's axes.
    pub action_in_world: Option<[f64; 6]>,
    /// Action seen from the body.
    pub action_in_body: Option<[f64; 6]>,
    /// Instance id of what hides most of the target.
    pub occluder: i64,
    /// Frame of the expert, position event, rotation event, displacement; none for experts.
    pub disturbance: Option<(i64, bool, bool, DVec3)>,
}

impl FrameRow {
    fn read(batch: &Batch, row: usize, row_in_file: usize) -> Self {
        let real = |name| batch.real(name, row).unwrap_or(f64::NAN);
        let angles_deg = [real("drone_pitch_deg"), real("drone_yaw_deg"), real("drone_roll_deg")];
        let [pitch_rad, yaw_rad, roll_rad] = angles_deg.map(f64::to_radians);
        let event = |name| batch.flag(name, row).unwrap_or(false);
        let pose = Pose {
            position_in_world: DVec3::new(real("drone_x_m"), real("drone_y_m"), real("drone_z_m")),
            pitch_rad,
            yaw_rad,
            roll_rad,
        };
        Self {
            row: row_in_file,
            trajectory_id: batch.text("trajectory_id", row),
            frame: batch.integer("frame", row).unwrap_or(-1),
            time_s: real("time_s"),
            pose,
            camera_pose: Pose {
                position_in_world: pose.position_in_world,
                pitch_rad: real("camera_pitch_deg").to_radians(),
                yaw_rad: real("camera_yaw_deg").to_radians(),
                roll_rad: real("camera_roll_deg").to_radians(),
            },
            angles_deg,
            feet_in_world: DVec3::new(real("target_x_m"), real("target_y_m"), real("target_z_m")),
            distance_m: real("distance_m"),
            clearance_m: real("clearance_m"),
            in_view: event("in_view"),
            visible: [real("visible_by_rays"), real("visible_by_pixels")],
            visible_by_dense_rays: batch.real("visible_by_dense_rays", row),
            visible_pixels: batch.integer("visible_pixels", row).unwrap_or(-1),
            visible_box: batch.pixel_box("visible_box_px", row),
            full_box: batch.pixel_box("full_box_px", row),
            action_in_world: batch.reals("action_in_world", row),
            action_in_body: batch.reals("action_in_body", row),
            occluder: batch.integer("occluder_instance", row).unwrap_or(-1),
            disturbance: batch.integer("expert_frame", row).map(|frame| {
                let offset = batch.reals("drone_offset_in_world_m", row).map_or(DVec3::NAN, DVec3::from_array);
                (frame, event("position_event"), event("rotation_event"), offset)
            }),
        }
    }

    /// The pose and actions as bytes, to compare with table `waypoints`.
    pub fn motion_bytes(&self) -> Vec<u8> {
        let p = self.pose.position_in_world;
        let pose = [p.x, p.y, p.z, self.angles_deg[0], self.angles_deg[1], self.angles_deg[2]];
        let expert_frame = self.disturbance.map_or(self.frame, |it| it.0);
        let target = self.feet_in_world.to_array();
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
}

fn motion_bytes(
    pose: &[f64; 6],
    target: [f64; 3],
    expert_frame: i64,
    in_world: Option<&[f64; 6]>,
    in_body: Option<&[f64; 6]>,
) -> Vec<u8> {
    let (none, expert_frame) = ([f64::MAX; 6], expert_frame as f64);
    let numbers = pose
        .iter()
        .chain(&target)
        .chain([&expert_frame])
        .chain(in_world.unwrap_or(&none))
        .chain(in_body.unwrap_or(&none));
    numbers.flat_map(|number| number.to_bits().to_le_bytes()).collect()
}

/// Reads a file of `frames`, giving the rows of one flight after the other to `visit`.
pub fn frames(path: &Path, visit: &mut dyn FnMut(Vec<FrameRow>)) -> ReadResult<()> {
    let mut group: Vec<FrameRow> = vec![];
    let mut row_in_file = 0;
    let table = tables::of_trajectories().into_iter().find(|table| table.name == "frames").expect("it exists");
    batches(path, &table, &mut |batch| {
        for row in 0..batch.rows() {
            let next = FrameRow::read(batch, row, row_in_file);
            row_in_file += 1;
            if group.first().is_some_and(|first| first.trajectory_id != next.trajectory_id) {
                visit(std::mem::take(&mut group));
            }
            group.push(next);
        }
    })?;
    if !group.is_empty() {
        visit(group);
    }
    Ok(())
}

/// Of each row of a file of `waypoints`: flight, step, motion.
pub fn waypoints(path: &Path, visit: &mut dyn FnMut(String, i64, Vec<u8>)) -> ReadResult<()> {
    let table = tables::of_trajectories().into_iter().find(|table| table.name == "waypoints").expect("it exists");
    batches(path, &table, &mut |batch| {
        for row in 0..batch.rows() {
            let pose = batch.reals("pose_in_world", row).unwrap_or([f64::NAN; 6]);
            let world = batch.reals("action_in_world", row);
            let body = batch.reals("action_in_body", row);
            let target = batch.reals("target_feet_in_world", row).unwrap_or([f64::NAN; 3]);
            let expert_step = batch.integer("expert_step", row).unwrap_or(-1);
            let motion = motion_bytes(&pose, target, expert_step, world.as_ref(), body.as_ref());
            visit(batch.text("trajectory_id", row), batch.integer("step", row).unwrap_or(-1), motion);
        }
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use arrow::array::{Float32Array, Float64Array, Int64Array, ListArray};

    #[test]
    fn numbers_that_are_not_finite_are_seen_in_columns_and_lists() {
        assert!(is_finite(&Float64Array::from(vec![Some(1.0), None])) && is_finite(&Int64Array::from(vec![1])));
        assert!(!is_finite(&Float64Array::from(vec![1.0, f64::NAN])));
        assert!(!is_finite(&Float32Array::from(vec![f32::INFINITY])));
        let lists = [Some(vec![Some(1.0), Some(f64::NEG_INFINITY)])];
        assert!(!is_finite(&ListArray::from_iter_primitive::<Float64Type, _, _>(lists)));
    }
}
