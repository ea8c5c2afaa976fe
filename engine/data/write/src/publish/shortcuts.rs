//! What gives the targets of rendered flights away: counted flight by flight.

use cosfly_metrics::shortcuts::Shortcuts;
use cosfly_render::PixelBox;
use cosfly_schema::log::messages::edges_px;
use cosfly_schema::{RenderedTrajectory, Role};
use cosfly_world::BodyKind;

/// Counts a flight: the frames of experts, where others are those of the target's kind, and the people of all flights.
pub fn count(record: &RenderedTrajectory, shortcuts: &mut Shortcuts) {
    let colour = |rgb: [f32; 3]| rgb.map(f64::from);
    let town = &record.town.name;
    let kind = record.target_kind();
    if let Some(outfit) = record.outfit.as_ref().filter(|_| kind.is_some_and(BodyKind::is_person)) {
        shortcuts.add_target(&format!("{town} {}", record.pedestrian_id), colour(outfit.top.linear_rgb));
    }
    for sighting in &record.sightings {
        let other = &record.others[sighting.person as usize];
        if !other.kind.is_person() {
            continue;
        }
        shortcuts.add_other(&format!("{town} {}", other.walk_id), colour(other.outfit.top.linear_rgb));
    }
    if record.role == Role::Perturbed {
        return;
    }
    let image_px = [record.camera.width, record.camera.height].map(f64::from);
    let edges = |it: &PixelBox| edges_px(it).map(|edge| edge as f64);
    for (frame, view) in record.views.iter().enumerate() {
        if let Some(visible) = &view.visible_box {
            let alike = record.seen_in(frame).filter(|(other, _)| Some(other.kind) == kind);
            let others = alike.map(|(_, sighting)| edges(&sighting.view.visible_box));
            shortcuts.add_frame(image_px, edges(visible), others);
        }
    }
}
