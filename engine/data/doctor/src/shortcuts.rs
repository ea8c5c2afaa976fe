//! Shortcuts to the targets of a dataset of cosfly: their place and size in the picture, and their looks.

use cosfly_diagnose::Result;
use cosfly_frames::{DVec3, Pose};
use cosfly_metrics::shortcuts::{Edges, Looks, Seen, ShortcutFigures, Shortcuts};
use cosfly_read::{PublishedDataset, PublishedFlight, RowIndex};
use cosfly_schema::tables::{Bodies, Trajectories};
use std::collections::BTreeMap;

/// Figures over all flights; experts alone count for places in the picture. Datasets from before the columns of clothes existed
/// have figures of places alone.
///
/// # Errors
/// Damage of the tables.
pub fn figures(dataset: &PublishedDataset) -> Result<ShortcutFigures> {
    let mut shortcuts = Shortcuts::default();
    add_targets(dataset, &mut shortcuts)?;
    add_others(dataset, &mut shortcuts)?;
    let mut boxes = BodyBoxes::of(dataset)?;
    dataset.walk(&|flight| flight.expert_id.is_none(), &mut |flight, rows| {
        let image_px = [flight.camera.width, flight.camera.height].map(f64::from);
        let mut bodies = boxes.bodies(flight)?;
        let frames = rows.iter().enumerate().filter_map(|(frame, row)| {
            let seen = |body: &SeenBody| body.seen(flight, &row.camera_pose);
            let own = SeenBody {
                kind: flight.target_kind.clone()?,
                edges_px: row.visible_box_px?.map(f64::from),
                feet_in_world: row.target.feet_in_world,
                height_m: flight.target_height_m,
            };
            let others = bodies.remove(&(frame as u32)).unwrap_or_default();
            Some((seen(&own), others.iter().filter(|other| other.kind == own.kind).map(seen).collect()))
        });
        shortcuts.add_flight(image_px, frames);
        Ok(())
    })?;
    Ok(shortcuts.figures())
}

/// Looks of the people who are followed; the paint of vehicles is no clothes.
fn add_targets(dataset: &PublishedDataset, shortcuts: &mut Shortcuts) -> Result<()> {
    for (_, path) in dataset.files("trajectories")? {
        cosfly_read::read(&path, &mut |rows| {
            for row in 0..rows.len() {
                let kind = rows.get_or(Trajectories::target_kind, row, Some(PERSON.to_owned()))?;
                let top = rows.get_or(Trajectories::target_top_linear_rgb, row, None)?;
                let Some(top) = top.filter(|_| kind.as_deref() == Some(PERSON)) else { continue };
                let id = rows.get(Trajectories::trajectory_id, row)?;
                let pedestrian = rows.get(Trajectories::pedestrian_id, row)?;
                let words = [
                    rows.get_or(Trajectories::target_bag, row, None)?,
                    rows.get_or(Trajectories::target_build, row, None)?,
                    rows.get_or(Trajectories::target_gait, row, None)?,
                ];
                let looks = looks(top, rows.get(Trajectories::target_height_m, row)?, words);
                shortcuts.add_target(&format!("{} {pedestrian}", town(dataset, &id)), looks);
            }
            Ok(())
        })?;
    }
    Ok(())
}

/// Looks of the people who are seen.
fn add_others(dataset: &PublishedDataset, shortcuts: &mut Shortcuts) -> Result<()> {
    for (_, path) in dataset.files("bodies")? {
        cosfly_read::read(&path, &mut |rows| {
            for row in 0..rows.len() {
                let is_seen = rows.get(Bodies::visible_pixels, row)? > 0;
                let Some(top) = rows.get(Bodies::top_linear_rgb, row)?.filter(|_| is_seen) else { continue };
                if rows.get(Bodies::kind, row)? == PERSON {
                    let id = rows.get(Bodies::trajectory_id, row)?;
                    let words =
                        [rows.get(Bodies::bag, row)?, rows.get(Bodies::build, row)?, rows.get(Bodies::gait, row)?];
                    let [.., height_m] = rows.get(Bodies::size_m, row)?;
                    let body = format!("{} {}", town(dataset, &id), rows.get(Bodies::body_id, row)?);
                    shortcuts.add_other(&body, looks(top, height_m, words));
                }
            }
            Ok(())
        })?;
    }
    Ok(())
}

