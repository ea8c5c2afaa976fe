//! Flights that are not published yet: from records to episodes.

use cosfly_domain::{BodyKind, Perturbation, PixelBox, TargetView};
use cosfly_episodes::{ExaminedEpisode, ExaminedMoment};
use cosfly_frames::{DVec3, action};
use cosfly_schema::{RenderedTrajectory, Role};

/// The episode of a rendered flight, without its pictures.
pub fn episode(record: &RenderedTrajectory) -> ExaminedEpisode {
    let trajectory = &record.trajectory;
    let is_plain = record.lens.is_none() && record.rolling_shutter.readout_s == 0.0;
    let limits = &trajectory.certificate.limits;
    let limits = [
        limits.clearance_m,
        limits.speed_mps,
        limits.acceleration_mps2,
        limits.jerk_mps3,
        limits.yaw_rate_deg_s,
        limits.pitch_rate_deg_s,
    ];
    ExaminedEpisode {
        id: record.trajectory_id.clone(),
        flight: record.flight_id.clone(),
        group: record.pedestrian_id.clone(),
        place: record.town.geometry_digest.clone(),
        town: record.town.name.clone(),
        is_perturbed: record.role == Role::Perturbed,
        displaced_m: Some(trajectory.perturbation.as_ref().map_or(0.0, displaced_m)),
        camera: is_plain.then_some(record.camera),
        target_height_m: trajectory.track.height_m,
        is_runner: record.target_kind() == Some(BodyKind::Runner),
        clothes: record.outfit.as_ref().map(|it| (it.top.name, it.trousers.name, it.backpack)),
        is_unlike_all: record.outfit.as_ref().map(|_| (0..record.len()).all(|frame| record.look_alikes(frame) == 0)),
        dt_s: record.dt_s(),
        limits: limits.map(|limit| limit.is_finite().then_some(limit)),
        moments: (0..record.len()).map(|frame| moment(record, frame)).collect(),
        ..ExaminedEpisode::default()
    }
}

/// Longest displacement of kind `jumps`, metres; the other kinds could be flown.
fn displaced_m(perturbation: &Perturbation) -> f64 {
    let jumps = perturbation.frames.iter().filter(|_| !perturbation.kind.is_flyable());
    jumps.map(|frame| frame.drone_offset_in_world.length()).fold(0.0, f64::max)
}

fn moment(record: &RenderedTrajectory, frame: usize) -> ExaminedMoment {
    let trajectory = &record.trajectory;
    let (pose, state, view) = (trajectory.poses_in_world[frame], trajectory.track.states[frame], &record.views[frame]);
    let next = trajectory.poses_in_world.get(frame + 1);
    // Inspections and patrols follow nobody.
    let follows = record.target_kind().is_some();
    ExaminedMoment {
        time_s: record.times().s(frame),
        drone: pose,
        camera: record.camera_pose(frame),
        next_in_world: next.map(|next| next.position_in_world),
        turn_deg: next.map(|next| {
            let [_, _, _, pitch, yaw, roll] = action::in_world(&pose, next);
            [pitch, yaw, roll]
        }),
        target_in_world: follows.then_some(state.feet_in_world + DVec3::Z * (0.5 * trajectory.track.height_m)),
        heading_and_speed: follows.then_some((state.heading_rad, state.speed_mps)),
        in_image: view.full_box.as_ref().map(|it| {
            let [left, top, right, bottom] = edges(it);
            (0.5 * (left + right), 0.5 * (top + bottom), bottom - top)
        }),
        visible_box: view.visible_box.as_ref().map(edges),
        visible: follows.then_some(share(view)),
        clearance_m: Some(trajectory.clearance_m[frame]),
    }
}

fn share(view: &TargetView) -> f64 {
    view.visible_by_pixels
}

/// Left, top, right and bottom edge, pixels.
fn edges(it: &PixelBox) -> [f64; 4] {
    [it.u_min, it.v_min, it.u_max + 1, it.v_max + 1].map(f64::from)
}
