//! Table `people`: everybody beside the target who is seen, frame by frame.

use super::{Column, DatasetItem, Kind, Table};
use crate::mcap_log::messages::edges_px;
use crate::{OtherPerson, Sighting};

/// The table.
pub fn table() -> Table<DatasetItem> {
    Table {
        name: "people",
        doc: "Everybody beside the target of whom a frame shows at least one pixel; empty where nobody else is about.",
        key: &["trajectory_id", "frame", "instance"],
        rows: |item| item.record.sightings.len(),
        per_frame: true,
        rows_per_group: 50_000,
        reads_previews: false,
        reads_expert: false,
        columns: vec![
            Column::new("trajectory_id", Kind::Text, "the flight", |item, _| (&item.record.trajectory_id).into()),
            Column::new("frame", Kind::Integer, "the frame", |item, i| sighting(item, i).frame.into()),
            Column::new(
                "instance",
                Kind::Integer,
                "id in instance images and in `frames.occluder_instance`: greater than those of all objects",
                |item, i| person(item, i).instance.into(),
            ),
            Column::new(
                "walk_id",
                Kind::Text,
                "stage and item of the walk; the same person in all flights",
                |item, i| (&person(item, i).walk_id).into(),
            ),
            Column::new(
                "feet_in_world_m",
                Kind::Reals(3),
                "ground point between the feet, CARLA's frame",
                |item, i| sighting(item, i).state.feet_in_world.into(),
            ),
            Column::new("heading_deg", Kind::Real, "walking direction, positive: x towards y", |item, i| {
                sighting(item, i).state.heading_rad.to_degrees().into()
            }),
            Column::new("speed_mps", Kind::Real, "speed along the ground; 0 while standing", |item, i| {
                sighting(item, i).state.speed_mps.into()
            }),
            Column::new("height_m", Kind::Real, "height of the body", |item, i| person(item, i).height_m.into()),
            Column::new("radius_m", Kind::Real, "radius of the body seen from above", |item, i| {
                person(item, i).radius_m.into()
            }),
            Column::new("visible_pixels", Kind::Integer, "visible pixels", |item, i| {
                sighting(item, i).view.pixels.into()
            }),
            Column::new(
                "visible_box_px",
                Kind::Box,
                "left, top, right, bottom edges around the visible pixels",
                |item, i| edges_px(&sighting(item, i).view.visible_box).map(|edge| edge as f32).into(),
            ),
        ],
    }
}

fn sighting(item: &DatasetItem, i: usize) -> &Sighting {
    &item.record.sightings[i]
}

fn person(item: &DatasetItem, i: usize) -> &OtherPerson {
    &item.record.others[sighting(item, i).person as usize]
}
