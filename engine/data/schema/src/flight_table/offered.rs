//! Columns of a flight that plugins can read: one value per frame, and facts about the flight.

use super::{ColumnKind, DeclaredColumn, Values};
use crate::log::messages::edges_px;
use crate::{CaptionRecord, RenderedTrajectory, flight_labels};
use arrow_array::{Array, BooleanArray, Float64Array, Int64Array, RecordBatch, RecordBatchOptions};
use arrow_ipc::writer::StreamWriter;
use arrow_schema::{DataType, Field, Schema};
use cosfly_diagnose::nearest_name;
use cosfly_domain::Trajectory;
use serde_json::json;
use std::collections::BTreeMap;
use std::sync::Arc;

/// Columns of all flights.
const OF_FLIGHTS: [(&str, ColumnKind); 15] = [
    ("frame", ColumnKind::Integer),
    ("time_s", ColumnKind::Real),
    ("drone_x", ColumnKind::Real),
    ("drone_y", ColumnKind::Real),
    ("drone_z", ColumnKind::Real),
    ("drone_yaw", ColumnKind::Real),
    ("drone_pitch", ColumnKind::Real),
    ("drone_roll", ColumnKind::Real),
    ("target_x", ColumnKind::Real),
    ("target_y", ColumnKind::Real),
    ("target_z", ColumnKind::Real),
    ("target_heading", ColumnKind::Real),
    ("target_speed", ColumnKind::Real),
    ("visibility", ColumnKind::Real),
    ("clearance", ColumnKind::Real),
];
/// Columns of rendered flights only.
const OF_RENDERED: [(&str, ColumnKind); 11] = [
    ("camera_yaw", ColumnKind::Real),
    ("camera_pitch", ColumnKind::Real),
    ("camera_roll", ColumnKind::Real),
    ("in_view", ColumnKind::Boolean),
    ("visible_pixels", ColumnKind::Integer),
    ("visible_by_pixels", ColumnKind::Real),
    ("box_left", ColumnKind::Real),
    ("box_top", ColumnKind::Real),
    ("box_right", ColumnKind::Real),
    ("box_bottom", ColumnKind::Real),
    ("occluder_instance", ColumnKind::Integer),
];
/// Prefixes of columns whose names depend on earlier stages.
const OPEN: [&str; 2] = ["cost_", "label_"];
/// Number of frames of [`FlightColumns::sample`].
pub const SAMPLE_FRAMES: usize = 40;

/// A requested column that cannot be read.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct ColumnError {
    /// The problem, and the existing columns.
    pub message: String,
    /// Probably intended name.
    pub hint: Option<String>,
}

/// Checks that flights have the requested columns, as far as known before a flight exists: names of costs and labels
/// depend on earlier stages.
///
/// # Errors
/// The first column that does not exist or has another type.
pub fn check_names(wanted: &[DeclaredColumn], is_rendered: bool) -> Result<(), ColumnError> {
    let mut known: Vec<(&str, ColumnKind)> = OF_FLIGHTS.to_vec();
    if is_rendered {
        known.extend(OF_RENDERED);
    }
    let is_open = |column: &&DeclaredColumn| !OPEN.iter().any(|start| column.name.starts_with(start));
    for column in wanted.iter().filter(is_open) {
        find(&known, column).map_err(|refusal| match OF_RENDERED.iter().any(|(name, _)| *name == column.name) {
            true if !is_rendered => ColumnError {
                message: format!("it reads `{}`, which only rendered flights have", column.name),
                hint: Some("stages with `makes = \"extras\"` read rendered flights".to_owned()),
            },
            _ => refusal,
        })?;
    }
    for column in wanted.iter().filter(|column| !is_open(column)) {
        if column.kind != ColumnKind::Real {
            return Err(wrong_kind(column, ColumnKind::Real));
        }
    }
    Ok(())
}

fn wrong_kind(column: &DeclaredColumn, kind: ColumnKind) -> ColumnError {
    let message = format!("it reads `{}` as {}; it is {}", column.name, column.kind.name(), kind.name());
    ColumnError { message, hint: None }
}

