//! `cosfly preview`: pictures of a finished flight.

use super::{Outcome, Refusals};
use crate::arguments::PreviewArguments;
use crate::exit;
use crate::text::{bytes, count};
use cosfly_diagnose::Diagnostic;
use cosfly_preview::Pictures;
use cosfly_read::{PublishedDataset, PublishedFlight};
use indicatif::{ProgressBar, ProgressStyle};
use std::fmt::Write;
use std::path::{Path, PathBuf};

/// Draws the pictures and says where they are.
pub fn preview(arguments: &PreviewArguments) -> Outcome {
    let dataset = PublishedDataset::open(&arguments.dir).map_err(one)?;
    let flight = match &arguments.trajectory {
        Some(id) => dataset.flight(id).map_err(one)?,
        None => &dataset.flights()[0],
    };
    let pictures = draw(&dataset, flight, arguments).map_err(one)?;
    let out = arguments.out.clone().unwrap_or_else(|| beside(&arguments.dir));
    let written = write(&out, flight, &pictures)?;
    crate::print(&report(&dataset, flight, &pictures, &written))?;
    Ok(exit::SUCCESS)
}

fn one(refusal: Box<Diagnostic>) -> Refusals {
    vec![refusal]
}

fn draw(
    dataset: &PublishedDataset,
    flight: &PublishedFlight,
    arguments: &PreviewArguments,
) -> cosfly_diagnose::Result<Pictures> {
    // Draws nothing unless standard error is a terminal.
    let style = ProgressStyle::with_template("reading {wide_bar:.cyan/blue} {pos}/{len} frames {eta:>5} left")
        .unwrap_or_else(|_| ProgressStyle::default_bar());
    let bar = ProgressBar::new(0).with_style(style);
    let pictures = cosfly_preview::draw(dataset, flight, arguments.frames.as_ref(), &mut |done, all| {
        bar.set_length(all);
        bar.set_position(done);
    });
    bar.finish_and_clear();
    pictures
}

/// The folder next to the dataset's: inside it, `verify` would find files that do not belong there.
fn beside(dataset: &Path) -> PathBuf {
    let folder = dataset.canonicalize().unwrap_or_else(|_| dataset.to_owned());
    let name = folder.file_name().map_or_else(|| "dataset".into(), |name| name.to_string_lossy().into_owned());
    folder.with_file_name(format!("{name}-preview"))
}

/// Writes the files; their paths and sizes.
fn write(out: &Path, flight: &PublishedFlight, pictures: &Pictures) -> Result<Vec<(PathBuf, u64)>, Refusals> {
    let refused = |error: std::io::Error| one(Diagnostic::io(format!("write pictures to `{}`", out.display()), &error));
    std::fs::create_dir_all(out).map_err(refused)?;
    let files = [("sheet.png", &pictures.sheet), ("clip.gif", &pictures.clip), ("plan.png", &pictures.plan)];
    let mut written = vec![];
    for (name, file) in files {
        let path = out.join(format!("{}-{name}", flight.trajectory_id));
        // Renamed when whole: a full disk leaves no half picture.
        let partial = path.with_extension("part");
        let outcome = std::fs::write(&partial, file).and_then(|()| std::fs::rename(&partial, &path));
        if outcome.is_err() {
            let _ = std::fs::remove_file(&partial);
        }
        outcome.map_err(refused)?;
        written.push((path, file.len() as u64));
    }
    Ok(written)
}

fn report(
    dataset: &PublishedDataset,
    flight: &PublishedFlight,
    pictures: &Pictures,
    written: &[(PathBuf, u64)],
) -> String {
    let [rows, shots] = pictures.shown.map(|number| count(number as u64, "frame"));
    let about = [
        format!("contact sheet of {rows}: colours, depth, labels, the target enlarged"),
        format!("clip of {shots}"),
        "plan: town, walk, flights coloured by visibility".to_owned(),
    ];
    let here = std::env::current_dir().ok();
    let mut text = format!("{} of {}\n", flight.trajectory_id, dataset.folder().display());
    for ((path, size), about) in written.iter().zip(about) {
        let path = here.as_ref().and_then(|here| path.strip_prefix(here).ok()).unwrap_or(path);
        let _ = writeln!(text, "  {}  {about} ({})", path.display(), bytes(*size));
    }
    let others = dataset.flights().len() - 1;
    if others > 0 {
        let other = dataset.flights().iter().find(|it| *it != flight).map_or("", |it| it.trajectory_id.as_str());
        let _ = writeln!(text, "{} more: `--trajectory {other}`", count(others as u64, "flight"));
    }
    text
}
