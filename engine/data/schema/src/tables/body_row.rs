//! [`BodyRow`]: a row of table `bodies`.

use crate::RenderedTrajectory;
use cosfly_domain::Traffic;
use std::collections::BTreeMap;

/// A row of the table: a body in a frame.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct BodyRow {
    /// Number of the frame.
    pub frame: u32,
    /// Id of the body.
    pub body_id: String,
    /// Place in [`RenderedTrajectory::others`]; `None` for a body that no picture can show.
    pub(super) other: Option<u32>,
    /// Place in [`RenderedTrajectory::sightings`]; `None` in frames that do not show the body.
    pub(super) sighting: Option<u32>,
    /// Place in [`RenderedTrajectory::around`]; `None` outside of traffic, and far from the target.
    pub(super) around: Option<u32>,
}

impl BodyRow {
    /// All rows of a flight, by frame and id of the body.
    pub fn all(record: &RenderedTrajectory) -> Vec<Self> {
        let places: BTreeMap<&str, u32> = record.others.iter().map(|it| it.body_id.as_str()).zip(0..).collect();
        let name = &record.around.traffic.name;
        let near: Vec<String> = record.around.numbers.iter().map(|number| Traffic::body_id(name, *number)).collect();
        let mut rows: BTreeMap<(u32, &str), Self> = BTreeMap::new();
        for (frame, place) in record.around.present() {
            let id = near[place as usize].as_str();
            let row = Self { around: Some(place), ..Self::new(frame, id, places.get(id).copied()) };
            rows.insert((frame, id), row);
        }
        for (sighting, seen) in (0..).zip(&record.sightings) {
            let id = record.others[seen.other as usize].body_id.as_str();
            let row = rows.entry((seen.frame, id)).or_insert_with(|| Self::new(seen.frame, id, Some(seen.other)));
            row.sighting = Some(sighting);
        }
        rows.into_values().collect()
    }

    fn new(frame: u32, body_id: &str, other: Option<u32>) -> Self {
        Self { frame, body_id: body_id.to_owned(), other, sighting: None, around: None }
    }
}