/// Index of a column among the known ones.
fn find(known: &[(&str, ColumnKind)], column: &DeclaredColumn) -> Result<usize, ColumnError> {
    match known.iter().position(|(name, _)| *name == column.name) {
        Some(place) if known[place].1 == column.kind => Ok(place),
        Some(place) => Err(wrong_kind(column, known[place].1)),
        None => {
            let all: Vec<&str> = known.iter().map(|(name, _)| *name).collect();
            let near = nearest_name(&column.name, all.iter().copied());
            Err(ColumnError {
                message: format!(
                    "it reads `{}`; flights have no such column; their columns are `{}`",
                    column.name,
                    all.join("`, `")
                ),
                hint: near.map(|near| format!("did you mean `{near}`?")),
            })
        }
    }
}

/// All columns of a flight, and facts about it.
#[derive(Clone, Debug, PartialEq)]
pub struct FlightColumns {
    facts: Vec<(String, String)>,
    columns: Vec<(String, Values)>,
    frames: usize,
}

impl FlightColumns {
    /// Columns of a flight before rendering.
    pub fn of_flight(flight: &Trajectory, item: &str) -> Self {
        let frames = flight.track.len();
        let (poses, states) = (&flight.poses_in_world, &flight.track.states);
        let real = |of: &dyn Fn(usize) -> f64| Values::Reals((0..frames).map(of).collect());
        let values = [
            Values::Integers((0..frames as i64).collect()),
            real(&|k| k as f64 * flight.track.dt_s),
            real(&|k| poses[k].position_in_world.x),
            real(&|k| poses[k].position_in_world.y),
            real(&|k| poses[k].position_in_world.z),
            real(&|k| poses[k].yaw_rad),
            real(&|k| poses[k].pitch_rad),
            real(&|k| poses[k].roll_rad),
            real(&|k| states[k].feet_in_world.x),
            real(&|k| states[k].feet_in_world.y),
            real(&|k| states[k].feet_in_world.z),
            real(&|k| states[k].heading_rad),
            real(&|k| states[k].speed_mps),
            Values::Reals(flight.visibility.clone()),
            Values::Reals(flight.clearance_m.clone()),
        ];
        let mut columns = named(&OF_FLIGHTS, values.into());
        for term in flight_labels::costs(flight) {
            columns.push((format!("cost_{}", term.name), Values::Reals(term.per_frame.clone())));
        }
        for label in flight_labels::labels(flight) {
            columns.push((format!("label_{}", label.name), Values::Reals(label.per_frame.to_vec())));
        }
        let facts = vec![("item".to_owned(), item.to_owned()), ("dt_s".to_owned(), flight.track.dt_s.to_string())];
        Self { facts, columns, frames }
    }

    /// Columns of a rendered flight with its captions.
    pub fn of_rendered(record: &RenderedTrajectory, captions: &[CaptionRecord]) -> Self {
        let mut all = Self::of_flight(&record.trajectory, &record.trajectory_id);
        let views = &record.views;
        let cameras: Vec<_> = (0..record.len()).map(|frame| record.camera_pose(frame)).collect();
        let real = |of: &dyn Fn(usize) -> f64| Values::Reals((0..record.len()).map(of).collect());
        let edges = |k: usize| views[k].visible_box.as_ref().map_or([0; 4], edges_px);
        let values = [
            real(&|k| cameras[k].yaw_rad),
            real(&|k| cameras[k].pitch_rad),
            real(&|k| cameras[k].roll_rad),
            Values::Booleans(views.iter().map(|view| view.in_view).collect()),
            Values::Integers(views.iter().map(|view| i64::from(view.pixels)).collect()),
            real(&|k| views[k].visible_by_pixels),
            real(&|k| f64::from(edges(k)[0])),
            real(&|k| f64::from(edges(k)[1])),
            real(&|k| f64::from(edges(k)[2])),
            real(&|k| f64::from(edges(k)[3])),
            Values::Integers(views.iter().map(|view| i64::from(view.occluder_instance)).collect()),
        ];
        all.columns.extend(named(&OF_RENDERED, values.into()));
        let facts = [
            ("trajectory_id", record.trajectory_id.clone()),
            ("role", record.role.name().to_owned()),
            ("pedestrian_id", record.pedestrian_id.clone()),
            ("town", record.town.name.clone()),
            ("weather", record.weather.name.clone()),
            ("width", record.camera.width.to_string()),
            ("height", record.camera.height.to_string()),
            ("horizontal_fov_rad", record.camera.horizontal_fov_rad.to_string()),
        ];
        all.facts.extend(facts.map(|(name, value)| (name.to_owned(), value)));
        if !captions.is_empty() {
            let each = captions.iter();
            let list: serde_json::Value =
                each.map(|it| json!({"language": it.language, "style": it.style, "text": it.text})).collect();
            all.facts.push(("captions".to_owned(), list.to_string()));
        }
        all
    }

