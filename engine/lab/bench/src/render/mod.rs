//! The renderer: what a frame costs on one core, stage by stage, how many frames a second come out as finished logs,
//! and how far both are from what the machine's memory could do.
//!
//! [`measure`] does it all in one run; [`views`] holds the towns and the cameras, and exports them for other renderers.

pub mod flight;
pub mod flown;
pub mod machine;
pub mod stages;
mod table;
pub mod throughput;
pub mod views;

use cosfly_diagnose::Result;
use cosfly_render::{PictureLook, Weather};
use cosfly_schema::EncodingConfig;
use machine::Machine;
use serde::Serialize;
use stages::StageTimes;
use std::path::Path;
use throughput::Throughput;
use views::{Ground, View};

/// What is measured.
pub struct RenderOptions<'a> {
    /// The towns, each with its views.
    pub grounds: Vec<Ground>,
    /// Every view is drawn in each of these.
    pub weathers: Vec<Weather>,
    /// Rounds over all views; the least time of each stage counts.
    pub rounds: usize,
    /// How images are stored.
    pub encoding: EncodingConfig,
    /// Threads of the throughput.
    pub threads: usize,
    /// Frames of each flight of the throughput.
    pub flight_frames: usize,
    /// An empty folder on the disk that is written to.
    pub scratch: &'a Path,
}

/// One town in one weather and look.
#[derive(Clone, Debug, Serialize)]
pub struct RenderRow {
    /// The town.
    pub town: String,
    /// Boxes in it.
    pub boxes: usize,
    /// Triangles with a face of boxes, figures and ground.
    pub triangles: usize,
    /// The weather.
    pub weather: String,
    /// How colours look.
    pub look: PictureLook,
    /// CPU time of one frame on one core.
    pub times: StageTimes,
}

/// Everything that was measured; prints as a table.
#[derive(Clone, Debug, Serialize)]
pub struct RenderReport {
    /// Size of the images.
    pub width: u32,
    /// See `width`.
    pub height: u32,
    /// Views per town.
    pub views: usize,
    /// By town, then weather; the first weather of each town in the simple look, too.
    pub rows: Vec<RenderRow>,
    /// Whole frames a second, of the first town, in the full look and in the simple one.
    pub throughput: [Throughput; 2],
    /// Limits of the machine.
    pub machine: Machine,
}

/// Measures everything.
pub fn measure(options: &RenderOptions<'_>) -> Result<RenderReport> {
    let first = options.grounds.first().expect("a town to draw");
    let mut rows = vec![];
    for ground in &options.grounds {
        for weather in &options.weathers {
            rows.push(row(ground, weather, PictureLook::Full, options)?);
        }
        if let Some(weather) = options.weathers.first() {
            rows.push(row(ground, weather, PictureLook::Simple, options)?);
        }
    }
    let flights = flights(first, options);
    let throughput = |look| throughput::throughput(first, &flights, look, options);
    let throughput = [throughput(PictureLook::Full)?, throughput(PictureLook::Simple)?];
    let (width, height) = (first.camera.width, first.camera.height);
    let machine = Machine::measure(width as usize * height as usize);
    Ok(RenderReport { width, height, views: first.views.len(), rows, throughput, machine })
}

/// A flight for each thread: planned ones where people can walk, or steps around the views.
fn flights(ground: &Ground, options: &RenderOptions<'_>) -> Vec<Vec<View>> {
    let (threads, frames) = (options.threads.max(1), options.flight_frames.max(1));
    let mut flights = flown::flown(ground, frames, threads as u64);
    let around = || (0..frames).map(|frame| ground.walked(frame, flight::DT_S)).collect();
    flights.resize_with(threads, around);
    flights
}

fn row(ground: &Ground, weather: &Weather, look: PictureLook, options: &RenderOptions<'_>) -> Result<RenderRow> {
    Ok(RenderRow {
        town: ground.name.clone(),
        boxes: ground.town.obstacles.len(),
        triangles: ground.scene.triangles().len(),
        weather: weather.name.clone(),
        look,
        times: stages::times(ground, weather, look, options)?,
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use cosfly_render::Camera;

    #[test]
    fn a_tiny_measurement_has_every_figure() {
        let camera = Camera { width: 64, height: 48, horizontal_fov_rad: 1.2 };
        let scratch = tempfile::tempdir().unwrap();
        let report = measure(&RenderOptions {
            grounds: vec![Ground::of_boxes(20, camera, 2)],
            weathers: vec![Weather::preset("HardRainNoon").unwrap()],
            rounds: 1,
            encoding: EncodingConfig::default(),
            threads: 2,
            flight_frames: 3,
            scratch: scratch.path(),
        })
        .unwrap();
        let times = report.rows[0].times;
        assert!(times.visibility_ms > 0.0 && times.whole_ms() > times.render_ms() && times.log_bytes > 1000.0);
        assert_eq!(report.throughput[0].frames, 6);
        assert!(report.throughput[1].frames_per_s > 0.0 && report.machine.far_copy_gbps > 0.0);
        assert!(report.rows.len() == 2 && report.rows[1].look == PictureLook::Simple);
        assert!(report.to_string().contains("HardRainNoon, simple"));
    }
}
