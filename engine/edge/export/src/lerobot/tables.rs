//! The three tables of LeRobot v3.0: frames, episodes, tasks.

use cosfly_dataset::tables::{Cell, Column, Kind, Table};
use serde_json::json;

/// Name of the pictures' feature.
pub const PICTURE: &str = "observation.images.rgb";
/// Names of the features that are vectors, and of their parts.
pub const VECTORS: [(&str, &[&str]); 4] = [
    ("observation.state", &["x", "y", "z", "pitch", "yaw", "roll"]),
    ("observation.target", &["x", "y", "z"]),
    ("observation.box", &["left", "top", "right", "bottom"]),
    ("action", &["dx", "dy", "dz", "dpitch", "dyaw", "droll"]),
];

/// The frames of an episode.
#[derive(Default)]
pub struct DataRows {
    /// Number of the episode.
    pub number: usize,
    /// Number of its first frame in the whole dataset.
    pub first: usize,
    /// Number of its task.
    pub task: usize,
    /// Seconds between frames.
    pub dt_s: f64,
    /// [`VECTORS`] of every frame.
    pub vectors: Vec<[Vec<f64>; 4]>,
    /// Picture files.
    pub pictures: Vec<Vec<u8>>,
}

/// An episode.
pub struct EpisodeRow {
    /// The flight.
    pub trajectory_id: String,
    /// The flight to whose next pose its actions lead; empty for an expert.
    pub expert_id: String,
    /// Its split.
    pub split: String,
    /// Its number.
    pub episode: usize,
    /// Its task.
    pub task: String,
    /// First frame in the whole dataset.
    pub from: usize,
    /// Behind the last one.
    pub to: usize,
    /// Folder of its file.
    pub chunk: usize,
    /// Its file.
    pub file: usize,
}

/// A task.
pub struct TaskRow {
    /// Its number.
    pub index: usize,
    /// What to do.
    pub task: String,
}

fn table<S>(name: &'static str, rows: fn(&S) -> usize, rows_per_group: usize, columns: Vec<Column<S>>) -> Table<S> {
    Table {
        name,
        doc: "",
        key: &[],
        rows,
        per_frame: false,
        rows_per_group,
        reads_previews: false,
        reads_expert: false,
        columns,
    }
}

/// A row per frame.
pub fn data() -> Table<DataRows> {
    let columns = vec![
        Column::new(PICTURE, Kind::Image, "", |it: &DataRows, i| Cell::Image(it.pictures[i].clone())),
        Column::new(VECTORS[0].0, Kind::Reals(6), "", |it, i| it.vectors[i][0].clone().into()),
        Column::new(VECTORS[1].0, Kind::Reals(3), "", |it, i| it.vectors[i][1].clone().into()),
        Column::new(VECTORS[2].0, Kind::Reals(4), "", |it, i| it.vectors[i][2].clone().into()),
        Column::new(VECTORS[3].0, Kind::Reals(6), "", |it, i| it.vectors[i][3].clone().into()),
        Column::new("timestamp", Kind::Real, "", |it, i| (i as f64 * it.dt_s).into()),
        Column::new("frame_index", Kind::Integer, "", |_, i| i.into()),
        Column::new("episode_index", Kind::Integer, "", |it, _| it.number.into()),
        Column::new("index", Kind::Integer, "", |it, i| (it.first + i).into()),
        Column::new("task_index", Kind::Integer, "", |it, _| it.task.into()),
    ];
    table("data", |it| it.pictures.len(), 200, columns)
}

/// A row per episode.
pub fn episodes() -> Table<EpisodeRow> {
    let columns = vec![
        Column::new("episode_index", Kind::Integer, "", |it: &EpisodeRow, _| it.episode.into()),
        Column::new("tasks", Kind::TextList, "", |it, _| vec![it.task.clone()].into()),
        Column::new("length", Kind::Integer, "", |it, _| (it.to - it.from).into()),
        Column::new("data/chunk_index", Kind::Integer, "", |it, _| it.chunk.into()),
        Column::new("data/file_index", Kind::Integer, "", |it, _| it.file.into()),
        Column::new("dataset_from_index", Kind::Integer, "", |it, _| it.from.into()),
        Column::new("dataset_to_index", Kind::Integer, "", |it, _| it.to.into()),
        Column::new("meta/episodes/chunk_index", Kind::Integer, "", |_, _| 0usize.into()),
        Column::new("meta/episodes/file_index", Kind::Integer, "", |_, _| 0usize.into()),
        Column::new("trajectory_id", Kind::Text, "", |it, _| (&it.trajectory_id).into()),
        Column::new("expert_id", Kind::Text, "", |it, _| (&it.expert_id).into()),
        Column::new("split", Kind::Text, "", |it, _| (&it.split).into()),
    ];
    table("episodes", |_| 1, 50_000, columns)
}

/// A row per task.
pub fn tasks() -> Table<TaskRow> {
    let columns = vec![
        Column::new("task_index", Kind::Integer, "", |it: &TaskRow, _| it.index.into()),
        Column::new("task", Kind::Text, "", |it, _| (&it.task).into()),
    ];
    table("tasks", |_| 1, 50_000, columns)
}

/// What tells pandas that `task` is the index of the tasks, without which LeRobot shows numbers instead of tasks.
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
