//! The three tables of LeRobot v3.0: frames, episodes, tasks.

use super::eyes::Eye;
use super::motion::STEPS;
use arrow_array::ArrayRef;
use arrow_array::builder::{FixedSizeListBuilder, Float64Builder};
use cosfly_schema::tables::{AnyColumn, CellProblem, Column, ImageFile, Kind, Table, Value};
use serde_json::json;
use std::sync::Arc;

/// Names of the features that are vectors, and of their parts. Policies take all features whose names begin with
/// `observation` as inputs, so that names of what a drone does not know begin with `privileged`.
pub const VECTORS: [(&str, &[&str]); 5] = [
    ("observation.state", &["dx", "dy", "dz", "dpitch", "dyaw", "droll", "pitch", "roll"]),
    ("privileged.pose", &["x", "y", "z", "pitch", "yaw", "roll"]),
    ("privileged.target", &["x", "y", "z"]),
    ("privileged.box", &["left", "top", "right", "bottom"]),
    ("action", &ACTION),
];
/// Name of the feature with the readings of all sensors that are no cameras, where there are any.
pub const SENSORS: &str = "observation.sensors";
/// Names of the parts of actions.
const ACTION: [&str; 6 * STEPS] = [
    "dx_1", "dy_1", "dz_1", "dpitch_1", "dyaw_1", "droll_1", "dx_2", "dy_2", "dz_2", "dpitch_2", "dyaw_2", "droll_2",
    "dx_3", "dy_3", "dz_3", "dpitch_3", "dyaw_3", "droll_3", "dx_4", "dy_4", "dz_4", "dpitch_4", "dyaw_4", "droll_4",
    "dx_5", "dy_5", "dz_5", "dpitch_5", "dyaw_5", "droll_5",
];

/// The frames of an episode.
#[derive(Default)]
pub struct DataRows {
    /// Number of the episode.
    pub number: usize,
    /// Number of the first frame among those of all episodes.
    pub first: usize,
    /// Number of the task.
    pub task: usize,
    /// Seconds between frames.
    pub dt_s: f64,
    /// [`VECTORS`] of every frame.
    pub vectors: Vec<[Vec<f64>; 5]>,
    /// [`SENSORS`] of every frame.
    pub readings: Vec<Vec<f64>>,
    /// Picture files, by camera and frame.
    pub pictures: Vec<Vec<Vec<u8>>>,
    /// Files of depth, where it is wanted, by camera and frame.
    pub depths: Vec<Vec<Vec<u8>>>,
}

/// An episode.
pub struct EpisodeRow {
    /// Id of the flight.
    pub trajectory_id: String,
    /// Id of the flight that the actions lead to; empty for an expert.
    pub expert_id: String,
    /// Split.
    pub split: String,
    /// Number.
    pub episode: usize,
    /// Task.
    pub task: String,
    /// First frame in the whole dataset.
    pub from: usize,
    /// Number behind the last frame.
    pub to: usize,
    /// Number of the folder of the file.
    pub chunk: usize,
    /// Number of the file.
    pub file: usize,
}

/// A task.
pub struct TaskRow {
    /// Number.
    pub index: usize,
    /// The instruction.
    pub task: String,
}

/// Column [`SENSORS`] of this many numbers.
struct SensorColumn(usize);

impl AnyColumn<DataRows> for SensorColumn {
    fn name(&self) -> &'static str {
        SENSORS
    }

    fn unit(&self) -> Option<&'static str> {
        None
    }

    fn doc(&self) -> &'static str {
        ""
    }

    fn kind(&self) -> Kind {
        Kind::Reals(self.0)
    }

    fn nullable(&self) -> bool {
        false
    }

    fn array(&self, record: &DataRows, _: usize) -> Result<ArrayRef, CellProblem> {
        let mut builder = FixedSizeListBuilder::new(Float64Builder::new(), self.0 as i32);
        for numbers in &record.readings {
            builder.values().append_slice(numbers);
            builder.append(true);
        }
        Ok(Arc::new(builder.finish()))
    }
}

/// Column of the files of a camera.
struct FileColumn {
    name: &'static str,
    files: fn(&DataRows) -> &[Vec<Vec<u8>>],
    camera: usize,
}

impl AnyColumn<DataRows> for FileColumn {
    fn name(&self) -> &'static str {
        self.name
    }

    fn unit(&self) -> Option<&'static str> {
        None
    }

    fn doc(&self) -> &'static str {
        ""
    }

    fn kind(&self) -> Kind {
        ImageFile::KIND
    }

    fn nullable(&self) -> bool {
        ImageFile::NULLABLE
    }

    fn array(&self, record: &DataRows, rows: usize) -> Result<ArrayRef, CellProblem> {
        let files = &(self.files)(record)[self.camera][..rows];
        Ok(ImageFile::array(files.iter().cloned().map(ImageFile).collect()))
    }
}

