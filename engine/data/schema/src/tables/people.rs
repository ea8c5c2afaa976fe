//! Table `people`: all visible bystanders, frame by frame.

use super::column::columns;
use super::value::Edges;
use super::{DatasetItem, Table};
use crate::log::messages::edges_px;
use crate::{OtherPerson, Sighting};
use cosfly_domain::Traits;

/// Definition of the table.
pub fn table() -> Table<DatasetItem> {
    let doc = "Bystanders, people, vehicles and other drones behind the target, one row for each frame that shows at least one pixel of them; empty in towns without bystanders.";
    let key = &["trajectory_id", "frame", "instance"];
    let rows = |item: &DatasetItem| item.record.sightings.len();
    Table { per_frame: true, ..Table::new("people", doc, key, rows, People::COLUMNS) }
}

/// Columns of table `people`.
pub struct People;

columns! { People::COLUMNS of DatasetItem;
    /// Trajectory that the frame belongs to.
    trajectory_id: String = |item, _| item.record.trajectory_id.clone();
    /// Split: `train`, `val` or `test`; that of the file.
    split: String = |item, _| item.membership.split.name().to_owned();
    /// Number of the frame, from 0.
    frame: u32 = |item, i| sighting(item, i).frame;
    /// Id in instance images and in `frames.occluder_instance`: greater than those of all objects.
    instance: u32 = |item, i| person(item, i).instance;
    /// Stage and item of the walk, such as `crowd-p00003`, or traffic and number of the body, such as `street-b00003`, or
    /// the flight of another drone, such as `expert-p00003-d2`; the same in all trajectories.
    walk_id: String = |item, i| person(item, i).walk_id.clone();
    /// Kind: `pedestrian`, `bicycle`, `motorcycle`, `car`, `van`, `truck`, `bus` or `drone`.
    kind: String = |item, i| person(item, i).kind.name().to_owned();
    /// Ground point between the feet, world frame: x, y, z.
    feet_in_world_m: [f64; 3] = |item, i| sighting(item, i).state.feet_in_world.to_array();
    /// Walking direction, positive: x towards y.
    heading_deg: f64 = |item, i| sighting(item, i).state.heading_rad.to_degrees();
    /// Speed along the ground; 0 while the person stands.
    speed_mps: f64 = |item, i| sighting(item, i).state.speed_mps;
    /// Height of the body.
    height_m: f64 = |item, i| person(item, i).height_m;
    /// Radius of the body seen from above; of a vehicle, of the circle around its outline.
    radius_m: f64 = |item, i| person(item, i).radius_m;
    /// Colour of the shirt or jacket in words; of a vehicle without a rider, of its paint.
    top_colour: String = |item, i| person(item, i).outfit.top.name.name().to_owned();
    /// Colour of the shirt or jacket: share of light that it reflects, linear red, green, blue.
    top_linear_rgb: [f64; 3] = |item, i| person(item, i).outfit.top.linear_rgb.map(f64::from);
    /// Colour of the trousers in words; of a vehicle without a rider, of its paint.
    trousers_colour: String = |item, i| person(item, i).outfit.trousers.name.name().to_owned();
    /// Whether the person wears a backpack.
    has_backpack: bool = |item, i| person(item, i).outfit.backpack;
    /// Whether the person holds an open umbrella, a part of the person in pixels and boxes: up to 1.25 times `height_m` high.
    has_umbrella: bool = |item, i| person(item, i).outfit.umbrella;
    /// Bag: `none`, `backpack` or `shoulder_bag`; null for vehicles and their riders.
    bag: Option<String> = |item, i| traits(item, i).map(|it| it.bag.name().to_owned());
    /// Build: `slim`, `medium` or `stout`; null for vehicles and their riders.
    build: Option<String> = |item, i| traits(item, i).map(|it| it.build.name().to_owned());
    /// Steps: `short`, `medium` or `long`; null for vehicles and their riders.
    gait: Option<String> = |item, i| traits(item, i).map(|it| it.gait.name().to_owned());
    /// Number of visible pixels.
    visible_pixels: u32 = |item, i| sighting(item, i).view.pixels;
    /// Left, top, right, bottom edge around the visible pixels.
    visible_box_px: Edges = |item, i| edges_px(&sighting(item, i).view.visible_box).map(|edge| edge as f32);
}

fn sighting(item: &DatasetItem, i: usize) -> &Sighting {
    &item.record.sightings[i]
}

fn person(item: &DatasetItem, i: usize) -> &OtherPerson {
    &item.record.others[sighting(item, i).person as usize]
}

fn traits(item: &DatasetItem, i: usize) -> Option<Traits> {
    person(item, i).outfit.traits
}