    /// A synthetic flight for trying stages: a straight trajectory past a standing target that is occluded for a while.
    pub fn sample() -> Self {
        let frames = SAMPLE_FRAMES;
        let of_frame = |name: &str, k: f64| match name {
            "time_s" => 0.5 * k,
            "drone_x" => 20.0 - k,
            "drone_y" => 10.0,
            "drone_z" => 20.0,
            "drone_pitch" | "camera_pitch" => -0.7,
            "visibility" | "visible_by_pixels" if !(20.0..25.0).contains(&k) => 1.0,
            "clearance" => 5.0,
            "box_left" | "box_top" => 30.0,
            "box_right" | "box_bottom" => 40.0,
            "cost_tracking" => 0.1 * k,
            _ => 0.0,
        };
        let column = |(name, kind): (&str, ColumnKind)| {
            let each = (0..frames).map(|k| k as f64);
            let values = match kind {
                ColumnKind::Integer if name == "frame" => Values::Integers((0..frames as i64).collect()),
                ColumnKind::Integer => Values::Integers(each.map(|k| 7 * (k as i64 % 2)).collect()),
                ColumnKind::Boolean => Values::Booleans(each.map(|k| k < 38.0).collect()),
                _ => Values::Reals(each.map(|k| of_frame(name, k)).collect()),
            };
            (name.to_owned(), values)
        };
        let all = OF_FLIGHTS.into_iter().chain([("cost_tracking", ColumnKind::Real)]).chain(OF_RENDERED);
        let facts = [
            ("item", "sample"),
            ("dt_s", "0.5"),
            ("trajectory_id", "expert-p00000"),
            ("role", "expert"),
            ("pedestrian_id", "p00000"),
            ("town", "sample"),
            ("weather", "ClearNoon"),
            ("width", "640"),
            ("height", "360"),
            ("horizontal_fov_rad", "1.5708"),
        ];
        let facts = facts.map(|(name, value)| (name.to_owned(), value.to_owned())).into();
        Self { facts, columns: all.map(column).collect(), frames }
    }

    /// Encodes the requested columns as an Arrow stream, in their order.
    ///
    /// # Errors
    /// The first column that does not exist.
    pub fn encode(&self, wanted: &[DeclaredColumn]) -> Result<Vec<u8>, ColumnError> {
        let known: Vec<(&str, ColumnKind)> =
            self.columns.iter().map(|(name, values)| (name.as_str(), values.kind())).collect();
        let places = wanted.iter().map(|column| find(&known, column)).collect::<Result<Vec<_>, _>>()?;
        let columns = places.into_iter().map(|place| &self.columns[place]);
        self.stream(columns)
            .map_err(|error| ColumnError { message: format!("the table cannot be built: {error}"), hint: None })
    }

    fn stream<'a>(
        &self,
        columns: impl Iterator<Item = &'a (String, Values)>,
    ) -> Result<Vec<u8>, arrow_schema::ArrowError> {
        let (mut fields, mut arrays): (Vec<Field>, Vec<Arc<dyn Array>>) = (vec![], vec![]);
        for (name, values) in columns {
            let (kind, array): (DataType, Arc<dyn Array>) = match values {
                Values::Integers(values) => (DataType::Int64, Arc::new(Int64Array::from(values.clone()))),
                Values::Booleans(values) => (DataType::Boolean, Arc::new(BooleanArray::from(values.clone()))),
                Values::Reals(values) => (DataType::Float64, Arc::new(Float64Array::from(values.clone()))),
                Values::Texts(_) | Values::Bytes(_) => continue,
            };
            fields.push(Field::new(name, kind, false));
            arrays.push(array);
        }
        let schema =
            Arc::new(Schema::new(fields).with_metadata(self.facts.iter().cloned().collect::<BTreeMap<_, _>>()));
        // A stage may read no column at all.
        let options = RecordBatchOptions::new().with_row_count(Some(self.frames));
        let batch = RecordBatch::try_new_with_options(Arc::clone(&schema), arrays, &options)?;
        let mut writer = StreamWriter::try_new(Vec::new(), &schema)?;
        writer.write(&batch)?;
        writer.finish()?;
        writer.into_inner()
    }
}

fn named(names: &[(&str, ColumnKind)], values: Vec<Values>) -> Vec<(String, Values)> {
    names.iter().zip(values).map(|((name, _), values)| ((*name).to_owned(), values)).collect()
}
