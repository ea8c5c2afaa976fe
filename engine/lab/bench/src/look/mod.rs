//! Statistics of how pictures look, beside those of real ones: spectral slope, flat pixels, edges, spread of colours.

mod spectrum;
mod statistics;
mod steady;

pub use statistics::{Statistics, of_picture};
pub use steady::{SteadyReport, SteadyRow, of_clips};

use crate::render::views::Ground;
use cosfly_diagnose::{Diagnostic, Fault, Result};
use cosfly_domain::Weather;
use cosfly_images::read::picture;
use cosfly_render::{FrameSetup, Renderer};
use serde::Serialize;
use std::fmt;
use std::path::Path;

/// Statistics of a set of pictures.
#[derive(Clone, Debug, Serialize)]
pub struct LookRow {
    /// Town and weather, or a folder.
    pub name: String,
    /// Number of pictures.
    pub pictures: usize,
    /// Lower quartile, median and upper quartile of each statistic.
    pub quartiles: [Statistics; 3],
}

/// Rows of all sets, printed as a table.
#[derive(Clone, Debug, Serialize)]
pub struct LookReport {
    /// Rows.
    pub rows: Vec<LookRow>,
}

/// Pictures of every view of a town in a weather, in the full look.
pub fn of_town(ground: &Ground, weather: &Weather) -> LookRow {
    let mut renderer = Renderer::new(ground.camera);
    let statistics = ground.views.iter().map(|view| {
        let setup = FrameSetup { pose: view.pose, weather, target: Some(view.target), others: &[] };
        of_picture(&renderer.render(&ground.scene, &setup).images.rgb, ground.camera.width as usize)
    });
    LookRow::of(format!("{}, {}", ground.name, weather.name), statistics.collect())
}

/// All JPEG and PNG files of a folder.
///
/// # Errors
/// The folder or a picture cannot be read, or there is none.
pub fn of_folder(folder: &Path) -> Result<LookRow> {
    let unreadable = |error: &std::io::Error| Diagnostic::io(format!("read `{}`", folder.display()), error);
    let entries = std::fs::read_dir(folder).map_err(|error| unreadable(&error))?;
    let mut paths = entries
        .map(|entry| entry.map(|entry| entry.path()))
        .collect::<std::io::Result<Vec<_>>>()
        .map_err(|error| unreadable(&error))?;
    paths.sort();
    let mut statistics = vec![];
    for path in paths {
        let format = match path.extension().and_then(|end| end.to_str()).map(str::to_ascii_lowercase).as_deref() {
            Some("jpg" | "jpeg") => "jpeg",
            Some("png") => "png",
            _ => continue,
        };
        let bytes =
            std::fs::read(&path).map_err(|error| Diagnostic::io(format!("read `{}`", path.display()), &error))?;
        let picture = picture(&bytes, format, None)?;
        statistics.push(of_picture(&picture.rgb, picture.size[0]));
    }
    if statistics.is_empty() {
        let message = format!("there is no JPEG or PNG picture in `{}`", folder.display());
        return Err(Diagnostic::new("bench-pictures", Fault::Input, message).hint("name a folder that holds pictures"));
    }
    Ok(LookRow::of(folder.display().to_string(), statistics))
}

impl LookRow {
    fn of(name: String, statistics: Vec<Statistics>) -> Self {
        let quartile = |share: f64| {
            Statistics::each(|pick| {
                let mut values: Vec<f64> = statistics.iter().map(pick).collect();
                values.sort_by(f64::total_cmp);
                values[((values.len() - 1) as f64 * share).round() as usize]
            })
        };
        let quartiles = [0.25, 0.5, 0.75].map(quartile);
        Self { name, pictures: statistics.len(), quartiles }
    }
}

impl fmt::Display for LookReport {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        writeln!(f, "Median (lower quartile, upper quartile) of each set")?;
        writeln!(
            f,
            "{:<34} {:>4}  {:^24}  {:^21}  {:^21}  {:^21}",
            "set", "", "spectral slope", "flat pixels, %", "edge pixels, %", "colour spread"
        )?;
        for LookRow { name, pictures, quartiles: [low, middle, high] } in &self.rows {
            let cell = |pick: fn(&Statistics) -> f64, digits: usize| {
                format!("{:.digits$} ({:.digits$}, {:.digits$})", pick(middle), pick(low), pick(high))
            };
            writeln!(
                f,
                "{name:<34} {pictures:>4}  {:^24}  {:^21}  {:^21}  {:^21}",
                cell(|it| it.spectral_slope, 2),
                cell(|it| 100.0 * it.flat_share, 1),
                cell(|it| 100.0 * it.edge_share, 1),
                cell(|it| it.colour_spread, 1),
            )?;
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use cosfly_domain::Camera;

    #[test]
    fn sets_have_ordered_quartiles_and_empty_folders_are_refused() {
        let camera = Camera { width: 160, height: 128, horizontal_fov_rad: 1.2 };
        let row = of_town(&Ground::of_boxes(60, camera, 3), &Weather::preset("ClearNoon").unwrap());
        let [low, middle, high] = row.quartiles;
        assert!(low.spectral_slope <= middle.spectral_slope && middle.flat_share <= high.flat_share);
        assert!(LookReport { rows: vec![row] }.to_string().contains("60 boxes, ClearNoon"));
        let empty = tempfile::tempdir().unwrap();
        assert_eq!(of_folder(empty.path()).unwrap_err().code, "bench-pictures");
    }
}
