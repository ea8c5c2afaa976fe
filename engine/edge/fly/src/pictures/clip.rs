//! The clip of a flight: what the camera saw where it matters, drawn from the poses of the log.

use super::window::telling;
use crate::log::LogLine;
use crate::suite::EpisodeTask;
use cosfly_diagnose::Result;
use cosfly_domain::{Camera, PixelBox};
use cosfly_env::EnvironmentSettings;
use cosfly_env::pictures::bystanders_at;
use cosfly_figures::{BodyFigure, FigureInPicture, gait_phase_rad};
use cosfly_plot::canvas::Canvas;
use cosfly_preview::{ClipShot, clip as encoded};
use cosfly_read::LoggedFrame;
use cosfly_render::{FrameSetup, Renderer, Scene};
use cosfly_schema::log::TargetStateMessage;
use cosfly_schema::log::messages::edges_px;

/// Width of the colour picture, pixels.
const WIDTH_PX: u32 = 320;
/// Length of a clip and time between its pictures, seconds.
const LENGTH_S: f64 = 12.0;
const EVERY_S: f64 = 0.2;

/// An animated picture of the steps of a flight that say most, GIF; `None` of a flight without steps.
///
/// # Errors
/// `preview-encode`.
pub fn clip(task: &EpisodeTask, settings: &EnvironmentSettings, steps: &[LogLine]) -> Result<Option<Vec<u8>>> {
    let count = |time_s: f64| ((time_s / settings.step_s).round() as usize).max(1);
    let shown: Vec<&LogLine> = steps[telling(steps, count(LENGTH_S))].iter().step_by(count(EVERY_S)).collect();
    if shown.is_empty() {
        return Ok(None);
    }
    let scene = task.scenery.scene();
    let height = (f64::from(WIDTH_PX) * settings.lens.aspect) as u32;
    let horizontal_fov_rad = settings.lens.horizontal_deg.to_radians();
    let mut renderer = Renderer::new(Camera { width: WIDTH_PX, height: height.max(1), horizontal_fov_rad });
    encoded(shown.into_iter().map(|line| shot(task, &scene, &mut renderer, line))).map(Some)
}

fn shot(task: &EpisodeTask, scene: &Scene, renderer: &mut Renderer, line: &LogLine) -> ClipShot {
    let (track, shooting) = (&task.episode.target, &task.shooting);
    let state = task.episode.target_at(line.time_s);
    let target = BodyFigure {
        state,
        height_m: track.height_m,
        radius_m: track.radius_m,
        clothes_seed: shooting.clothes_seed,
        gait_phase_rad: gait_phase_rad(task.episode.walked_m(line.time_s), track.height_m),
        body: shooting.body.in_rain(shooting.weather.precipitation, &shooting.clothes_seed),
    };
    let rain = shooting.weather.precipitation;
    let others: Vec<FigureInPicture> = bystanders_at(&task.episode, line.time_s, rain).collect();
    let setup = FrameSetup { pose: line.pose(), weather: &shooting.weather, target: Some(target), others: &others };
    let drawn = renderer.render(scene, &setup);
    let (images, view) = (drawn.images, drawn.target_view);
    let edges = |pixel_box: &Option<PixelBox>| pixel_box.iter().flat_map(edges_px).collect();
    let told = TargetStateMessage {
        frame: line.step,
        time_s: line.time_s,
        radius_m: track.radius_m,
        visible_by_rays: line.visible,
        visible_by_pixels: view.visible_by_pixels,
        visible_box_px: edges(&view.visible_box),
        full_box_px: edges(&view.full_box),
        ..TargetStateMessage::default()
    };
    let logged = LoggedFrame {
        width: images.width,
        height: images.height,
        depth_m: images.depth_m.clone(),
        semantic: images.semantic.clone(),
        target: told,
        ..LoggedFrame::default()
    };
    let rgb = Canvas { width: images.width as usize, height: images.height as usize, rgb: images.rgb.clone() };
    ClipShot { logged, rgb }
}
