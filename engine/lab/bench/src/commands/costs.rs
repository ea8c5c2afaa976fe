//! `costs`: core-seconds, bytes and money of a thousand frames by look and size, as the table of the book.

use super::outcome::{Outcome, Refusals, print};
use clap::Args;
use cosfly_diagnose::Diagnostic;
use cosfly_lab::render::RenderOptions;
use cosfly_lab::render::stages::{StageTimes, times};
use cosfly_render::{PictureLook, RenderConfig};
use cosfly_schema::EncodingConfig;
use std::fmt::Write;
use std::path::Path;

/// Examples of `costs`.
pub const EXAMPLES: &str = "\
Examples:
  cosfly-lab costs
  cosfly-lab costs --price 0.04              a column with the price at 0.04 per core-hour
  cosfly-lab costs --town my.xodr --views 40";

const SECONDS_PER_HOUR: f64 = 3600.0;

/// Sizes of the table, pixels: of networks, of small previews, of video.
const SIZES: [(u32, u32); 4] = [(84, 84), (224, 224), (640, 360), (1280, 720)];

/// Arguments of `costs`.
#[derive(Args, Debug)]
pub struct CostsArguments {
    /// An OpenDRIVE town instead of the one printed by `cosfly town`
    #[arg(long, value_name = "FILE")]
    pub town: Option<std::path::PathBuf>,
    /// Weather preset
    #[arg(long, value_name = "PRESET", default_value = "ClearNoon")]
    pub weather: String,
    /// Number of viewpoints
    #[arg(long, value_name = "N", default_value_t = 20, value_parser = super::outcome::counts())]
    pub views: usize,
    /// Rounds over all views; the minimum time counts
    #[arg(long, value_name = "N", default_value_t = 3, value_parser = super::outcome::counts())]
    pub rounds: usize,
    /// Price of a core-hour, in any currency: adds a column
    #[arg(long, value_name = "MONEY")]
    pub price: Option<f64>,
}

/// Costs of a thousand frames.
struct Row {
    name: &'static str,
    size: (u32, u32),
    core_s: f64,
    mb: f64,
}

/// Measures and prints a table in Markdown.
pub fn costs(arguments: &CostsArguments) -> Outcome {
    let scratch = std::env::current_dir()
        .and_then(tempfile::tempdir_in)
        .map_err(|error| vec![Diagnostic::io("make a scratch folder here", &error)])?;
    let mut rows = vec![];
    for size in SIZES {
        rows.extend(rows_of(size, arguments, scratch.path())?);
    }
    print(&table(&rows, arguments.price))
}

/// Rows of one size: depth and ids, the simple look, the full look.
fn rows_of(size: (u32, u32), arguments: &CostsArguments, scratch: &Path) -> Result<[Row; 3], Refusals> {
    let camera = RenderConfig { width: size.0, height: size.1, ..RenderConfig::default() }.camera();
    let options = RenderOptions {
        grounds: vec![super::ground::of_town(arguments.town.as_deref(), camera, arguments.views)?],
        weathers: vec![super::ground::weather(&arguments.weather)?],
        rounds: arguments.rounds,
        encoding: EncodingConfig::default(),
        threads: 1,
        flight_frames: 1,
        scratch,
    };
    let measured = |look| -> Result<StageTimes, Refusals> {
        times(&options.grounds[0], &options.weathers[0], look, &options).map_err(|refusal| vec![refusal])
    };
    let (simple, full) = (measured(PictureLook::Simple)?, measured(PictureLook::Full)?);
    // A millisecond a frame is a second a thousand frames; a kilobyte a frame is a megabyte.
    let row = |name, core_s, bytes: f64| Row { name, size, core_s, mb: bytes / 1e3 };
    Ok([
        row("depth and ids", simple.depth_and_ids_ms(), simple.depth_and_ids_bytes),
        row("simple", simple.whole_ms(), simple.log_bytes),
        row("full", full.whole_ms(), full.log_bytes),
    ])
}

fn table(rows: &[Row], price: Option<f64>) -> String {
    let priced = |text: &str| if price.is_some() { text.to_owned() } else { String::new() };
    let mut text = format!(
        "| look | size | core-seconds | MB |{}\n| --- | --- | ---: | ---: |{}\n",
        priced(" price |"),
        priced(" ---: |")
    );
    for Row { name, size: (width, height), core_s, mb } in rows {
        let _ = write!(text, "| {name} | {width} x {height} | {core_s:.1} | {mb:.1} |");
        let _ = match price {
            Some(price) => writeln!(text, " {:.6} |", price * core_s / SECONDS_PER_HOUR),
            None => writeln!(text),
        };
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_price_adds_a_column() {
        let row = Row { name: "full", size: (84, 84), core_s: 36.0, mb: 12.34 };
        let plain =
            "| look | size | core-seconds | MB |\n| --- | --- | ---: | ---: |\n| full | 84 x 84 | 36.0 | 12.3 |\n";
        assert_eq!(table(std::slice::from_ref(&row), None), plain);
        assert!(table(&[row], Some(0.5)).ends_with("| 36.0 | 12.3 | 0.005000 |\n"));
    }
}
