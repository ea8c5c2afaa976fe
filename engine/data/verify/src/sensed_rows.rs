//! [`SensedRows`]: the readings of a sensor along one flight, as its table has them.

use arrow_array::RecordBatch;
use arrow_array::cast::AsArray;
use arrow_array::types::{Float64Type, Int64Type};
use cosfly_frames::{DQuat, DVec3};
use std::collections::BTreeMap;

/// Readings of a sensor along one flight.
#[derive(Clone, Debug, Default)]
pub struct SensedRows {
    /// Frame of each.
    pub frames: Vec<i64>,
    /// Time of each after the first frame, seconds.
    pub times_s: Vec<f64>,
    /// Numbers by the name of their column.
    pub numbers: BTreeMap<String, Vec<f64>>,
}

impl SensedRows {
    /// Adds the rows of a batch.
    pub fn push(&mut self, batch: &RecordBatch) {
        for (field, column) in batch.schema().fields().iter().zip(batch.columns()) {
            if let Some(values) = column.as_primitive_opt::<Float64Type>() {
                let list = match field.name().as_str() {
                    "time_s" => &mut self.times_s,
                    name => self.numbers.entry(name.to_owned()).or_default(),
                };
                list.extend_from_slice(values.values());
            } else if let (Some(values), "frame") = (column.as_primitive_opt::<Int64Type>(), field.name().as_str()) {
                self.frames.extend_from_slice(values.values());
            }
        }
    }

    /// Time between readings, seconds.
    pub fn step_s(&self) -> f64 {
        self.times_s.get(1).copied().unwrap_or_default()
    }

    /// Vectors of three columns, where they are there.
    pub fn vectors(&self, names: [&str; 3]) -> Option<Vec<DVec3>> {
        let [x, y, z] = names.map(|name| self.numbers.get(name));
        let (x, y, z) = (x?, y?, z?);
        Some((0..x.len()).map(|row| DVec3::new(x[row], y[row], z[row])).collect())
    }

    /// Turns of the sensor into the world.
    pub fn quaternions(&self) -> Option<Vec<DQuat>> {
        let [x, y, z, w] = ["true_qx", "true_qy", "true_qz", "true_qw"].map(|name| self.numbers.get(name));
        let (x, y, z, w) = (x?, y?, z?, w?);
        Some((0..x.len()).map(|row| DQuat::from_xyzw(x[row], y[row], z[row], w[row]).normalize()).collect())
    }
}
