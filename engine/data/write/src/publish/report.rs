//! The dataset's page, `report/index.html`: sketches of its records and previews.

use super::source::DatasetSource;
use super::summary::Summary;
use cosfly_diagnose::Result;
use cosfly_frames::DVec3;
use cosfly_report::{BoxSketch, Figures, FlightSketch, RejectionSketch, Report, TextSketch, TownSketch};
use cosfly_schema::config::DatasetConfig;
use cosfly_schema::log::messages::edges_px;
use cosfly_schema::published_costs::costs;
use cosfly_schema::tables::{DatasetItem, ObjectRecord};
use cosfly_schema::{Rejection, RenderedTrajectory, Role};

/// Path of the page in the dataset.
pub const PATH: &str = "report/index.html";

/// The page of a dataset.
pub fn page(
    config: &DatasetConfig,
    summary: &Summary,
    figures: Figures,
    boxes: &[ObjectRecord],
    rejections: &[Rejection],
    source: &dyn DatasetSource,
) -> Result<String> {
    let of_town = |name: &String| boxes.iter().filter(|it| it.town == *name).map(box_sketch).collect();
    let report = Report {
        title: config.title.clone(),
        description: config.description.clone(),
        name_and_version: format!("{} {}", config.name, config.version),
        published: config.date_published.clone(),
        license: config.license.name.clone(),
        creator: config.creator.name.clone(),
        languages: summary.languages.iter().cloned().collect(),
        towns: summary.towns.keys().map(|name| TownSketch { name: name.clone(), boxes: of_town(name) }).collect(),
        figures,
        rejections: rejections.iter().map(rejection_sketch).collect(),
        planners: source.planners()?,
        shortcuts: Some(summary.shortcuts.figures()),
    };
    cosfly_report::page(&report, &mut |flight, frame| source.picture(&flight.id, frame))
}

fn box_sketch(object: &ObjectRecord) -> BoxSketch {
    let shape = &object.obstacle.shape;
    BoxSketch {
        instance: object.instance(),
        kind: object.kind().to_owned(),
        center_m: [shape.center_in_world.x, shape.center_in_world.y],
        half_m: [shape.half_extents_m.x, shape.half_extents_m.y],
        yaw_rad: shape.yaw_rad,
    }
}

fn rejection_sketch(rejection: &Rejection) -> RejectionSketch {
    RejectionSketch {
        id: rejection.trajectory_id.clone(),
        stage: rejection.stage.clone(),
        reason: rejection.reason.clone(),
    }
}

/// The figures of flight `number` that the page shows.
pub fn sketch(number: u64, item: &DatasetItem, split: &str) -> FlightSketch {
    let record = &item.record;
    let trajectory = &record.trajectory;
    let place = |it: DVec3| it.to_array().map(|metres| metres as f32);
    FlightSketch {
        number,
        id: record.trajectory_id.clone(),
        flight_id: record.flight_id.clone(),
        is_perturbed: record.role == Role::Perturbed,
        pedestrian: record.pedestrian_id.clone(),
        town: record.town.name.clone(),
        weather: record.weather.name.clone(),
        split: split.to_owned(),
        dt_s: record.dt_s(),
        image_px: [record.camera.width, record.camera.height],
        drone_m: trajectory.poses_in_world.iter().map(|pose| place(pose.position_in_world)).collect(),
        feet_m: trajectory.track.states.iter().map(|state| place(state.feet_in_world)).collect(),
        visible: record.views.iter().map(|view| view.visible_by_rays as f32).collect(),
        clearance_m: trajectory.clearance_m.iter().map(|metres| *metres as f32).collect(),
        box_px: record.views.iter().map(|view| view.full_box.as_ref().map(edges)).collect(),
        holds: trajectory.certificate.holds,
        violations: trajectory.certificate.violations.clone(),
        max_jerk_mps3: trajectory.certificate.max_jerk_mps3,
        convergence: trajectory.convergence.clone(),
        term_costs: costs(trajectory).map(|term| (term.name.to_owned(), term.weight * term.sum)).collect(),
        texts: texts(item),
    }
}

/// Captions and goals of a flight.
fn texts(item: &DatasetItem) -> Vec<TextSketch> {
    let is_unlike_all = is_unlike_all(&item.record);
    let text = |language: &str, kind: &str, text: String, subjects: Vec<String>| TextSketch {
        language: language.to_owned(),
        kind: kind.to_owned(),
        text,
        singles_out: is_unlike_all && subjects.iter().any(|it| it == "clothes"),
        subjects,
        ..TextSketch::default()
    };
    let captions = item.captions.iter().map(|it| TextSketch {
        is_taught: it.writer == "teacher",
        refused: it.refused.len() as u64,
        refused_for: it.refused_for.concat(),
        ..text(&it.language, &it.style, it.text.clone(), it.verdicts.clone())
    });
    let goals = item.derived.goals.iter().map(|it| {
        let sketch = text(&it.language, &it.grain, it.lines.join(" "), it.subjects.clone());
        // A goal with false clothes singles nobody out.
        TextSketch { singles_out: sketch.singles_out && it.fits, ..sketch }
    });
    captions.chain(goals).collect()
}

/// Whether nobody else who is seen in the flight wears what the target wears.
fn is_unlike_all(record: &RenderedTrajectory) -> bool {
    let Some(own) = &record.outfit else { return false };
    let own_kind = record.target_kind();
    let mut seen = record.sightings.iter().map(|it| &record.others[it.other as usize]);
    seen.all(|it| Some(it.plan.kind) != own_kind || !it.outfit.is_like(own))
}

fn edges(it: &cosfly_domain::PixelBox) -> [f32; 4] {
    edges_px(it).map(|edge| edge as f32)
}
