//! The Parquet tables: one file per table, one list of them, and their common types.
//!
//! To add a table over the trajectories, write its file and add two lines below: its `mod` and its entry in
//! [`of_trajectories`]. Writer, checks, card, `croissant.json` and reference page follow from its columns.

mod arrow_schema;
mod bodies;
mod bodies_3d;
mod body_row;
mod captions;
mod column;
mod crossings;
mod files;
mod frames;
mod goals;
mod objects;
mod pairs;
mod phrases;
mod rejected;
mod table;
mod target_losses;
mod trajectories;
mod value;
mod waypoints;
mod windows;

pub use arrow_schema::{hugging_face_features, schema};
pub use bodies::Bodies;
pub use bodies_3d::Bodies3d;
pub use body_row::BodyRow;
pub use captions::Captions;
pub use column::{AnyColumn, CellProblem, Column};
pub use crossings::Crossings;
pub use files::{FileRecord, Files};
pub use frames::{Frames, ROLES};
pub use goals::Goals;
pub use objects::{ObjectRecord, Objects, kind_name};
pub use pairs::Pairs;
pub use phrases::Phrases;
pub use rejected::Rejected;
pub use table::{CrossingRow, DatasetItem, Derived, GoalRow, INLINE_SETS, Membership, Need, PhraseRow, Table};
pub use target_losses::TargetLosses;
pub use trajectories::{Trajectories, WEATHER_NUMBERS, WeatherNumber};
pub use value::{Edges, ImageFile, Kind, Value};
pub use waypoints::Waypoints;
pub use windows::{DIFFICULTIES, SCENES, SceneMembership, Windows};

/// Tables over the trajectories, in the order of the card.
pub fn of_trajectories() -> Vec<Table<DatasetItem>> {
    vec![
        trajectories::table(),
        frames::table(),
        waypoints::table(),
        captions::table(),
        pairs::table(),
        bodies::table(),
        bodies_3d::table(),
        target_losses::table(),
        phrases::table(),
        goals::table(),
        crossings::table(),
        windows::table(),
    ]
}

/// Table of items without a trajectory.
pub fn of_rejections() -> Table<crate::Rejection> {
    rejected::table()
}

/// Table of the objects behind instance ids.
pub fn of_objects() -> Table<ObjectRecord> {
    objects::table()
}

/// Table of all files with their hashes.
pub fn of_files() -> Table<FileRecord> {
    files::table()
}
