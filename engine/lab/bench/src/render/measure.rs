//! All measurements of the renderer, one after another.

use super::machine::Machine;
use super::options::RenderOptions;
use super::stages::StageTimes;
use super::throughput::Throughput;
use super::views::{Ground, View};
use super::{flight, flown, stages, throughput};
use cosfly_diagnose::Result;
use cosfly_domain::Weather;
use cosfly_render::PictureLook;
use serde::Serialize;

/// Times of one town in one weather and look.
#[derive(Clone, Debug, Serialize)]
pub struct RenderRow {
    /// Name of the town.
    pub town: String,
    /// Number of boxes in the town.
    pub boxes: usize,
    /// Number of triangles of boxes, figures and ground.
    pub triangles: usize,
    /// Name of the weather.
    pub weather: String,
    /// Look of the colours.
    pub look: PictureLook,
    /// CPU times of one frame on one core.
    pub times: StageTimes,
}

/// All measurements, printed as a table.
#[derive(Clone, Debug, Serialize)]
pub struct RenderReport {
    /// Width of the images, pixels.
    pub width: u32,
    /// Height of the images, pixels.
    pub height: u32,
    /// Number of views per town.
    pub views: usize,
    /// Rows by town, then weather; the first weather of each town in the simple look, too.
    pub rows: Vec<RenderRow>,
    /// Throughput of the first town, in the full look and in the simple one.
    pub throughput: [Throughput; 2],
    /// Limits of the machine.
    pub machine: Machine,
}

/// Runs all measurements.
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

/// A flight for each thread: planned ones where people can walk, otherwise steps around the views.
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
    use cosfly_domain::Camera;
    use cosfly_schema::EncodingConfig;

    #[test]
    fn a_tiny_measurement_has_every_figure() {
        let camera = Camera { width: 64, height: 48, horizontal_fov_rad: 1.2 };
        let scratch = tempfile::tempdir().unwrap();
        let report = measure(&RenderOptions {
            grounds: vec![Ground::of_boxes(20, camera, 2)],
            weathers: vec![cosfly_materials::presets::preset("HardRainNoon").unwrap()],
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
