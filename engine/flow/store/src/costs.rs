//! Measured time of tasks on this machine, by stage, for predictions. No key and no output depends on it.

use crate::fault::PublishStep;
use crate::store::Store;
use cosfly_diagnose::Result;
use cosfly_fingerprint::Digest;
use serde::{Deserialize, Serialize};
use std::fs;
use std::path::PathBuf;

/// Items after which older ones count half.
const REMEMBERED: u64 = 10_000;

/// Measured tasks.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Costs {
    /// Number of tasks.
    pub items: u64,
    /// Time of all of them on one core each, seconds.
    pub seconds: f64,
}

impl Costs {
    /// Time of a task, seconds; `None` without a measurement.
    pub fn per_item_s(&self) -> Option<f64> {
        (self.items > 0 && self.seconds.is_finite() && self.seconds >= 0.0).then(|| self.seconds / self.items as f64)
    }

    fn add(&mut self, other: &Self) {
        while self.items > REMEMBERED {
            self.items /= 2;
            self.seconds *= 0.5;
        }
        self.items += other.items;
        self.seconds += other.seconds;
    }
}

impl Store {
    /// Measured tasks of a stage: with exactly this definition, else of the same kind, such as `render` or `dataset.logs`.
    pub fn costs(&self, definition: &Digest, kind: &str) -> Costs {
        let read = |path| serde_json::from_slice(&fs::read(path).ok()?).ok();
        let own: Option<Costs> = read(self.costs_path(&definition.to_string()));
        own.or_else(|| read(self.costs_path(kind))).unwrap_or_default()
    }

    /// Adds measured tasks of a stage.
    ///
    /// # Errors
    /// `machine-io`.
    pub fn add_costs(&self, definition: &Digest, kind: &str, costs: &Costs) -> Result<()> {
        for name in [&definition.to_string(), kind] {
            let path = self.costs_path(name);
            let known = fs::read(&path).ok().and_then(|bytes| serde_json::from_slice(&bytes).ok());
            let mut sum: Costs = known.unwrap_or_default();
            sum.add(costs);
            let text = serde_json::to_string(&sum).unwrap_or_default();
            self.write_file(&path, text.as_bytes(), PublishStep::WriteRun, PublishStep::RenameRun)?;
        }
        Ok(())
    }

    fn costs_path(&self, name: &str) -> PathBuf {
        self.layout.folder("costs").join(name)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn costs_of_a_definition_come_first_and_those_of_its_kind_next() {
        let root = tempfile::tempdir().unwrap();
        let store = Store::open(root.path()).unwrap();
        let [one, other] = ["one", "other"].map(|text| Digest::of(text.as_bytes()));
        assert_eq!(store.costs(&one, "render").per_item_s(), None);
        store.add_costs(&one, "render", &Costs { items: 4, seconds: 8.0 }).unwrap();
        store.add_costs(&other, "render", &Costs { items: 4, seconds: 32.0 }).unwrap();
        let unknown = Digest::of(b"unknown");
        let per_item = [one, other, unknown].map(|definition| store.costs(&definition, "render").per_item_s());
        assert_eq!(per_item, [Some(2.0), Some(8.0), Some(5.0)]);
        fs::write(root.path().join("costs/render"), "{").unwrap();
        assert_eq!(store.costs(&unknown, "render").per_item_s(), None);
    }
}
