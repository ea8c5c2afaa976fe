//! `cosfly verify`: re-checks a finished dataset.

use super::Outcome;
use crate::arguments::VerifyArguments;
use crate::exit;
use crate::text::{bytes, count};
use indicatif::{ProgressBar, ProgressStyle};
use std::fmt::Write;

/// Prints one line per finding and a verdict.
pub fn verify(arguments: &VerifyArguments) -> Outcome {
    // Draws nothing unless standard error is a terminal.
    let style = ProgressStyle::with_template("verify {wide_bar:.cyan/blue} {pos}/{len} flights {eta:>5} left")
        .unwrap_or_else(|_| ProgressStyle::default_bar());
    let bar = ProgressBar::new(0).with_style(style);
    let report = cosfly_verify::verify(&arguments.dir, &mut |done, all| {
        bar.set_length(all);
        bar.set_position(done);
    });
    bar.finish_and_clear();
    let report = report.map_err(|refusal| vec![refusal])?;
    let mut text = String::new();
    for finding in &report.findings {
        let _ = writeln!(text, "{finding}");
    }
    let hidden = report.found - report.findings.len() as u64;
    if hidden > 0 {
        let _ = writeln!(text, "... and {hidden} more");
    }
    let _ = writeln!(
        text,
        "checked {} of {}, {} with {}, {}",
        count(report.files, "file"),
        bytes(report.bytes),
        count(report.flights, "flight"),
        count(report.frames, "frame"),
        count(report.boxes, "target box").replace("boxs", "boxes"),
    );
    if report.labels > 0 {
        let _ = writeln!(
            text,
            "visible shares by rays and by pixels agree within 5 points in {} of {}{}",
            report.labels - report.gaps,
            count(report.labels, "frame"),
            if report.gaps > 0 { "; not in these:" } else { "" }
        );
    }
    for gap in &report.label_gaps {
        let _ = writeln!(text, "  {gap}");
    }
    let hidden = report.gaps - report.label_gaps.len() as u64;
    if hidden > 0 {
        let _ = writeln!(text, "  ... and {hidden} more");
    }
    let _ = match report.found {
        0 => writeln!(text, "nothing wrong was found"),
        found => writeln!(text, "{} found", count(found, "problem")),
    };
    let mut wrong = 0;
    if let Some(number) = arguments.regenerate {
        let (told, found) = super::regenerate::regenerated(arguments, usize::from(number))?;
        text += &told;
        wrong = found;
    }
    crate::print(&text)?;
    Ok(if report.is_sound() && wrong == 0 { exit::SUCCESS } else { exit::FOUND_PROBLEMS })
}
