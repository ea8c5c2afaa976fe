//! Table `bodies`: the people and vehicles of traffic around the target, frame by frame, seen or not.

use super::column::columns;
use super::{DatasetItem, Table};
use cosfly_domain::Body;
use cosfly_frames::TargetState;

/// Definition of the table.
pub fn table() -> Table<DatasetItem> {
    let doc = "People and vehicles that come within 60 m of the target, frame by frame, visible or not; empty outside of stage `traffic`.";
    let rows = |item: &DatasetItem| item.derived.bodies.len();
    Table { per_frame: true, ..Table::new("bodies", doc, &["trajectory_id", "frame", "body"], rows, Bodies::COLUMNS) }
}

/// Columns of table `bodies`.
pub struct Bodies;

columns! { Bodies::COLUMNS of DatasetItem;
    /// Trajectory that the frame belongs to.
    trajectory_id: String = |item, _| item.record.trajectory_id.clone();
    /// Split: `train`, `val` or `test`; that of the file.
    split: String = |item, _| item.membership.split.name().to_owned();
    /// Number of the frame, from 0.
    frame: u32 = |item, i| item.derived.bodies[i].0;
    /// Number of the body in its traffic, as in `trajectories.target_body`.
    body: u32 = |item, i| item.record.around.numbers[item.derived.bodies[i].1 as usize];
    /// Kind: `pedestrian`, `bicycle`, `motorcycle`, `car`, `van`, `truck` or `bus`.
    kind: String = |item, i| body(item, i).plan.kind.name().to_owned();
    /// Name of the traffic and number of the body, as in `people.walk_id`.
    walk_id: String = |item, i| {
        cosfly_domain::Traffic::body_id(&item.record.around.traffic.name, item.record.around.numbers[item.derived.bodies[i].1 as usize])
    };
    /// Number of the group that the body moves with; null where it moves alone.
    group: Option<u32> = |item, i| body(item, i).plan.group;
    /// Middle of the body on the ground, world frame: x, y, z.
    feet_in_world_m: [f64; 3] = |item, i| state(item, i).feet_in_world.to_array();
    /// Direction of travel, positive: x towards y.
    heading_deg: f64 = |item, i| state(item, i).heading_rad.to_degrees();
    /// Speed along the ground.
    speed_mps: f64 = |item, i| state(item, i).speed_mps;
    /// Length along the heading, width and height; a person is a cylinder whose length and width are its diameter.
    size_m: [f64; 3] = |item, i| body(item, i).plan.size_m.to_array();
}

fn body(item: &DatasetItem, i: usize) -> &Body {
    &item.record.around.traffic.bodies[item.derived.bodies[i].1 as usize]
}

fn state(item: &DatasetItem, i: usize) -> TargetState {
    let body = body(item, i);
    body.states[(item.derived.bodies[i].0 - body.first_frame) as usize]
}
