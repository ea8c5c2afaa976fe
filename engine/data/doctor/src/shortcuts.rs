//! Shortcuts to the targets of a dataset of cosfly: their place and size in the picture, and their looks.

use cosfly_diagnose::Result;
use cosfly_domain::TARGET_INSTANCE;
use cosfly_frames::{DVec3, Pose};
use cosfly_metrics::shortcuts::{Looks, Seen, ShortcutFigures, Shortcuts};
use cosfly_read::{PublishedDataset, PublishedFlight, SeenBody, SightingReader};
use cosfly_schema::tables::{Bodies, Trajectories};

/// Figures over all flights; experts alone count for places in the picture. Datasets from before the columns of clothes existed
/// have figures of places alone.
///
/// # Errors
/// Damage of the tables.
pub fn figures(dataset: &PublishedDataset) -> Result<ShortcutFigures> {
    let mut shortcuts = Shortcuts::default();
    add_targets(dataset, &mut shortcuts)?;
    add_others(dataset, &mut shortcuts)?;
    let mut sightings = SightingReader::of(dataset)?;
    dataset.walk(&|flight| flight.expert_id.is_none(), &mut |flight, rows| {
        let image_px = [flight.camera.width, flight.camera.height].map(f64::from);
        let bodies = dataset.place(&flight.trajectory_id).map_or(Ok(&[][..]), |place| sightings.at(dataset, place))?;
        let frames = (0..).zip(rows).filter_map(|(frame, row)| {
            let seen = |body: &SeenBody| seen(body, flight, &row.camera_pose);
            let own = SeenBody {
                frame,
                instance: TARGET_INSTANCE,
                kind: flight.target_kind.clone()?,
                feet_in_world: row.target.feet_in_world,
                height_m: flight.target_height_m,
                visible_box_px: row.visible_box_px?,
            };
            let start = bodies.partition_point(|other| other.frame < frame);
            let others = bodies[start..].iter().take_while(|other| other.frame == frame);
            Some((seen(&own), others.filter(|other| other.kind == own.kind).map(seen).collect()))
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

/// Kind of people.
const PERSON: &str = "pedestrian";

/// A body as the camera sees it; crown and feet of people only.
fn seen(body: &SeenBody, flight: &PublishedFlight, camera_pose: &Pose) -> Seen {
    // Rows of a wide lens are angles.
    let is_person = body.kind == PERSON && !flight.lens.is_wide(&flight.camera);
    let row = |point| flight.camera.project(camera_pose, point).filter(|_| is_person).map(|(_, row, _)| row);
    let crown = row(body.feet_in_world + body.height_m * DVec3::Z);
    Seen {
        edges_px: body.visible_box_px.map(f64::from),
        crown_and_feet_px: crown.zip(row(body.feet_in_world)).map(|(crown, feet)| [crown, feet]),
        distance_m: (body.feet_in_world - camera_pose.position_in_world).length(),
        height_m: body.height_m,
    }
}