fn town<'a>(dataset: &'a PublishedDataset, trajectory_id: &str) -> &'a str {
    dataset.place(trajectory_id).map_or("", |place| &dataset.flights()[place].town)
}

fn looks(top: [f64; 3], height_m: f64, words: [Option<String>; 3]) -> Looks {
    let [bag, build, gait] = words.map(Option::unwrap_or_default);
    let bag = if bag.is_empty() { "none".to_owned() } else { bag };
    Looks::of_words(top, height_m, [&bag, &build, &gait])
}

/// Bodies that are seen, by frame.
type SeenBodies = BTreeMap<u32, Vec<SeenBody>>;

/// Kind of people.
const PERSON: &str = "pedestrian";

/// A body that is seen in a frame.
struct SeenBody {
    kind: String,
    edges_px: Edges,
    feet_in_world: DVec3,
    height_m: f64,
}

impl SeenBody {
    /// The body as the camera sees it; crown and feet of people only.
    fn seen(&self, flight: &PublishedFlight, camera_pose: &Pose) -> Seen {
        let is_person = self.kind == PERSON;
        let row = |point| flight.camera.project(camera_pose, point).filter(|_| is_person).map(|(_, row, _)| row);
        let crown = row(self.feet_in_world + self.height_m * DVec3::Z);
        Seen {
            edges_px: self.edges_px,
            crown_and_feet_px: crown.zip(row(self.feet_in_world)).map(|(crown, feet)| [crown, feet]),
            distance_m: (self.feet_in_world - camera_pose.position_in_world).length(),
            height_m: self.height_m,
        }
    }
}

/// Bodies that are seen, flight by flight; those of neighbouring flights are read together.
struct BodyBoxes<'a> {
    dataset: &'a PublishedDataset,
    index: RowIndex,
    known: BTreeMap<usize, SeenBodies>,
}

impl<'a> BodyBoxes<'a> {
    fn of(dataset: &'a PublishedDataset) -> Result<Self> {
        Ok(Self { dataset, index: dataset.row_index("bodies")?, known: BTreeMap::new() })
    }

    fn bodies(&mut self, flight: &PublishedFlight) -> Result<SeenBodies> {
        let Some(place) = self.dataset.place(&flight.trajectory_id).filter(|it| self.index.has(*it)) else {
            return Ok(SeenBodies::new());
        };
        if !self.known.contains_key(&place) {
            let wanted = self.index.beside(place);
            let mut known: BTreeMap<usize, SeenBodies> = BTreeMap::new();
            self.index.visit(&wanted, &mut |rows, _| {
                let ids = rows.values(Bodies::trajectory_id)?;
                let (frames, edges) = (rows.values(Bodies::frame)?, rows.values(Bodies::visible_box_px)?);
                let (feet, sizes) = (rows.values(Bodies::feet_in_world_m)?, rows.values(Bodies::size_m)?);
                for row in 0..rows.len() {
                    let Some(place) = self.dataset.place(ids.text(row)).filter(|it| wanted.contains(it)) else {
                        continue;
                    };
                    let Some(edges_px) = edges.at(row)? else { continue };
                    let [.., height_m] = sizes.at(row)?;
                    let of_frame = known.entry(place).or_default().entry(frames.at(row)?).or_default();
                    of_frame.push(SeenBody {
                        kind: rows.get(Bodies::kind, row)?,
                        edges_px: edges_px.map(f64::from),
                        feet_in_world: DVec3::from_array(feet.at(row)?),
                        height_m,
                    });
                }
                Ok(())
            })?;
            self.known = known;
        }
        Ok(self.known.remove(&place).unwrap_or_default())
    }
}
