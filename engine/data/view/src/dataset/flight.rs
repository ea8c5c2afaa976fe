//! Frames and texts of a flight.

use super::around::{crossings, own_rows};
use super::causes::Loss;
use super::opened::Opened;
use super::pictures::FlightLog;
use super::summary::is_point;
use crate::routes::told;
use crate::subject::short;
use cosfly_diagnose::Result;
use cosfly_read::{FrameRow, PublishedFlight};
use cosfly_schema::tables::{Captions, Goals};
use serde_json::{Map, Value, json};
use std::sync::Arc;

/// A flight; without its log where that is damaged: the page tells what is wrong.
///
/// # Errors
/// `view-unknown`, damage of tables.
pub fn flight(opened: &Opened, number: usize, log: Result<Arc<FlightLog>>) -> Result<Value> {
    let flight = opened.at(number)?;
    let rows = opened.rows("frames")?;
    let frames = opened.dataset.frames(&rows, flight)?;
    let mut value = columns(flight, &frames);
    let family = opened.dataset.family(flight).into_iter();
    let family: Vec<Value> =
        family.filter_map(|it| Some(json!({ "number": opened.number(it)?, "name": it.trajectory_id }))).collect();
    let is_point = is_point(flight);
    value.insert("name".into(), json!(flight.trajectory_id));
    value.insert("town".into(), json!(flight.town));
    value.insert("dt_s".into(), json!(flight.dt_s));
    value.insert("family".into(), json!(family));
    value.insert("size".into(), json!([flight.camera.width, flight.camera.height]));
    value.insert("fov_deg".into(), json!(short(flight.lens.span_rad(&flight.camera).to_degrees())));
    value.insert("facts".into(), facts(flight));
    value.insert("losses".into(), losses(opened, flight, &frames, is_point));
    value.insert("crossings".into(), json!(crossings(opened, number)?));
    value.insert("captions".into(), captions(opened, number)?);
    value.insert("goals".into(), goals(opened, number)?);
    match log {
        Ok(log) => value.insert("channels".into(), json!(log.channels())),
        Err(refusal) => value.insert("problem".into(), told(&refusal)),
    };
    Ok(Value::Object(value))
}

/// Numbers of the frames, by their names.
fn columns(flight: &PublishedFlight, frames: &[FrameRow]) -> Map<String, Value> {
    let is_point = is_point(flight);
    let numbers =
        |of: &dyn Fn(&FrameRow) -> f64| Value::from(frames.iter().map(|it| short(of(it))).collect::<Vec<_>>());
    let edges = |of: &dyn Fn(&FrameRow) -> Option<[f32; 4]>| {
        json!(frames.iter().map(|it| of(it).map(|edges| edges.map(|edge| short(f64::from(edge))))).collect::<Vec<_>>())
    };
    let entries = [
        ("time_s", numbers(&|it| it.time_s)),
        ("x", numbers(&|it| it.pose.position_in_world.x)),
        ("y", numbers(&|it| it.pose.position_in_world.y)),
        ("z", numbers(&|it| it.pose.position_in_world.z)),
        ("camera_yaw_deg", numbers(&|it| it.camera_pose.yaw_rad.to_degrees())),
        ("camera_pitch_deg", numbers(&|it| it.camera_pose.pitch_rad.to_degrees())),
        ("target_x", numbers(&|it| it.target.feet_in_world.x)),
        ("target_y", numbers(&|it| it.target.feet_in_world.y)),
        ("target_z", numbers(&|it| it.target.feet_in_world.z)),
        ("heading_deg", numbers(&|it| it.target.heading_rad.to_degrees())),
        ("target_speed_mps", numbers(&|it| it.target.speed_mps)),
        ("visible", numbers(&|it| if is_point { it.visible_by_rays } else { it.visible_by_pixels })),
        ("visible_by_rays", numbers(&|it| it.visible_by_rays)),
        ("distance_m", numbers(&|it| it.distance_m)),
        ("clearance_m", numbers(&|it| it.clearance_m)),
        ("in_view", numbers(&|it| f64::from(u8::from(it.in_view)))),
        ("look_alikes", numbers(&|it| f64::from(it.look_alikes))),
        ("occluder", numbers(&|it| f64::from(it.occluder_instance))),
        ("expert_frame", numbers(&|it| it.disturbance.as_ref().map_or(f64::NAN, |it| f64::from(it.expert_frame)))),
        ("visible_box", edges(&|it| it.visible_box_px)),
        ("full_box", edges(&|it| it.full_box_px)),
    ];
    entries.into_iter().map(|(name, value)| (name.to_owned(), value)).collect()
}

/// Facts in words.
fn facts(flight: &PublishedFlight) -> Value {
    let mut facts = vec![
        ("split", flight.split.clone()),
        ("town", flight.town.clone()),
        ("weather", flight.weather.clone()),
        ("target", flight.target_kind.clone().unwrap_or_else(|| "nobody".to_owned())),
        ("pedestrian", flight.pedestrian_id.clone()),
        ("log", flight.mcap_path.clone()),
    ];
    if let Some((top, trousers, backpack)) = &flight.target_clothes {
        let bag = if *backpack { ", a backpack" } else { "" };
        facts.push(("clothes", format!("{top} top, {trousers} trousers{bag}")));
    }
    facts.extend(flight.camera_name.iter().map(|name| ("camera", name.clone())));
    facts.extend(flight.expert_id.iter().map(|name| ("expert", name.clone())));
    json!(facts)
}

/// Intervals without the target.
fn losses(opened: &Opened, flight: &PublishedFlight, frames: &[FrameRow], is_point: bool) -> Value {
    let is_lost = |it: &FrameRow| if is_point { it.visible_by_rays <= 0.0 } else { it.visible_pixels == 0 };
    let mut begin = 0;
    let mut losses = vec![];
    for part in frames.chunk_by(|a, b| is_lost(a) == is_lost(b)) {
        let end = begin + part.len();
        if is_lost(&part[0]) {
            let mut loss = Loss::from(begin);
            part.iter().for_each(|frame| loss.add(frame.in_view, frame.occluder_instance));
            let cause = opened.causes.words(&flight.town, &loss);
            losses.push(json!({ "from": begin, "end": end, "cause": cause }));
        }
        begin = end;
    }
    json!(losses)
}

fn captions(opened: &Opened, number: usize) -> Result<Value> {
    let mut captions = vec![];
    own_rows(opened, "captions", number, &mut |rows, row| {
        let writer = rows.get_or(Captions::writer, row, "template".to_owned())?;
        captions.push(json!({
            "language": rows.get(Captions::language, row)?, "style": rows.get(Captions::style, row)?,
            "text": rows.get(Captions::text, row)?, "writer": writer,
        }));
        Ok(())
    })?;
    Ok(json!(captions))
}

fn goals(opened: &Opened, number: usize) -> Result<Value> {
    let mut goals = vec![];
    own_rows(opened, "goals", number, &mut |rows, row| {
        goals.push(json!({
            "language": rows.get(Goals::language, row)?, "grain": rows.get(Goals::grain, row)?,
            "from": rows.get(Goals::start_frame, row)?, "end": rows.get(Goals::end_frame, row)?,
            "lines": rows.get(Goals::lines, row)?, "fits": rows.get(Goals::fits, row)?,
        }));
        Ok(())
    })?;
    Ok(json!(goals))
}
