//! What gives the targets of a dataset of cosfly away: their place in the picture, and their clothes.

use cosfly_diagnose::Result;
use cosfly_metrics::shortcuts::{Edges, ShortcutFigures, Shortcuts};
use cosfly_read::{PublishedDataset, PublishedFlight, RowIndex};
use cosfly_schema::tables::{People, Trajectories};
use std::collections::BTreeMap;

/// Figures over all flights; experts alone count for places in the picture. Datasets from before the columns of clothes existed
/// have figures of places alone.
///
/// # Errors
/// Damage of the tables.
pub fn figures(dataset: &PublishedDataset) -> Result<ShortcutFigures> {
    let mut shortcuts = Shortcuts::default();
    let town = |id: &str| dataset.place(id).map_or("", |place| &dataset.flights()[place].town);
    for (_, path) in dataset.files("trajectories")? {
        cosfly_read::read(&path, &mut |rows| {
            for row in 0..rows.len() {
                if let Some(top) = rows.get_or(Trajectories::target_top_linear_rgb, row, None)? {
                    let id = rows.get(Trajectories::trajectory_id, row)?;
                    shortcuts
                        .add_target(&format!("{} {}", town(&id), rows.get(Trajectories::pedestrian_id, row)?), top);
                }
            }
            Ok(())
        })?;
    }
    for (_, path) in dataset.files("people")? {
        cosfly_read::read(&path, &mut |rows| {
            for row in 0..rows.len() {
                let is_person = rows.get_or(People::kind, row, PERSON.to_owned())? == PERSON;
                if is_person && rows.has(People::top_linear_rgb) {
                    let id = rows.get(People::trajectory_id, row)?;
                    let walk = format!("{} {}", town(&id), rows.get(People::walk_id, row)?);
                    shortcuts.add_other(&walk, rows.get(People::top_linear_rgb, row)?);
                }
            }
            Ok(())
        })?;
    }
    let mut people = PeopleBoxes::of(dataset)?;
    dataset.walk(&|flight| flight.expert_id.is_none(), &mut |flight, rows| {
        let image_px = [flight.camera.width, flight.camera.height].map(f64::from);
        let boxes = people.boxes(flight)?;
        for (frame, row) in rows.iter().enumerate() {
            if let Some(target) = row.visible_box_px {
                let others = boxes.get(&(frame as u32)).into_iter().flatten();
                let alike = others.filter(|other| flight.target_kind.as_ref() == Some(&other.0)).map(|other| other.1);
                shortcuts.add_frame(image_px, target.map(f64::from), alike);
            }
        }
        Ok(())
    })?;
    Ok(shortcuts.figures())
}

/// Kinds and boxes of bodies by frame.
type Boxes = BTreeMap<u32, Vec<(String, Edges)>>;

/// Kind of people, and of all bodies in tables without kinds.
const PERSON: &str = "pedestrian";

/// Boxes of people, flight by flight; those of neighbouring flights are read together.
struct PeopleBoxes<'a> {
    dataset: &'a PublishedDataset,
    index: RowIndex,
    known: BTreeMap<usize, Boxes>,
}

impl<'a> PeopleBoxes<'a> {
    fn of(dataset: &'a PublishedDataset) -> Result<Self> {
        Ok(Self { dataset, index: dataset.row_index("people")?, known: BTreeMap::new() })
    }

    fn boxes(&mut self, flight: &PublishedFlight) -> Result<Boxes> {
        let Some(place) = self.dataset.place(&flight.trajectory_id).filter(|it| self.index.has(*it)) else {
            return Ok(Boxes::new());
        };
        if !self.known.contains_key(&place) {
            let wanted = self.index.beside(place);
            let mut known: BTreeMap<usize, Boxes> = BTreeMap::new();
            self.index.visit(&wanted, &mut |rows, _| {
                let ids = rows.values(People::trajectory_id)?;
                let (frames, edges) = (rows.values(People::frame)?, rows.values(People::visible_box_px)?);
                for row in 0..rows.len() {
                    let Some(place) = self.dataset.place(ids.text(row)).filter(|it| wanted.contains(it)) else {
                        continue;
                    };
                    let of_frame = known.entry(place).or_default().entry(frames.at(row)?).or_default();
                    let kind = rows.get_or(People::kind, row, PERSON.to_owned())?;
                    of_frame.push((kind, edges.at(row)?.map(f64::from)));
                }
                Ok(())
            })?;
            self.known = known;
        }
        Ok(self.known.remove(&place).unwrap_or_default())
    }
}
