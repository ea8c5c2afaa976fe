//! Table `bodies`: people, vehicles and other drones around the target, frame by frame.

use super::column::columns;
use super::value::Edges;
use super::{DatasetItem, Table};
use crate::log::messages::edges_px;
use crate::{OtherBody, Sighting};
use cosfly_domain::{BodyPlan, Outfit, Traits};
use cosfly_frames::TargetState;

/// Definition of the table.
pub fn table() -> Table<DatasetItem> {
    let doc = "People, vehicles and other drones around the target. One row for each frame that shows at least one pixel of a body; bodies of stage `traffic` that come within 60 m of the target also have one for each frame in which they are hidden.";
    let rows = |item: &DatasetItem| item.derived.bodies.len();
    Table {
        per_frame: true,
        ..Table::new("bodies", doc, &["trajectory_id", "frame", "body_id"], rows, Bodies::COLUMNS)
    }
}

/// Columns of table `bodies`.
pub struct Bodies;

columns! { Bodies::COLUMNS of DatasetItem;
    /// Trajectory that the frame belongs to.
    trajectory_id: String = |item, _| item.record.trajectory_id.clone();
    /// Split: `train`, `val` or `test`; that of the file.
    split: String = |item, _| item.membership.split.name().to_owned();
    /// Number of the frame, from 0.
    frame: u32 = |item, i| item.derived.bodies[i].frame;
    /// Id of the body: stage and item of a walk, such as `crowd-p00003`; traffic and number, such as `street-b00003`; the flight
    /// of another drone, such as `expert-p00003-d2`; the same in all trajectories.
    body_id: String = |item, i| item.derived.bodies[i].body_id.clone();
    /// Id in instance images and in `frames.occluder_instance`: greater than those of all objects; null for a body that no
    /// picture of the trajectory can show.
    instance: Option<u32> = |item, i| other(item, i).map(|it| it.instance);
    /// Kind, such as `pedestrian`, `push_chair` or `car`: a word of `follow.kinds` of stage `traffic`, or `drone`.
    kind: String = |item, i| plan(item, i).kind.name().to_owned();
    /// Number of the group that the body moves with; null where it moves alone.
    group: Option<u32> = |item, i| plan(item, i).group;
    /// Middle of the body on the ground, world frame: x, y, z; of a drone, the point below its middle at its lowest part.
    feet_in_world_m: [f64; 3] = |item, i| state(item, i).feet_in_world.to_array();
    /// Direction of travel, positive: x towards y.
    heading_deg: f64 = |item, i| state(item, i).heading_rad.to_degrees();
    /// Speed along the ground; 0 while the body stands.
    speed_mps: f64 = |item, i| state(item, i).speed_mps;
    /// Length along the heading, width and height; a person is a cylinder whose length and width are its diameter.
    size_m: [f64; 3] = |item, i| plan(item, i).size_m.to_array();
    /// Colour of the shirt or jacket in words; of a vehicle without a rider, of its paint; null where `instance` is.
    top_colour: Option<String> = |item, i| outfit(item, i).map(|it| it.top.name.name().to_owned());
    /// Colour of the shirt or jacket: share of light that it reflects, linear red, green, blue; null where `instance` is.
    top_linear_rgb: Option<[f64; 3]> = |item, i| outfit(item, i).map(|it| it.top.linear_rgb.map(f64::from));
    /// Colour of the trousers in words; of a vehicle without a rider, of its paint; null where `instance` is.
    trousers_colour: Option<String> = |item, i| outfit(item, i).map(|it| it.trousers.name.name().to_owned());
    /// Whether the person wears a backpack; null where `instance` is.
    has_backpack: Option<bool> = |item, i| outfit(item, i).map(|it| it.backpack);
    /// Whether the person holds an open umbrella, a part of the person in pixels and boxes: up to 1.25 times the height of the
    /// person; null where `instance` is.
    has_umbrella: Option<bool> = |item, i| outfit(item, i).map(|it| it.umbrella);
    /// Bag: `none`, `backpack` or `shoulder_bag`; null for vehicles and their riders, and where `instance` is.
    bag: Option<String> = |item, i| traits(item, i).map(|it| it.bag.name().to_owned());
    /// Build: `slim`, `medium` or `stout`; null for vehicles and their riders, and where `instance` is.
    build: Option<String> = |item, i| traits(item, i).map(|it| it.build.name().to_owned());
    /// Steps: `short`, `medium` or `long`; null for vehicles and their riders, and where `instance` is.
    gait: Option<String> = |item, i| traits(item, i).map(|it| it.gait.name().to_owned());
    /// Number of visible pixels; 0 while the body is hidden or outside of the picture.
    visible_pixels: u32 = |item, i| sighting(item, i).map_or(0, |it| it.view.pixels);
    /// Left, top, right, bottom edge around the visible pixels; null where there are none.
    visible_box_px: Option<Edges> = |item, i| {
        sighting(item, i).map(|it| edges_px(&it.view.visible_box).map(|edge| edge as f32))
    };
}

fn sighting(item: &DatasetItem, i: usize) -> Option<&Sighting> {
    item.derived.bodies[i].sighting.map(|place| &item.record.sightings[place as usize])
}

fn other(item: &DatasetItem, i: usize) -> Option<&OtherBody> {
    item.derived.bodies[i].other.map(|place| &item.record.others[place as usize])
}

fn outfit(item: &DatasetItem, i: usize) -> Option<&Outfit> {
    other(item, i).map(|it| &it.outfit)
}

fn traits(item: &DatasetItem, i: usize) -> Option<Traits> {
    outfit(item, i)?.traits
}

fn plan(item: &DatasetItem, i: usize) -> &BodyPlan {
    let near = || &near(item, i).expect("a body is in a picture, or around").plan;
    other(item, i).map_or_else(near, |it| &it.plan)
}

fn state(item: &DatasetItem, i: usize) -> TargetState {
    let near =
        || *near(item, i).and_then(|it| it.state(item.derived.bodies[i].frame)).expect("a body is seen, or present");
    sighting(item, i).map_or_else(near, |it| it.state)
}

fn near(item: &DatasetItem, i: usize) -> Option<&cosfly_domain::Body> {
    item.derived.bodies[i].around.map(|place| &item.record.around.traffic.bodies[place as usize])
}
