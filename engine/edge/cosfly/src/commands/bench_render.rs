//! `cosfly bench render`: what pictures cost, stage by stage, and how many come out as finished logs.

use super::{Outcome, Refusals};
use crate::arguments::BenchRenderArguments;
use crate::exit;
use cosfly_bench::render::views::Ground;
use cosfly_bench::render::{RenderOptions, measure};
use cosfly_dataset::EncodingConfig;
use cosfly_diagnose::{Diagnostic, Fault};
use cosfly_render::{Camera, RenderConfig, Weather};
use std::path::Path;

/// Clear noon, hard rain, night.
const WEATHERS: [&str; 3] = ["ClearNoon", "HardRainNoon", "ClearNight"];

/// Measures, or exports the boxes.
pub fn render(arguments: &BenchRenderArguments) -> Outcome {
    let camera = camera(arguments)?;
    if let Some(file) = &arguments.boxes {
        let scene = Ground::of_boxes(arguments.box_count, camera, arguments.views).exported();
        let text = serde_json::to_string(&scene).unwrap_or_default() + "\n";
        std::fs::write(file, text)
            .map_err(|error| vec![Diagnostic::io(format!("write `{}`", file.display()), &error)])?;
        crate::print(&format!("{} boxes and {} views in {}\n", scene.boxes.len(), scene.views.len(), file.display()))?;
        return Ok(exit::SUCCESS);
    }
    let scratch = std::env::current_dir()
        .and_then(tempfile::tempdir_in)
        .map_err(|error| vec![Diagnostic::io("make a scratch folder here", &error)])?;
    let report = measure(&RenderOptions {
        grounds: grounds(arguments, camera)?,
        weathers: weathers(arguments)?,
        rounds: arguments.rounds,
        encoding: EncodingConfig::default(),
        threads: std::thread::available_parallelism().map_or(1, usize::from),
        flight_frames: arguments.frames,
        scratch: scratch.path(),
    })
    .map_err(|refusal| vec![refusal])?;
    let json = || serde_json::to_string_pretty(&report).unwrap_or_default() + "\n";
    crate::print(&if arguments.json { json() } else { report.to_string() })?;
    Ok(exit::SUCCESS)
}

fn camera(arguments: &BenchRenderArguments) -> Result<Camera, Refusals> {
    let config = RenderConfig { width: arguments.width, height: arguments.height, ..RenderConfig::default() };
    let refused =
        |message: String, hint: String| vec![Diagnostic::new("bench-parameters", Fault::Recipe, message).hint(hint)];
    config.validate().map_err(|problem| refused(problem.message, problem.hint))?;
    Ok(config.camera())
}

fn weathers(arguments: &BenchRenderArguments) -> Result<Vec<Weather>, Refusals> {
    let names: Vec<&str> = match arguments.weathers.is_empty() {
        true => WEATHERS.to_vec(),
        false => arguments.weathers.iter().map(String::as_str).collect(),
    };
    let weather = |name: &&str| {
        let mut weather = Weather::preset(name).ok_or_else(|| {
            let message = format!("there is no weather `{name}`");
            let hint = format!("the presets are {}", Weather::PRESETS.join(", "));
            vec![Diagnostic::new("bench-weather", Fault::Recipe, message).hint(hint)]
        })?;
        weather.sun_azimuth_angle = 215.0;
        Ok(weather)
    };
    names.iter().map(weather).collect()
}

fn grounds(arguments: &BenchRenderArguments, camera: Camera) -> Result<Vec<Ground>, Refusals> {
    let unreadable = |error: &dyn std::fmt::Display| {
        vec![Diagnostic::new("bench-town", Fault::Input, format!("the town cannot be read: {error}"))]
    };
    let town = match &arguments.town {
        None => Ground::downtown(camera, arguments.views).map_err(|error| unreadable(&error))?,
        Some(path) => {
            let map = std::fs::read(path)
                .map_err(|error| vec![Diagnostic::io(format!("read `{}`", path.display()), &error)])?;
            Ground::of_map(name_of(path), &map, camera, arguments.views).map_err(|error| unreadable(&error))?
        }
    };
    Ok(vec![town, Ground::of_boxes(arguments.box_count, camera, arguments.views)])
}

fn name_of(path: &Path) -> &str {
    path.file_stem().and_then(|stem| stem.to_str()).unwrap_or("town")
}
