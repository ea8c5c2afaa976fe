//! Shortcuts to the targets of rendered flights, counted flight by flight.

use cosfly_domain::{BodyKind, Outfit, PixelBox, Traits};
use cosfly_frames::{DVec3, Pose, TargetState};
use cosfly_metrics::shortcuts::{Looks, Seen, Shortcuts};
use cosfly_schema::log::messages::edges_px;
use cosfly_schema::{RenderedTrajectory, Role};

/// Counts a flight: the frames of experts, where others are those of the target's kind, and the grown
/// people on foot of all flights.
pub fn count(record: &RenderedTrajectory, shortcuts: &mut Shortcuts) {
    let town = &record.town.name;
    let kind = record.target_kind();
    let track = &record.trajectory.track;
    if let Some(outfit) = record.outfit.as_ref().filter(|_| kind == Some(BodyKind::Pedestrian)) {
        shortcuts.add_target(&format!("{town} {}", record.pedestrian_id), looks(outfit, track.height_m));
    }
    for sighting in &record.sightings {
        let other = &record.others[sighting.other as usize];
        if other.plan.kind == BodyKind::Pedestrian {
            shortcuts.add_other(&format!("{town} {}", other.body_id), looks(&other.outfit, other.plan.size_m.z));
        }
    }
    if record.role == Role::Perturbed {
        return;
    }
    let image_px = [record.camera.width, record.camera.height].map(f64::from);
    let frames = record.views.iter().enumerate().filter_map(|(frame, view)| {
        let pose = record.camera_pose(frame);
        let target = seen(record, &pose, view.visible_box.as_ref()?, (&track.states[frame], track.height_m));
        let alike = record.seen_in(frame).filter(|(other, _)| Some(other.plan.kind) == kind);
        let others = alike
            .map(|(other, it)| seen(record, &pose, &it.view.visible_box, (&it.state, other.plan.size_m.z)))
            .collect();
        Some((target, others))
    });
    shortcuts.add_flight(image_px, frames);
}

fn looks(outfit: &Outfit, height_m: f64) -> Looks {
    let Traits { bag, build, gait } = outfit.traits.unwrap_or(Traits::PLAIN);
    Looks::of_words(outfit.top.linear_rgb.map(f64::from), height_m, [bag.name(), build.name(), gait.name()])
}

/// A body in the picture; crown and feet of a grown person only.
fn seen(record: &RenderedTrajectory, pose: &Pose, visible: &PixelBox, (state, height_m): (&TargetState, f64)) -> Seen {
    let feet = state.feet_in_world;
    // Rows of a wide lens are angles.
    let is_person = !record.lens.is_wide(&record.camera) && record.target_kind() == Some(BodyKind::Pedestrian);
    let row = |point| record.camera.project(pose, point).filter(|_| is_person).map(|(_, row, _)| row);
    Seen {
        edges_px: edges_px(visible).map(|edge| edge as f64),
        crown_and_feet_px: row(feet + height_m * DVec3::Z).zip(row(feet)).map(|(crown, feet)| [crown, feet]),
        distance_m: (feet - pose.position_in_world).length(),
        height_m,
    }
}
