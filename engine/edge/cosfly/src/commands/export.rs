//! `cosfly export`: a finished dataset in the format of others.

use super::Outcome;
use crate::arguments::{BoxScaleChoice, ExportArguments, FrameChoice, RoleChoice};
use crate::exit;
use crate::text::{bytes, count};
use cosfly_diagnose::{Diagnostic, Fault, Result};
use cosfly_export::{BoxScale, Input, Options, OutFolder, Source, exporter};
use cosfly_metrics::{DeltaFrame, WindowShape};
use cosfly_read::PublishedDataset;
use indicatif::{ProgressBar, ProgressStyle};
use std::fmt::Write;

/// Writes the export and says what is in it.
pub fn export(arguments: &ExportArguments) -> Outcome {
    crate::print(&written(arguments).map_err(|refusal| vec![refusal])?)?;
    Ok(exit::SUCCESS)
}

fn written(arguments: &ExportArguments) -> Result<String> {
    let dataset = PublishedDataset::open(&arguments.dir)?;
    let options = options(arguments);
    let format = exporter(&arguments.format).ok_or_else(|| {
        Diagnostic::new("export-format", Fault::Recipe, format!("there is no format `{}`", arguments.format))
    })?;
    // Draws nothing unless standard error is a terminal.
    let style = ProgressStyle::with_template("export {wide_bar:.cyan/blue} {pos}/{len} frames {eta:>5} left")
        .unwrap_or_else(|_| ProgressStyle::default_bar());
    let bar = ProgressBar::new(0).with_style(style);
    let progress = |done, all| {
        bar.set_length(all);
        bar.set_position(done);
    };
    let source = Source::new(&dataset, &options, &progress)?;
    let out = OutFolder::begin(&arguments.out, dataset.folder())?;
    let remarks = format.export(&source, &out)?;
    let written = out.finish()?;
    bar.finish_and_clear();
    let mut text = format!(
        "{}: {} of {}, format {}\n",
        arguments.out.display(),
        count(written.files, "file"),
        bytes(written.bytes),
        format.name()
    );
    for remark in remarks {
        let _ = writeln!(text, "  {remark}");
    }
    Ok(text)
}

fn options(arguments: &ExportArguments) -> Options {
    Options {
        splits: arguments.splits.clone(),
        trajectories: arguments.trajectories.clone(),
        every: arguments.every,
        language: arguments.language.clone(),
        delta_frame: match arguments.frame {
            FrameChoice::World => DeltaFrame::World,
            FrameChoice::Body => DeltaFrame::Body,
        },
        input: match arguments.input {
            RoleChoice::Perturbed => Input::Perturbed,
            RoleChoice::Expert => Input::Expert,
        },
        box_scale: match arguments.box_scale {
            BoxScaleChoice::Pixels => BoxScale::Pixels,
            BoxScaleChoice::Thousandths => BoxScale::Thousandths,
        },
        window: WindowShape { history: arguments.history, horizon: arguments.horizon, stride: arguments.stride },
        towns: arguments.towns.clone(),
        shard_bytes: arguments.shard_size as u64 * 1_000_000,
    }
}