/// A row per frame; with the pictures of these cameras, so many numbers of sensors, and with depth.
pub fn data(eyes: &[Eye], sensed: usize, has_depth: bool) -> Table<DataRows> {
    const COLUMNS: &[&dyn AnyColumn<DataRows>] = &[
        &Column::named(VECTORS[0].0, "", |it: &DataRows, i| numbers::<8>(&it.vectors[i][0])),
        &Column::named(VECTORS[1].0, "", |it: &DataRows, i| numbers::<6>(&it.vectors[i][1])),
        &Column::named(VECTORS[2].0, "", |it: &DataRows, i| numbers::<3>(&it.vectors[i][2])),
        &Column::named(VECTORS[3].0, "", |it: &DataRows, i| numbers::<4>(&it.vectors[i][3])),
        &Column::named(VECTORS[4].0, "", |it: &DataRows, i| numbers::<{ 6 * STEPS }>(&it.vectors[i][4])),
        &Column::named("timestamp", "", |it: &DataRows, i| i as f64 * it.dt_s),
        &Column::named("frame_index", "", |_: &DataRows, i| i as u64),
        &Column::named("episode_index", "", |it: &DataRows, _| it.number as u64),
        &Column::named("index", "", |it: &DataRows, i| (it.first + i) as u64),
        &Column::named("task_index", "", |it: &DataRows, _| it.task as u64),
    ];
    let rows = |it: &DataRows| it.vectors.len();
    let mut table = Table { rows_per_group: 200, ..Table::new("data", "", &[], rows, COLUMNS) };
    // Columns live as long as the program; there are few cameras and few widths.
    let column = |name, files, camera| -> &'static dyn AnyColumn<DataRows> {
        Box::leak(Box::new(FileColumn { name, files, camera }))
    };
    let numbered = || eyes.iter().enumerate();
    let colours = numbered().map(|(at, eye)| column(eye.colours, |it| &it.pictures, at));
    table.columns.splice(0..0, colours);
    table.columns.extend(numbered().filter(|_| has_depth).map(|(at, eye)| column(eye.depths, |it| &it.depths, at)));
    if sensed > 0 {
        table.columns.push(Box::leak(Box::new(SensorColumn(sensed))));
    }
    table
}

/// The numbers of a vector, which has `N`.
fn numbers<const N: usize>(vector: &[f64]) -> [f64; N] {
    std::array::from_fn(|i| vector[i])
}

/// A row per episode.
pub fn episodes() -> Table<EpisodeRow> {
    const COLUMNS: &[&dyn AnyColumn<EpisodeRow>] = &[
        &Column::named("episode_index", "", |it: &EpisodeRow, _| it.episode as u64),
        &Column::named("tasks", "", |it: &EpisodeRow, _| vec![it.task.clone()]),
        &Column::named("length", "", |it: &EpisodeRow, _| (it.to - it.from) as u64),
        &Column::named("data/chunk_index", "", |it: &EpisodeRow, _| it.chunk as u64),
        &Column::named("data/file_index", "", |it: &EpisodeRow, _| it.file as u64),
        &Column::named("dataset_from_index", "", |it: &EpisodeRow, _| it.from as u64),
        &Column::named("dataset_to_index", "", |it: &EpisodeRow, _| it.to as u64),
        &Column::named("meta/episodes/chunk_index", "", |_: &EpisodeRow, _| 0u64),
        &Column::named("meta/episodes/file_index", "", |_: &EpisodeRow, _| 0u64),
        &Column::named("trajectory_id", "", |it: &EpisodeRow, _| it.trajectory_id.clone()),
        &Column::named("expert_id", "", |it: &EpisodeRow, _| it.expert_id.clone()),
        &Column::named("split", "", |it: &EpisodeRow, _| it.split.clone()),
    ];
    Table::new("episodes", "", &[], |_: &EpisodeRow| 1, COLUMNS)
}

/// A row per task.
pub fn tasks() -> Table<TaskRow> {
    const COLUMNS: &[&dyn AnyColumn<TaskRow>] = &[
        &Column::named("task_index", "", |it: &TaskRow, _| it.index as u64),
        &Column::named("task", "", |it: &TaskRow, _| it.task.clone()),
    ];
    Table::new("tasks", "", &[], |_: &TaskRow| 1, COLUMNS)
}

/// Metadata for pandas: `task` is the index of the tasks. Without it, LeRobot shows numbers instead of tasks.
pub fn pandas_index() -> String {
    let column = |name: &str, kind: &str, numpy: &str| json!({"name": name, "field_name": name, "pandas_type": kind, "numpy_type": numpy, "metadata": null});
    json!({
        "index_columns": ["task"],
        "column_indexes": [{
            "name": null, "field_name": null, "pandas_type": "unicode", "numpy_type": "object",
            "metadata": {"encoding": "UTF-8"},
        }],
        "columns": [column("task_index", "int64", "int64"), column("task", "unicode", "object")],
        "creator": {"library": "cosfly", "version": env!("CARGO_PKG_VERSION")},
        "pandas_version": "2.2.0",
    })
    .to_string()
}
